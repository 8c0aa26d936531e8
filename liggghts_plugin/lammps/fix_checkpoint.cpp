// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_checkpoint.hpp"

#include <string_view>

#include <lammps/force.h>
#include <lammps/input.h>
#include <lammps/neigh_list.h>
#include <lammps/pair.h>
#include <lammps/timer.h>

namespace granflux::lammps {

using namespace LAMMPS_NS::FixConst;

namespace {

bool is_wall(const LAMMPS_NS::Fix& fix) {
  return std::string_view(fix.style).starts_with("wall/gran") && fix.restart_peratom;
}

/// What walls keep of each particle, as they pack it for another rank.
std::vector<std::vector<double>> packed_walls(const LAMMPS_NS::Modify& modify, int n) {
  constexpr std::size_t most = 1024; // numbers that a fix packs for a particle
  std::vector<std::vector<double>> all;
  std::vector<double> one(most);
  for (LAMMPS_NS::Fix* fix : driver::fixes_of(modify)) {
    if (!is_wall(*fix))
      continue;
    all.emplace_back();
    for (int i = 0; i < n; ++i) {
      const int count = fix->pack_exchange(i, one.data());
      all.back().insert(all.back().end(), one.begin(), one.begin() + count);
    }
  }
  return all;
}

void unpack_walls(const LAMMPS_NS::Modify& modify, int n, std::vector<std::vector<double>>& all) {
  auto wall = all.begin();
  for (LAMMPS_NS::Fix* fix : driver::fixes_of(modify)) {
    if (!is_wall(*fix))
      continue;
    double* at = wall++->data();
    for (int i = 0; i < n; ++i)
      at += fix->unpack_exchange(i, at);
  }
}

} // namespace

FixCheckpoint::FixCheckpoint(LAMMPS_NS::LAMMPS* lammps, int narg, char** arg)
    : CheckpointFix(lammps, narg, arg) {
  maxexchange = driver::KeptForces::saved;
}

int FixCheckpoint::setmask() {
  return END_OF_STEP | PRE_EXCHANGE | PRE_FORCE;
}

int FixCheckpoint::stages_of_forces() const {
  return POST_FORCE | FINAL_INTEGRATE;
}

/// The set-up computes forces with velocities of another half step, and LAMMPS' friction then also
/// cuts springs that slide.
void FixCheckpoint::setup_pre_force(int) {
  if (brings_forces())
    histories_ = packed_walls(*modify, atom->nlocal);
}

void FixCheckpoint::restore_histories() {
  unpack_walls(*modify, atom->nlocal, histories_);
  histories_.clear();
  restore_pair_history();
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
  for (LAMMPS_NS::Fix* fix : driver::fixes_of(*modify))
    if (std::string_view(fix->style) == "NEIGH_HISTORY")
      fix->setup_post_neighbor();
}

/// All is where it belongs: lists were built in this step. Only rank 0 opens the file.
void FixCheckpoint::write_host_file(const std::string& path) {
  input->one("write_restart " + (path.empty() ? std::string("pipe") : path) + " noinit");
}

/// And for later runs.
void FixCheckpoint::stop_host() {
  timer->force_timeout();
}

} // namespace granflux::lammps
