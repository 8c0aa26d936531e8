// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "neighbor.hpp"

#include <cmath>
#include <limits>

#include <mpi.h>

#include <liggghts/atom.h>
#include <liggghts/force.h>

#include <algorithm>
#include <atomic>

#include "pair_gran.hpp"
#include "team.hpp"
#include "verlet.hpp"

namespace granflux::particle_subset {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();
// The bound is a sum over steps: its rounding error stays far below this share of it.
constexpr double rounding = 1e-9;

} // namespace

Neighbor::Neighbor(LAMMPS_NS::LAMMPS* lammps) : LAMMPS_NS::Neighbor(lammps), travel_(unknown) {}

void Neighbor::init() {
  LAMMPS_NS::Neighbor::init();
  take_over_integrator(*lmp); // the last of the host's parts that the script may have changed
}

void Neighbor::build(int topology) {
  LAMMPS_NS::Neighbor::build(topology);
  if (auto* pair = dynamic_cast<PairGran*>(force->pair))
    pair->build_lists();
  travel_ = 0;
}

void Neighbor::hears_all_motion(bool all) {
  if (!all)
    travel_ = unknown;
}

int Neighbor::check_distance() {
  if (boxcheck || triclinic || atom->radvary_flag)
    return LAMMPS_NS::Neighbor::check_distance();
  const bool possible = travel_ * (1 + rounding) > std::sqrt(triggersq);
  int moved = possible && any_beyond_trigger();
  MPI_Allreduce(MPI_IN_PLACE, &moved, 1, MPI_INT, MPI_MAX, world);
  if (moved && ago == std::max(every, delay))
    ++ndanger;
  return moved;
}

bool Neighbor::any_beyond_trigger() const {
  const int count = includegroup ? atom->nfirst : atom->nlocal;
  if (count == 0)
    return false;
  const double* now = atom->x[0];
  const double* then = xhold[0];
  std::atomic<bool> found = false;
  for_each_subset(count, [&](Range range) {
    for (int i = 3 * range.begin; i < 3 * range.end; i += 3) {
      const double x = now[i] - then[i];
      const double y = now[i + 1] - then[i + 1];
      const double z = now[i + 2] - then[i + 2];
      if (x * x + y * y + z * z > triggersq) {
        found.store(true, std::memory_order_relaxed);
        return;
      }
    }
  });
  return found;
}

} // namespace granflux::particle_subset
