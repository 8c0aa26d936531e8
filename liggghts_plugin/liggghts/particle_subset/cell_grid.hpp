// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

#include <granflux/cfd/vec3.hpp>

#include "particles.hpp"

namespace granflux::particle_subset {

/// Particles sorted into cells no smaller than the longest distance of a pair, so that the partners
/// of a particle lie in its own cell and the 26 around it: nine runs of three cells that follow
/// each other in memory. Within a cell by number. Cells are counted along the shortest extent
/// first, as SpatialOrder has it: of the runs around a particle some then hold lower numbers only.
/// The same for every number of threads.
class CellGrid {
public:
  /// All particles and ghosts. `reach`: longest distance between the centres of a pair. Uses
  /// `threads` threads.
  void sort(const Particles& particles, double reach, int threads);

  /// The places begin ... end - 1 in sorted order, and the least and the largest number in them.
  struct Run {
    int begin, end;
    int least, most;
  };
  /// Calls visit(run, whether its middle cell is that of the place) for the particles in the cells
  /// around a place within the grid.
  template <class Visit> void for_each_run_around(const Vec3& place, Visit&& visit) const {
    const Run* const middle = run_.data() + cell_of(place);
    const auto layer = [&](const Run* of, auto in_own_layer) {
      visit(of[-stride_of_rows_], std::false_type{});
      visit(of[0], in_own_layer);
      visit(of[stride_of_rows_], std::false_type{});
    };
    layer(middle - stride_of_layers_, std::false_type{});
    layer(middle, std::true_type{});
    layer(middle + stride_of_layers_, std::false_type{});
  }
  /// No particle has more of them around it.
  [[nodiscard]] int most_around() const { return 9 * longest_run_; }

  /// What is needed of the particles to find partners, in sorted order, an array per number. Each
  /// may be read `lanes` places beyond its end.
  static constexpr int lanes = 8;
  struct Columns {
    const double *x, *y, *z, *radius;
    const int* number;
  };
  [[nodiscard]] Columns columns() const {
    return {x_.data(), y_.data(), z_.data(), radius_.data(), number_.data()};
  }

private:
  [[nodiscard]] int cell_of(const Vec3& place) const {
    int cell = 0;
    for (int d = 0; d < 3; ++d)
      cell += stride_[d] *
              (1 + std::min(whole((place[d] - origin_[d]) * inverse_size_[d]), cells_[d] - 3));
    return cell;
  }
  /// Whole cells from the origin; not-a-number goes to the first.
  [[nodiscard]] static int whole(double cells) { return cells > 0 ? int(cells) : 0; }
  void choose_cells(const Particles& particles, double reach, int threads);
  [[nodiscard]] Run run_around(int cell) const;

  int cells_[3] = {1, 1, 1}; // with one empty layer around those in use
  int stride_[3] = {1, 1, 1};
  int stride_of_rows_ = 1, stride_of_layers_ = 1; // 1 within a row
  Vec3 origin_;
  double inverse_size_[3] = {0, 0, 0};
  int longest_run_ = 0;
  std::vector<int> cell_;                // of each particle
  std::vector<std::vector<int>> strays_; // of each thread: particles in cells of other threads
  std::vector<int> start_;               // of each cell in the sorted order, and the end
  std::vector<Run> run_;                 // of each cell with those before and behind it
  std::vector<double> x_, y_, z_, radius_;
  std::vector<int> number_;
};

} // namespace granflux::particle_subset
