// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/coupling/kernel/centre.hpp>
#include <granflux/coupling/kernel/divided.hpp>
#include <granflux/coupling/kernel/smoothed.hpp>
#include <granflux/coupling/kernel/spline.hpp>
#include <granflux/coupling/kernel/trilinear.hpp>
#include <granflux/coupling/law_list.hpp>

namespace granflux::coupling {

template <VoidFractionKernel... Kernels> using KernelList = LawList<Kernels...>;

/// All kernels a case may name; a new one is one file and one word here.
using VoidFractionKernels = KernelList<Centre, Divided, Trilinear, Spline, Smoothed>;
using AnyKernel = VoidFractionKernels::Any;

/// Whether a kernel serves what this locator finds cells in.
template <class Kernel, class Locator>
inline constexpr bool serves = requires(const Kernel kernel, const Locator& locator,
                                        const ParticlePlace& particle) {
  kernel(locator, particle, [](const cfd::Index3&, double) {});
};

/// Whether it says how far a particle may move with its shares.
template <class Kernel, class Locator>
inline constexpr bool tells_room = requires(const Kernel kernel, const Locator& locator,
                                            const ParticlePlace& particle) {
  {
    kernel(locator, particle, [](const cfd::Index3&, double) {})
    } -> std::same_as<Room>;
};

/// Whether its shares are products in one cube of cells.
template <class Kernel, class Locator>
inline constexpr bool has_cube = requires(const Kernel kernel, const Locator& locator) {
  kernel.cube(locator, Vec3{});
};

} // namespace granflux::coupling
