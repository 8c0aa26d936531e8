// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "contact_kernel.hpp"

#include "law/hertz.hpp"
#include "law/hertz_stiffness.hpp"
#include "law/hooke.hpp"
#include "law/hooke_stiffness.hpp"
#include "normal_kernels.hpp"

namespace granflux::particle_subset {

std::unique_ptr<ContactKernel> make_contact_kernel(const LawNames& names, std::string& unknown) {
  if (names.normal == HookeStiffness::name)
    return hooke_stiffness_kernel(names, unknown);
  if (names.normal == Hooke::name)
    return hooke_kernel(names, unknown);
  if (names.normal == HertzStiffness::name)
    return hertz_stiffness_kernel(names, unknown);
  if (names.normal == Hertz::name)
    return hertz_kernel(names, unknown);
  unknown = "model " + names.normal;
  return nullptr;
}

} // namespace granflux::particle_subset
