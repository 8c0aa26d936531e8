// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>
#include <mpi.h>
#include <optional>
#include <span>
#include <string>

#include <granflux/cfd/vec3.hpp>

#include "checkpoint_options.hpp"
#include "stop_signals.hpp"

namespace granflux::driver {

/// The last checkpoint that is whole, for messages.
struct GoodCheckpoint {
  std::string file;
  long step = 0;
};

/// When checkpoints of a host's run are due, and how one gets on the disk: what `fix
/// granflux/checkpoint` is in every host. A checkpoint step is known one step ahead, for the host
/// builds its lists in it. Calls are collective.
class Checkpointer {
public:
  /// Throws ConfigError where the file cannot be written.
  Checkpointer(std::span<char*> words, MPI_Comm comm);

  /// Before a run: `now` is the step it starts from.
  void start(long now);
  /// The next step that ends with a checkpoint.
  [[nodiscard]] long due() const { return due_; }
  /// At the end of every step that is not due: looks, in some, whether a signal has come.
  void look(long now);

  /// At the end of the step that is due. `host_writes`: to the file of that name. Throws
  /// NumericalError on all ranks where the file cannot be written; the last one is then still
  /// there. Returns whether the run is to stop.
  bool write(long now, const std::function<void(const std::string& path)>& host_writes);

  /// What a user needs to know after a stop.
  [[nodiscard]] std::string how_to_continue() const;
  [[nodiscard]] const std::optional<GoodCheckpoint>& last() const { return last_; }

private:
  void plan(long now);

  MPI_Comm comm_;
  CheckpointOptions options_;
  StopSignals signals_;
  long due_ = -1;
  bool stop_ = false;
  std::optional<GoodCheckpoint> last_;
};

/// Throws NumericalError on all ranks, naming what, where a number is not finite. Collective.
void check_finite(std::span<const Vec3> values, const std::string& what, MPI_Comm comm);

} // namespace granflux::driver
