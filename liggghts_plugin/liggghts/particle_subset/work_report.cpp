// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "work_report.hpp"

#include <array>

#include <fmt/core.h>

#include "driver/rank_spread.hpp"

namespace granflux::particle_subset {

namespace {

double ratio(double a, double b) {
  return b > 0 ? a / b : 0;
}

} // namespace

std::string work_report(const WorkTimes& times, const WorkLoad& load, MPI_Comm comm) {
  constexpr std::array names{
      "contacts",        "contact lists", "walls",  "integration",         "gas",  "other fixes",
      "neighbour lists", "communication", "output", "waiting for threads", "rest", "total"};
  std::array<double, names.size()> seconds{
      times.contacts, times.contact_lists, times.walls,           times.integration,
      times.gas,      times.other_fixes,   times.neighbour_lists, times.communication,
      times.output,   times.waiting,       times.total,           times.total};
  constexpr std::size_t rest = names.size() - 2, total = names.size() - 1;
  for (std::size_t part = 0; part < rest; ++part)
    seconds[rest] -= seconds[part];

  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const driver::RankSpread time(seconds, comm);
  // A thread's share is its rank's, divided by number.
  const driver::RankSpread count(
      std::array{load.particles, load.ghosts, load.particles / load.threads}, comm);
  const double particle_steps = count.mean[0] * ranks * load.steps;

  std::string text = fmt::format(
      "\ngranflux: particle work of {} rank{} x {} thread{}, {:.0f} particles, {:.0f} steps\n",
      ranks, ranks == 1 ? "" : "s", load.threads, load.threads == 1 ? "" : "s",
      count.mean[0] * ranks, load.steps);
  text += fmt::format("  {:<20}{:>11}{:>9}{:>19}{:>15}\n", "mean of ranks", "s", "%",
                      "ns/particle-step", "slowest/mean");
  for (std::size_t part = 0; part < names.size(); ++part)
    text += fmt::format("  {:<20}{:>11.4f}{:>9.2f}{:>19.2f}{:>15.2f}\n", names[part],
                        time.mean[part], 100 * ratio(time.mean[part], time.mean[total]),
                        1e9 * ratio(time.mean[part], particle_steps), time.most_over_mean(part));
  text +=
      fmt::format("  {:<20}{:>11}{:>9}{:>19}{:>15}\n", "", "mean", "least", "most", "most/mean");
  constexpr std::array counted{"particles a rank", "ghosts a rank", "particles a thread"};
  for (std::size_t k = 0; k < counted.size(); ++k)
    text += fmt::format("  {:<20}{:>11.0f}{:>9.0f}{:>19.0f}{:>15.2f}\n", counted[k], count.mean[k],
                        count.least[k], count.most[k], count.most_over_mean(k));
  return text;
}

} // namespace granflux::particle_subset
