// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "kernels_of_normal_law.hpp"
#include "law/hooke.hpp"
#include "normal_kernels.hpp"

namespace granflux::particle_subset {

std::unique_ptr<ContactKernel> hooke_kernel(const LawNames& names, std::string& unknown) {
  return kernel_with_normal<Hooke>(names, unknown);
}

} // namespace granflux::particle_subset
