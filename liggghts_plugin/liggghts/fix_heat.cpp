// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "fix_heat.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>

#include <fmt/core.h>
#include <mpi.h>
#include <omp.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/domain.h>
#include <liggghts/error.h>
#include <liggghts/fix_property_atom.h>
#include <liggghts/force.h>
#include <liggghts/group.h>
#include <liggghts/modify.h>
#include <liggghts/neigh_list.h>
#include <liggghts/output.h>
#include <liggghts/pair_gran.h>
#include <liggghts/update.h>

#include <granflux/coupling/contact_heat/conductance.hpp>

#include "contact_times.hpp"
#include "fix_couple.hpp"
#include "particle_subset/fix_nve_sphere.hpp"
#include "particle_subset/fix_wall_gran.hpp"
#include "particle_subset/half_kick_heat.hpp"
#include "particle_subset/pair_gran.hpp"
#include "particle_subset/team.hpp"
#include "particle_subset/verlet.hpp"
#include "scene.hpp"

namespace granflux::liggghts {

using particle_subset::ContactHeatRates;
using particle_subset::HeatDetails;
using particle_subset::HeatSums;
using particle_subset::NearHeatRates;
using particle_subset::WallHeatRates;

namespace {

template <class Row> Row* rows(const LAMMPS_NS::FixPropertyAtom& property) {
  return property.array_atom ? reinterpret_cast<Row*>(property.array_atom[0]) : nullptr;
}

constexpr int doubles(std::size_t bytes) {
  return int(bytes / sizeof(double));
}

} // namespace

FixHeat::FixHeat(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg) : HeatFix(lammps, narg, arg) {
  guarded([&] {
    options_ = driver::read_heat_options({arg + 3, std::size_t(narg - 3)});
    of_words_ = options_;
    check_groups();
  });
}

int FixHeat::setmask() {
  using namespace LAMMPS_NS::FixConst;
  const driver::EffectSet words = options_.available();
  const bool near = words.has(driver::Effect::gas_gap) || words.has(driver::Effect::radiation);
  return PRE_FORCE | PRE_FINAL_INTEGRATE | (near ? PRE_EXCHANGE : 0);
}

/// A fix property/atom of that name, made here unless there is one.
LAMMPS_NS::FixPropertyAtom* FixHeat::property(const char* name, int values, bool restarts,
                                              bool ghosts, double initial) {
  const char* shape = values == 1 ? "scalar" : "vector";
  if (Fix* found = modify->find_fix_property(name, "property/atom", shape, values, 0, style, false))
    return static_cast<LAMMPS_NS::FixPropertyAtom*>(found);
  own_properties_.emplace_back(name);
  std::vector<std::string> words{
      name, "all", "property/atom", name, shape, restarts ? "yes" : "no", ghosts ? "yes" : "no",
      "no"};
  words.resize(words.size() + std::size_t(values), fmt::format("{}", initial));
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  return modify->add_fix_property_atom(int(arguments.size()), arguments.data(), style);
}

void FixHeat::post_create() {
  temperature_ = property("Temp", 1, true, true, options_.initial_temperature);
  carry_ = property("granflux_temperature_carry", 1, true, false, 0);
  heat_flux_ = property("heatFlux", 1, false, false, 0);
  source_ = property("heatSource", 1, true, false, 0);
  if (!options_.effects.given() || options_.available().has(driver::Effect::friction))
    parted_ = property("granflux_parted_heat", 1, true, false, 0);
  if (options_.every > 1 && !options_.sampled && options_.available().has(driver::Effect::damping))
    kept_damping_ = property("granflux_kept_damping", 1, true, false, 0);
  if (options_.effects.by != driver::EffectsWanted::By::numbers)
    make_properties();
}

/// Of the effects that are on: others hold no memory. Where effects are not chosen scripts find
/// all.
void FixHeat::make_properties() {
  const bool all = !options_.effects.given();
  const bool near = all || options_.near.any(), touching = all || touches();
  if ((touching || near) && !details_) {
    contacts_ = property("heatContact", doubles(sizeof(ContactHeatRates)), false, false, 0);
    details_ = property("heatDetail", doubles(sizeof(HeatDetails)), false, false, 0);
  }
  if (touching && !walls_)
    walls_ = property("heatWall", doubles(sizeof(WallHeatRates)), false, false, 0);
  if (near && !near_)
    near_ = property("heatNear", doubles(sizeof(NearHeatRates)), false, false, 0);
}

void FixHeat::pre_delete(bool unfix) {
  if (unfix)
    for (const std::string& name : own_properties_)
      modify->delete_fix(name.c_str(), true);
}

void FixHeat::check_script() const {
  if (!atom->radius_flag || !atom->rmass_flag)
    throw ConfigError(fmt::format("atom_style {}: particles must have a radius and a mass "
                                  "(atom_style granular or sphere)",
                                  atom->atom_style));
  for (int i = 0; i < modify->nfix; ++i) {
    const std::string_view other = modify->fix[i]->style;
    if (other.starts_with("heat/gran") || other == "transportequation/scalar")
      throw ConfigError(fmt::format("fix {} (style {}) changes the same temperatures: use one of "
                                    "the two",
                                    modify->fix[i]->id, other));
  }
}

void FixHeat::init() {
  guarded([&] {
    check_script();
    begin_run();
    materials_ = read_heat_materials(*lmp, options_);
    law_ = particle_subset::ContactHeat(options_.contacts, materials_.materials,
                                        materials_.overlap_ratio);
    near_law_ = particle_subset::NearHeat(options_.near, materials_.emissivity);
    sums_.resize(static_cast<std::size_t>(omp_get_max_threads()));
    at_walls_.resize(sums_.size());
    subsets_ = dynamic_cast<particle_subset::PairGran*>(force->pair);
    if (subsets_ && !subsets_->holds_history())
      subsets_ = nullptr;
    pair_ = nullptr;
    if (subsets_) {
      if (touches())
        subsets_->set_heat(*this);
      if (options_.near.any())
        subsets_->set_near_heat(*this);
      return;
    }
    if (!options_.available().any())
      return;
    pair_ = dynamic_cast<LAMMPS_NS::PairGran*>(force->pair_match("gran", 0));
    if (!pair_)
      throw ConfigError("needs pair_style gran");
    const auto& wanted = options_.contacts;
    if (!law_.needs_no_force() || wanted.friction != particle_subset::FrictionHeat::off ||
        wanted.damping || options_.near.any())
      throw ConfigError("contact forces are LIGGGHTS' own, which does not hand them on one by one: "
                        "use conduction overlap, stock or off, friction off, damping off, gas_gap "
                        "off, radiation off");
    if (force->newton_pair)
      throw ConfigError("newton on: must be off");
  });
}

/// Before lists and ghosts of a run: they must hold what particles notice without touching.
void FixHeat::setup_pre_exchange() {
  reach_ = options_.near.reach(0.5 * (neighbor->cutneighmax - neighbor->skin));
  // LIGGGHTS takes a particle for a ghost within half of this of the border.
  comm->cutghostuser = std::max(comm->cutghostuser, neighbor->cutneighmax + 2 * reach_);
}

void FixHeat::setup(int) {
  near_seconds_ = step_seconds_ = particle_steps_ = 0;
  guarded([&] {
    if (touches())
      link_walls();
    check_heat_every([&] { return contact_times_of(*lmp); });
    open_books();
  });
}

std::string FixHeat::method() const {
  const auto& contacts = options_.contacts;
  const auto& [gap, surroundings] = options_.near;
  return fmt::format(
      "granflux: heat of contacts {}; conduction {}, friction {}, damping {}{}{}\n",
      subsets_ ? "by particle subset" : "beside LIGGGHTS' own forces",
      contacts.radius
          ? std::visit([](const auto& r) { return std::string(r.name); }, *contacts.radius)
          : "off",
      contacts.friction == particle_subset::FrictionHeat::off      ? "off"
      : contacts.friction == particle_subset::FrictionHeat::slider ? "slider"
                                                                   : "speed",
      contacts.damping ? "on" : "off",
      gap ? fmt::format(", gas of {} W/(m K) in gaps", gap->conductivity) : "",
      surroundings ? fmt::format(", radiation, surroundings of {} K", *surroundings) : "");
}

void FixHeat::keep(driver::EffectSet on) {
  options_.keep(on);
  make_properties();
}

std::optional<Vec3> FixHeat::gravity() const {
  return gravity_of(*lmp);
}

void FixHeat::describe(coupling::SceneState& scene) {
  const HeatMaterials found = read_heat_materials(*lmp, of_words_);
  coupling::HeatOfScene heat{.heat_capacity = found.capacity.front(),
                             .conductivity = found.materials.front().conductivity};
  if (const auto& radius = of_words_.contacts.radius;
      radius && std::visit([](const auto& r) { return r.needs_force; }, *radius)) {
    heat.young = found.materials.front().young;
    heat.poisson = found.materials.front().poisson;
  }
  driver::add_near_heat(heat, of_words_.near, found.emissivity);
  for (int i = 0; i < modify->nfix; ++i)
    if (const auto* wall = dynamic_cast<const particle_subset::FixWallGran*>(modify->fix[i]))
      for (const double temperature : wall->temperatures())
        scene.meets(temperature);
  if (of_words_.near.surroundings)
    scene.meets(*of_words_.near.surroundings);
  driver::add_temperatures(scene, {temperature_->vector_atom, std::size_t(atom->nlocal)}, world);
  scene.heat = heat;
}

void FixHeat::link_walls() {
  for (int i = 0; i < modify->nfix; ++i) {
    Fix& fix = *modify->fix[i];
    if (auto* wall = dynamic_cast<particle_subset::FixWallGran*>(&fix)) {
      if (!dynamic_cast<particle_subset::Verlet*>(update->integrate))
        throw ConfigError(fmt::format("fix {} wall/gran: heat of walls needs a box that is "
                                      "orthogonal and spheres without bonds",
                                      fix.id));
      if (const std::string obstacle = wall->set_heat(*this, law_); !obstacle.empty())
        throw ConfigError(fmt::format("fix {} wall/gran: {}", fix.id, obstacle));
    } else if (auto* stock = dynamic_cast<LAMMPS_NS::FixWallGran*>(&fix)) {
      if (stock->heattransfer_flag() ||
          options_.contacts.friction != particle_subset::FrictionHeat::off)
        throw ConfigError(fmt::format("fix {} wall/gran is LIGGGHTS' own (-subset off): heat of "
                                      "walls is by particle subset only",
                                      fix.id));
    }
  }
}

particle_subset::HeatOfContacts FixHeat::heat_of_contacts() {
  const bool keeps = !options_.sampled;
  particle_subset::HeatOfContacts heat{
      .law = &law_,
      .arrays = {.temperature = temperature_->vector_atom,
                 .rate = heat_flux_->vector_atom,
                 .sums = sums_.data(),
                 .shown = shown(),
                 .kept = {.now = !steps_now(),
                          .dt = update->dt,
                          .friction = keeps ? parted_heat() : nullptr,
                          .damping = keeps && options_.contacts.damping && kept_damping_
                                         ? kept_damping_->vector_atom
                                         : nullptr},
                 .part_of_step = keeps ? 1. / options_.every : 1,
                 .resistances = {}}};
  if (!heat.rests())
    heat.arrays.resistances = resistances();
  return heat;
}

/// Of what makes heat, as the options want it.
particle_subset::Resistances FixHeat::resistances() {
  const auto& contacts = options_.contacts;
  const auto rows = [this](std::vector<particle_subset::Resistance>& of) {
    if (of.size() < std::size_t(atom->nlocal))
      of.resize(std::size_t(atom->nmax));
    return of.data();
  };
  particle_subset::Resistances found{.walls = at_walls_.data()};
  if (contacts.damping)
    found.damping = rows(damping_);
  if (contacts.friction != particle_subset::FrictionHeat::off && subsets_ && subsets_->rubs())
    found.rubbing = rows(rubbing_);
  return found;
}

/// Of what resists motion, half a kick makes heat.
bool FixHeat::looks_at_forces() const {
  const auto& contacts = options_.contacts;
  if (contacts.damping || contacts.friction == particle_subset::FrictionHeat::off)
    return contacts.damping;
  const auto is_rough_wall = [](const Fix* fix) {
    const auto* wall = dynamic_cast<const particle_subset::FixWallGran*>(fix);
    return wall && wall->rubs();
  };
  return (subsets_ && subsets_->rubs()) ||
         std::any_of(modify->fix, modify->fix + modify->nfix, is_rough_wall);
}

/// What is received of each kind: it costs more than the sum. Where it can be seen, in the last
/// step of temperature before or at output, and in the first and last of a run.
bool FixHeat::wants_details() const {
  if (!steps_now())
    return false;
  const auto now = update->ntimestep, next = now + options_.every;
  return output->next < next || update->laststep < next ||
         now <= update->firststep + options_.every;
}

particle_subset::HeatShown FixHeat::shown() const {
  if (!wants_details())
    return {};
  if (!details_)
    return {};
  return {.contacts = rows<ContactHeatRates>(*contacts_),
          .details = rows<HeatDetails>(*details_),
          .walls = walls_ ? rows<WallHeatRates>(*walls_) : nullptr,
          .near = near_ ? rows<NearHeatRates>(*near_) : nullptr};
}

/// Ghosts take the temperature of their particles; sums start from zero.
void FixHeat::pre_force(int) {
  if (rests())
    return;
  std::ranges::fill(sums_, HeatSums{});
  for (auto& touches : at_walls_)
    touches.clear();
  if (!steps_now())
    return;
  if (options_.available().any())
    temperature_->do_forward_comm();
  if (!touches()) // else the contacts clear it
    std::fill_n(heat_flux_->vector_atom, atom->nlocal, 0.0);
  if (const particle_subset::HeatShown shown = this->shown(); shown.wanted())
    particle_subset::for_each_subset(atom->nlocal, [&](particle_subset::Range range) {
      const auto clear = [range](auto* rows) {
        if (rows)
          std::fill(rows + range.begin, rows + range.end, std::remove_pointer_t<decltype(rows)>{});
      };
      clear(shown.contacts);
      clear(shown.details);
      clear(shown.walls);
      clear(shown.near);
    });
  if (pair_)
    conduct_by_shape();
}

/// Along LIGGGHTS' own list, from distances alone.
void FixHeat::conduct_by_shape() {
  const particle_subset::HeatOfContacts heat = heat_of_contacts();
  const particle_subset::HeatArrays& arrays = heat.arrays;
  const LAMMPS_NS::NeighList& list = *pair_->list;
  const auto give = [&](int particle, double received, double conductance) {
    if (particle >= atom->nlocal)
      return;
    arrays.rate[particle] += received;
    sums_.front().conduction += received;
    if (arrays.shown.wanted()) {
      arrays.shown.contacts[particle].conduction += received;
      arrays.shown.details[particle].conductance += conductance;
    }
  };
  std::fill_n(arrays.rate, atom->nlocal, 0.0);
  for (int row = 0; row < list.inum; ++row) {
    const int i = list.ilist[row];
    for (int entry = 0; entry < list.numneigh[i]; ++entry) {
      const int j = list.firstneigh[i][entry] & NEIGHMASK;
      const double* xi = atom->x[i];
      const double* xj = atom->x[j];
      const double distance = std::hypot(xi[0] - xj[0], xi[1] - xj[1], xi[2] - xj[2]);
      const double overlap = atom->radius[i] + atom->radius[j] - distance;
      if (overlap <= 0)
        continue;
      const double conductance = law_.conductance(law_.pair(atom->type[i], atom->type[j]),
                                                  atom->radius[i], atom->radius[j], overlap, 0);
      const double heat_to_i = conductance * (arrays.temperature[j] - arrays.temperature[i]);
      give(i, heat_to_i, conductance);
      give(j, -heat_to_i, conductance);
    }
  }
}

void FixHeat::pre_final_integrate() {
  step_alone();
}

double* FixHeat::parted_heat() {
  return options_.contacts.friction == particle_subset::FrictionHeat::off ? nullptr
                                                                          : parted_->vector_atom;
}

/// What contacts have made since the last step of temperature, and what springs of contacts held
/// that had ended when the lists were built. With a step of temperature in every time step there is
/// some in the step of the build alone, or the first one after that of a run's setup.
bool FixHeat::has_kept_heat() const {
  return options_.every > 1 || neighbor->lastcall + 1 >= update->ntimestep;
}

/// The particles of `range` receive it.
void FixHeat::receive_kept_heat(const particle_subset::HeatShown& shown,
                                particle_subset::Range range, HeatSums& sums) {
  const double dt = step_of_temperature();
  double* const rate = heat_flux_->vector_atom;
  const auto receive = [&](double* kept, double HeatSums::*sum, double HeatDetails::*detail) {
    double total = 0;
#pragma omp simd reduction(+ : total)
    for (int i = range.begin; i < range.end; ++i) {
      rate[i] += kept[i] / dt;
      total += kept[i];
    }
    sums.*sum += total / dt;
    if (shown.wanted())
      for (int i = range.begin; i < range.end; ++i) {
        shown.contacts[i].made += kept[i] / dt;
        shown.details[i].*detail += kept[i] / dt;
      }
    std::fill(kept + range.begin, kept + range.end, 0.0);
  };
  if (double* const friction = parted_heat())
    receive(friction, &HeatSums::friction, &HeatDetails::friction);
  if (options_.contacts.damping && kept_damping_)
    receive(kept_damping_->vector_atom, &HeatSums::damping, &HeatDetails::damping);
}

/// What goes into walls is in no temperature: it is booked in the time step in which it is found.
void FixHeat::book_heat_of_walls() {
  double power = 0;
  for (const HeatSums& part : sums_)
    power += part.to_walls;
  book_for_walls(power, options_.sampled ? step_of_temperature() : update->dt);
}

/// What resists motion in contacts works on the velocities at the step, half a step beyond those
/// that forces are found with.
void FixHeat::receive_half_kick_heat() {
  const particle_subset::HeatOfWall walls{.contacts = heat_of_contacts(), .temperature = {}};
  const particle_subset::HeatArrays& arrays = walls.contacts.arrays;
  const particle_subset::Resistance* const damping = arrays.resistances.damping;
  const particle_subset::Resistance* const rubbing = arrays.resistances.rubbing;
  if (!damping && !rubbing &&
      std::ranges::all_of(at_walls_, [](const auto& touches) { return touches.empty(); }))
    return;
  std::vector<std::pair<particle_subset::HalfKick, particle_subset::Spheres>> motions;
  for (int i = 0; i < modify->nfix; ++i)
    if (const auto* motion = dynamic_cast<const particle_subset::FixNveSphere*>(modify->fix[i]))
      motions.emplace_back(motion->half_kick(), motion->spheres());
  const auto heat = [&motions](int particle, const particle_subset::Resistance& resistance) {
    double sum = 0;
    for (const auto& [half, spheres] : motions)
      sum += half_kick_heat(half, spheres, particle, resistance);
    return sum;
  };
  if (damping || rubbing)
    particle_subset::for_each_subset(atom->nlocal, [&](particle_subset::Range range) {
      HeatSums& sums = arrays.sums[omp_get_thread_num()];
      for (int i = range.begin; i < range.end; ++i)
        arrays.add_made(i, rubbing ? heat(i, rubbing[i]) : 0, damping ? heat(i, damping[i]) : 0,
                        sums);
    });
  const bool friction = options_.contacts.friction != particle_subset::FrictionHeat::off;
  // Of a thread's list all particles are its own.
#pragma omp parallel for schedule(static, 1)
  for (const auto& touches : at_walls_)
    for (const particle_subset::WallResistance& touch : touches)
      walls.add_made(touch.particle, friction ? heat(touch.particle, touch.rubbing) : 0,
                     options_.contacts.damping ? heat(touch.particle, touch.damping) : 0);
}

particle_subset::HeatedParticles FixHeat::heated_particles(coupling::HeatState* gas) const {
  return {.temperature = temperature_->vector_atom,
          .carry = carry_->vector_atom,
          .heat_flux = heat_flux_->vector_atom,
          .source = source_->vector_atom,
          .mass = atom->rmass,
          .type = atom->type,
          .groups = atom->mask,
          .gas = gas};
}

particle_subset::StepPowers
FixHeat::step_particles(const particle_subset::HeatedParticles& particles,
                        particle_subset::Range range, HeatSums& sums) {
  const particle_subset::HeatShown shown = this->shown();
  const bool has_kept = has_kept_heat();
  particle_subset::StepPowers powers;
  particle_subset::for_each_block(range, [&](particle_subset::Range block) {
    if (has_kept)
      receive_kept_heat(shown, block, sums);
    powers +=
        step_temperature(particles, materials_.capacity, held(), step_of_temperature(), block);
  });
  return powers;
}

particle_subset::OwnWork* FixHeat::work_ahead() {
  const bool contacts_are_all = touches() && !options_.near.any() && !steps_by_gas();
  return contacts_are_all && steps_now() && !rests() && !wants_details() && !looks_at_forces()
             ? &step_ahead_
             : nullptr;
}

bool FixHeat::StepAhead::begin_own_work(int /*eflag*/, int /*vflag*/) {
  threads.assign(heat.sums_.size(), {});
  return true;
}

void FixHeat::StepAhead::own_work(int thread, particle_subset::Range block) {
  const double start = MPI_Wtime();
  const particle_subset::Range unseen = heat.subsets_->contacts_of(thread).unseen;
  const particle_subset::Range range{std::max(block.begin, unseen.begin),
                                     std::min(block.end, unseen.end)};
  if (range.size() <= 0)
    return;
  OfThread& mine = threads[std::size_t(thread)];
  mine.powers +=
      heat.step_particles(heat.heated_particles(nullptr), range, heat.sums_[std::size_t(thread)]);
  if (mine.done.size() == 0)
    mine.done.begin = range.begin;
  mine.done.end = range.end;
  mine.seconds += MPI_Wtime() - start;
}

void FixHeat::step(coupling::HeatState* gas) {
  const double start = MPI_Wtime();
  receive_half_kick_heat();
  book_heat_of_walls();
  if (!steps_now())
    return;
  if (options_.near.any())
    subsets_->add_near_heat(near_law_, heat_of_contacts().arrays);
  const double between = MPI_Wtime();
  const particle_subset::HeatedParticles particles = heated_particles(gas);
  if (wants_details())
    check_time_step(particles);
  std::vector<particle_subset::StepPowers> parts(sums_.size());
  particle_subset::for_each_subset(atom->nlocal, [&](particle_subset::Range left) {
    const auto thread = std::size_t(omp_get_thread_num());
    for (const StepAhead::OfThread& ahead : step_ahead_.threads) {
      parts[thread] += step_particles(particles, {left.begin, std::min(ahead.done.begin, left.end)},
                                      sums_[thread]);
      left.begin = std::max(left.begin, ahead.done.end);
    }
    parts[thread] += step_particles(particles, left, sums_[thread]);
  });
  particle_subset::StepPowers stepped;
  double seconds = MPI_Wtime() - between;
  if (!step_ahead_.threads.empty())
    seconds += step_ahead_.threads.front().seconds;
  for (const StepAhead::OfThread& ahead : step_ahead_.threads)
    stepped += ahead.powers;
  step_ahead_.threads.clear();
  for (const auto& part : parts)
    stepped += part;
  HeatSums contacts;
  for (const HeatSums& part : sums_)
    contacts += part;
  book({.conduction = contacts.conduction,
        .walls = contacts.walls,
        .friction = contacts.friction,
        .damping = contacts.damping,
        .convection = stepped.convection,
        .source = stepped.source,
        .to_walls = contacts.to_walls,
        .held = stepped.held,
        .radiation = contacts.radiation},
       step_of_temperature());
  near_seconds_ += between - start;
  step_seconds_ += seconds;
  particle_steps_ += double(options_.every) * atom->nlocal;
}

void FixHeat::check_time_step(const particle_subset::HeatedParticles& particles) const {
  if (!details_)
    return;
  double largest = 0;
  particle_subset::for_each_subset(atom->nlocal, [&](particle_subset::Range range) {
    const double number =
        conduction_number(shown(), particles, materials_.capacity, step_of_temperature(), range);
#pragma omp critical(granflux_conduction_number)
    largest = std::max(largest, number);
  });
  refuse_long_step(largest);
}

driver::WarmParticles FixHeat::particles() const {
  const auto n = std::size_t(atom->nlocal);
  return {.temperature = {temperature_->vector_atom, n},
          .carry = {carry_->vector_atom, n},
          .mass = {atom->rmass, n},
          .radius = {atom->radius, n},
          .type = {atom->type, n},
          .capacity = materials_.capacity};
}

std::optional<driver::HeatReport::Conduction> FixHeat::conduction() const {
  if (!options_.contacts.radius)
    return {};
  return driver::HeatReport::Conduction{
      .conductance = [details =
                          rows<HeatDetails>(*details_)](int i) { return details[i].conductance; },
      .materials = materials_.materials};
}

void FixHeat::post_run() {
  HeatFix::post_run();
  if (options_.effects.given() && update->ntimestep != update->firststep)
    driver::say(*lmp, driver::heat_cost(options_.available(),
                                        {near_seconds_, step_seconds_, particle_steps_}, world));
}

} // namespace granflux::liggghts
