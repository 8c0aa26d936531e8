// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
#include <functional>
#include <mpi.h>
#include <optional>
#include <span>
#include <string>

#include "heat_books.hpp"
#include "particle_subset/contact_heat.hpp"

namespace granflux::driver {

/// The particles of a rank, as far as their heat is concerned; one entry a particle.
struct WarmParticles {
  std::span<const double> temperature, carry; ///< K; what rounding has kept from it
  std::span<const double> mass, radius;       ///< kg, m
  std::span<const int> type;                  ///< from 1 on
  std::span<const double> capacity;           ///< of each type [J/(kg K)]
};

/// Heat of these particles, sum of m c T [J].
[[nodiscard]] double heat_of(const WarmParticles& particles);

/// What is told of the temperatures of all particles on all ranks: the values of fix granflux/heat,
/// its warnings, its line at the end of a run.
class HeatReport {
public:
  static constexpr int values = 24;

  /// Conductances of a particle's contacts [W/K] and the conductivities of types, where there is
  /// conduction.
  struct Conduction {
    std::function<double(int particle)> conductance;
    std::span<const particle_subset::ThermalMaterial> materials;
  };

  /// Sums over all ranks. `powers`: of the last step; `heat_at_start`: of all particles when the
  /// books were opened [J]. Collective.
  void look(const WarmParticles& particles, const std::optional<Conduction>& conduction,
            const HeatPowers& powers, const HeatBooks& books, std::optional<double> heat_at_start,
            MPI_Comm comm);

  /// Heat of all particles [J].
  [[nodiscard]] double heat() const { return heat_; }
  /// Entry n of the output vector, from 0 on (docs/reference/fix_granflux_heat.md).
  [[nodiscard]] double value(int n) const;
  /// Lines that were not said before: of large Biot numbers, and of heat by radiation where it is
  /// not `with_radiation`.
  [[nodiscard]] std::string warnings(bool with_radiation);
  /// The line at the end of a run with conduction.
  [[nodiscard]] std::string biot_numbers() const;

private:
  double heat_ = 0;     // sum m c T [J]
  double capacity_ = 0; // sum m c [J/K]
  double low_ = 0, high_ = 0;
  double biot_sum_ = 0, biot_max_ = 0, particles_ = 0;
  double carried_ = 0;                 // heat that is not accounted for by what was received [J]
  std::array<HeatPowers, 2> totals_{}; // powers [W] and energies [J]
  bool warned_of_biot_ = false, warned_of_radiation_ = false;
};

} // namespace granflux::driver
