// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/weights.hpp>

#include <stdexcept>
#include <type_traits>

namespace granflux::coupling {

std::size_t Weights::most_particles(const AnyKernel& any_kernel, const AnyLocator& any_locator) {
  return std::visit(
      []<class Kernel, class Locator>(const Kernel&, const Locator&) {
        if constexpr (has_cube<Kernel, Locator>)
          return CubeShares<Kernel::width>::most_particles;
        else
          return ShareLists::most_particles;
      },
      any_kernel, any_locator);
}

void Weights::build(const AnyKernel& any_kernel, const AnyLocator& any_locator,
                    std::span<const Vec3> position, std::span<const double> radius,
                    std::span<const std::uint8_t> coupled) {
  const ParticlesToPlace particles{position, radius, coupled};
  placed_.resize(particles.size());
  const auto keep = [&]<class Shares>(std::type_identity<Shares>) -> Shares& {
    if (!std::holds_alternative<Shares>(shares_))
      shares_.emplace<Shares>();
    return std::get<Shares>(shares_);
  };
  placing_ = std::visit(
      [&]<class Kernel, class Locator>(const Kernel& kernel, const Locator& locator) -> Placing {
        if constexpr (has_cube<Kernel, Locator>)
          return keep(std::type_identity<CubeShares<Kernel::width>>{})
              .build(kernel, locator, particles, placed_);
        else if constexpr (serves<Kernel, Locator>)
          return keep(std::type_identity<ShareLists>{}).build(kernel, locator, particles, placed_);
        else
          throw std::logic_error("a kernel for lattices was given another grid");
      },
      any_kernel, any_locator);
}

} // namespace granflux::coupling
