// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "wall_kernel.hpp"

#include "law/hertz.hpp"
#include "law/hertz_stiffness.hpp"
#include "law/hooke.hpp"
#include "law/hooke_stiffness.hpp"
#include "normal_kernels.hpp"

namespace granflux::particle_subset {

std::unique_ptr<WallKernel> make_wall_kernel(const LawNames& names) {
  if (names.normal == Hooke::name)
    return hooke_wall_kernel(names);
  if (names.normal == HookeStiffness::name)
    return hooke_stiffness_wall_kernel(names);
  if (names.normal == Hertz::name)
    return hertz_wall_kernel(names);
  if (names.normal == HertzStiffness::name)
    return hertz_stiffness_wall_kernel(names);
  return nullptr;
}

} // namespace granflux::particle_subset
