// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "kernels_of_normal_law.hpp"
#include "law/hertz_stiffness.hpp"
#include "normal_kernels.hpp"

namespace granflux::particle_subset {

std::unique_ptr<ContactKernel> hertz_stiffness_kernel(const LawNames& names, std::string& unknown) {
  return kernel_with_normal<HertzStiffness>(names, unknown);
}

} // namespace granflux::particle_subset
