// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "host_view.hpp"

#include <algorithm>
#include <string_view>

#include <liggghts/atom.h>
#include <liggghts/fix.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/modify.h>

#include "fix_heat.hpp"

namespace granflux::liggghts {

namespace {

/// The rows of LIGGGHTS' two-dimensional arrays are contiguous; without particles there is none.
template <class Row> std::span<Row> rows(double** array, std::size_t n) {
  return n ? std::span<Row>(reinterpret_cast<Row*>(array[0]), n) : std::span<Row>();
}

constexpr int all_bit = 1; // bit of LIGGGHTS' group `all`

} // namespace

HostView::HostView(LAMMPS_NS::LAMMPS* lammps, LAMMPS_NS::FixPropertyAtom& fluid, int group_bit,
                   int held_bit)
    : Pointers(lammps), fluid_(fluid), group_bit_(group_bit), held_bit_(held_bit) {}

void HostView::find_held() {
  frozen_bits_ = moved_bits_ = 0;
  for (const LAMMPS_NS::Fix* fix : std::span(modify->fix, std::size_t(modify->nfix))) {
    if (std::string_view(fix->style) == "freeze")
      frozen_bits_ |= fix->groupbit;
    if (fix->time_integrate)
      moved_bits_ |= fix->groupbit;
  }
}

coupling::ParticleView HostView::particles(bool with_id) {
  const auto n = std::size_t(atom->nlocal);
  coupling::ParticleView view;
  view.position = rows<const Vec3>(atom->x, n);
  view.velocity = rows<Vec3>(atom->v, n);
  view.force = rows<Vec3>(atom->f, n);
  view.radius = {atom->radius, n};
  view.mass = {atom->rmass, n};
  view.fluid = rows<coupling::FluidState>(fluid_.array_atom, n);

  const std::span<const int> mask(atom->mask, n);
  if (group_bit_ != all_bit) {
    coupled_.resize(n);
    std::ranges::transform(mask, coupled_.begin(),
                           [&](int m) { return std::uint8_t((m & group_bit_) != 0); });
    view.coupled = coupled_;
  }
  if (frozen_bits_ || held_bit_ || !(moved_bits_ & all_bit)) {
    fixed_.resize(n);
    std::ranges::transform(mask, fixed_.begin(), [&](int m) {
      return std::uint8_t((m & (frozen_bits_ | held_bit_)) != 0 || (m & moved_bits_) == 0);
    });
    view.fixed = fixed_;
  }
  if (heat_) {
    heat_->show_to_gas(view);
    view.heat = {heat_states(), n};
  }
  if (with_id && atom->tag_enable) {
    id_.assign(atom->tag, atom->tag + n);
    view.id = id_;
  }
  return view;
}

coupling::HeatState* HostView::heat_states() const {
  double** array = heat_states_->array_atom;
  return array ? reinterpret_cast<coupling::HeatState*>(array[0]) : nullptr;
}

void HostView::clear_frozen_forces() {
  if (!frozen_bits_)
    return;
  const auto n = std::size_t(atom->nlocal);
  const std::span<Vec3> forces = rows<Vec3>(atom->f, n);
  for (std::size_t i = 0; i < n; ++i)
    if (atom->mask[i] & frozen_bits_)
      forces[i] = {};
}

} // namespace granflux::liggghts
