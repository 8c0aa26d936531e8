// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_checkpoint.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "fmt_of_lammps.hpp"

#include <lammps/atom.h>
#include <lammps/comm.h>
#include <lammps/error.h>
#include <lammps/force.h>
#include <lammps/input.h>
#include <lammps/lammps.h>
#include <lammps/modify.h>
#include <lammps/neigh_list.h>
#include <lammps/pair.h>
#include <lammps/timer.h>
#include <lammps/update.h>

#include <granflux/cfd/error.hpp>

#include "driver/restart_values.hpp"
#include "fix_couple.hpp"
#include "guard.hpp"

namespace granflux::lammps {

namespace {

std::span<const Vec3> rows(double** array, int n) {
  return n ? std::span(reinterpret_cast<const Vec3*>(array[0]), std::size_t(n))
           : std::span<const Vec3>();
}

bool is_wall(const LAMMPS_NS::Fix& fix) {
  return std::string_view(fix.style).starts_with("wall/gran") && fix.restart_peratom;
}

/// What walls keep of each particle, as they pack it for another rank.
std::vector<std::vector<double>> packed_walls(const LAMMPS_NS::Modify& modify, int n) {
  constexpr std::size_t most = 1024; // numbers that a fix packs for a particle
  std::vector<std::vector<double>> all;
  std::vector<double> one(most);
  for (int f = 0; f < modify.nfix; ++f) {
    if (!is_wall(*modify.fix[f]))
      continue;
    all.emplace_back();
    for (int i = 0; i < n; ++i) {
      const int count = modify.fix[f]->pack_exchange(i, one.data());
      all.back().insert(all.back().end(), one.begin(), one.begin() + count);
    }
  }
  return all;
}

void unpack_walls(const LAMMPS_NS::Modify& modify, int n, std::vector<std::vector<double>>& all) {
  auto wall = all.begin();
  for (int f = 0; f < modify.nfix; ++f) {
    if (!is_wall(*modify.fix[f]))
      continue;
    double* at = wall++->data();
    for (int i = 0; i < n; ++i)
      at += modify.fix[f]->unpack_exchange(i, at);
  }
}

FixCouple* gas_of(LAMMPS_NS::Modify& modify) {
  for (int i = 0; i < modify.nfix; ++i)
    if (auto* found = dynamic_cast<FixCouple*>(modify.fix[i]))
      return found;
  return nullptr;
}

} // namespace

FixCheckpoint::FixCheckpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
    : Fix(lammps, narg, arg) {
  restart_global = restart_peratom = 1;
  create_attribute = 1;
  force_reneighbor = 1;
  maxexchange = driver::KeptForces::saved;
  nevery = 1;
  guard(*this, *error, [&] {
    if (igroup != 0)
      throw ConfigError("the group must be all");
    if (!atom->radius_flag || !atom->torque_flag)
      throw ConfigError("particles must be spheres (atom_style sphere)");
    point_ =
        std::make_unique<driver::Checkpointer>(std::span(arg + 3, std::size_t(narg - 3)), world);
  });
  next_reneighbor = point_->due();
  atom->add_callback(LAMMPS_NS::Atom::GROW);
  atom->add_callback(LAMMPS_NS::Atom::RESTART);
}

FixCheckpoint::~FixCheckpoint() {
  atom->delete_callback(id, LAMMPS_NS::Atom::GROW);
  atom->delete_callback(id, LAMMPS_NS::Atom::RESTART);
}

int FixCheckpoint::setmask() {
  using namespace LAMMPS_NS::FixConst;
  return END_OF_STEP | PRE_EXCHANGE | PRE_FORCE;
}

/// What comes after this fix would change what it has put in place.
void FixCheckpoint::init() {
  guard(*this, *error, [&] {
    bool later = false;
    for (int i = 0; i < modify->nfix; ++i) {
      const Fix& other = *modify->fix[i];
      using namespace LAMMPS_NS::FixConst;
      if (later && (other.time_integrate || (modify->fmask[i] & (POST_FORCE | FINAL_INTEGRATE))))
        throw ConfigError(
            fmt::format("fix {} (style {}) comes after it: define it last", other.id, other.style));
      if (other.restart_file)
        throw ConfigError(fmt::format("fix {} (style {}) keeps its state in a file of its own, "
                                      "which checkpoints cannot take along",
                                      other.id, other.style));
      later = later || &other == this;
    }
  });
}

/// Particles still have what the restart file brought; lists take it from there only for entries
/// that are marked as touching, and have taken the marks off.
void FixCheckpoint::restore_pair_history() {
  const LAMMPS_NS::Pair* pair = force->pair_match("gran", 0);
  if (!pair || !pair->list)
    return;
  const LAMMPS_NS::NeighList& list = *pair->list;
  for (int row = 0; row < list.inum; ++row) {
    const int i = list.ilist[row];
    for (int entry = 0; entry < list.numneigh[i]; ++entry)
      list.firstneigh[i][entry] |= 1 << SBBITS;
  }
  for (int i = 0; i < modify->nfix; ++i)
    if (std::string_view(modify->fix[i]->style) == "NEIGH_HISTORY")
      modify->fix[i]->setup_post_neighbor();
}

/// The set-up computes forces with velocities of another half step, and LAMMPS' friction then also
/// cuts springs that slide.
void FixCheckpoint::setup_pre_force(int) {
  if (kept_.rows())
    histories_ = packed_walls(*modify, atom->nlocal);
}

void FixCheckpoint::setup(int) {
  guard(*this, *error, [&] {
    if (kept_.rows() && brings_forces()) {
      kept_.restore(atom->f, atom->torque, atom->nlocal);
      unpack_walls(*modify, atom->nlocal, histories_);
      restore_pair_history();
      histories_.clear();
    }
    if (kept_.rows() && !brings_forces())
      say("granflux: WARNING: time step or gas are not those of the checkpoint: the run continues "
          "with forces computed anew, not to the last bit\n");
    kept_.drop();
    if (const FixCouple* gas = gas_of(*modify))
      gas->gas().check_state_fits();
    point_->start(long(update->ntimestep));
  });
  next_reneighbor = point_->due();
}

driver::KeptForces::Step FixCheckpoint::this_step() const {
  return {.time_step = update->dt, .with_gas = gas_of(*modify) ? 1. : 0.};
}

/// A run that is set up from the checkpoint sorts its particles.
void FixCheckpoint::pre_exchange() {
  if (update->ntimestep == point_->due())
    atom->nextsort = update->ntimestep;
}

void FixCheckpoint::end_of_step() {
  const auto now = long(update->ntimestep);
  if (now != point_->due()) {
    point_->look(now);
    next_reneighbor = point_->due();
    return;
  }
  guard(*this, *error, [&] {
    for (const auto& [array, name] : {std::pair(atom->x, "position"),
                                      std::pair(atom->v, "velocity"), std::pair(atom->f, "force")})
      driver::check_finite(rows(array, atom->nlocal), name, world);
    writing_ = true;
    const bool stop = point_->write(now, [&](const std::string& path) {
      // All is where it belongs: lists were built in this step. Only rank 0 opens the file.
      input->one("write_restart " + (path.empty() ? std::string("pipe") : path) + " noinit");
    });
    writing_ = false;
    if (stop) {
      say(point_->how_to_continue());
      timer->force_timeout(); // on all ranks: after this step, and for later runs
    }
  });
  next_reneighbor = point_->due();
}

void FixCheckpoint::say(const std::string& text) const {
  if (comm->me != 0)
    return;
  for (FILE* out : {screen, logfile})
    if (out) {
      std::fputs(text.c_str(), out);
      std::fflush(out);
    }
}

void FixCheckpoint::write_restart(FILE* file) {
  if (comm->me != 0)
    return;
  guard(*this, *error, [&] {
    driver::KeptForces::write(writing_ ? std::optional(this_step()) : std::nullopt, file);
  });
}

void FixCheckpoint::restart(char* block) {
  guard(*this, *error, [&] { kept_.read(block, atom->nmax); });
}

void FixCheckpoint::grow_arrays(int n) {
  if (auto* rows = kept_.rows())
    rows->grow(n);
}

void FixCheckpoint::copy_arrays(int from, int to, int) {
  if (auto* rows = kept_.rows())
    rows->copy(from, to);
}

void FixCheckpoint::set_arrays(int particle) {
  if (auto* rows = kept_.rows())
    rows->set_fresh(particle);
}

int FixCheckpoint::pack_exchange(int particle, double* buffer) {
  auto* rows = kept_.rows();
  return rows ? rows->pack(particle, buffer) : 0;
}

int FixCheckpoint::unpack_exchange(int particle, double* buffer) {
  auto* rows = kept_.rows();
  return rows ? rows->unpack(particle, buffer) : 0;
}

int FixCheckpoint::pack_restart(int particle, double* buffer) {
  return writing_ ? driver::KeptForces::pack(atom->f[particle], atom->torque[particle], buffer)
                  : driver::KeptForces::pack(nullptr, nullptr, buffer);
}

void FixCheckpoint::unpack_restart(int particle, int nth) {
  if (auto* rows = kept_.rows())
    rows->unpack(particle, driver::restart_values(atom->extra, particle, nth));
}

int FixCheckpoint::size_restart(int) {
  return driver::KeptForces::saved;
}

int FixCheckpoint::maxsize_restart() {
  return driver::KeptForces::saved;
}

} // namespace granflux::lammps
