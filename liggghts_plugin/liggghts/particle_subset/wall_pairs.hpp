// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace granflux::particle_subset {

/// Which triangles a particle may touch: LIGGGHTS' lists of particles per triangle, turned round.
struct WallPairs {
  std::vector<int> particle; ///< ascending, each once
  std::vector<int> begin;    ///< of each of them in the arrays below, and the end
  std::vector<int> triangle; ///< ascending for each particle
  std::vector<int> place;    ///< of the pair among all pairs, triangle after triangle
  bool current = false;

  /// `near`(t): the particles near triangle t of `triangles`; those from `owned` on are ghosts and
  /// left out.
  template <class Near> void turn_round(int triangles, int owned, Near&& near);

private:
  std::vector<int> row_; // of each owned particle: pairs, then where its next pair goes
};

template <class Near> void WallPairs::turn_round(int triangles, int owned, Near&& near) {
  const auto at = [](auto& values, int i) -> auto& {
    return values[std::size_t(i)];
  };
  row_.assign(std::size_t(owned), 0);
  for (int t = 0; t < triangles; ++t)
    for (const int p : near(t))
      if (p < owned)
        ++at(row_, p);
  particle.clear();
  begin.assign(1, 0);
  for (int p = 0; p < owned; ++p)
    if (const int pairs = at(row_, p)) {
      particle.push_back(p);
      at(row_, p) = begin.back();
      begin.push_back(begin.back() + pairs);
    }
  triangle.resize(std::size_t(begin.back()));
  place.resize(std::size_t(begin.back()));
  int next_place = 0;
  for (int t = 0; t < triangles; ++t)
    for (const int p : near(t))
      if (p < owned) {
        const int k = at(row_, p)++;
        at(triangle, k) = t;
        at(place, k) = next_place++;
      }
  current = true;
}

} // namespace granflux::particle_subset
