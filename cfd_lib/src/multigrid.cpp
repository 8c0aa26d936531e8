// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/multigrid.hpp>

#include <granflux/cfd/coarsening.hpp>
#include <granflux/cfd/coarsest_solver.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/halo.hpp>
#include <granflux/cfd/row_sweep.hpp>

namespace granflux::cfd {

namespace {

constexpr long largest_coarsest = 300; ///< cells; beyond, a factorisation costs more than a level
constexpr int halo_layers = 1;         ///< a face couples nearest neighbours only

/// Chebyshev smoothing damps the part of the spectrum of A over its diagonal above a quarter of
/// its upper bound, which is 2 for any matrix of this kind (Gershgorin); what lies below is for
/// the coarse levels. Three steps leave 1/13 of it. Saad, Iterative Methods for Sparse Linear
/// Systems, 2nd ed., algorithm 12.1.
constexpr int smoothing_steps = 3;
constexpr double spectrum_high = 2, spectrum_low = spectrum_high / 4;
constexpr double spectrum_centre = (spectrum_high + spectrum_low) / 2;
constexpr double spectrum_half_width = (spectrum_high - spectrum_low) / 2;

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// Coefficients of one block's low faces along i, j, k and the strides of its layout.
struct Stencil {
  const double *ci, *cj, *ck;
  std::ptrdiff_t sj, sk;

  /// (A x) of cell c. Differences, not a diagonal: exact for constants whatever the coefficients.
  [[nodiscard]] double operator()(const double* x, std::ptrdiff_t c) const {
    const double here = x[c];
    return ci[c] * (here - x[c - 1]) + ci[c + 1] * (here - x[c + 1]) + cj[c] * (here - x[c - sj]) +
           cj[c + sj] * (here - x[c + sj]) + ck[c] * (here - x[c - sk]) +
           ck[c + sk] * (here - x[c + sk]);
  }
};

/// What a face loses where coarse cells reach across a link: the factor of its coefficient is
/// that for a boundary times this.
struct LinkFactor {
  std::size_t block; ///< index into Mesh::local
  int direction;
  IndexBox faces;
  double factor;
};

/// Share of the coefficient that is left when the distance between cells that were one apart has
/// grown to the mean of the coarse cells' widths.
double over_distance(int width_below, int width_above) {
  return 2.0 / (width_below + width_above);
}

/// A direction of one cell that is its own neighbour: its faces couple nothing.
bool closed_on_itself(const Mesh& mesh, int id, int d) {
  const BlockInfo& info = mesh.blocks[u(id)];
  if (info.cells[u(d)] > 1)
    return false;
  return std::any_of(info.patches.begin(), info.patches.end(), [&](const Patch& patch) {
    return patch.side.direction == d && patch.link && patch.link->block == id;
  });
}

struct Level {
  explicit Level(const Mesh& m)
      : mesh(m), halo(m, halo_layers), x(make_fields(m)), other(make_fields(m)),
        inverse_diagonal(make_fields(m)), used(m.local.size()) {}

  [[nodiscard]] Stencil stencil(std::size_t b) const {
    const Layout& layout = mesh.local[b].layout;
    return {used[b][0]->data(), used[b][1]->data(), used[b][2]->data(), layout.stride[1],
            layout.stride[2]};
  }

  const Mesh& mesh;
  Halo halo;
  BlockFields x, other; ///< the iterate and the one before it; ghosts at boundaries stay 0
  BlockFields inverse_diagonal;
  std::vector<std::array<const Field*, 3>> used; ///< coefficients, or zeros where none couples

  // Of coarse levels only.
  std::vector<std::array<Field, 3>> coefficient;
  BlockFields rhs;

  // Towards the next coarser level.
  Pairings pairings; ///< of all blocks
  std::vector<LinkFactor> link_factors;
  int visits = 1; ///< cycles of the next level in one of this
};

/// Coarse face coefficients from fine ones.
void join_faces(const Level& fine, Level& coarse) {
  for (std::size_t b = 0; b < fine.mesh.local.size(); ++b) {
    const Layout &from = fine.mesh.local[b].layout, &to = coarse.mesh.local[b].layout;
    const auto& pairing = fine.pairings[u(fine.mesh.local[b].id)];
    for (int d = 0; d < 3; ++d) {
      const Field& c = *fine.used[b][u(d)];
      Field& joined = coarse.coefficient[b][u(d)];
      Index3 faces = to.cells;
      ++faces[u(d)];
      // Fine cells that make a coarse one; along d the one face between coarse cells.
      const auto range = [&](int e, int I) {
        const int n = from.cells[u(e)], first = pairing[u(e)].first(I, n);
        return std::array<int, 2>{first, e == d ? first + 1 : pairing[u(e)].first(I + 1, n)};
      };
      const auto factor = [&](int I) {
        const int n = from.cells[u(d)];
        const int below = I > 0 ? pairing[u(d)].width(I - 1, n) : 0;
        const int above = I < to.cells[u(d)] ? pairing[u(d)].width(I, n) : 0;
        return below == 0 ? 1.0 / above : above == 0 ? 1.0 / below : over_distance(below, above);
      };
#pragma omp parallel for collapse(2)                                                               \
    schedule(static) if (from.interior() >= smallest_parallel_sweep)
      for (int K = 0; K < faces[2]; ++K)
        for (int J = 0; J < faces[1]; ++J) {
          const auto [k_first, k_end] = range(2, K);
          const auto [j_first, j_end] = range(1, J);
          for (int I = 0; I < faces[0]; ++I) {
            const auto [i_first, i_end] = range(0, I);
            double sum = 0;
            for (int k = k_first; k < k_end; ++k)
              for (int j = j_first; j < j_end; ++j)
                for (int i = i_first; i < i_end; ++i)
                  sum += c[from.at(i, j, k)];
            joined[to.at(I, J, K)] = sum * factor(d == 0 ? I : d == 1 ? J : K);
          }
        }
    }
  }
  for (const LinkFactor& link : fine.link_factors) {
    const Layout& layout = coarse.mesh.local[link.block].layout;
    Field& joined = coarse.coefficient[link.block][u(link.direction)];
    for (int k = link.faces.lo[2]; k < link.faces.hi[2]; ++k)
      for (int j = link.faces.lo[1]; j < link.faces.hi[1]; ++j)
        for (int i = link.faces.lo[0]; i < link.faces.hi[0]; ++i)
          joined[layout.at(i, j, k)] *= link.factor;
  }
}

/// Faces of coarse link patches, with the widths of the cells on both sides.
std::vector<LinkFactor> link_factors(const Mesh& fine, const Mesh& coarse,
                                     const Pairings& pairings) {
  std::vector<LinkFactor> factors;
  for (std::size_t b = 0; b < coarse.local.size(); ++b) {
    const int id = coarse.local[b].id;
    const auto width = [&](int block, int d, bool high) {
      const int n = fine.blocks[u(block)].cells[u(d)], N = coarse.blocks[u(block)].cells[u(d)];
      return pairings[u(block)][u(d)].width(high ? N - 1 : 0, n);
    };
    for (const Patch& patch : coarse.blocks[u(id)].patches) {
      const int d = patch.side.direction;
      // The donor's axis that runs on across the side, and the side it is met on.
      const Link& link = *patch.link;
      int across = 0;
      while (link.axis[u(across)] != d)
        ++across;
      const bool donor_high = (link.sign[u(across)] > 0) != patch.side.high;
      const int own = width(id, d, patch.side.high), beyond = width(link.block, across, donor_high);
      IndexBox faces = patch.cells;
      if (patch.side.high)
        ++faces.lo[u(d)], ++faces.hi[u(d)];
      factors.push_back({b, d, faces, own * over_distance(own, beyond)});
    }
  }
  return factors;
}

/// Sums in i of a fine row, added to the coarse row.
void add_joined(const double* fine, int n, const Pairing& pairing, double* coarse, int N) {
  if (!pairing.pairs) {
    for (int I = 0; I < N; ++I)
      coarse[I] += fine[I];
    return;
  }
  const int first_whole = pairing.shift, end_whole = (n + pairing.shift) / 2;
  const double* pair = fine - pairing.shift;
  for (int I = first_whole; I < end_whole; ++I)
    coarse[I] += pair[2 * I] + pair[2 * I + 1];
  if (first_whole == 1)
    coarse[0] += fine[0];
  if (end_whole < N)
    coarse[N - 1] += fine[n - 1];
}

/// The coarse row spread to the cells of a fine row, added.
void add_spread(const double* coarse, int N, const Pairing& pairing, double* fine, int n) {
  if (!pairing.pairs) {
    for (int i = 0; i < n; ++i)
      fine[i] += coarse[i];
    return;
  }
  const int first_whole = pairing.shift, end_whole = (n + pairing.shift) / 2;
  double* pair = fine - pairing.shift;
  for (int I = first_whole; I < end_whole; ++I) {
    pair[2 * I] += coarse[I];
    pair[2 * I + 1] += coarse[I];
  }
  if (first_whole == 1)
    fine[0] += coarse[0];
  if (end_whole < N)
    fine[n - 1] += coarse[N - 1];
}

/// The first smoothing step for a zero guess: one pass without neighbours.
void first_step(Level& level, const BlockFields& rhs) {
  for (std::size_t b = 0; b < level.mesh.local.size(); ++b) {
    const Layout& layout = level.mesh.local[b].layout;
    const double *r = rhs[b].data(), *inverse = level.inverse_diagonal[b].data();
    double* x = level.x[b].data();
    for_rows(layout, [=, n = layout.cells[0]](std::ptrdiff_t row, int, int) {
#pragma omp simd
      for (std::ptrdiff_t c = row; c < row + n; ++c)
        x[c] = inverse[c] * r[c] / spectrum_centre;
    });
  }
}

/// x + keep (x - x_before) + gain (rhs - A x) / diagonal, which becomes x. Where there is no x
/// before (keep 0, or it was zero) its memory is only written.
template <bool has_before>
void step(Level& level, const BlockFields& rhs, double keep, double gain) {
  level.halo.exchange({&level.x});
  for (std::size_t b = 0; b < level.mesh.local.size(); ++b) {
    const Layout& layout = level.mesh.local[b].layout;
    const Stencil a = level.stencil(b);
    const double *r = rhs[b].data(), *inverse = level.inverse_diagonal[b].data(),
                 *x = level.x[b].data();
    double* next = level.other[b].data();
    for_rows(layout, [=, n = layout.cells[0]](std::ptrdiff_t row, int, int) {
#pragma omp simd
      for (std::ptrdiff_t c = row; c < row + n; ++c) {
        const double change = gain * inverse[c] * (r[c] - a(x, c));
        if constexpr (has_before)
          next[c] = x[c] + keep * (x[c] - next[c]) + change;
        else
          next[c] = (1 + keep) * x[c] + change;
      }
    });
  }
  std::swap(level.x, level.other);
}

/// Chebyshev iteration for A x = rhs from x, or from zero.
void smooth(Level& level, const BlockFields& rhs, bool from_zero) {
  constexpr double sigma = spectrum_centre / spectrum_half_width;
  double rho = 1 / sigma;
  if (from_zero)
    first_step(level, rhs);
  else
    step<false>(level, rhs, 0, 1 / spectrum_centre);
  for (int k = 1; k < smoothing_steps; ++k) {
    const double rho_new = 1 / (2 * sigma - rho);
    const double keep = rho_new * rho, gain = 2 * rho_new / spectrum_half_width;
    if (k == 1 && from_zero)
      step<false>(level, rhs, keep, gain);
    else
      step<true>(level, rhs, keep, gain);
    rho = rho_new;
  }
}

/// Sums the residual over the cells that join; uses the memory of the iterate before.
void restrict_residual(Level& fine, const BlockFields& rhs, Level& coarse) {
  fine.halo.exchange({&fine.x});
  for (std::size_t b = 0; b < fine.mesh.local.size(); ++b) {
    const Layout &from = fine.mesh.local[b].layout, &to = coarse.mesh.local[b].layout;
    const auto& pairing = fine.pairings[u(fine.mesh.local[b].id)];
    const Stencil a = fine.stencil(b);
    const double *r = rhs[b].data(), *x = fine.x[b].data();
    double *residual = fine.other[b].data(), *sum = coarse.rhs[b].data();
    const auto [ni, nj, nk] = from.cells;
    const int NI = to.cells[0], NJ = to.cells[1], NK = to.cells[2];
#pragma omp parallel for collapse(2)                                                               \
    schedule(static) if (from.interior() >= smallest_parallel_sweep)
    for (int K = 0; K < NK; ++K)
      for (int J = 0; J < NJ; ++J) {
        double* coarse_row = sum + to.at(0, J, K);
        std::fill(coarse_row, coarse_row + NI, 0.0);
        for (int k = pairing[2].first(K, nk); k < pairing[2].first(K + 1, nk); ++k)
          for (int j = pairing[1].first(J, nj); j < pairing[1].first(J + 1, nj); ++j) {
            const std::ptrdiff_t row = from.at(0, j, k);
#pragma omp simd
            for (std::ptrdiff_t c = row; c < row + ni; ++c)
              residual[c] = r[c] - a(x, c);
            add_joined(residual + row, ni, pairing[0], coarse_row, NI);
          }
      }
  }
}

void add_correction(const Level& coarse, Level& fine) {
  for (std::size_t b = 0; b < fine.mesh.local.size(); ++b) {
    const Layout &to = fine.mesh.local[b].layout, &from = coarse.mesh.local[b].layout;
    const auto& pairing = fine.pairings[u(fine.mesh.local[b].id)];
    const double* correction = coarse.x[b].data();
    double* x = fine.x[b].data();
    for_rows(to, [&, correction, x](std::ptrdiff_t row, int j, int k) {
      add_spread(correction + from.at(0, pairing[1].coarse(j), pairing[2].coarse(k)), from.cells[0],
                 pairing[0], x + row, to.cells[0]);
    });
  }
}

/// False where a cell's coefficients do not sum to a positive number. On coarse levels a whole
/// closed region may have become one cell: nothing couples to it and its correction is 0.
bool invert_diagonal(Level& level) {
  bool good = true;
  for (std::size_t b = 0; b < level.mesh.local.size(); ++b) {
    const Layout& layout = level.mesh.local[b].layout;
    const Stencil a = level.stencil(b);
    double* inverse = level.inverse_diagonal[b].data();
    int bad = 0;
#pragma omp parallel for collapse(2) schedule(static) reduction(+ : bad) if (                      \
        layout.interior() >= smallest_parallel_sweep)
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j) {
        const std::ptrdiff_t row = layout.at(0, j, k);
#pragma omp simd reduction(+ : bad)
        for (std::ptrdiff_t c = row; c < row + layout.cells[0]; ++c) {
          const double diagonal =
              a.ci[c] + a.ci[c + 1] + a.cj[c] + a.cj[c + a.sj] + a.ck[c] + a.ck[c + a.sk];
          const bool positive = diagonal > 0 && diagonal < std::numeric_limits<double>::infinity();
          inverse[c] = positive ? 1 / diagonal : 0;
          bad += positive ? 0 : 1;
        }
      }
    good = good && bad == 0;
  }
  return good;
}

long cells_of(const Mesh& mesh) {
  long cells = 0;
  for (const BlockInfo& info : mesh.blocks)
    cells += long(info.cells[0]) * info.cells[1] * info.cells[2];
  return cells;
}

} // namespace

struct Multigrid::Impl {
  Impl(const Mesh& mesh, bool singular) {
    levels.push_back(std::make_unique<Level>(mesh));
    Coarsening coarsening(mesh);
    for (;;) {
      Level& fine = *levels.back();
      const long cells = cells_of(fine.mesh);
      if (cells <= largest_coarsest)
        break;
      Pairings pairings = coarsening.next(fine.mesh);
      Mesh joined = join_cells(fine.mesh, pairings);
      const long joined_cells = cells_of(joined);
      if (joined_cells == cells)
        break;
      meshes.push_back(std::make_unique<Mesh>(std::move(joined)));
      levels.push_back(std::make_unique<Level>(*meshes.back()));
      Level& coarse = *levels.back();
      coarse.rhs = make_fields(coarse.mesh);
      for (const Block& block : coarse.mesh.local)
        coarse.coefficient.push_back(
            {Field(block.layout), Field(block.layout), Field(block.layout)});
      fine.link_factors = link_factors(fine.mesh, coarse.mesh, pairings);
      fine.pairings = std::move(pairings);
      // Two visits make up for what the simple transfer lacks, where they are cheap.
      fine.visits = 4 * joined_cells <= cells ? 2 : 1;
    }
    zeros.resize(mesh.local.size());
    for (std::size_t b = 0; b < mesh.local.size(); ++b)
      for (const auto& level : levels)
        for (int d = 0; d < 3; ++d)
          if (closed_on_itself(level->mesh, mesh.local[b].id, d))
            zeros[b] = Field(mesh.local[b].layout);
    for (std::size_t l = 1; l < levels.size(); ++l)
      couple(*levels[l], levels[l]->coefficient);
    coarsest = std::make_unique<CoarsestSolver>(levels.back()->mesh, singular);
  }

  /// Where a direction is one cell that is its own neighbour, zeros stand for its coefficients.
  void couple(Level& level, const std::vector<std::array<Field, 3>>& coefficient) const {
    for (std::size_t b = 0; b < level.mesh.local.size(); ++b)
      for (int d = 0; d < 3; ++d)
        level.used[b][u(d)] = closed_on_itself(level.mesh, level.mesh.local[b].id, d)
                                  ? &zeros[b]
                                  : &coefficient[b][u(d)];
  }

  /// One cycle for the level's x.
  void cycle(std::size_t l, const BlockFields& rhs, bool from_zero) {
    Level& fine = *levels[l];
    if (l + 1 == levels.size()) {
      coarsest->solve(rhs, fine.x);
      return;
    }
    Level& coarse = *levels[l + 1];
    smooth(fine, rhs, from_zero);
    restrict_residual(fine, rhs, coarse);
    // The coarsest level is solved exactly: once is enough.
    const int visits = l + 2 == levels.size() ? 1 : fine.visits;
    for (int visit = 0; visit < visits; ++visit)
      cycle(l + 1, coarse.rhs, visit == 0);
    add_correction(coarse, fine);
    smooth(fine, rhs, false);
  }

  std::vector<std::unique_ptr<Mesh>> meshes; ///< of the coarse levels
  std::vector<std::unique_ptr<Level>> levels;
  BlockFields zeros; ///< where needed; of the finest layouts, so large enough for all levels
  std::unique_ptr<CoarsestSolver> coarsest;
  std::vector<double> row_sums;
};

Multigrid::Multigrid(const Mesh& mesh, bool singular)
    : impl_(std::make_unique<Impl>(mesh, singular)) {}

Multigrid::~Multigrid() = default;

void Multigrid::setup(const PressureSystem& system) {
  Impl& s = *impl_;
  Level& finest = *s.levels.front();
  s.couple(finest, system.coefficient);
  int good = invert_diagonal(finest);
  MPI_Allreduce(MPI_IN_PLACE, &good, 1, MPI_INT, MPI_MIN, finest.mesh.comm);
  if (!good)
    throw NumericalError("pressure equation: the coefficients of a cell are all zero, or not "
                         "numbers");
  for (std::size_t l = 1; l < s.levels.size(); ++l) {
    join_faces(*s.levels[l - 1], *s.levels[l]);
    invert_diagonal(*s.levels[l]);
  }
  s.coarsest->factorise(s.levels.size() == 1 ? system.coefficient : s.levels.back()->coefficient);
}

const BlockFields& Multigrid::apply(const BlockFields& residual) {
  impl_->cycle(0, residual, true);
  return impl_->levels.front()->x;
}

double Multigrid::multiply(BlockFields& q, BlockFields& image) {
  Impl& s = *impl_;
  Level& finest = *s.levels.front();
  finest.halo.exchange({&q});
  double total = 0;
  for (std::size_t b = 0; b < finest.mesh.local.size(); ++b) {
    const Layout& layout = finest.mesh.local[b].layout;
    const Stencil a = finest.stencil(b);
    const double* from = q[b].data();
    double* to = image[b].data();
    total += sum_rows(layout, s.row_sums, [=, n = layout.cells[0]](std::ptrdiff_t row) {
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (std::ptrdiff_t c = row; c < row + n; ++c) {
        to[c] = a(from, c);
        sum += from[c] * to[c];
      }
      return sum;
    });
  }
  MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_DOUBLE, MPI_SUM, finest.mesh.comm);
  return total;
}

std::vector<long> Multigrid::level_sizes() const {
  std::vector<long> sizes;
  for (const auto& level : impl_->levels)
    sizes.push_back(cells_of(level->mesh));
  return sizes;
}

} // namespace granflux::cfd
