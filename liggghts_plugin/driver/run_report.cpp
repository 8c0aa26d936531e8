// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "run_report.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/core.h>

#include "rank_spread.hpp"

namespace granflux::driver {

namespace {

double relative(double residual, double scale) {
  return scale > 0 ? residual / scale : residual;
}

} // namespace

RunTimesOverRanks over_ranks(RunTimes times, MPI_Comm comm) {
  const coupling::CouplingTimes& c = times.coupling;
  times.exchange = c.locate + c.deposit + c.messages + c.sample;
  times.rest = times.total -
               (c.gas + times.exchange + c.laws + c.force + times.fields + times.contacts +
                times.other_fixes + times.neighbour_lists + times.communication + times.output);
  using Row = std::array<double, sizeof(RunTimes) / sizeof(double)>;
  const RankSpread spread(std::bit_cast<Row>(times), comm);
  return {std::bit_cast<RunTimes>(spread.mean), std::bit_cast<RunTimes>(spread.least),
          std::bit_cast<RunTimes>(spread.most)};
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

std::string run_report(const RunTimesOverRanks& times, const LargestResiduals& largest,
                       double particle_steps) {
  std::string text = fmt::format("\ngranflux: {:<30}{:>11}{:>9}{:>19}{:>12}{:>12}\n",
                                 "time of the run, mean of ranks", "s", "%", "ns/particle-step",
                                 "least, s", "most, s");
  const auto row = [&](const char* name, auto seconds_of) {
    const double mean = seconds_of(times.mean);
    text +=
        fmt::format("  {:<38}{:>11.4f}{:>9.2f}{:>19.2f}{:>12.4f}{:>12.4f}\n", name, mean,
                    100 * relative(mean, times.mean.total), 1e9 * relative(mean, particle_steps),
                    seconds_of(times.least), seconds_of(times.most));
  };
  row("gas", [](const RunTimes& t) { return t.coupling.gas; });
  row("exchange", [](const RunTimes& t) { return t.exchange; });
  row("  locate", [](const RunTimes& t) { return t.coupling.locate; });
  row("  deposit", [](const RunTimes& t) { return t.coupling.deposit; });
  row("  messages", [](const RunTimes& t) { return t.coupling.messages; });
  row("  sample", [](const RunTimes& t) { return t.coupling.sample; });
  row("drag and heat laws", [](const RunTimes& t) { return t.coupling.laws; });
  row("fluid force", [](const RunTimes& t) { return t.coupling.force; });
  row("gas fields", [](const RunTimes& t) { return t.fields; });
  row("contacts", [](const RunTimes& t) { return t.contacts; });
  row("walls, integration, other fixes", [](const RunTimes& t) { return t.other_fixes; });
  row("neighbour lists", [](const RunTimes& t) { return t.neighbour_lists; });
  row("communication", [](const RunTimes& t) { return t.communication; });
  row("output", [](const RunTimes& t) { return t.output; });
  row("rest", [](const RunTimes& t) { return t.rest; });
  row("total", [](const RunTimes& t) { return t.total; });

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
