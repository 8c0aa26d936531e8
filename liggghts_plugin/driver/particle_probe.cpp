// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "particle_probe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/core.h>

namespace granflux::driver {

namespace {

double squared(const Vec3& v) {
  return dot(v, v);
}

double sum(const Vec3& v) {
  return v.x + v.y + v.z;
}

std::string text(const Vec3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

bool within(double distance_squared, double radius) {
  return distance_squared <= radius * radius;
}

} // namespace

/// A division or a square root takes longer than all the rest: neither is in the loop, but where a
/// largest value grows.
ParticleProbe ParticleJudge::look(const coupling::ParticleView& view, MPI_Comm comm) const {
  const double dt2 = time_step * time_step, dt4 = dt2 * dt2, path2 = judge_path ? dt2 : 0;
  constexpr double far = std::numeric_limits<double>::max();
  long bad = 0;
  double speed2 = 0, rate2 = 0, least_radius = far, least_mass = far, largest_radius = 0;
  double mass_per_cube = far; // of the radius
  const auto n = std::ptrdiff_t(view.size());
  const bool all_free = view.fixed.empty(), with_heat = !view.temperature.empty();
#pragma omp parallel for schedule(static)                                                          \
    reduction(+ : bad) reduction(max : speed2, rate2, largest_radius)                              \
    reduction(min : least_radius, least_mass, mass_per_cube)
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto p = std::size_t(i);
    const double r = view.radius[p], m = view.mass[p], r2 = r * r;
    const double v2 = squared(view.velocity[p]);
    const double f2 = squared(view.force[p]);
    // True for numbers only: those that are not fail every comparison.
    const bool moves = (std::abs(sum(view.position[p])) <= far) & (v2 <= far) & (v2 * path2 <= r2);
    const bool fixed = !all_free && view.fixed[p];
    const bool held = (f2 * dt4 <= r2 * m * m) | ((f2 <= far) & fixed);
    const bool warm = !with_heat || (view.temperature[p] >= 0 && view.temperature[p] <= far);
    bad += !(moves & held & warm);
    speed2 = std::max(speed2, v2);
    if (v2 > rate2 * r2)
      rate2 = v2 / r2;
    if (!fixed && m < mass_per_cube * (r2 * r))
      mass_per_cube = m / (r2 * r);
    least_radius = std::min(least_radius, r);
    least_mass = std::min(least_mass, m);
    largest_radius = std::max(largest_radius, r);
  }
  std::array<double, 7> all{double(bad), speed2,         rate2,         -least_radius,
                            -least_mass, largest_radius, -mass_per_cube};
  MPI_Allreduce(MPI_IN_PLACE, all.data(), int(all.size()), MPI_DOUBLE, MPI_MAX, comm);
  const bool some = all[5] > 0;
  return {.good = all[0] == 0,
          .speed = std::sqrt(all[1]),
          .speed_over_radius = std::sqrt(all[2]),
          .least_radius = some ? -all[3] : 0,
          .least_mass = some ? -all[4] : 0,
          .largest_radius = all[5],
          .least_density = all[6] > -far ? -all[6] * 3 / (4 * std::numbers::pi) : 0};
}

std::string ParticleJudge::complaint(const coupling::ParticleView& view) const {
  const double dt2 = time_step * time_step;
  const auto who = [&](std::size_t p) {
    return fmt::format("particle {}at {} m, velocity {} m/s",
                       view.id.empty() ? "" : fmt::format("{} ", view.id[p]),
                       text(view.position[p]), text(view.velocity[p]));
  };
  // Its own state first: forces that are not a number may come from a neighbour's.
  for (std::size_t p = 0; p < view.size(); ++p) {
    if (!std::isfinite(sum(view.position[p]) + sum(view.velocity[p])))
      return fmt::format("{}: not a number", who(p));
    if (!view.temperature.empty() &&
        !(view.temperature[p] >= 0 && std::isfinite(view.temperature[p])))
      return fmt::format("{}: temperature {:.6g} K", who(p), view.temperature[p]);
  }
  for (std::size_t p = 0; p < view.size(); ++p) {
    const double r = view.radius[p], kick = dt2 * norm(view.force[p]) / view.mass[p];
    const bool free = view.fixed.empty() || !view.fixed[p];
    if (!std::isfinite(sum(view.force[p])))
      return fmt::format("{}: its force {} N is not a number", who(p), text(view.force[p]));
    if (free && !within(kick * kick, r))
      return fmt::format("{}: its force of {:.3g} N moves it by {:.3g} of its radius in one step",
                         who(p), norm(view.force[p]), kick / r);
    if (judge_path && !within(squared(view.velocity[p]) * dt2, r))
      return fmt::format("{}: moves by {:.3g} of its radius in one step", who(p),
                         time_step * norm(view.velocity[p]) / r);
  }
  return {};
}

} // namespace granflux::driver
