// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <granflux/cfd/mesh.hpp>
#include <granflux/coupling/cell_row.hpp>
#include <granflux/coupling/grid_extent.hpp>

namespace granflux::coupling {

/// LatticeAxis::row<2>() along a direction of equal cells, of points inside the box: by arithmetic
/// alone, and without branches, for next to walls, in thin beds everywhere, they would be foretold
/// wrongly as often as not.
struct LinearPlace {
  double first = 0, last = 0; ///< nodes [m]
  double per_length = 0;      ///< cells per metre
  double least = 0, most = 0; ///< lower cells, as numbers

  [[nodiscard]] CellRow<2> row(double x) const {
    const double at = place(x, first, per_length, least, most), below = lower(at, most);
    return {int(below), {at - below}};
  }
  // Its parts. A point next to a wall counts as at the centre of the cell.
  static double place(double x, double first, double per_length, double least, double most) {
    const double at = (x - first) * per_length - 0.5, above = at > least ? at : least;
    return above < most + 1 ? above : most + 1;
  }
  static double lower(double place, double most) {
    const double below = std::floor(place);
    return below < most ? below : most;
  }
};

/// Cells along one direction of the lattice, made ready for many look-ups.
class LatticeAxis {
public:
  LatticeAxis() = default;
  LatticeAxis(const std::vector<double>& nodes, bool periodic);

  [[nodiscard]] int cells() const { return cells_; }
  [[nodiscard]] bool periodic() const { return periodic_; }
  /// m; the period of a periodic direction
  [[nodiscard]] double length() const { return nodes_.back() - nodes_.front(); }

  /// Cell that holds x; a point on a face belongs to the cell above it, the upper end of a
  /// direction that is not periodic to the last cell. Nothing if x is outside or not a number.
  /// Along a periodic direction the index goes on below 0 and past the last cell.
  [[nodiscard]] std::optional<int> cell(double x) const;
  /// Shares of x in n cells, by B-splines of degree n - 1; along a periodic direction the cells are
  /// unwrapped. Nothing where cell(x) is nothing.
  ///
  /// n = 2: in the cells below and above x whose centres it lies between, linear. Between a wall
  /// and the first centre the share of the cell beyond the wall is 0; along a direction of one cell
  /// without a period that is the upper one.
  ///
  /// n = 3: in the cell of x and its two neighbours, by quadratic B-splines with the nodes as
  /// knots, whose Greville points are the cell centres. What a cell beyond a wall would get goes to
  /// the cell before it. Without a period the cells are inside the grid as far as it has three;
  /// beyond, shares are 0.
  template <int n> [[nodiscard]] std::optional<CellRow<n>> row(double x) const;
  /// Unwrapped index to 0 <= i < cells; the identity where the direction is not periodic.
  [[nodiscard]] int wrap(int i) const;
  /// Where cells are equal, and two at least without a period.
  [[nodiscard]] const std::optional<LinearPlace>& pairs() const { return pairs_; }
  /// Centre of a cell [m]; along a periodic direction of any unwrapped one.
  [[nodiscard]] double centre(int i) const;
  /// The image of x at most one period outside the box; x itself where it already is.
  [[nodiscard]] double fold(double x) const;

private:
  [[nodiscard]] int within(double x) const; ///< for x inside the box
  [[nodiscard]] std::optional<CellRow<2>> linear_row(double x) const;
  [[nodiscard]] CellRow<2> linear_row_inside(double x) const;           ///< the box, by arithmetic
  [[nodiscard]] std::optional<CellRow<2>> searched_row(double x) const; ///< linear, on any nodes
  [[nodiscard]] std::optional<CellRow<3>> quadratic_row(double x) const;
  [[nodiscard]] CellRow<2> inner(int lower, double upper_share) const;
  [[nodiscard]] CellRow<3> inner(int middle, double below, double above) const;
  [[nodiscard]] double node(int i) const;
  [[nodiscard]] double width(int i) const;

  std::vector<double> nodes_, centres_;
  int cells_ = 0;
  bool periodic_ = false;
  bool uniform_ = false;  ///< nearly, so that a cell is found by arithmetic and a look at its nodes
  bool equal_ = false;    ///< to rounding: nodes need no look
  double per_length_ = 0; ///< cells per metre where uniform

  std::optional<LinearPlace> pairs_; ///< where cells are equal, and two at least without a period
};

/// Finds the cell of a point on the lattice: arithmetic on uniform directions, binary search on
/// stretched ones.
class LatticeLocator {
public:
  LatticeLocator() = default;
  explicit LatticeLocator(const cfd::Lattice& lattice);

  [[nodiscard]] const LatticeAxis& axis(int d) const { return axes_[std::size_t(d)]; }
  [[nodiscard]] const GridExtent& extent() const { return extent_; }
  /// Unwrapped cell triple; nothing for a point outside the domain.
  [[nodiscard]] std::optional<cfd::Index3> cell(const Vec3& x) const;
  /// The lattice cell that an unwrapped triple stands for.
  [[nodiscard]] cfd::Index3 wrap(const cfd::Index3& c) const {
    return {axes_[0].wrap(c[0]), axes_[1].wrap(c[1]), axes_[2].wrap(c[2])};
  }
  /// The periodic image of x that lies in the box or within one period of it: a host may hand over
  /// particles that it has not wrapped yet, and the window must not grow with how far they went.
  [[nodiscard]] Vec3 fold(const Vec3& x) const {
    return {axes_[0].fold(x.x), axes_[1].fold(x.y), axes_[2].fold(x.z)};
  }

private:
  std::array<LatticeAxis, 3> axes_;
  GridExtent extent_;
};

// Here, not in the .cpp: these run several times a particle and coupling step.

inline int LatticeAxis::within(double x) const {
  if (!uniform_) {
    const auto above = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, x);
    return int(above - nodes_.begin()) - 1;
  }
  // The product may miss by one next to a face: the nodes decide.
  int i = std::clamp(int((x - nodes_.front()) * per_length_), 0, cells_ - 1);
  if (x < nodes_[std::size_t(i)])
    i = std::max(i - 1, 0);
  else if (i + 1 < cells_ && x >= nodes_[std::size_t(i) + 1])
    ++i;
  return i;
}

inline std::optional<int> LatticeAxis::cell(double x) const {
  if (nodes_.front() <= x && x < nodes_.back())
    return within(x);
  if (!periodic_)
    return x == nodes_.back() ? std::optional(cells_ - 1) : std::nullopt;
  const double periods = std::floor((x - nodes_.front()) / length());
  if (!(std::abs(periods) < 1000)) // not a number, or so far off that the index may overflow
    return std::nullopt;
  return within(x - periods * length()) + cells_ * int(periods);
}

inline CellRow<2> LatticeAxis::inner(int lower, double upper_share) const {
  if (!periodic_) {
    if (lower < 0)
      return {0, {0}};
    if (lower + 1 >= cells_)
      return cells_ > 1 ? CellRow<2>{cells_ - 2, {1}} : CellRow<2>{0, {0}};
  }
  return {lower, {upper_share}};
}

inline std::optional<CellRow<2>> LatticeAxis::linear_row(double x) const {
  if (pairs_ && pairs_->first <= x && x <= pairs_->last)
    return pairs_->row(x);
  return searched_row(x);
}

inline CellRow<3> LatticeAxis::inner(int middle, double below, double above) const {
  if (!periodic_) {
    if (cells_ == 1)
      return {0, {1, 0}};
    if (middle == 0)
      return {0, {1 - above, 0}};
    if (middle == cells_ - 1)
      return cells_ > 2 ? CellRow<3>{cells_ - 3, {0, 1 - below}} : CellRow<3>{0, {below, 0}};
  }
  return {middle - 1, {below, above}};
}

inline std::optional<CellRow<3>> LatticeAxis::quadratic_row(double x) const {
  if (equal_ && nodes_.front() <= x && x <= nodes_.back()) {
    const double place = (x - nodes_.front()) * per_length_;
    const int middle = std::min(int(place), cells_ - 1);
    const double above = place - middle, below = 1 - above;
    return inner(middle, 0.5 * below * below, 0.5 * above * above);
  }
  const std::optional<int> in = cell(x);
  if (!in)
    return std::nullopt;
  const double h = width(*in), above = (x - node(*in)) / h, below = 1 - above;
  const bool walled_below = !periodic_ && *in == 0, walled_above = !periodic_ && *in == cells_ - 1;
  return inner(*in, walled_below ? 0 : below * below * h / (h + width(*in - 1)),
               walled_above ? 0 : above * above * h / (h + width(*in + 1)));
}

template <int n> std::optional<CellRow<n>> LatticeAxis::row(double x) const {
  static_assert(n == 2 || n == 3);
  if constexpr (n == 2)
    return linear_row(x);
  else
    return quadratic_row(x);
}

inline int LatticeAxis::wrap(int i) const {
  if (!periodic_ || (0 <= i && i < cells_))
    return i;
  const int rest = i % cells_;
  return rest < 0 ? rest + cells_ : rest;
}

inline double LatticeAxis::centre(int i) const {
  if (0 <= i && i < cells_)
    return centres_[std::size_t(i)];
  const int wrapped = wrap(i);
  return centres_[std::size_t(wrapped)] + (i - wrapped) / cells_ * length();
}

inline double LatticeAxis::node(int i) const {
  const int wrapped = wrap(i);
  return nodes_[std::size_t(wrapped)] + (i - wrapped) / cells_ * length();
}

inline double LatticeAxis::width(int i) const {
  const auto wrapped = std::size_t(wrap(i));
  return nodes_[wrapped + 1] - nodes_[wrapped];
}

inline double LatticeAxis::fold(double x) const {
  if (!periodic_ || std::abs(x - 0.5 * (nodes_.front() + nodes_.back())) <= 1.5 * length())
    return x;
  return x - std::floor((x - nodes_.front()) / length()) * length();
}

inline std::optional<cfd::Index3> LatticeLocator::cell(const Vec3& x) const {
  const auto i = axes_[0].cell(x.x), j = axes_[1].cell(x.y), k = axes_[2].cell(x.z);
  if (!i || !j || !k)
    return std::nullopt;
  return cfd::Index3{*i, *j, *k};
}

} // namespace granflux::coupling
