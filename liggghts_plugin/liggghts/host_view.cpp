// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "host_view.hpp"

#include <cstdio>
#include <string_view>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/fix.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/modify.h>

#include "contact_times.hpp"
#include "fix_checkpoint.hpp"
#include "fix_heat.hpp"
#include "scene.hpp"

namespace granflux::liggghts {

namespace {

/// The rows of LIGGGHTS' two-dimensional arrays are contiguous; without particles there is none.
template <class Row> std::span<Row> rows(double** array, std::size_t n) {
  return n ? std::span<Row>(reinterpret_cast<Row*>(array[0]), n) : std::span<Row>();
}

} // namespace

HostView::HostView(LAMMPS_NS::LAMMPS* lammps, int group_bit, int held_bit)
    : Pointers(lammps), groups_(group_bit, held_bit) {}

void HostView::find_held() {
  groups_.forget_fixes();
  for (const LAMMPS_NS::Fix* fix : std::span(modify->fix, std::size_t(modify->nfix))) {
    if (std::string_view(fix->style) == "freeze")
      groups_.add_frozen(fix->groupbit);
    if (fix->time_integrate)
      groups_.add_moved(fix->groupbit);
  }
}

driver::Scene HostView::scene() {
  return scene_of(*lmp);
}

driver::ContactTimes HostView::contact_times() {
  return contact_times_of(*lmp);
}

coupling::ParticleView HostView::particles(bool with_id) {
  const auto n = std::size_t(atom->nlocal);
  coupling::ParticleView view;
  view.position = rows<const Vec3>(atom->x, n);
  view.velocity = rows<Vec3>(atom->v, n);
  view.force = rows<Vec3>(atom->f, n);
  view.radius = {atom->radius, n};
  view.mass = {atom->rmass, n};
  view.fluid = rows<coupling::FluidState>(fluid_->array_atom, n);
  groups_.show({atom->mask, n}, view);
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
  const auto n = std::size_t(atom->nlocal);
  groups_.clear_frozen_forces({atom->mask, n}, rows<Vec3>(atom->f, n));
}

double HostView::step_temperatures() {
  return heat_->step_with_gas(heat_states());
}

const FixCheckpoint* HostView::checkpoint() const {
  for (int i = 0; i < modify->nfix; ++i)
    if (const auto* found = dynamic_cast<const FixCheckpoint*>(modify->fix[i]))
      return found;
  return nullptr;
}

bool HostView::forces_come_back() {
  const FixCheckpoint* fix = checkpoint();
  return fix && fix->brings_forces();
}

std::optional<driver::GoodCheckpoint> HostView::last_checkpoint() {
  const FixCheckpoint* fix = checkpoint();
  return fix ? fix->point().last() : std::nullopt;
}

void HostView::describe(coupling::SceneState& scene) {
  describe_particles(*lmp, scene);
  for (LAMMPS_NS::Fix* fix : std::span(modify->fix, std::size_t(modify->nfix)))
    if (auto* heat = dynamic_cast<FixHeat*>(fix))
      heat->describe(scene);
}

void HostView::say(const std::string& text) {
  if (comm->me != 0)
    return;
  for (FILE* out : {screen, logfile})
    if (out) {
      std::fputs(text.c_str(), out);
      std::fflush(out);
    }
}

} // namespace granflux::liggghts
