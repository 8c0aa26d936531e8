// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "alike.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <string_view>

#include <liggghts/fix.h>

#include "team.hpp"

namespace granflux::particle_subset {

namespace {

/// The number that all have, or 0.
template <class Number> Number shared_number(const Number* numbers, int count) {
  if (count == 0)
    return 0;
  const Number first = numbers[0];
  std::atomic<bool> others = false;
  for_each_subset(count, [&](Range range) {
    int different = 0;
    for (int p = range.begin; p < range.end; ++p)
      different |= numbers[p] != first;
    if (different)
      others.store(true, std::memory_order_relaxed);
  });
  return others ? 0 : first;
}

/// Beginnings of the names of fixes that leave sizes alone; what is inserted comes with new lists.
constexpr std::array<std::string_view, 15> known{
    "granflux/",      "nve/sphere",       "gravity",      "freeze",       "wall/gran",
    "contacthistory", "neighlist",        "mesh/surface", "move/mesh",    "property",
    "insert/",        "particletemplate", "ave/",         "particledist", "check/time"};

} // namespace

Alike find_alike(const Particles& particles) {
  Alike alike{.type = shared_number(particles.type, particles.all)};
  alike.radius = shared_number(particles.radius, particles.all);
  alike.mass = alike.radius > 0 ? shared_number(particles.mass, particles.all) : 0;
  if (!(alike.mass > 0))
    alike.radius = alike.mass = 0;
  return alike;
}

bool sizes_stay(const LAMMPS_NS::Modify& modify) {
  return std::all_of(modify.fix, modify.fix + modify.nfix, [](const LAMMPS_NS::Fix* fix) {
    return std::ranges::any_of(known, [&](std::string_view beginning) {
      return std::string_view(fix->style).starts_with(beginning);
    });
  });
}

} // namespace granflux::particle_subset
