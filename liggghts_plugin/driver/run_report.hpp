// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include <granflux/coupling/coupler.hpp>

namespace granflux::driver {

/// Seconds of one run on one rank.
struct RunTimes {
  coupling::CouplingTimes coupling;
  double fields = 0; ///< writing gas fields
  double contacts = 0, other_fixes = 0, neighbour_lists = 0, communication = 0, output = 0;
  double total = 0;
  double exchange = 0, rest = 0; ///< what follows from the others: over_ranks() sets it
};
/// Part by part over the ranks: a rank that comes late to gas and exchange finds the others waiting
/// there, so the least of their times is what they take by themselves.
struct RunTimesOverRanks {
  RunTimes mean, least, most;
};
/// Collective.
RunTimesOverRanks over_ranks(RunTimes times, MPI_Comm comm);

/// Largest values over the coupling steps of one run.
struct LargestResiduals {
  double void_volume = 0;  ///< ExchangeReport::volume_residual
  double momentum = 0;     ///< ExchangeReport::momentum_residual
  double gas_mass = 0;     ///< continuity residual over the scale of its terms
  double gas_momentum = 0; ///< momentum budget of the gas over the scale of its terms
  double budget = 0;       ///< ExchangeReport::budget_residual
  bool with_heat = false;  ///< the gas has a temperature
  double gas_heat = 0;     ///< heat budget of the gas over the scale of its terms
  double heat = 0;         ///< ExchangeReport::heat_residual
  long nusselt_out_of_range = 0;
  double stiffness = 0; ///< ExchangeReport::stiffness_max
  double courant = 0;
  double void_fraction_min = 1; ///< smallest
  long outside = 0;             ///< particles of the group outside the gas grid
  long law_out_of_range = 0;    ///< particles outside the drag law's range
  long exchanges = 0;

  void add(const coupling::ExchangeReport& report, const cfd::Balance& balance);
};

/// Residuals relative to the scale of their own terms; 0 where all terms vanish.
double relative_continuity_residual(const cfd::StepReport& gas);
double relative_momentum_residual(const cfd::Balance& balance);
double relative_heat_residual(const cfd::Balance& balance);

/// What one rank has of the gas, and what of it crosses between ranks.
struct GasShare {
  double cells = 0;
  int threads = 1;
  double numbers_sent =
      0; ///< a coupling step, for void fraction, exchange terms and gas at particles
};
/// How evenly the gas is divided. Collective.
std::string division_report(const GasShare& mine, MPI_Comm comm);

/// The table at the end of a run. particle_steps: sum over steps of the particles of all ranks.
std::string run_report(const RunTimesOverRanks& times, const LargestResiduals& largest,
                       double particle_steps);

} // namespace granflux::driver
