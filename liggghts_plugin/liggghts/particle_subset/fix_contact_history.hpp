// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <liggghts/fix_contact_history.h>

#include "contact_lists.hpp"

namespace granflux::particle_subset {

/// LIGGGHTS' fix contacthistory, which carries the memory of contacts with the particles over
/// exchange, sorting and restarts, filled from the lists of the threads where the pair style has
/// them.
class FixContactHistory : public LAMMPS_NS::FixContactHistory {
public:
  FixContactHistory(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
      : LAMMPS_NS::FixContactHistory(lammps, narg, arg) {}

  /// What is taken over here goes to files and other ranks as it is.
  void setup_pre_exchange() override;
  void pre_exchange() override;
  [[nodiscard]] PartnerHistory arrays() {
    return {npartner_, partner_, contacthistory_, one_sided_};
  }

private:
  void take_over(bool one_sided);
  [[nodiscard]] bool one_side_will_do() const;

  bool one_sided_ = false;
};

} // namespace granflux::particle_subset
