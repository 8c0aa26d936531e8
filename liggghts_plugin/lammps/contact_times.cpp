// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_times.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string_view>

#include <mpi.h>

#include "fmt_of_lammps.hpp"

#include <lammps/atom.h>
#include <lammps/force.h>
#include <lammps/lammps.h>
#include <lammps/pair.h>

namespace granflux::lammps {

namespace {

std::vector<driver::ParticleType> types_of(LAMMPS_NS::LAMMPS& lammps) {
  LAMMPS_NS::Atom& atom = *lammps.atom;
  const auto types = std::size_t(atom.ntypes);
  constexpr double none = std::numeric_limits<double>::max();
  std::vector<double> least(2 * types, none);
  for (int i = 0; i < atom.nlocal; ++i) {
    const auto type = std::size_t(atom.type[i]) - 1;
    least[2 * type] = std::min(least[2 * type], atom.radius[i]);
    least[2 * type + 1] = std::min(least[2 * type + 1], atom.rmass[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, least.data(), int(least.size()), MPI_DOUBLE, MPI_MIN, lammps.world);
  std::vector<driver::ParticleType> found(types);
  for (std::size_t type = 0; type < types; ++type)
    if (least[2 * type] != none) {
      found[type].least_radius = least[2 * type];
      found[type].least_mass = least[2 * type + 1];
    }
  return found;
}

struct Constants {
  double kn = 0, kt = 0, gamma_n = 0;
};

/// The classes of gran/hooke and gran/hertz have no installed header and hand nothing out by name,
/// but every pair style says its settings to a restart file: for these kn, kt, gamma_n come first.
Constants constants_of(LAMMPS_NS::Pair& pair) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* file = open_memstream(&text, &size);
  pair.write_restart_settings(file);
  std::fclose(file);
  Constants constants;
  if (size >= sizeof constants)
    std::memcpy(&constants, text, sizeof constants);
  std::free(text);
  return constants;
}

} // namespace

driver::ContactTimes contact_times_of(LAMMPS_NS::LAMMPS& lammps) {
  constexpr std::array<std::string_view, 3> known{"gran/hooke", "gran/hooke/history",
                                                  "gran/hertz/history"};
  const std::string_view style = lammps.force->pair_style ? lammps.force->pair_style : "none";
  std::string unknown;
  Constants constants;
  if (std::ranges::find(known, style) == known.end())
    unknown = fmt::format("pair_style {} tells no stiffness", style);
  else
    constants = constants_of(*lammps.force->pair);
  driver::ContactTimes times =
      driver::shortest_times(types_of(lammps), [&](int, int, double, double mass) {
        return driver::NormalSpring{.hertzian = style == "gran/hertz/history",
                                    .stiffness = constants.kn,
                                    .damping = constants.gamma_n * mass};
      });
  times.unknown = unknown;
  return times;
}

} // namespace granflux::lammps
