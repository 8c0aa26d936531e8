// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "law/hooke.hpp"
#include "normal_kernels.hpp"
#include "wall_kernels_of_normal_law.hpp"

namespace granflux::particle_subset {

std::unique_ptr<WallKernel> hooke_wall_kernel(const LawNames& names) {
  return wall_kernel_with_normal<Hooke>(names);
}

} // namespace granflux::particle_subset
