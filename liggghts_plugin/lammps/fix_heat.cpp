// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_heat.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include <lammps/atom.h>
#include <lammps/comm.h>
#include <lammps/domain.h>
#include <lammps/error.h>
#include <lammps/force.h>
#include <lammps/group.h>
#include <lammps/lammps.h>
#include <lammps/modify.h>
#include <lammps/neigh_list.h>
#include <lammps/pair.h>
#include <lammps/update.h>

#include <granflux/cfd/vec3.hpp>

#include "contact_times.hpp"
#include "driver/restart_values.hpp"
#include "fix_couple.hpp"
#include "particle_subset/temperature_step.hpp"
#include "scene.hpp"

namespace granflux::lammps {

using particle_subset::FrictionHeat;

namespace {

/// Pair styles whose function `single` gives the force of one contact as LAMMPS applied it.
constexpr std::string_view with_single[] = {"gran/hooke", "gran/hooke/history",
                                            "gran/hertz/history"};
/// Its tangential force is one of the slip of the moment, and all of its work is lost.
constexpr std::string_view without_memory = "gran/hooke";

constexpr int tangential_force = 0; // from here on in Pair::svector

Vec3 row(double** array, int i) {
  return {array[i][0], array[i][1], array[i][2]};
}

/// Velocity of i's surface relative to j's at their contact, tangential; `apart`: from j to i,
/// whose square is `squared`.
Vec3 slip_of(const LAMMPS_NS::Atom& atom, int i, int j, const Vec3& apart, double squared) {
  const Vec3 relative = row(atom.v, i) - row(atom.v, j);
  const Vec3 spin = atom.radius[i] * row(atom.omega, i) + atom.radius[j] * row(atom.omega, j);
  return relative - (dot(relative, apart) / squared) * apart -
         (1 / std::sqrt(squared)) * cross(spin, apart);
}

} // namespace

FixHeat::FixHeat(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
    : HeatFix(lammps, narg, arg), temperature_(std::vector<double>(1)),
      carry_(std::vector<double>(1)) {
  restart_peratom = 1;
  create_attribute = 1;
  peratom_flag = 1;
  size_peratom_cols = 0;
  peratom_freq = 1;
  comm_forward = 1;
  comm_reverse = 2;
  maxexchange = 2;
  guarded([&] {
    check_script();
    words_ = read_heat_words({arg + 3, std::size_t(narg - 3)}, atom->ntypes);
    check_groups();
  });
  find_law();
  temperature_ = ParticleRows(std::vector<double>{words_.options.initial_temperature});
  grow_arrays(atom->nmax);
  atom->add_callback(LAMMPS_NS::Atom::GROW);
  atom->add_callback(LAMMPS_NS::Atom::RESTART);
}

FixHeat::~FixHeat() {
  atom->delete_callback(id, LAMMPS_NS::Atom::GROW);
  atom->delete_callback(id, LAMMPS_NS::Atom::RESTART);
}

void FixHeat::find_law() {
  const auto& contacts = words_.options.contacts;
  touching_ = contacts.radius || contacts.friction != FrictionHeat::off;
  law_ = particle_subset::ContactHeat(
      contacts, words_.materials,
      std::vector<double>(words_.materials.size() * words_.materials.size(), 1));
}

void FixHeat::keep(driver::EffectSet on) {
  words_.options.keep(on);
  find_law();
}

std::optional<Vec3> FixHeat::gravity() const {
  return gravity_of(*lmp);
}

void FixHeat::describe(coupling::SceneState& scene) {
  const particle_subset::ThermalMaterial& material = words_.materials.front();
  coupling::HeatOfScene heat{.heat_capacity = words_.capacity.front(),
                             .conductivity = material.conductivity};
  if (words_.knows_moduli) {
    heat.young = material.young;
    heat.poisson = material.poisson;
  }
  driver::add_temperatures(scene, {temperature_.data(), std::size_t(atom->nlocal)}, world);
  scene.heat = heat;
}

int FixHeat::setmask() {
  return LAMMPS_NS::FixConst::POST_FORCE | LAMMPS_NS::FixConst::POST_RUN;
}

void FixHeat::check_script() const {
  if (!atom->radius_flag || !atom->rmass_flag)
    throw ConfigError(fmt::format("atom_style {}: particles must have a radius and a mass each, as "
                                  "those of atom_style sphere",
                                  atom->atom_style));
}

/// Forces of contacts come from the pair style, one by one.
void FixHeat::check_pair_style() const {
  if (!touching_)
    return;
  const std::string_view pair = force->pair_style ? force->pair_style : "none";
  if (std::ranges::find(with_single, pair) == std::end(with_single))
    throw ConfigError(fmt::format("pair_style {}: heat of contacts needs gran/hooke, "
                                  "gran/hooke/history or gran/hertz/history, or conduction off and "
                                  "friction off",
                                  pair));
  if (words_.options.contacts.friction != FrictionHeat::off && pair != without_memory)
    throw ConfigError(fmt::format("friction speed: the tangential force of pair_style {} has a "
                                  "spring, which LAMMPS does not hand on: needs gran/hooke, or "
                                  "friction off",
                                  pair));
  if (!comm->ghost_velocity)
    throw ConfigError("comm_modify vel no: must be yes");
}

void FixHeat::init() {
  guarded([&] {
    begin_run();
    check_pair_style();
  });
  frozen_ = 0;
  for (int i = 0; i < modify->nfix; ++i)
    if (std::string_view(modify->fix[i]->style) == "freeze")
      frozen_ |= modify->fix[i]->groupbit;
}

void FixHeat::setup(int) {
  guarded([&] {
    if (touching_)
      check_heat_every([&] { return contact_times_of(*lmp); });
  });
  open_books();
}

std::string FixHeat::method() const {
  const auto& contacts = words_.options.contacts;
  return fmt::format(
      "granflux: heat of contacts beside LAMMPS' own forces; conduction {}, friction {}; walls are "
      "adiabatic\n",
      contacts.radius
          ? std::visit([](const auto& r) { return std::string(r.name); }, *contacts.radius)
          : "off",
      contacts.friction == FrictionHeat::off ? "off" : "speed");
}

/// Along LAMMPS' own list, after the forces and with the velocities that they came from.
driver::HeatPowers FixHeat::sum_contacts() {
  comm->forward_comm_fix(this);
  const double* temperature = temperature_.data();
  LAMMPS_NS::Pair& pair = *force->pair;
  const LAMMPS_NS::NeighList& list = *pair.list;
  const bool by_force = !law_.needs_no_force();
  const bool friction = words_.options.contacts.friction != FrictionHeat::off;
  const int theirs = force->newton_pair ? atom->nlocal + atom->nghost : atom->nlocal;
  contacts_.assign(std::size_t(theirs), {});
  double made = 0, conducted = 0;
  const auto give = [&](int particle, double rate, double conductance) {
    if (particle >= theirs)
      return; // its own rank has the pair too
    contacts_[std::size_t(particle)].rate += rate;
    contacts_[std::size_t(particle)].conductance += conductance;
  };
  for (int entry = 0; entry < list.inum; ++entry) {
    const int i = list.ilist[entry];
    for (int n = 0; n < list.numneigh[i]; ++n) {
      const int j = list.firstneigh[i][n] & NEIGHMASK;
      const Vec3 apart = row(atom->x, i) - row(atom->x, j);
      const double squared = dot(apart, apart), sum = atom->radius[i] + atom->radius[j];
      if (squared >= sum * sum)
        continue;
      const double distance = std::sqrt(squared);
      double pressing = 0; // over the distance
      if (by_force || friction)
        pair.single(i, j, atom->type[i], atom->type[j], squared, 1, 1, pressing);
      const auto& of_pair = law_.pair(atom->type[i], atom->type[j]);
      const double conductance = law_.conductance(of_pair, atom->radius[i], atom->radius[j],
                                                  sum - distance, pressing * distance);
      const double to_i = conductance * (temperature[j] - temperature[i]);
      const double heat = friction ? friction_heat(pair.svector, i, j, apart, squared) : 0;
      give(i, to_i + of_pair.share * heat, conductance);
      give(j, -to_i + (1 - of_pair.share) * heat, conductance);
      // A pair across ranks with newton off is met by both: each books its own particle.
      const bool both = j < theirs;
      conducted += both ? 0 : to_i;
      made += both ? heat : of_pair.share * heat;
    }
  }
  if (force->newton_pair)
    comm->reverse_comm_fix(this);
  return {.conduction = conducted, .friction = made};
}

/// Power of the tangential force that the pair style has just told, with the slip at the middle of
/// the half steps around it [W].
double FixHeat::friction_heat(const double* told, int i, int j, const Vec3& apart,
                              double squared) const {
  const Vec3 on_i{told[tangential_force], told[tangential_force + 1], told[tangential_force + 2]};
  const double mi = atom->rmass[i], mj = atom->rmass[j];
  particle_subset::Contact contact{};
  contact.slip = slip_of(*atom, i, j, apart, squared);
  contact.reduced_mass = (atom->mask[i] & frozen_)   ? mj
                         : (atom->mask[j] & frozen_) ? mi
                                                     : mi * mj / (mi + mj);
  return -dot(on_i, mean_slip(contact, on_i, update->dt));
}

void FixHeat::post_force(int) {
  step_alone();
}

void FixHeat::step(coupling::HeatState* gas) {
  if (!steps_now())
    return;
  const auto n = std::size_t(atom->nlocal);
  rate_.assign(n, 0);
  no_source_.resize(n);
  driver::HeatPowers powers;
  if (touching_) {
    powers = sum_contacts();
    for (std::size_t i = 0; i < n; ++i)
      rate_[i] = contacts_[i].rate;
    check_time_step();
  }
  const particle_subset::HeatedParticles heated{.temperature = temperature_.data(),
                                                .carry = carry_.data(),
                                                .heat_flux = rate_.data(),
                                                .source = no_source_.data(),
                                                .mass = atom->rmass,
                                                .type = atom->type,
                                                .groups = atom->mask,
                                                .gas = gas};
  const auto stepped = particle_subset::step_temperature(
      heated, words_.capacity, held(), step_of_temperature(), {.begin = 0, .end = atom->nlocal});
  powers.convection = stepped.convection;
  powers.held = stepped.held;
  book(powers, step_of_temperature());
}

void FixHeat::check_time_step() const {
  double largest = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    largest =
        std::max(largest, contacts_[std::size_t(i)].conductance /
                              (atom->rmass[i] * words_.capacity[std::size_t(atom->type[i]) - 1]));
  refuse_long_step(step_of_temperature() * largest);
}

driver::WarmParticles FixHeat::particles() const {
  const auto n = std::size_t(atom->nlocal);
  return {.temperature = {temperature_.data(), n},
          .carry = {carry_.data(), n},
          .mass = {atom->rmass, n},
          .radius = {atom->radius, n},
          .type = {atom->type, n},
          .capacity = words_.capacity};
}

std::optional<driver::HeatReport::Conduction> FixHeat::conduction() const {
  if (!words_.options.contacts.radius)
    return {};
  return driver::HeatReport::Conduction{.conductance =
                                            [this](int i) {
                                              return std::size_t(i) < contacts_.size()
                                                         ? contacts_[std::size_t(i)].conductance
                                                         : 0; // before the first step
                                            },
                                        .materials = words_.materials};
}

int FixHeat::modify_param(int narg, char** arg) {
  if (narg < 3 || std::string_view(arg[0]) != "temperature")
    return 0; // LAMMPS reports it
  guarded([&] { set_temperatures(arg[1], arg[2]); });
  return 3;
}

void FixHeat::set_temperatures(const char* of_group, const char* kelvin) {
  const int index = group->find(of_group);
  if (index < 0)
    throw ConfigError(fmt::format("temperature {}: no such group", of_group));
  const std::string_view word = kelvin;
  double value = 0;
  const auto [last, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || last != word.data() + word.size() || !(value > 0 && value < 1e5))
    throw ConfigError(
        fmt::format("temperature {} {}: must be above 0 and below 1e5 K", of_group, kelvin));
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & group->bitmask[index]) {
      temperature_.data()[i] = value;
      carry_.data()[i] = 0;
    }
  look_again();
}

void FixHeat::grow_arrays(int n) {
  temperature_.grow(n);
  carry_.grow(n);
  vector_atom = temperature_.data();
}

void FixHeat::copy_arrays(int from, int to, int) {
  temperature_.copy(from, to);
  carry_.copy(from, to);
}

void FixHeat::set_arrays(int particle) {
  temperature_.set_fresh(particle);
  carry_.set_fresh(particle);
}

int FixHeat::pack_exchange(int particle, double* buffer) {
  const int n = temperature_.pack(particle, buffer);
  return n + carry_.pack(particle, buffer + n);
}

int FixHeat::unpack_exchange(int particle, double* buffer) {
  const int n = temperature_.unpack(particle, buffer);
  return n + carry_.unpack(particle, buffer + n);
}

int FixHeat::pack_restart(int particle, double* buffer) {
  buffer[0] = maxsize_restart(); // the length, itself included
  pack_exchange(particle, buffer + 1);
  return maxsize_restart();
}

void FixHeat::unpack_restart(int particle, int nth) {
  unpack_exchange(particle, driver::restart_values(atom->extra, particle, nth));
}

int FixHeat::size_restart(int) {
  return maxsize_restart();
}

int FixHeat::maxsize_restart() {
  return temperature_.columns() + carry_.columns() + 1;
}

double FixHeat::memory_usage() {
  return temperature_.bytes() + carry_.bytes() + double(contacts_.capacity() * sizeof(Contacts));
}

int FixHeat::pack_forward_comm(int n, int* list, double* buffer, int, int*) {
  for (int k = 0; k < n; ++k)
    buffer[k] = temperature_.data()[list[k]];
  return n;
}

void FixHeat::unpack_forward_comm(int n, int first, double* buffer) {
  std::copy_n(buffer, n, temperature_.data() + first);
}

int FixHeat::pack_reverse_comm(int n, int first, double* buffer) {
  for (int k = 0; k < n; ++k) {
    const Contacts& ghost = contacts_[std::size_t(first + k)];
    *buffer++ = ghost.rate;
    *buffer++ = ghost.conductance;
  }
  return 2 * n;
}

void FixHeat::unpack_reverse_comm(int n, int* list, double* buffer) {
  for (int k = 0; k < n; ++k) {
    Contacts& own = contacts_[std::size_t(list[k])];
    own.rate += *buffer++;
    own.conductance += *buffer++;
  }
}

} // namespace granflux::lammps
