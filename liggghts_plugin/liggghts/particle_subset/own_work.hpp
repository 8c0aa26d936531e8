// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "subset.hpp"

namespace granflux::particle_subset {

/// A part of the forces of a step in which each thread adds to its own particles only and looks at
/// no forces of others: threads go from one such part to the next without waiting for each other.
class OwnWork {
public:
  /// What one thread has to do before; looks at no forces. False: not in this step, which asks for
  /// more than forces: the host's own call is to be made.
  virtual bool begin_own_work(int eflag, int vflag) = 0;
  /// On each thread, with its share of the rank's particles: what must be done before any of it is
  /// gone through.
  virtual void start_own_work(int /*thread*/, Range /*own*/) {}
  /// On each thread, for one block of its share after the other, ascending: all parts work on a
  /// block while it is in the cache. Adds to particles of the block; contacts, whose reach is known
  /// to those who clear forces, to later ones of the share too.
  virtual void own_work(int thread, Range block) = 0;
  /// What one thread has to do afterwards.
  virtual void end_own_work() {}
  /// Whether that looks at the particles' motion, which must not have gone on until then.
  [[nodiscard]] virtual bool looks_back() const { return false; }

protected:
  ~OwnWork() = default;
};

} // namespace granflux::particle_subset
