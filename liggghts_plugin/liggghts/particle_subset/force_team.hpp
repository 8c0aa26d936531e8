// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

#include "own_work.hpp"

namespace granflux::particle_subset {

/// Gathers parts of the forces and does them in one go of all threads, block of particles after
/// block.
class ForceTeam {
public:
  /// `seconds`: what the time of the first thread is added to.
  void add(OwnWork& part, double& seconds) { parts_.push_back({&part, &seconds}); }
  /// Whether one of the parts looks at the particles' motion at its end.
  [[nodiscard]] bool looks_back() const;
  /// Does all that was added, for the `owned` particles of the rank; adds to `waiting` the time
  /// that the first thread waits for the others.
  void work(int owned, double& waiting);

private:
  struct Part {
    OwnWork* work;
    double* seconds;
  };
  void work_through(int thread, Range own, auto&& after);

  std::vector<Part> parts_;
};

} // namespace granflux::particle_subset
