// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "run_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "rank_spread.hpp"

namespace granflux::driver {

namespace {

double relative(double residual, double scale) {
  return scale > 0 ? residual / scale : residual;
}

} // namespace

RunTimes mean_over_ranks(RunTimes times, MPI_Comm comm) {
  static_assert(sizeof(RunTimes) % sizeof(double) == 0, "RunTimes must hold doubles only");
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  auto* values = reinterpret_cast<double*>(&times);
  constexpr int count = sizeof(RunTimes) / sizeof(double);
  MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_SUM, comm);
  std::for_each_n(values, count, [&](double& value) { value /= ranks; });
  return times;
}

double relative_continuity_residual(const cfd::StepReport& gas) {
  return relative(gas.continuity_residual, gas.continuity_scale);
}

double relative_momentum_residual(const cfd::Balance& balance) {
  return relative(norm(balance.momentum_residual), balance.momentum_scale);
}

double relative_heat_residual(const cfd::Balance& balance) {
  return relative(std::abs(balance.heat_residual), balance.heat_scale);
}

void LargestResiduals::add(const coupling::ExchangeReport& report, const cfd::Balance& balance) {
  void_volume = std::max(void_volume, report.volume_residual);
  momentum = std::max(momentum, report.momentum_residual);
  gas_mass = std::max(gas_mass, relative_continuity_residual(report.gas));
  gas_momentum = std::max(gas_momentum, relative_momentum_residual(balance));
  budget = std::max(budget, report.budget_residual);
  with_heat = with_heat || balance.heat_scale > 0;
  gas_heat = std::max(gas_heat, relative_heat_residual(balance));
  heat = std::max(heat, report.heat_residual);
  nusselt_out_of_range = std::max(nusselt_out_of_range, report.nusselt_out_of_range);
  stiffness = std::max(stiffness, report.stiffness_max);
  courant = std::max(courant, report.gas.courant);
  void_fraction_min = std::min(void_fraction_min, report.void_fraction_min);
  outside = std::max(outside, report.outside);
  law_out_of_range = std::max(law_out_of_range, report.law_out_of_range);
  ++exchanges;
}

std::string division_report(const GasShare& mine, MPI_Comm comm) {
  constexpr std::array names{"gas cells a rank", "gas cells a thread",
                             "numbers sent a rank and coupling step"};
  const RankSpread spread(std::array{mine.cells, mine.cells / mine.threads, mine.numbers_sent},
                          comm);
  std::string text = fmt::format("granflux: {:<36}{:>11}{:>9}{:>9}{:>11}\n",
                                 "gas, divided by blocks", "mean", "least", "most", "most/mean");
  for (std::size_t k = 0; k < names.size(); ++k)
    text += fmt::format("  {:<44}{:>11.0f}{:>9.0f}{:>9.0f}{:>11.2f}\n", names[k], spread.mean[k],
                        spread.least[k], spread.most[k], spread.most_over_mean(k));
  return text;
}

std::string run_report(const RunTimes& times, const LargestResiduals& largest,
                       double particle_steps) {
  const coupling::CouplingTimes& c = times.coupling;
  const double exchange = c.locate + c.deposit + c.messages + c.sample;
  const double known = c.gas + exchange + c.force + times.fields + times.contacts +
                       times.other_fixes + times.neighbour_lists + times.communication +
                       times.output;
  std::string text = fmt::format("\ngranflux: {:<34}{:>11}{:>9}{:>19}\n",
                                 "time of the run, mean of ranks", "s", "%", "ns/particle-step");
  const auto row = [&](const char* name, double seconds) {
    text +=
        fmt::format("  {:<42}{:>11.4f}{:>9.2f}{:>19.2f}\n", name, seconds,
                    100 * relative(seconds, times.total), 1e9 * relative(seconds, particle_steps));
  };
  row("gas", c.gas);
  row("exchange", exchange);
  row("  locate", c.locate);
  row("  deposit", c.deposit);
  row("  messages", c.messages);
  row("  sample", c.sample);
  row("fluid force", c.force);
  row("gas fields", times.fields);
  row("contacts", times.contacts);
  row("walls, integration, other fixes", times.other_fixes);
  row("neighbour lists", times.neighbour_lists);
  row("communication", times.communication);
  row("output", times.output);
  row("rest", times.total - known);
  row("total", times.total);

  text += fmt::format("granflux: largest of {} coupling steps\n", largest.exchanges);
  const auto value = [&](const char* name, double v) {
    text += fmt::format("  {:<42}{:>11.3e}\n", name, v);
  };
  value("residual of void volume", largest.void_volume);
  value("residual of momentum handed over", largest.momentum);
  value("residual of gas mass", largest.gas_mass);
  value("residual of gas momentum", largest.gas_momentum);
  value("residual of momentum of gas and exchange", largest.budget);
  if (largest.with_heat) {
    value("residual of gas heat", largest.gas_heat);
    value("residual of heat handed over", largest.heat);
  }
  value("Courant number", largest.courant);
  value("coupling interval over response time", largest.stiffness);
  value("smallest void fraction", largest.void_fraction_min);
  text += fmt::format("  {:<42}{:>11}\n", "particles outside the gas grid", largest.outside);
  text += fmt::format("  {:<42}{:>11}\n", "particles outside the drag law's range",
                      largest.law_out_of_range);
  if (largest.with_heat)
    text += fmt::format("  {:<42}{:>11}\n", "particles outside the Nusselt law's range",
                        largest.nusselt_out_of_range);
  return text;
}

} // namespace granflux::driver
