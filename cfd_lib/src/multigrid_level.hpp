// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <granflux/cfd/coarsening.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/level_field.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// Chebyshev iteration for A x = rhs, A scaled by its diagonal. Saad, Iterative Methods for Sparse
/// Linear Systems, 2nd ed., algorithm 12.1.
struct Smoothing {
  /// Step n, from 1: x + keep (x - x_before) + gain (rhs - A x) / diagonal.
  struct Step {
    float keep, gain;
  };

  /// Damps what lies within centre -+ half_width of the spectrum.
  Smoothing(int steps, double centre, double half_width);
  /// Damps the part of the spectrum above a share of its upper bound, which is 2 for any matrix
  /// without mass (Gershgorin); what lies below is for the coarse levels.
  static Smoothing above(double share_left_to_coarse_levels, int steps);
  [[nodiscard]] int count() const { return int(steps.size()) - 1; }

  std::vector<Step> steps; ///< entry 0 is not used
};

/// Cells join along the same directions in a whole block. Where they are coupled more strongly
/// along one direction here and along another there, as in cells stretched towards a wall, error
/// that varies along the weak one is left to the smoother: it must reach further down.
Smoothing smoothing_for(const Mesh& finest);
/// The one that reaches furthest.
Smoothing far_reaching_smoothing();

/// What one block holds on one level of the multigrid solver.
struct LevelBlock {
  enum class Holds {
    equation,
    transfer ///< right-hand side and x alone
  };
  LevelBlock(Index3 cells, int outer, Holds what = Holds::equation);

  LevelLayout layout;
  std::array<FloatField, 3> coefficient; ///< of low faces; 0 where a direction couples nothing
  FloatField mass; ///< what the diagonal has beyond the sum of the coefficients; empty for nothing
  FloatField inverse_diagonal; ///< 0 where nothing couples to a cell
  FloatField rhs;
  FloatField x, spare; ///< the iterate and its next one; ghosts at boundaries stay 0

  /// Planes are swept along `outer`, one of j and k, rows in a plane along `inner`.
  int inner, outer;
  /// Of rhs and x after correct_and_smooth, one a row; empty where they are not wanted.
  std::vector<double> products;
  /// Per thread: planes of the iterates between x and the next x, with ghosts that stay 0.
  std::vector<FloatField> planes;
};

/// What a face loses where coarse cells reach across a link: the factor of its coefficient is
/// that for a boundary times this.
struct LinkFactor {
  std::size_t block; ///< index into Mesh::local
  int direction;
  IndexBox faces;
  float factor;
  int direction_beyond; ///< that of the cells beyond
};

/// Cells of all blocks.
long cells_of_all_ranks(const Mesh& mesh);

struct Level {
  Level(const Mesh& finest, const Smoothing& how);
  Level(const Mesh& m, const Level& finer);
  /// What stands in for a coarser level where residual and correction are wanted cell by cell.
  static Level cell_by_cell(const Level& level);

  const Mesh& mesh;
  bool linked; ///< whether cells of any rank have neighbours in other blocks, or across a period
  Halo halo;
  std::vector<LevelBlock> blocks; ///< as Mesh::local
  const Smoothing& smoothing;

  // From the next finer level.
  Pairings pairings; ///< of all its blocks
  std::vector<LinkFactor> link_factors;
  int visits = 1; ///< cycles of this level in one of that

  /// Fills the ghosts of a field behind links; nothing to do where nothing is linked.
  void exchange(FloatField LevelBlock::*field);

private:
  Level(const Mesh& m, std::vector<LevelBlock> b, const Smoothing& how);

  std::vector<float*> exchanged_; ///< kept, so that nothing is allocated in a loop
};

/// Share of the coefficient that is left when the distance between cells that were one apart has
/// grown to the mean of the coarse cells' widths.
constexpr double over_distance(int width_below, int width_above) {
  return 2.0 / (width_below + width_above);
}

/// Factors for the faces of the links of `coarse`.
std::vector<LinkFactor> link_factors(const Mesh& fine, const Mesh& coarse,
                                     const Pairings& pairings);

/// Coefficients and inverse diagonal of `coarse` from those of `fine`: sums over the faces that
/// join, over the distance that has grown.
void join_level(const Level& fine, Level& coarse);

/// What smoothing starts from.
enum class Start {
  zero,
  iterate,  ///< x
  corrected ///< x and what the coarse level adds
};

/// Chebyshev smoothing of A x = rhs from zero on all blocks of a level. Collective.
void smooth(Level& level);

/// Chebyshev smoothing of A x = rhs on all blocks of a level, then the residual summed over the
/// cells that join into the right-hand side of `coarse`. Collective.
void smooth_and_restrict(Level& level, Level& coarse, Start start);

/// The correction from `coarse` added to x, then Chebyshev smoothing. Collective.
void correct_and_smooth(const Level& coarse, Level& level);

} // namespace granflux::cfd
