// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <array>
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

  /// What is needed of a particle to find partners, in sorted order.
  struct Entry {
    double x, y, z, radius;
  };

  /// The places begin ... end - 1 in sorted order, and the least and the largest number in them.
  struct Run {
    int begin, end;
    int least, most;
  };
  /// The particles in the cells around a place within the grid.
  [[nodiscard]] std::array<Run, 9> around(const Vec3& place) const;

  /// Of each place in sorted order.
  [[nodiscard]] const Entry* entries() const { return entry_.data(); }
  [[nodiscard]] const int* numbers() const { return number_.data(); }

private:
  [[nodiscard]] int cell_of(const Vec3& place) const;
  void choose_cells(const Particles& particles, double reach, int threads);

  struct Numbers {
    int least, most;
  };

  int cells_[3] = {1, 1, 1}; // with one empty layer around those in use
  int stride_[3] = {1, 1, 1};
  int stride_of_rows_ = 1, stride_of_layers_ = 1; // 1 within a row
  Vec3 origin_;
  double inverse_size_[3] = {0, 0, 0};
  std::vector<int> cell_;        // of each particle
  std::vector<int> start_;       // of each cell in the sorted order, and the end
  std::vector<int> filled_;      // particles of each cell not yet placed
  std::vector<Numbers> numbers_; // in each cell
  std::vector<int> number_;
  std::vector<Entry> entry_;
};

} // namespace granflux::particle_subset
