// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "fix_checkpoint.hpp"

#include <string_view>

#include <liggghts/signal_handling.h>
#include <liggghts/write_restart.h>

namespace granflux::liggghts {

using namespace LAMMPS_NS::FixConst;

int FixCheckpoint::setmask() {
  return END_OF_STEP | PRE_EXCHANGE;
}

int FixCheckpoint::stages_of_forces() const {
  return POST_FORCE | PRE_FINAL_INTEGRATE | FINAL_INTEGRATE;
}

/// They are with the lists.
void FixCheckpoint::hand_histories_to_particles() {
  for (LAMMPS_NS::Fix* fix : driver::fixes_of(*modify))
    if (std::string_view(fix->style).starts_with("contacthistory"))
      fix->setup_pre_exchange();
}

void FixCheckpoint::write_host_file(const std::string& path) {
  std::string name = path; // LIGGGHTS' own call wants to change it
  LAMMPS_NS::WriteRestart(lmp).write(name.data());
}

void FixCheckpoint::stop_host() {
  LAMMPS_NS::SignalHandler::request_quit = true;
}

} // namespace granflux::liggghts
