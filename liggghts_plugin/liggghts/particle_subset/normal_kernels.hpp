// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <memory>
#include <string>

#include "contact_kernel.hpp"
#include "wall_kernel.hpp"

namespace granflux::particle_subset {

/// Like make_contact_kernel, for one normal law each.
std::unique_ptr<ContactKernel> hooke_kernel(const LawNames& names, std::string& unknown);
std::unique_ptr<ContactKernel> hooke_stiffness_kernel(const LawNames& names, std::string& unknown);
std::unique_ptr<ContactKernel> hertz_kernel(const LawNames& names, std::string& unknown);
std::unique_ptr<ContactKernel> hertz_stiffness_kernel(const LawNames& names, std::string& unknown);

std::unique_ptr<WallKernel> hooke_wall_kernel(const LawNames& names);
std::unique_ptr<WallKernel> hooke_stiffness_wall_kernel(const LawNames& names);
std::unique_ptr<WallKernel> hertz_wall_kernel(const LawNames& names);
std::unique_ptr<WallKernel> hertz_stiffness_wall_kernel(const LawNames& names);

} // namespace granflux::particle_subset
