// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// Chebyshev smoothing, with the transfers between levels in the same sweep. A block without links
// is swept once: planes of successive iterates follow each other through the block, close enough
// to stay in cache. Blocks with links need their neighbours' values after every step, and are
// swept step by step.

#include "multigrid_level.hpp"

#include <algorithm>
#include <omp.h>

namespace granflux::cfd {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// A x for the cells of one row.
struct RowOperator {
  const float *x, *inner_low, *inner_high, *outer_low, *outer_high; ///< the row and those around
  const float *ci, *c_inner, *c_inner_high, *c_outer, *c_outer_high;

  /// Differences, not a diagonal: exact for constants whatever the coefficients, and what single
  /// precision loses in the flux through a face one cell gets and the other gives.
  float operator()(std::ptrdiff_t i) const {
    const float here = x[i];
    return ci[i] * (here - x[i - 1]) + ci[i + 1] * (here - x[i + 1]) +
           c_inner[i] * (here - inner_low[i]) + c_inner_high[i] * (here - inner_high[i]) +
           c_outer[i] * (here - outer_low[i]) + c_outer_high[i] * (here - outer_high[i]);
  }
};

/// A plane of rows.
template <class Value> struct Plane {
  Value* first; ///< cell 0 of row 0
  std::ptrdiff_t stride;
  [[nodiscard]] Value* row(int j) const { return first + j * stride; }
};

/// A block as planes of rows, and how its cells join.
struct Sweep {
  Sweep(const Level& level, const LevelBlock& block, const std::array<Pairing, 3>* pairing)
      : b(block), steps(level.smoothing), n(block.layout.cells[0]),
        n_inner(block.layout.cells[u(block.inner)]), n_outer(block.layout.cells[u(block.outer)]) {
    if (pairing)
      along_row = (*pairing)[0], inner = (*pairing)[u(block.inner)],
      outer = (*pairing)[u(block.outer)];
  }
  template <class Value> [[nodiscard]] Plane<Value> plane(Value* field, int k) const {
    return plane_of(b, field, k);
  }
  /// Of a field of the block, or of the coarser block that this one joins into.
  template <class Value>
  [[nodiscard]] Plane<Value> plane_of(const LevelBlock& of, Value* field, int k) const {
    return {field + of.layout.origin + k * of.layout.stride[u(b.outer)],
            of.layout.stride[u(b.inner)]};
  }
  [[nodiscard]] RowOperator row_operator(const Plane<const float>& x, const Plane<const float>& low,
                                         const Plane<const float>& high, int j, int k) const {
    const std::ptrdiff_t row =
        b.layout.origin + j * b.layout.stride[u(b.inner)] + k * b.layout.stride[u(b.outer)];
    const float* c_inner = b.coefficient[u(b.inner)].data() + row;
    const float* c_outer = b.coefficient[u(b.outer)].data() + row;
    return {x.row(j),     x.row(j - 1),
            x.row(j + 1), low.row(j),
            high.row(j),  b.coefficient[0].data() + row,
            c_inner,      c_inner + b.layout.stride[u(b.inner)],
            c_outer,      c_outer + b.layout.stride[u(b.outer)]};
  }

  const LevelBlock& b;
  const Smoothing& steps;
  int n, n_inner, n_outer;
  Pairing along_row, inner, outer;
};

/// Sums of pairs of a fine row, added to the coarse row.
void add_joined(const float* fine, int n, const Pairing& pairing, float* coarse, int N) {
  if (!pairing.pairs) {
#pragma omp simd
    for (int I = 0; I < N; ++I)
      coarse[I] += fine[I];
    return;
  }
  const int first_whole = pairing.shift, end_whole = (n + pairing.shift) / 2;
  const float* pair = fine - pairing.shift;
#pragma omp simd
  for (int I = first_whole; I < end_whole; ++I)
    coarse[I] += pair[2 * I] + pair[2 * I + 1];
  if (first_whole == 1)
    coarse[0] += fine[0];
  if (end_whole < N)
    coarse[N - 1] += fine[n - 1];
}

/// corrected = x and the coarse row spread to its cells.
void spread(const float* coarse, int N, const Pairing& pairing, const float* x, float* corrected,
            int n) {
  if (!pairing.pairs) {
#pragma omp simd
    for (int i = 0; i < n; ++i)
      corrected[i] = x[i] + coarse[i];
    return;
  }
  const int first_whole = pairing.shift, end_whole = (n + pairing.shift) / 2;
  const float* from = x - pairing.shift;
  float* to = corrected - pairing.shift;
#pragma omp simd
  for (int I = first_whole; I < end_whole; ++I) {
    to[2 * I] = from[2 * I] + coarse[I];
    to[2 * I + 1] = from[2 * I + 1] + coarse[I];
  }
  if (first_whole == 1)
    corrected[0] = x[0] + coarse[0];
  if (end_whole < N)
    corrected[n - 1] = x[n - 1] + coarse[N - 1];
}

/// One row of a step; `before` and `mass` are not looked at where there are none. Returns the row's
/// part of rhs . next where that is asked for.
template <bool has_before, bool has_mass, bool has_product>
double step_row(const RowOperator& a, const float* rhs, const float* inverse, const float* before,
                const float* mass, float* next, int n, const Smoothing::Step& step) {
  const auto [keep, gain] = step;
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    float image = a(i);
    if constexpr (has_mass)
      image += mass[i] * a.x[i];
    const float change = gain * inverse[i] * (rhs[i] - image);
    float x = (1 + keep) * a.x[i] + change;
    if constexpr (has_before)
      x -= keep * before[i];
    next[i] = x;
  }
  double product = 0;
  if constexpr (has_product) {
#pragma omp simd reduction(+ : product)
    for (std::ptrdiff_t i = 0; i < n; ++i)
      product += double(rhs[i]) * double(next[i]);
  }
  return product;
}

/// The first step from zero: no neighbours.
void first_row(const float* rhs, const float* inverse, float* next, int n, float gain) {
#pragma omp simd
  for (std::ptrdiff_t i = 0; i < n; ++i)
    next[i] = gain * inverse[i] * rhs[i];
}

/// x of a plane and what the coarse plane adds.
void correct_plane(const Sweep& s, const LevelBlock& coarse, int k, const Plane<float>& to) {
  const auto x = s.plane(s.b.x.data(), k);
  const auto from = s.plane_of(coarse, coarse.x.data(), s.outer.coarse(k));
  for (int j = 0; j < s.n_inner; ++j)
    spread(from.row(s.inner.coarse(j)), coarse.layout.cells[0], s.along_row, x.row(j), to.row(j),
           s.n);
}

void first_plane(const Sweep& s, int k, const Plane<float>& to) {
  const auto rhs = s.plane(s.b.rhs.data(), k), inverse = s.plane(s.b.inverse_diagonal.data(), k);
  for (int j = 0; j < s.n_inner; ++j)
    first_row(rhs.row(j), inverse.row(j), to.row(j), s.n, s.steps.steps[1].gain);
}

/// Step n of a plane. `before` has no rows where it is zero, or not needed; `products`, for the
/// rows of the block, receives those of the right-hand side and the new iterate if it is given.
void step_plane(const Sweep& s, int n, int k, const Plane<const float>& x,
                const Plane<const float>& low, const Plane<const float>& high,
                const Plane<const float>& before, const Plane<float>& to, double* products) {
  const auto rhs = s.plane(s.b.rhs.data(), k), inverse = s.plane(s.b.inverse_diagonal.data(), k);
  const float* mass = s.b.mass.data();
  const Plane<const float> masses = mass ? s.plane(mass, k) : Plane<const float>{nullptr, 0};
  const auto step_of = products ? step_row<true, false, true>
                       : before.first
                           ? (mass ? step_row<true, true, false> : step_row<true, false, false>)
                           : (mass ? step_row<false, true, false> : step_row<false, false, false>);
  for (int j = 0; j < s.n_inner; ++j) {
    const double product =
        step_of(s.row_operator(x, low, high, j, k), rhs.row(j), inverse.row(j), before.row(j),
                masses.row(j), to.row(j), s.n, s.steps.steps[u(n)]);
    if (products)
      products[k * s.n_inner + j] = product;
  }
}

/// The residual of a plane, summed into the plane of the coarse right-hand side that it joins.
/// `row` is room for one row.
void restrict_plane(const Sweep& s, LevelBlock& coarse, int k, const Plane<const float>& x,
                    const Plane<const float>& low, const Plane<const float>& high, float* row) {
  const auto rhs = s.plane(s.b.rhs.data(), k);
  const int K = s.outer.coarse(k), N = coarse.layout.cells[0];
  const auto sum = s.plane_of(coarse, coarse.rhs.data(), K);
  for (int j = 0; j < s.n_inner; ++j) {
    const int J = s.inner.coarse(j);
    float* coarse_row = sum.row(J);
    if (k == s.outer.first(K, s.n_outer) && j == s.inner.first(J, s.n_inner))
      std::fill(coarse_row, coarse_row + N, 0.0F);
    const RowOperator a = s.row_operator(x, low, high, j, k);
    const float* r = rhs.row(j);
#pragma omp simd
    for (std::ptrdiff_t i = 0; i < s.n; ++i)
      row[i] = r[i] - a(i);
    add_joined(row, s.n, s.along_row, coarse_row, N);
  }
}

/// Work space of one thread: of every iterate the three planes that others still need, a plane of
/// zeros for what lies outside the block, and a row.
class Window {
public:
  static constexpr int depth = 3;
  static std::size_t size(const LevelBlock& b, const Smoothing& steps) {
    return std::size_t(depth * (steps.count() + 1) + 1) * plane_size(b) + std::size_t(row_size(b));
  }
  Window(const LevelBlock& b, const Smoothing& steps, float* memory)
      : row_(row_size(b)), plane_(std::ptrdiff_t(plane_size(b))), zeros_(memory),
        planes_(memory + plane_), scratch_(memory + plane_ * (depth * (steps.count() + 1) + 1)),
        n_outer_(b.layout.cells[u(b.outer)]) {}

  /// Plane k of iterate n; zeros outside the block.
  [[nodiscard]] Plane<float> at(int n, int k) const {
    const bool inside = k >= 0 && k < n_outer_;
    float* plane = inside ? planes_ + plane_ * (depth * n + k % depth) : zeros_;
    return {plane + LevelLayout::line + row_, row_};
  }
  [[nodiscard]] float* row() const { return scratch_; }

private:
  static std::ptrdiff_t row_size(const LevelBlock& b) { return b.layout.stride[1]; }
  static std::size_t plane_size(const LevelBlock& b) {
    return std::size_t(row_size(b) * (b.layout.cells[u(b.inner)] + 2) + 2 * LevelLayout::line);
  }
  std::ptrdiff_t row_, plane_;
  float *zeros_, *planes_, *scratch_;
  int n_outer_;
};

template <class Value> Plane<const Value> as_const(const Plane<Value>& p) {
  return {p.first, p.stride};
}

/// Where they are wanted.
double* products_of(LevelBlock& b) {
  return b.products.empty() ? nullptr : b.products.data();
}

/// All steps for the planes [begin, end) of a block without links, the last iterate into `spare`,
/// its residual summed into `coarse` if it is given. What neighbouring slabs compute of the
/// iterates between is computed here once more, so that slabs do not wait for each other.
void sweep_slab(const Sweep& s, Start start, const LevelBlock* correction, LevelBlock* coarse,
                LevelBlock& out, const Window& window, int begin, int end) {
  const int last = s.steps.count(), first = start == Start::zero ? 1 : 0;
  const int behind = coarse ? 1 : 0; // planes of the last iterate needed beyond the slab's
  const auto at = [&](int n, int k) {
    return n == 0 && start == Start::iterate ? s.plane(s.b.x.data(), k) : as_const(window.at(n, k));
  };
  const auto from = [&](int n) { return std::max(begin - (last - n) - behind, 0); };
  const auto to = [&](int n) { return std::min(end + (last - n) + behind, s.n_outer); };
  for (int front = from(first) + first; front < end + last + behind; ++front) {
    for (int n = first; n <= last; ++n) {
      const int k = front - n;
      if (k < from(n) || k >= to(n))
        continue;
      const bool store = n == last && k >= begin && k < end;
      const Plane<float> next =
          n == last && !coarse ? s.plane(out.spare.data(), k) : window.at(n, k);
      if (n == 0 && start == Start::corrected)
        correct_plane(s, *correction, k, next);
      else if (n == 1 && start == Start::zero)
        first_plane(s, k, next);
      else if (n > 0) {
        const bool has_before = n - 2 >= first;
        step_plane(s, n, k, at(n - 1, k), at(n - 1, k - 1), at(n - 1, k + 1),
                   has_before ? at(n - 2, k) : Plane<const float>{nullptr, 0}, next,
                   n == last && !coarse ? products_of(out) : nullptr);
      }
      if (store && coarse) {
        const auto kept = s.plane(out.spare.data(), k);
        for (int j = 0; j < s.n_inner; ++j)
          std::copy(next.row(j), next.row(j) + s.n, kept.row(j));
      }
    }
    const int k = front - last - 1;
    if (coarse && k >= begin && k < end)
      restrict_plane(s, *coarse, k, at(last, k), at(last, k - 1), at(last, k + 1), window.row());
  }
}

/// Makes room for as many threads as may sweep the block.
void make_room(LevelBlock& b) {
  const bool parallel = worth_a_team(b.layout);
  const auto threads = std::size_t(parallel ? omp_get_max_threads() : 1);
  if (b.planes.size() < threads)
    b.planes.resize(threads);
}

/// That of this thread, touched first by it.
float* own_room(LevelBlock& b, const Smoothing& steps) {
  FloatField& room = b.planes[u(omp_get_thread_num())];
  if (room.size() < Window::size(b, steps))
    room = FloatField(Window::size(b, steps));
  return room.data();
}

/// sweep_slab of a whole block, dealt to the threads.
void sweep_block(const Level& level, LevelBlock& b, const std::array<Pairing, 3>& pairing,
                 Start start, const LevelBlock* correction, LevelBlock* coarse) {
  const Sweep s(level, b, &pairing);
  make_room(b);
  const int N = s.outer.coarse(s.n_outer - 1) + 1; // coarse planes: a slab begins where one does
  in_team(worth_a_team(b.layout), [&] {
    const int threads = omp_get_num_threads(), thread = omp_get_thread_num();
    const int begin = s.outer.first(int(long(N) * thread / threads), s.n_outer);
    const int end = s.outer.first(int(long(N) * (thread + 1) / threads), s.n_outer);
    if (begin < end)
      sweep_slab(s, start, correction, coarse, b, Window(b, s.steps, own_room(b, s.steps)), begin,
                 end);
  });
  std::swap(b.x, b.spare);
}

/// body(sweep, block, plane) for all planes of all blocks of a level, dealt to the threads;
/// pairings where cells join.
template <class Body> void for_planes(Level& level, const Pairings* pairings, Body&& body) {
  for (std::size_t b = 0; b < level.blocks.size(); ++b) {
    LevelBlock& block = level.blocks[b];
    const Sweep s(level, block, pairings ? &(*pairings)[u(level.mesh.local[b].id)] : nullptr);
    deal(worth_a_team(block.layout), s.n_outer, [&](std::ptrdiff_t k) { body(s, b, int(k)); });
  }
}

/// Step by step, for levels with links.
void smooth_by_steps(Level& level, Start start) {
  if (start == Start::zero) {
    for_planes(level, nullptr, [&](const Sweep& s, std::size_t b, int k) {
      first_plane(s, k, s.plane(level.blocks[b].x.data(), k));
    });
  }
  for (int n = start == Start::zero ? 2 : 1; n <= level.smoothing.count(); ++n) {
    level.exchange(&LevelBlock::x);
    const bool has_before = n > (start == Start::zero ? 2 : 1);
    for_planes(level, nullptr, [&](const Sweep& s, std::size_t b, int k) {
      LevelBlock& block = level.blocks[b];
      const auto x = [&](int plane) { return as_const(s.plane(block.x.data(), plane)); };
      const Plane<float> next = s.plane(block.spare.data(), k);
      step_plane(s, n, k, x(k), x(k - 1), x(k + 1),
                 has_before ? as_const(next) : Plane<const float>{nullptr, 0}, next,
                 n == level.smoothing.count() && start == Start::corrected ? products_of(block)
                                                                           : nullptr);
    });
    for (LevelBlock& block : level.blocks)
      std::swap(block.x, block.spare);
  }
}

} // namespace

void smooth(Level& level) {
  constexpr int most_in_cache = 16; // steps whose planes are swept at once
  if (level.linked || level.smoothing.count() > most_in_cache) {
    smooth_by_steps(level, Start::zero);
    return;
  }
  for (LevelBlock& block : level.blocks)
    sweep_block(level, block, {}, Start::zero, nullptr, nullptr);
}

void smooth_and_restrict(Level& level, Level& coarse, Start start) {
  if (!level.linked) {
    for (std::size_t b = 0; b < level.blocks.size(); ++b)
      sweep_block(level, level.blocks[b], coarse.pairings[u(level.mesh.local[b].id)], start,
                  nullptr, &coarse.blocks[b]);
    return;
  }
  smooth_by_steps(level, start);
  level.exchange(&LevelBlock::x);
  for (std::size_t b = 0; b < level.blocks.size(); ++b) {
    LevelBlock& block = level.blocks[b];
    make_room(block);
    const Sweep s(level, block, &coarse.pairings[u(level.mesh.local[b].id)]);
    const int N = s.outer.coarse(s.n_outer - 1) + 1;
    in_team(worth_a_team(block.layout), [&] {
      float* row = Window(block, s.steps, own_room(block, s.steps)).row();
#pragma omp for schedule(static) nowait
      for (int K = 0; K < N; ++K)
        for (int k = s.outer.first(K, s.n_outer); k < s.outer.first(K + 1, s.n_outer); ++k) {
          const auto x = [&](int plane) { return as_const(s.plane(block.x.data(), plane)); };
          restrict_plane(s, coarse.blocks[b], k, x(k), x(k - 1), x(k + 1), row);
        }
    });
  }
}

void correct_and_smooth(const Level& coarse, Level& level) {
  if (!level.linked) {
    for (std::size_t b = 0; b < level.blocks.size(); ++b)
      sweep_block(level, level.blocks[b], coarse.pairings[u(level.mesh.local[b].id)],
                  Start::corrected, &coarse.blocks[b], nullptr);
    return;
  }
  for_planes(level, &coarse.pairings, [&](const Sweep& s, std::size_t b, int k) {
    correct_plane(s, coarse.blocks[b], k, s.plane(level.blocks[b].x.data(), k));
  });
  smooth_by_steps(level, Start::corrected);
}

} // namespace granflux::cfd
