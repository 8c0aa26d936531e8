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
/// granflux/checkpoint` is in every host. The host builds its lists in a checkpoint step: for the
/// script's interval it is told of the step before; one that a signal asks for waits until lists
/// are built anyway, so that it leaves no trace in the run, unless that takes too long. Calls are
/// collective.
class Checkpointer {
public:
  /// Throws ConfigError where the file cannot be written.
  Checkpointer(std::span<char*> words, MPI_Comm comm);

  /// Before a run: the steps it starts from and ends with.
  void start(long now, long last);
  /// The next step that must build lists and end with a checkpoint.
  [[nodiscard]] long due() const { return due_; }
  /// In a step in which the host builds its lists.
  void lists_are_built(long now);
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
  long due_ = -1, last_of_run_ = -1;
  StopSignals::Wish wish_ = StopSignals::Wish::none; ///< of all ranks
  double asked_ = 0;                                 ///< when, on this rank's clock [s]
  bool forced_ = false;                              ///< lists are built for a signal's checkpoint
  std::optional<GoodCheckpoint> last_;
};

/// Throws NumericalError on all ranks, naming what, where a number is not finite. Collective.
void check_finite(std::span<const Vec3> values, const std::string& what, MPI_Comm comm);

} // namespace granflux::driver
