// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_contact_history.hpp"

#include <algorithm>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>

#include "pair_gran.hpp"

namespace granflux::particle_subset {

void FixContactHistory::pre_exchange() {
  auto* pair = dynamic_cast<PairGran*>(pair_gran_);
  if (!pair || !pair->holds_history()) {
    LAMMPS_NS::FixContactHistory::pre_exchange();
    return;
  }
  // From here on the particles' arrays are what counts, as in the stock fix.
  *computeflag_ = 0;
  std::fill_n(npartner_, atom->nmax, 0);
  ipage_->reset();
  dpage_->reset();
  pair->store_history(arrays());
  maxtouch_ = 0;
  if (atom->nlocal > 0)
    maxtouch_ = *std::max_element(npartner_, npartner_ + atom->nlocal);
  comm->maxexchange_fix = std::max(comm->maxexchange_fix, (dnum_ + 1) * maxtouch_ + 1);
}

} // namespace granflux::particle_subset
