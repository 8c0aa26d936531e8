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

#include <fmt/core.h>

#include <liggghts/lammps.h>

#include <liggghts/atom.h>
#include <liggghts/comm.h>
#include <liggghts/error.h>
#include <liggghts/modify.h>
#include <liggghts/signal_handling.h>
#include <liggghts/update.h>
#include <liggghts/write_restart.h>

#include <granflux/cfd/error.hpp>

#include "driver/restart_values.hpp"
#include "fix_couple.hpp"

namespace granflux::liggghts {

namespace {

/// LIGGGHTS' numbers for what a fix is called for.
constexpr int growth = 0, restarts = 1;

std::span<const Vec3> rows(double** array, int n) {
  return n ? std::span(reinterpret_cast<const Vec3*>(array[0]), std::size_t(n))
           : std::span<const Vec3>();
}

FixCouple* gas_of(LAMMPS_NS::Modify& modify) {
  for (int i = 0; i < modify.nfix; ++i)
    if (auto* found = dynamic_cast<FixCouple*>(modify.fix[i]))
      return found;
  return nullptr;
}

} // namespace

template <class Work> void FixCheckpoint::guard(Work&& work) {
  const auto text = [this](const std::exception& e) {
    return fmt::format("fix {} granflux/checkpoint: {}", id, e.what());
  };
  try {
    work();
  } catch (const ConfigError& e) {
    error->all(FLERR, text(e).c_str()); // thrown on all ranks alike
  } catch (const NumericalError& e) {
    error->all(FLERR, text(e).c_str()); // likewise
  } catch (const std::exception& e) {
    error->one(FLERR, text(e).c_str());
  }
}

FixCheckpoint::FixCheckpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
    : Fix(lammps, narg, arg) {
  restart_global = restart_peratom = 1;
  create_attribute = 1;
  force_reneighbor = 1;
  nevery = 1;
  guard([&] {
    if (igroup != 0)
      throw ConfigError("the group must be all");
    if (!atom->radius_flag || !atom->torque_flag)
      throw ConfigError("particles must be spheres (atom_style granular or sphere)");
    point_ =
        std::make_unique<driver::Checkpointer>(std::span(arg + 3, std::size_t(narg - 3)), world);
  });
  next_reneighbor = point_->due();
  atom->add_callback(growth);
  atom->add_callback(restarts);
}

FixCheckpoint::~FixCheckpoint() {
  atom->delete_callback(id, growth);
  atom->delete_callback(id, restarts);
}

int FixCheckpoint::setmask() {
  return LAMMPS_NS::FixConst::END_OF_STEP | LAMMPS_NS::FixConst::PRE_EXCHANGE;
}

/// What comes after this fix would change what it has put in place.
void FixCheckpoint::init() {
  guard([&] {
    bool later = false;
    for (int i = 0; i < modify->nfix; ++i) {
      const Fix& other = *modify->fix[i];
      using namespace LAMMPS_NS::FixConst;
      if (later && (other.time_integrate ||
                    (modify->fmask[i] & (POST_FORCE | PRE_FINAL_INTEGRATE | FINAL_INTEGRATE))))
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

void FixCheckpoint::setup(int) {
  guard([&] {
    if (kept_.rows() && brings_forces())
      kept_.restore(atom->f, atom->torque, atom->nlocal);
    else if (kept_.rows())
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
  guard([&] {
    for (const auto& [array, name] : {std::pair(atom->x, "position"),
                                      std::pair(atom->v, "velocity"), std::pair(atom->f, "force")})
      driver::check_finite(rows(array, atom->nlocal), name, world);
    // Histories are with the lists now; restart files take them from the particles.
    for (int i = 0; i < modify->nfix; ++i)
      if (std::string_view(modify->fix[i]->style).starts_with("contacthistory"))
        modify->fix[i]->setup_pre_exchange();
    writing_ = true;
    const bool stop = point_->write(now, [&](const std::string& path) {
      std::string name = path; // LIGGGHTS' own call wants to change it
      LAMMPS_NS::WriteRestart(lmp).write(name.data());
    });
    writing_ = false;
    if (stop) {
      say(point_->how_to_continue());
      LAMMPS_NS::SignalHandler::request_quit = true; // on all ranks: after this step
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
  guard([&] {
    driver::KeptForces::write(writing_ ? std::optional(this_step()) : std::nullopt, file);
  });
}

void FixCheckpoint::restart(char* block) {
  guard([&] { kept_.read(block, atom->nmax); });
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

} // namespace granflux::liggghts
