// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "host_view.hpp"

#include <liggghts/fix_property_atom.h>

#include "contact_times.hpp"
#include "fix_checkpoint.hpp"
#include "scene.hpp"

namespace granflux::liggghts {

HostView::HostView(LAMMPS_NS::LAMMPS* lammps, int group_bit, int held_bit)
    : ScriptHost(lammps, group_bit, held_bit) {}

driver::ContactTimes HostView::contact_times() {
  return contact_times_of(*lmp);
}

std::optional<Vec3> HostView::gravity() {
  return gravity_of(*lmp);
}

std::span<coupling::FluidState> HostView::fluid_states() {
  return driver::rows_of<coupling::FluidState>(fluid_->array_atom, std::size_t(atom->nlocal));
}

std::span<coupling::HeatState> HostView::heat_states() {
  return driver::rows_of<coupling::HeatState>(heat_states_->array_atom, std::size_t(atom->nlocal));
}

} // namespace granflux::liggghts
