// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <granflux/cfd/mesh.hpp>
#include <granflux/coupling/block_stack.hpp>
#include <granflux/coupling/grid_extent.hpp>
#include <granflux/coupling/room.hpp>

namespace granflux::coupling {

/// Finds the cell of a point in blocks of any shape: a cell is what the trilinear map makes of the
/// unit cube between its eight nodes. A regular grid of bins says which cells may hold a point. Two
/// planes of each face, between which it lies, tell most points inside from those outside; between
/// the planes Newton's method inverts the map. Near a cell the search goes from cell to cell across
/// the face that a point is farthest beyond. A point on a face belongs to the cell of lower
/// number; one between a curved wall and the flat faces that stand for it to none.
///
/// Every rank holds the nodes of all blocks (24 bytes a cell, and some 280 to find it by):
/// particles go where they like.
class BlockLocator {
public:
  BlockLocator() = default;
  /// Collective. Throws ConfigError on all ranks where a periodic connection is not along an axis.
  explicit BlockLocator(const cfd::Mesh& mesh);

  /// Cell as BlockStack numbers it; nothing for a point outside all cells, or not a number.
  [[nodiscard]] std::optional<cfd::Index3> cell(const Vec3& x) const;
  /// The same, quicker for most points in the cell `near` and around it.
  [[nodiscard]] std::optional<cfd::Index3> cell(const Vec3& x, const cfd::Index3& near) const;
  /// Radius of a ball around x that surely lies within the cell [m]; not above 0 where x does not,
  /// or nearly touches a face.
  [[nodiscard]] double room(const cfd::Index3& cell, const Vec3& x) const;

  /// A set of up to 32 points about a centre, in units of a radius.
  struct PointSet {
    static constexpr int most = 32;
    int count = 0;
    alignas(64) std::array<float, most> x{}, y{}, z{};
  };
  /// The cells in which points of a set lie, in the order of the first point in each.
  struct PointsInCells {
    struct Part {
      cfd::Index3 cell;
      int points;
    };
    std::array<Part, PointSet::most> parts;
    int count = 0; ///< of parts
    Room room;     ///< in which all points may move together while each stays in its cell
    [[nodiscard]] auto begin() const { return parts.begin(); }
    [[nodiscard]] auto end() const { return parts.begin() + count; }
  };
  /// Of a set with this radius [m] about a centre in the cell `near`. A point outside all cells
  /// counts with the centre.
  [[nodiscard]] PointsInCells cells(const PointSet& points, const Vec3& centre, double radius,
                                    const cfd::Index3& near) const;

  /// Another for each locator that is made of a mesh: what was found by one serves its copies.
  [[nodiscard]] long edition() const { return edition_; }
  /// The periodic image of x that lies within the extent of the mesh along periodic directions.
  [[nodiscard]] Vec3 fold(const Vec3& x) const { return any_period_ ? image(x) : x; }
  [[nodiscard]] const GridExtent& extent() const { return extent_; }

private:
  struct Nodes {
    cfd::Index3 cells{};
    int first = 0; ///< layer of the stack
    std::vector<Vec3> at;
    std::size_t first_cell = 0; ///< in cells_
    [[nodiscard]] const Vec3& operator()(int i, int j, int k) const {
      return at[std::size_t(i) + std::size_t(cells[0] + 1) *
                                     (std::size_t(j) + std::size_t(cells[1] + 1) * std::size_t(k))];
    }
  };
  /// Along its outward normal, from the middle of the cell: nothing of the face lies before
  /// `inner`, nothing of the cell beyond `outer`, whatever is rounded.
  struct Face {
    std::array<float, 3> normal;
    float inner, outer;
    int across; ///< number of the cell behind it, or none
  };
  static constexpr int none = -1;
  struct Cell {
    int block = 0;
    cfd::Index3 at{};
    Vec3 low, high; ///< of the box around it
    Vec3 middle;
    std::array<Face, 6> faces;
  };
  class PointSearch;
  enum class Verdict { inside, outside, open };
  struct Outermost {
    float beyond; ///< the inner plane of a face; negative behind it
    int across;   ///< of that face
  };

  void gather_nodes(const cfd::Mesh& mesh);
  void find_periods(const cfd::Mesh& mesh);
  [[nodiscard]] Vec3 image(const Vec3& x) const;
  void fill_bins();
  [[nodiscard]] std::array<Vec3, 8> corners(const Cell& c) const;
  static void find_faces(Cell& cell, const std::array<Vec3, 8>& node);
  [[nodiscard]] static Verdict judge(const Cell& cell, const Vec3& x);
  [[nodiscard]] static Outermost outermost(const Cell& cell, const Vec3& x);
  void find_neighbours();
  [[nodiscard]] int number(const cfd::Index3& in_stack) const;
  [[nodiscard]] cfd::Index3 in_stack(int cell) const;
  /// Number of the cell that holds x, or none.
  [[nodiscard]] int find(const Vec3& x) const;
  /// How far x, which no cell holds, surely is from all of them [m].
  [[nodiscard]] double away_from_all(const Vec3& x) const;
  [[nodiscard]] cfd::Index3 bin(const Vec3& x) const;
  [[nodiscard]] std::size_t bin_number(const cfd::Index3& b) const {
    return std::size_t(b[0]) +
           std::size_t(bins_[0]) * (std::size_t(b[1]) + std::size_t(bins_[1]) * std::size_t(b[2]));
  }

  long edition_ = 0;
  std::vector<Nodes> blocks_;
  std::vector<int> block_of_layer_; ///< of the stack
  GridExtent extent_;
  bool any_period_ = false;
  cfd::Index3 bins_{1, 1, 1};
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> bin_start_;  ///< of each bin in candidates_, and the end
  std::vector<std::uint32_t> candidates_; ///< in cells_, increasing within a bin
};

} // namespace granflux::coupling
