// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "normal_law.hpp"

#include "choices.hpp"
#include "law/hertz.hpp"
#include "law/hertz_stiffness.hpp"
#include "law/hooke.hpp"
#include "law/hooke_stiffness.hpp"

namespace granflux::particle_subset {

std::optional<NormalForce> normal_force(std::string_view law, const Material& material, int a,
                                        int b, const Contact& contact) {
  std::optional<NormalForce> force;
  choose(Choices<Hooke, HookeStiffness, Hertz, HertzStiffness>{}, law, [&](auto chosen) {
    using Law = decltype(chosen);
    force = Law::force(Law::constants(material, a, b), contact);
  });
  return force;
}

bool is_hertzian(std::string_view law) {
  return law == Hertz::name || law == HertzStiffness::name;
}

} // namespace granflux::particle_subset
