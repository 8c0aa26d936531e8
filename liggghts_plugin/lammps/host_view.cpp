// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "host_view.hpp"

#include "contact_times.hpp"
#include "fix_checkpoint.hpp"
#include "scene.hpp"

namespace granflux::lammps {

HostView::HostView(LAMMPS_NS::LAMMPS* lammps, ParticleRows& fluid, int group_bit, int held_bit)
    : ScriptHost(lammps, group_bit, held_bit), fluid_(fluid) {}

driver::ContactTimes HostView::contact_times() {
  return contact_times_of(*lmp);
}

std::optional<Vec3> HostView::gravity() {
  return gravity_of(*lmp);
}

std::span<coupling::FluidState> HostView::fluid_states() {
  return fluid_.view<coupling::FluidState>(atom->nlocal);
}

std::span<coupling::HeatState> HostView::heat_states() {
  return heat_states_->view<coupling::HeatState>(atom->nlocal);
}

} // namespace granflux::lammps
