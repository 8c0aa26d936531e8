// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "near_heat.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <granflux/coupling/near_heat/radiation.hpp>

namespace granflux::particle_subset {

double NearHeatOptions::reach(double radius) const {
  return std::max(gas_gap ? gas_gap->reach(radius) : 0, surroundings ? coupling::sight(radius) : 0);
}

NearHeat::NearHeat(const NearHeatOptions& options, std::vector<double> emissivity)
    : options_(options), emissivity_(std::move(emissivity)) {}

/// The work of one thread.
class NearHeat::Thread {
public:
  Thread(const NearHeat& law, const Particles& particles, const HeatArrays& arrays, Range own,
         HeatSums& sums, std::span<double> facing)
      : law_(law), p_(particles), arrays_(arrays), own_(own), sums_(sums), facing_(facing) {}

  template <class Ordered> void go_along(const ContactRows& rows, Ordered ordered) {
    for (int row = 0; row < own_.size(); ++row)
      for (int e = rows.row_begin(row); e < rows.row_end(row); ++e) {
        const auto [i, j] = ordered(own_.begin + row, rows.partner[std::size_t(e)]);
        exchange(i, j);
      }
  }

  /// What the others leave of each sphere's sight.
  void radiate_to_surroundings(double temperature) {
    for (int i = own_.begin; i < own_.end; ++i) {
      const double area =
          4 * std::numbers::pi * p_.radius[i] * p_.radius[i] - facing_[std::size_t(i)];
      const double per_kelvin4 = coupling::stefan_boltzmann * emissivity(i) * area;
      const double own = arrays_.temperature[i];
      const double heat = per_kelvin4 * coupling::difference_of_fourth_powers(temperature, own);
      arrays_.rate[i] += heat;
      sums_.radiation += heat;
      if (arrays_.shown.wanted()) {
        arrays_.shown.near[i].radiation += heat;
        arrays_.shown.near[i].conductance += slope(per_kelvin4, temperature, own);
      }
    }
  }

private:
  [[nodiscard]] double emissivity(int i) const {
    return law_.emissivity_[std::size_t(p_.type[i]) - 1];
  }

  /// (a^4 - b^4) / (a - b) [K3] times per_kelvin4.
  static double slope(double per_kelvin4, double a, double b) {
    return per_kelvin4 * (a * a + b * b) * (a + b);
  }

  void exchange(int i, int j) {
    const Vec3 separation = p_.position[i] - p_.position[j];
    const double squared = dot(separation, separation);
    const double radius_i = p_.radius[i], radius_j = p_.radius[j];
    const double limit = radius_i + radius_j + law_.options_.reach(std::max(radius_i, radius_j));
    if (squared >= limit * limit)
      return;
    const double distance = std::sqrt(squared);
    if (law_.options_.gas_gap) {
      const double conductance = law_.options_.gas_gap->conductance(radius_i, radius_j, distance);
      const double heat = conductance * (arrays_.temperature[j] - arrays_.temperature[i]);
      give(i, j, heat, conductance, &NearHeatRates::gas_gap, &HeatSums::conduction);
    }
    if (law_.options_.surroundings) {
      const double area = coupling::facing_area(radius_i, radius_j, distance);
      const double t_i = arrays_.temperature[i], t_j = arrays_.temperature[j];
      const double per_kelvin4 = coupling::stefan_boltzmann * area *
                                 coupling::exchange_emissivity(emissivity(i), emissivity(j));
      const double heat = per_kelvin4 * coupling::difference_of_fourth_powers(t_j, t_i);
      give(i, j, heat, slope(per_kelvin4, t_i, t_j), &NearHeatRates::radiation,
           &HeatSums::radiation);
      if (own_.holds(i))
        facing_[std::size_t(i)] += area;
      if (own_.holds(j))
        facing_[std::size_t(j)] += area;
    }
  }

  void give(int i, int j, double heat, double conductance, double NearHeatRates::*kind,
            double HeatSums::*sum) {
    const auto to = [&](int particle, double received) {
      if (!own_.holds(particle))
        return;
      arrays_.rate[particle] += received;
      sums_.*sum += received;
      if (arrays_.shown.wanted()) {
        arrays_.shown.near[particle].*kind += received;
        arrays_.shown.near[particle].conductance += conductance;
      }
    };
    to(i, heat);
    to(j, -heat);
  }

  const NearHeat& law_;
  const Particles& p_;
  const HeatArrays& arrays_;
  const Range own_;
  HeatSums& sums_;
  std::span<double> facing_;
};

void NearHeat::add(const Particles& particles, const ThreadContacts& contacts,
                   const HeatArrays& arrays, HeatSums& sums, std::span<double> facing) const {
  const Range own = contacts.own;
  if (options_.surroundings)
    std::fill(facing.begin() + own.begin, facing.begin() + own.end, 0.0);
  Thread thread(*this, particles, arrays, own, sums, facing);
  thread.go_along(contacts.lower, [](int i, int partner) { return std::pair(partner, i); });
  thread.go_along(contacts.upper, [](int i, int partner) { return std::pair(i, partner); });
  if (options_.surroundings)
    thread.radiate_to_surroundings(*options_.surroundings);
}

} // namespace granflux::particle_subset
