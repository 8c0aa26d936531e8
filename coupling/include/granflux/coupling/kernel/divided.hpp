// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

#include <granflux/coupling/kernel/kernel.hpp>

namespace granflux::coupling {

/// The particle stood for by 29 points of equal volume; each gives 1/29 to the cell it lies in, a
/// point outside the domain to the cell of the centre.
///
/// The sphere is cut into a core of V/29 and two shells of 14 V/29, each shell into 14 equal parts
/// along the directions of a cube's 6 faces and 8 corners. The points of a shell lie on its root
/// mean square radius, so that the set has the sphere's centre of mass and, by the cubic symmetry
/// of the directions and a core point of no extent, its second moments but for the core's
/// (1/29)^(5/3) = 0.4 %.
struct Divided {
  static constexpr std::string_view name = "divided";
  static constexpr bool smooths = false;
  static constexpr int points = 29;
  static constexpr int parts = points;

  template <class Emit>
  Room operator()(const BlockLocator& blocks, const ParticlePlace& particle, Emit&& emit) const {
    const double room = blocks.room(particle.cell, particle.centre) - outermost() * particle.radius;
    if (room > 0) {
      emit(particle.cell, 1.0);
      return {.ball = float(room)};
    }
    const auto found = blocks.cells(point_set(), particle.centre, particle.radius, particle.cell);
    for (const auto& [cell, count] : found)
      emit(cell, count / double(points));
    return found.room;
  }

  template <class Emit>
  void operator()(const LatticeLocator& lattice, const ParticlePlace& particle, Emit&& emit) const {
    if (inside_one_cell(lattice, particle)) {
      emit(particle.cell, 1.0);
      return;
    }
    std::array<cfd::Index3, points> cells;
    std::array<int, points> counts{};
    int found = 0;
    for (const Vec3& offset : offsets()) {
      const Vec3 point = particle.centre + particle.radius * offset;
      const auto cell = lattice.cell(point).value_or(particle.cell);
      int slot = 0;
      while (slot < found && cells[std::size_t(slot)] != cell)
        ++slot;
      if (slot == found)
        cells[std::size_t(found++)] = cell;
      ++counts[std::size_t(slot)];
    }
    for (int slot = 0; slot < found; ++slot)
      emit(cells[std::size_t(slot)], counts[std::size_t(slot)] / double(points));
  }

  /// The points for a sphere of radius 1 at the origin.
  static const std::array<Vec3, points>& offsets() {
    static const auto set = make_offsets();
    return set;
  }

private:
  static bool inside_one_cell(const LatticeLocator& lattice, const ParticlePlace& particle) {
    const Vec3 half{particle.radius, particle.radius, particle.radius};
    return lattice.cell(particle.centre - half) == particle.cell &&
           lattice.cell(particle.centre + half) == particle.cell;
  }

  static double outermost() {
    static const double radius = shell_radius(15, points);
    return radius;
  }
  static const BlockLocator::PointSet& point_set() {
    static const auto set = [] {
      BlockLocator::PointSet all{.count = points};
      for (std::size_t k = 0; k < offsets().size(); ++k) {
        all.x[k] = float(offsets()[k].x);
        all.y[k] = float(offsets()[k].y);
        all.z[k] = float(offsets()[k].z);
      }
      return all;
    }();
    return set;
  }

  /// Root mean square radius of the shell between the spheres that hold `inner` and `outer` of the
  /// 29 parts: sqrt(3/5 (b^5 - a^5) / (b^3 - a^3)).
  static double shell_radius(int inner, int outer) {
    const double a3 = inner / double(points), b3 = outer / double(points);
    return std::sqrt(0.6 * (std::pow(b3, 5 / 3.) - std::pow(a3, 5 / 3.)) / (b3 - a3));
  }

  static std::array<Vec3, points> make_offsets() {
    std::array<Vec3, points> set{};
    std::size_t next = 1; // the first is the core's, at the centre
    for (const double radius : {shell_radius(1, 15), shell_radius(15, 29)}) {
      for (int d = 0; d < 3; ++d)
        for (const double sign : {-1., 1.})
          set[next++][d] = sign * radius;
      const double c = radius / std::sqrt(3.);
      for (int corner = 0; corner < 8; ++corner)
        set[next++] = {corner & 1 ? c : -c, corner & 2 ? c : -c, corner & 4 ? c : -c};
    }
    return set;
  }
};

} // namespace granflux::coupling
