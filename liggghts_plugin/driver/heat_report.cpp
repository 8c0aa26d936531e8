// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "heat_report.hpp"

#include <algorithm>
#include <limits>

#include <fmt/core.h>

#include <granflux/coupling/compensated_sum.hpp>
#include <granflux/coupling/contact_heat/conductance.hpp>

namespace granflux::driver {

namespace {

constexpr double biot_limit = 0.1;      // above it a particle is not of one temperature
constexpr double radiation_limit = 700; // K; above it radiation cannot be neglected

} // namespace

double heat_of(const WarmParticles& p) {
  coupling::CompensatedSum heat;
  for (std::size_t i = 0; i < p.temperature.size(); ++i)
    heat += p.mass[i] * p.capacity[std::size_t(p.type[i]) - 1] * (p.temperature[i] + p.carry[i]);
  return heat.value();
}

void HeatReport::look(const WarmParticles& p, const std::optional<Conduction>& conduction,
                      const HeatPowers& powers, const HeatBooks& books,
                      std::optional<double> heat_at_start, MPI_Comm comm) {
  double capacity = 0, biot_sum = 0, biot_max = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < p.temperature.size(); ++i) {
    const auto type = std::size_t(p.type[i]) - 1;
    capacity += p.mass[i] * p.capacity[type];
    low = std::min(low, p.temperature[i]);
    high = std::max(high, p.temperature[i]);
    if (conduction) {
      const double biot = coupling::biot_number(
          conduction->conductance(int(i)), conduction->materials[type].conductivity, p.radius[i]);
      biot_sum += biot;
      biot_max = std::max(biot_max, biot);
    }
  }
  totals_ = {powers, books.value()};
  MPI_Allreduce(MPI_IN_PLACE, totals_.data(), int(sizeof totals_ / sizeof(double)), MPI_DOUBLE,
                MPI_SUM, comm);
  double sums[] = {heat_of(p), capacity, biot_sum, double(p.temperature.size())};
  double extremes[] = {high, -low, biot_max};
  MPI_Allreduce(MPI_IN_PLACE, sums, 4, MPI_DOUBLE, MPI_SUM, comm);
  MPI_Allreduce(MPI_IN_PLACE, extremes, 3, MPI_DOUBLE, MPI_MAX, comm);
  // By particles, less what those of fixed temperature passed on.
  const HeatPowers& e = totals_[1];
  const double received = e.conduction + e.walls + e.friction + e.damping + e.convection +
                          e.source + e.radiation - e.held;
  heat_ = sums[0];
  capacity_ = sums[1];
  biot_sum_ = sums[2];
  particles_ = sums[3];
  high_ = extremes[0];
  low_ = -extremes[1];
  biot_max_ = extremes[2];
  carried_ = heat_ - heat_at_start.value_or(heat_) - received;
}

std::string HeatReport::warnings(bool with_radiation) {
  std::string text;
  if (biot_max_ > biot_limit && !warned_of_biot_) {
    warned_of_biot_ = true;
    text += fmt::format(
        "granflux: WARNING: the largest Biot number of a particle is {:.3g}: above {} its "
        "inside is not of one temperature, as is assumed\n",
        biot_max_, biot_limit);
  }
  if (!with_radiation && high_ > radiation_limit && !warned_of_radiation_) {
    warned_of_radiation_ = true;
    text +=
        fmt::format("granflux: WARNING: the hottest particle has {:.0f} K: above {} K radiation "
                    "matters, which is off (keyword radiation)\n",
                    high_, radiation_limit);
  }
  return text;
}

std::string HeatReport::biot_numbers() const {
  if (particles_ == 0)
    return {};
  return fmt::format("granflux: Biot number of the particles at the end of the run: mean {:.3g}, "
                     "largest {:.3g}\n",
                     biot_sum_ / particles_, biot_max_);
}

double HeatReport::value(int n) const {
  const bool any = particles_ > 0;
  const auto& [powers, energies] = totals_;
  const std::array<double, values> all{any ? heat_ / capacity_ : 0,
                                       any ? low_ : 0,
                                       any ? high_ : 0,
                                       any ? biot_sum_ / particles_ : 0,
                                       biot_max_,
                                       powers.conduction,
                                       powers.walls,
                                       powers.friction,
                                       powers.damping,
                                       powers.convection,
                                       powers.source,
                                       powers.to_walls,
                                       powers.held,
                                       energies.conduction,
                                       energies.walls,
                                       energies.friction,
                                       energies.damping,
                                       energies.convection,
                                       energies.source,
                                       energies.to_walls,
                                       energies.held,
                                       carried_,
                                       powers.radiation,
                                       energies.radiation};
  return all[std::size_t(n)];
}

} // namespace granflux::driver
