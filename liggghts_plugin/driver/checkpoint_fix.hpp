// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "checkpoint_record.hpp"
#include "checkpointer.hpp"
#include "fixes_of_run.hpp"
#include "guard.hpp"
#include "kept_forces.hpp"
#include "restart_values.hpp"
#include "rows_of.hpp"
#include "say.hpp"

namespace granflux::driver {

/// fix ID all granflux/checkpoint FILE every N: restart files from which a run goes on to the last
/// bit (docs/reference/fix_granflux_checkpoint.md). Written once over the classes of a host, which
/// have the same names in all of them: `HostFix` is its class Fix, `Couple` its fix of the gas.
/// What hosts do their own way is virtual.
template <class HostFix, class Couple> class CheckpointFix : public HostFix {
public:
  template <class Lammps>
  CheckpointFix(Lammps* lammps, int narg, char** arg) : HostFix(lammps, narg, arg) {
    this->restart_global = this->restart_peratom = 1;
    this->create_attribute = 1;
    this->force_reneighbor = 1;
    this->nevery = 1;
    guarded([&] {
      if (this->igroup != 0)
        throw ConfigError("the group must be all");
      if (!this->atom->radius_flag || !this->atom->torque_flag)
        throw ConfigError("particles must be spheres (atom_style sphere or granular)");
      point_ =
          std::make_unique<Checkpointer>(std::span(arg + 3, std::size_t(narg - 3)), this->world);
    });
    this->next_reneighbor = point_->due();
    this->atom->add_callback(growth);
    this->atom->add_callback(restarts);
  }
  ~CheckpointFix() override {
    this->atom->delete_callback(this->id, growth);
    this->atom->delete_callback(this->id, restarts);
  }
  CheckpointFix(const CheckpointFix&) = delete;
  CheckpointFix& operator=(const CheckpointFix&) = delete;

  /// The forces of the last step are known, so that the run that is set up needs no others.
  [[nodiscard]] bool brings_forces() const { return record_ && record_->forces == forces_now(); }
  [[nodiscard]] const Checkpointer& point() const { return *point_; }

  void init() override;
  void setup_pre_exchange() override;
  void setup(int) override;
  void pre_exchange() override { point_->lists_are_built(now()); }
  void end_of_step() override;

  void write_restart(std::FILE* file) override;
  void restart(char* block) override;

  void grow_arrays(int n) override {
    if (auto* rows = kept_.rows())
      rows->grow(n);
  }
  void copy_arrays(int from, int to, int) override {
    if (auto* rows = kept_.rows())
      rows->copy(from, to);
  }
  void set_arrays(int particle) override {
    if (auto* rows = kept_.rows())
      rows->set_fresh(particle);
  }
  int pack_exchange(int particle, double* buffer) override {
    auto* rows = kept_.rows();
    return rows ? rows->pack(particle, buffer) : 0;
  }
  int unpack_exchange(int particle, double* buffer) override {
    auto* rows = kept_.rows();
    return rows ? rows->unpack(particle, buffer) : 0;
  }
  int pack_restart(int particle, double* buffer) override {
    return writing_
               ? KeptForces::pack(this->atom->f[particle], this->atom->torque[particle], buffer)
               : KeptForces::pack(nullptr, nullptr, buffer);
  }
  void unpack_restart(int particle, int nth) override {
    if (auto* rows = kept_.rows())
      rows->unpack(particle, restart_values(this->atom->extra, particle, nth));
  }
  int size_restart(int) override { return KeptForces::saved; }
  int maxsize_restart() override { return KeptForces::saved; }

protected:
  /// Fixes called at one of these stages behind this one would change what it has put in place.
  [[nodiscard]] virtual int stages_of_forces() const = 0;
  /// By the host's own command; the path is empty on ranks that do not write.
  virtual void write_host_file(const std::string& path) = 0;
  /// In order, on all ranks, after this step.
  virtual void stop_host() = 0;
  /// Before a checkpoint: what restart files take from the particles must be there.
  virtual void hand_histories_to_particles() {}
  /// In the set-up, when forces are in place: histories of contacts, where it has changed them.
  virtual void restore_histories() {}

private:
  static constexpr int growth = 0, restarts = 1; // hosts' numbers for what a fix is called for

  template <class Work> void guarded(Work&& work) { guard(*this, *this->error, work); }
  [[nodiscard]] long now() const { return long(this->update->ntimestep); }
  [[nodiscard]] CheckpointRecord::Forces forces_now() const {
    return {.time_step = this->update->dt, .with_gas = find_fix<Couple>(*this->modify) ? 1. : 0.};
  }
  [[nodiscard]] CheckpointRecord record_now() const;
  [[nodiscard]] std::vector<KeptFix> kept_fixes() const;
  void check_order() const;

  std::unique_ptr<Checkpointer> point_;
  std::optional<CheckpointRecord> record_; ///< of the file that was read, until the first set-up
  KeptForces kept_;
  std::optional<int> sorts_every_; ///< what the script wants, while the set-up must not sort
  bool writing_ = false;           ///< what is packed goes to a checkpoint
};

/// What comes after this fix would change what it has put in place.
template <class HostFix, class Couple> void CheckpointFix<HostFix, Couple>::check_order() const {
  bool later = false;
  for (int i = 0; i < this->modify->nfix; ++i) {
    const HostFix& other = *this->modify->fix[i];
    if (later && (other.time_integrate || (this->modify->fmask[i] & stages_of_forces())))
      throw ConfigError(
          fmt::format("fix {} (style {}) comes after it: define it last", other.id, other.style));
    if (other.restart_file)
      throw ConfigError(fmt::format("fix {} (style {}) keeps its state in a file of its own, "
                                    "which checkpoints cannot take along",
                                    other.id, other.style));
    later = later || &other == this;
  }
}

template <class HostFix, class Couple> void CheckpointFix<HostFix, Couple>::init() {
  guarded([&] {
    check_order();
    if (record_)
      check_fixes(*record_, kept_fixes());
  });
}

/// The file has brought the particles in the order that they had.
template <class HostFix, class Couple> void CheckpointFix<HostFix, Couple>::setup_pre_exchange() {
  if (brings_forces() && record_->ranks == this->comm->nprocs)
    sorts_every_ = std::exchange(this->atom->sortfreq, 0);
}

template <class HostFix, class Couple> void CheckpointFix<HostFix, Couple>::setup(int) {
  guarded([&] {
    if (brings_forces()) {
      kept_.restore(this->atom->f, this->atom->torque, this->atom->nlocal);
      restore_histories();
    } else if (record_) {
      say(*this->lmp,
          "granflux: WARNING: time step or gas are not those of the checkpoint: the run "
          "continues with forces computed anew, not to the last bit\n");
    }
    if (sorts_every_) {
      this->atom->sortfreq = *sorts_every_;
      this->atom->nextsort = decltype(this->atom->nextsort)(record_->next_sort);
      sorts_every_.reset();
    }
    record_.reset();
    kept_.drop();
    if (const Couple* gas = find_fix<Couple>(*this->modify))
      gas->gas().check_state_fits();
    point_->start(now(), long(this->update->laststep));
  });
  this->next_reneighbor = point_->due();
}

template <class HostFix, class Couple> void CheckpointFix<HostFix, Couple>::end_of_step() {
  if (now() != point_->due()) {
    point_->look(now());
    this->next_reneighbor = point_->due();
    return;
  }
  guarded([&] {
    const auto& all = *this->atom;
    for (const auto& [array, name] :
         {std::pair(all.x, "position"), std::pair(all.v, "velocity"), std::pair(all.f, "force")})
      check_finite(rows_of<const Vec3>(array, std::size_t(all.nlocal)), name, this->world);
    hand_histories_to_particles();
    writing_ = true;
    const bool stop = point_->write(now(), [&](const std::string& path) { write_host_file(path); });
    writing_ = false;
    if (stop) {
      say(*this->lmp, point_->how_to_continue());
      stop_host();
    }
  });
  this->next_reneighbor = point_->due();
}

/// All fixes that keep something in restart files, but this one: only its own ID finds the record.
template <class HostFix, class Couple>
std::vector<KeptFix> CheckpointFix<HostFix, Couple>::kept_fixes() const {
  std::vector<KeptFix> kept;
  for (const HostFix* fix : fixes_of(*this->modify))
    if (fix != this && (fix->restart_global || fix->restart_peratom))
      kept.push_back({.id = fix->id, .style = fix->style});
  return kept;
}

template <class HostFix, class Couple>
CheckpointRecord CheckpointFix<HostFix, Couple>::record_now() const {
  return {.forces = forces_now(),
          .ranks = double(this->comm->nprocs),
          .next_sort = double(this->atom->nextsort),
          .fixes = kept_fixes()};
}

template <class HostFix, class Couple>
void CheckpointFix<HostFix, Couple>::write_restart(std::FILE* file) {
  if (this->comm->me == 0)
    guarded([&] {
      write_checkpoint_record(writing_ ? std::optional(record_now()) : std::nullopt, file);
    });
}

template <class HostFix, class Couple> void CheckpointFix<HostFix, Couple>::restart(char* block) {
  guarded([&] {
    record_ = read_checkpoint_record(block);
    if (record_)
      kept_.expect(this->atom->nmax);
  });
}

} // namespace granflux::driver
