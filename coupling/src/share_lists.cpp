// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/share_lists.hpp>

namespace granflux::coupling {

void ShareLists::keep_found(std::size_t particles, std::string_view kernel, long locator) {
  for (Run& run : runs_)
    std::swap(run.entries, run.before);
  if (found_.size() == particles && kernel_ == kernel && locator_ == locator)
    return;
  found_.assign(particles, {});
  kernel_ = kernel;
  locator_ = locator;
}

/// Joins what the threads found, cells by their place in the window, and sorts it by cell.
void ShareLists::join(Placing& all) {
  for (std::size_t p = 0; p + 1 < offset_.size(); ++p)
    offset_[p + 1] += offset_[p];
  std::vector<std::size_t> first(runs_.size() + 1, 0);
  for (std::size_t t = 0; t < runs_.size(); ++t) {
    all += runs_[t].placing;
    first[t + 1] = first[t] + runs_[t].entries.size();
  }
  if (all.placed == 0)
    all.window = {};
  window_ = all.window;

  cell_.resize(first.back());
  share_.resize(first.back());
#pragma omp parallel for schedule(static, 1)
  for (std::size_t t = 0; t < runs_.size(); ++t)
    for (std::size_t e = 0; e < runs_[t].entries.size(); ++e) {
      const auto& [cell, share] = runs_[t].entries[e];
      cell_[first[t] + e] = std::uint32_t(window_.index(cell));
      share_[first[t] + e] = share;
    }

  particle_.resize(cell_.size());
  cell_share_.resize(cell_.size());
  const std::size_t count = offset_.size() - 1;
  cells_.sort(
      window_.size(),
      [&](int t, int n, auto&& visit) {
        const std::size_t end = run_begin(count, t + 1, n);
        for (std::size_t p = run_begin(count, t, n); p < end; ++p)
          for (std::size_t e = offset_[p]; e < offset_[p + 1]; ++e)
            visit(cell_[e], std::pair(p, e));
      },
      [&](const std::pair<std::size_t, std::size_t>& entry, std::size_t, std::size_t place) {
        particle_[place] = std::uint32_t(entry.first);
        cell_share_[place] = share_[entry.second];
      });
}

} // namespace granflux::coupling
