// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/multigrid.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include <granflux/cfd/error.hpp>

#include "coarsest_solver.hpp"
#include "graph_level.hpp"
#include "split_levels.hpp"

namespace granflux::cfd {

namespace {

/// Of CellGroups: coarse cells whose cells are coupled worse than this are split. Error of that
/// shape shrinks by a factor like this, which conjugate gradients notice as a mode of its own.
constexpr double badly_coupled = 0.003;
/// Where more than this share of the coarse cells are split, cells are coupled badly everywhere,
/// and the smoother reaches further down.
constexpr double often = 0.01;

constexpr long largest_coarsest = 300; ///< cells; beyond, a factorisation costs more than a level

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// Smallest and largest diagonal of A over all ranks.
struct DiagonalRange {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  bool good = true; ///< all are positive numbers
};

/// A power of 2 that brings both ends of the range equally far from 1.
double centring_scale(const DiagonalRange& range) {
  return std::ldexp(1, -(std::ilogb(range.least) + std::ilogb(range.most)) / 2);
}

/// Whether single precision takes the range and quotients of numbers in it.
bool is_centred(const DiagonalRange& range, double scale) {
  constexpr double far = 0x1p40;
  return range.least * scale > 1 / far && range.most * scale < far;
}

/// How cells join into the next level; nothing where none do.
std::optional<Pairings> joining(Coarsening& coarsening, const Mesh& mesh) {
  Pairings pairings = coarsening.next(mesh);
  for (const auto& of_block : pairings)
    for (const Pairing& pairing : of_block)
      if (pairing.pairs)
        return pairings;
  return std::nullopt;
}

} // namespace

struct Multigrid::Impl {
  Impl(const Mesh& mesh, bool is_singular)
      : singular(is_singular), by_mesh(smoothing_for(mesh)), smoothing(by_mesh) {
    levels.push_back(std::make_unique<Level>(mesh, smoothing));
    Coarsening coarsening(mesh);
    while (const auto pairings = joining(coarsening, levels.back()->mesh)) {
      const Level& fine = *levels.back();
      if (structured == 0 && cells_of_all_ranks(fine.mesh) <= largest_coarsest)
        structured = levels.size();
      meshes.push_back(std::make_unique<Mesh>(join_cells(fine.mesh, *pairings)));
      auto coarse = std::make_unique<Level>(*meshes.back(), fine);
      coarse->link_factors = link_factors(fine.mesh, *meshes.back(), *pairings);
      coarse->pairings = *pairings;
      // Two visits make up for what the simple transfer lacks, where they are cheap.
      coarse->visits =
          4 * cells_of_all_ranks(coarse->mesh) <= cells_of_all_ranks(fine.mesh) ? 2 : 1;
      levels.push_back(std::move(coarse));
    }
    if (structured == 0)
      structured = levels.size();
    // The coarsest level is solved exactly: once is enough.
    Level& last = *levels[structured - 1];
    last.visits = 1;
    coarsest = std::make_unique<CoarsestSolver>(last.mesh, singular);
    for (LevelBlock& block : levels.front()->blocks)
      block.products.resize(std::size_t(block.layout.cells[1]) *
                            std::size_t(block.layout.cells[2]));
  }

  /// One cycle for the level's x.
  void cycle(std::size_t l, Start start) {
    Level& fine = *levels[l];
    if (l + 1 == structured) {
      coarsest->solve(fine);
      return;
    }
    if (split && l == split_from) {
      smooth_and_restrict(fine, split->cells(), start);
      split->correct();
      correct_and_smooth(split->cells(), fine);
      return;
    }
    Level& coarse = *levels[l + 1];
    smooth_and_restrict(fine, coarse, start);
    for (int visit = 0; visit < coarse.visits; ++visit)
      cycle(l + 1, visit == 0 ? Start::zero : Start::iterate);
    correct_and_smooth(coarse, fine);
  }

  /// Whether the finest coefficients are those of the system, in single precision.
  [[nodiscard]] bool has(const PressureSystem& system) const;
  /// Takes them from the system, times scale; throws where a diagonal is not a positive number.
  DiagonalRange take(const PressureSystem& system);
  /// Coefficients of the coarse levels from those of the finest.
  void join();

  bool singular;
  Smoothing by_mesh;                         ///< what the mesh asks for
  Smoothing smoothing;                       ///< what the levels use
  std::vector<std::unique_ptr<Mesh>> meshes; ///< of the coarse levels
  std::vector<std::unique_ptr<Level>> levels;
  std::size_t structured = 0; ///< levels of the cycle; those beyond serve where cells are split
  std::unique_ptr<CoarsestSolver> coarsest;
  std::unique_ptr<SplitLevels> split; ///< where cells are joined badly: all below `split_from`
  std::size_t split_from = 0;
  bool ready = false;
  double scale = 1; ///< a power of 2 that brings the coefficients near 1
};

bool Multigrid::Impl::has(const PressureSystem& system) const {
  const Level& finest = *levels.front();
  std::atomic<bool> same = ready;
  for (std::size_t b = 0; b < finest.blocks.size(); ++b) {
    const LevelLayout& layout = finest.blocks[b].layout;
    const Layout& from = finest.mesh.local[b].layout;
    for (int d = 0; d < 3; ++d) {
      if (closed_on_itself(finest.mesh, finest.mesh.local[b].id, d))
        continue;
      const double* c = system.coefficient[b][u(d)].data();
      const float* taken = finest.blocks[b].coefficient[u(d)].data();
      Index3 n = layout.cells;
      ++n[u(d)];
      // Ends at the first row that differs: a system that has changed costs next to nothing.
      deal(worth_a_team(layout), n[2], [&](std::ptrdiff_t k) {
        for (int j = 0; same && j < n[1]; ++j) {
          const double* row = c + from.at(0, j, int(k));
          const float* taken_row = taken + layout.at(0, j, int(k));
          int differ = 0;
#pragma omp simd reduction(+ : differ)
          for (int i = 0; i < n[0]; ++i)
            differ += float(row[i] * scale) == taken_row[i] ? 0 : 1;
          if (differ > 0)
            same = false;
        }
      });
    }
  }
  return same;
}

DiagonalRange Multigrid::Impl::take(const PressureSystem& system) {
  Level& finest = *levels.front();
  DiagonalRange range;
  for (std::size_t b = 0; b < finest.blocks.size(); ++b) {
    LevelBlock& block = finest.blocks[b];
    const LevelLayout& to = block.layout;
    const Layout& from = finest.mesh.local[b].layout;
    std::array<double, 3> couples{}; // 1, or 0 where a direction is its own neighbour
    for (int d = 0; d < 3; ++d)
      couples[u(d)] = closed_on_itself(finest.mesh, finest.mesh.local[b].id, d) ? 0 : 1;
    in_team(worth_a_team(to), [&] {
      const DiagonalRange none;
      double least = none.least, most = none.most;
      int bad = 0;
#pragma omp for collapse(2) schedule(static) nowait
      for (int k = 0; k <= to.cells[2]; ++k)
        for (int j = 0; j <= to.cells[1]; ++j) {
          std::array<const double*, 3> c{};
          for (int d = 0; d < 3; ++d) {
            c[u(d)] = system.coefficient[b][u(d)].data() + from.at(0, j, k);
            if ((j == to.cells[1] && d != 1) || (k == to.cells[2] && d != 2))
              continue; // no such faces
            const double factor = couples[u(d)] * scale;
            float* taken = block.coefficient[u(d)].data() + to.at(0, j, k);
#pragma omp simd
            for (int i = 0; i < to.cells[0] + (d == 0); ++i)
              taken[i] = float(c[u(d)][i] * factor);
          }
          if (j == to.cells[1] || k == to.cells[2])
            continue;
          float* inverse = block.inverse_diagonal.data() + to.at(0, j, k);
          const auto [ci, cj, ck] = c;
          const std::ptrdiff_t sj = from.stride[1], sk = from.stride[2];
#pragma omp simd reduction(min : least) reduction(max : most) reduction(+ : bad)
          for (std::ptrdiff_t i = 0; i < to.cells[0]; ++i) {
            const double diagonal = couples[0] * (ci[i] + ci[i + 1]) +
                                    couples[1] * (cj[i] + cj[i + sj]) +
                                    couples[2] * (ck[i] + ck[i + sk]);
            inverse[i] = float(1 / (diagonal * scale));
            least = diagonal < least ? diagonal : least;
            most = diagonal > most ? diagonal : most;
            bad += diagonal > 0 && diagonal < std::numeric_limits<double>::infinity() ? 0 : 1;
          }
        }
#pragma omp critical(diagonal_range)
      {
        range.least = std::min(range.least, least);
        range.most = std::max(range.most, most);
        range.good = range.good && bad == 0;
      }
    });
  }
  double ends[3] = {range.least, -range.most, range.good ? 1.0 : 0.0};
  MPI_Allreduce(MPI_IN_PLACE, ends, 3, MPI_DOUBLE, MPI_MIN, finest.mesh.comm);
  return {ends[0], -ends[1], ends[2] > 0};
}

void Multigrid::Impl::join() {
  std::vector<long> bad;
  for (std::size_t l = 1; l < structured; ++l) {
    join_level(*levels[l - 1], *levels[l]);
    bad.push_back(badly_joined(*levels[l - 1], *levels[l], badly_coupled));
  }
  MPI_Allreduce(MPI_IN_PLACE, bad.data(), int(bad.size()), MPI_LONG, MPI_SUM,
                levels.front()->mesh.comm);
  const auto worst = std::find_if(bad.begin(), bad.end(), [](long cells) { return cells > 0; });
  split.reset();
  smoothing = by_mesh;
  if (worst == bad.end()) {
    coarsest->factorise(*levels[structured - 1]);
    return;
  }
  split_from = std::size_t(worst - bad.begin());
  if (double(*worst) > often * double(cells_of_all_ranks(levels[split_from + 1]->mesh)) &&
      by_mesh.count() < far_reaching_smoothing().count())
    smoothing = far_reaching_smoothing();
  split = std::make_unique<SplitLevels>(levels, split_from, largest_coarsest, singular);
}

Multigrid::Multigrid(const Mesh& mesh, bool singular)
    : impl_(std::make_unique<Impl>(mesh, singular)) {}

Multigrid::~Multigrid() = default;

void Multigrid::setup(const PressureSystem& system) {
  Impl& s = *impl_;
  int same = s.has(system) ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, s.levels.front()->mesh.comm);
  if (same)
    return;
  s.ready = false;
  DiagonalRange range = s.take(system);
  if (range.good && !is_centred(range, s.scale)) { // rounds nothing, so results do not depend on it
    s.scale = centring_scale(range);
    range = s.take(system);
  }
  if (!range.good)
    throw NumericalError("pressure equation: the coefficients of a cell are all zero, or not "
                         "numbers");
  s.join();
  s.ready = true;
}

double Multigrid::scale() const {
  return impl_->scale;
}

const LevelLayout& Multigrid::layout(std::size_t b) const {
  return impl_->levels.front()->blocks[b].layout;
}

float* Multigrid::residual(std::size_t b) {
  return impl_->levels.front()->blocks[b].rhs.data();
}

const float* Multigrid::correction(std::size_t b) const {
  return impl_->levels.front()->blocks[b].x.data();
}

double Multigrid::apply() {
  Level& finest = *impl_->levels.front();
  impl_->cycle(0, Start::zero);
  finest.exchange(&LevelBlock::x);
  double product = 0;
  for (const LevelBlock& block : finest.blocks)
    for (const double of_row : block.products)
      product += of_row;
  MPI_Allreduce(MPI_IN_PLACE, &product, 1, MPI_DOUBLE, MPI_SUM, finest.mesh.comm);
  return product;
}

std::vector<long> Multigrid::level_sizes() const {
  std::vector<long> sizes;
  for (std::size_t l = 0; l < impl_->structured; ++l) {
    sizes.push_back(cells_of_all_ranks(impl_->levels[l]->mesh));
    if (impl_->split && l == impl_->split_from) {
      const std::vector<long> nodes = impl_->split->sizes();
      sizes.insert(sizes.end(), nodes.begin(), nodes.end());
      break;
    }
  }
  return sizes;
}

} // namespace granflux::cfd
