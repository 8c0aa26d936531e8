// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_contact_history.hpp"

#include <algorithm>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/domain.h>
#include <liggghts/output.h>
#include <liggghts/update.h>

#include "pair_gran.hpp"
#include "team.hpp"

namespace granflux::particle_subset {

void FixContactHistory::setup_pre_exchange() {
  if (*computeflag_) // else the particles' arrays are what counts
    take_over(false);
}

void FixContactHistory::pre_exchange() {
  take_over(one_side_will_do());
}

/// The lists that are about to be built are all that looks at the arrays: a step, no ghosts, and no
/// restart file is due in it.
bool FixContactHistory::one_side_will_do() const {
  const bool ghosts =
      comm->nprocs > 1 || domain->xperiodic || domain->yperiodic || domain->zperiodic;
  const bool step = update->whichflag == 1 && !update->setupflag;
  return step && !ghosts && output->next != update->ntimestep;
}

void FixContactHistory::take_over(bool one_sided) {
  auto* pair = dynamic_cast<PairGran*>(pair_gran_);
  const bool from_threads = pair && pair->holds_history();
  one_sided_ = from_threads && one_sided;
  if (!from_threads) {
    LAMMPS_NS::FixContactHistory::pre_exchange();
    return;
  }
  // From here on the particles' arrays are what counts, as in the stock fix.
  *computeflag_ = 0;
  ipage_->reset();
  dpage_->reset();
  // Also of particles that have been inserted since.
  for_each_subset(atom->nmax, [this](Range range) {
    std::fill(npartner_ + range.begin, npartner_ + range.end, 0);
  });
  maxtouch_ = pair->store_history(arrays());
  comm->maxexchange_fix = std::max(comm->maxexchange_fix, (dnum_ + 1) * maxtouch_ + 1);
}

} // namespace granflux::particle_subset
