// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>
#include <vector>

namespace granflux::cfd {

/// A node of another rank, by its number there.
struct RemoteNode {
  int rank, number;
  friend auto operator<=>(const RemoteNode&, const RemoteNode&) = default;
};

/// Brings values of other ranks' nodes: they follow a rank's own nodes in its arrays.
class GraphHalo {
public:
  GraphHalo() = default;
  /// `ghosts` in increasing order, each once. Collective.
  GraphHalo(MPI_Comm comm, int own, std::vector<RemoteNode> ghosts);

  /// Collective.
  void exchange(std::vector<float>& values) const { exchange_values(values, MPI_FLOAT); }
  void exchange(std::vector<int>& values) const { exchange_values(values, MPI_INT); }
  [[nodiscard]] const std::vector<RemoteNode>& ghosts() const { return ghosts_; }

private:
  template <class Value> void exchange_values(std::vector<Value>& values, MPI_Datatype type) const;

  struct Message {
    int rank;
    std::vector<int> nodes; ///< own ones
  };
  struct Range {
    int rank, first, count; ///< of the ghosts
  };
  MPI_Comm comm_ = MPI_COMM_NULL;
  int own_ = 0;
  std::vector<RemoteNode> ghosts_;
  std::vector<Message> sends_;
  std::vector<Range> receives_;
};

} // namespace granflux::cfd
