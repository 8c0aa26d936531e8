// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/mesh.hpp>

#include <string>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

namespace {

struct Face {
  Vec3 area, centre;
};

/// Face of four corners in order around it, right-handed about the area vector.
Face face_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {0.5 * cross(c - a, d - b), 0.25 * (a + b + c + d)};
}

void set(VectorField& field, std::ptrdiff_t c, const Vec3& v) {
  for (int m = 0; m < 3; ++m)
    field[std::size_t(m)][c] = v[m];
}

Vec3 get(const VectorField& field, std::ptrdiff_t c) {
  return {field[0][c], field[1][c], field[2][c]};
}

VectorField make_vector(const Layout& layout) {
  return {Field(layout), Field(layout), Field(layout)};
}

} // namespace

Block make_block(int id, Index3 cells, const NodeMap& node) {
  Block block;
  block.id = id;
  block.layout = Layout(cells);
  const Layout& layout = block.layout;
  block.node = make_vector(layout);
  block.centre = make_vector(layout);
  block.volume = Field(layout);
  for (auto& area : block.area)
    area = make_vector(layout);
  for (auto& conductance : block.conductance)
    conductance = Field(layout);
  for (auto& weight : block.weight)
    weight = Field(layout);

  constexpr int g = ghost_layers;
  const auto each = [&](int first, auto&& body) {
    for (int k = first; k < cells[2] + g; ++k)
      for (int j = first; j < cells[1] + g; ++j)
        for (int i = first; i < cells[0] + g; ++i)
          body(i, j, k, layout.at(i, j, k));
  };
  std::array<VectorField, 3> face_centre{make_vector(layout), make_vector(layout),
                                         make_vector(layout)};
  each(-g, [&](int i, int j, int k, std::ptrdiff_t c) {
    std::array<Vec3, 8> corner; // bit 0, 1, 2: high in i, j, k
    for (int b = 0; b < 8; ++b)
      corner[std::size_t(b)] = node(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2 & 1));
    const auto face = [&](int a, int b, int d, int e) {
      return face_of(corner[std::size_t(a)], corner[std::size_t(b)], corner[std::size_t(d)],
                     corner[std::size_t(e)]);
    };
    const Face low[3] = {face(0, 2, 6, 4), face(0, 4, 5, 1), face(0, 1, 3, 2)};
    const Face high[3] = {face(1, 3, 7, 5), face(2, 6, 7, 3), face(4, 5, 7, 6)};
    Vec3 centre;
    for (const Vec3& x : corner)
      centre += 0.125 * x;
    double volume = 0; // divergence theorem about the centre
    for (int d = 0; d < 3; ++d) {
      volume +=
          (dot(high[d].area, high[d].centre - centre) - dot(low[d].area, low[d].centre - centre)) /
          3;
      set(block.area[std::size_t(d)], c, low[d].area);
      set(face_centre[std::size_t(d)], c, low[d].centre);
    }
    set(block.node, c, corner[0]);
    set(block.centre, c, centre);
    block.volume[c] = volume;
    const bool interior =
        i >= 0 && j >= 0 && k >= 0 && i < cells[0] && j < cells[1] && k < cells[2];
    if (interior && !(volume > 0))
      throw ConfigError(
          "grid: cell (" + std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k) +
          ") of block " + std::to_string(id) + " has volume " + std::to_string(volume) +
          " m3: a cell must have a positive volume (folded or wrongly ordered nodes)");
  });
  each(1 - g, [&](int, int, int, std::ptrdiff_t c) {
    for (int d = 0; d < 3; ++d) {
      const std::ptrdiff_t below = c - layout.stride[std::size_t(d)];
      const Vec3 area = get(block.area[std::size_t(d)], c);
      const Vec3 step = get(block.centre, c) - get(block.centre, below);
      const Vec3 to_face = get(face_centre[std::size_t(d)], c) - get(block.centre, below);
      const double along = dot(area, step);
      block.conductance[std::size_t(d)][c] = along != 0 ? dot(area, area) / along : 0;
      block.weight[std::size_t(d)][c] = along != 0 ? dot(area, to_face) / along : 0.5;
    }
  });
  return block;
}

std::optional<CellRef> resolve(const Mesh& mesh, CellRef ref) {
  for (;;) {
    const BlockInfo& info = mesh.blocks[std::size_t(ref.block)];
    int outside = -1;
    for (int d = 0; d < 3; ++d)
      if (ref.cell[std::size_t(d)] < 0 || ref.cell[std::size_t(d)] >= info.cells[std::size_t(d)])
        outside = d;
    if (outside < 0)
      return ref;
    const auto o = std::size_t(outside);
    const Side side{outside, ref.cell[o] >= 0};
    Index3 touching = ref.cell;
    touching[o] = side.high ? info.cells[o] - 1 : 0;
    const Patch* found = nullptr;
    for (const Patch& patch : info.patches)
      if (patch.side == side && patch.cells.contains(touching))
        found = &patch;
    if (!found || !found->link)
      return std::nullopt;
    ref = {found->link->block, found->link->donor(ref.cell)};
  }
}

BlockFields make_fields(const Mesh& mesh, double value) {
  BlockFields fields;
  for (const Block& block : mesh.local)
    fields.emplace_back(block.layout, value);
  return fields;
}

BlockVectors make_vectors(const Mesh& mesh, Vec3 value) {
  BlockVectors vectors;
  for (const Block& block : mesh.local)
    vectors.push_back(
        {Field(block.layout, value.x), Field(block.layout, value.y), Field(block.layout, value.z)});
  return vectors;
}

} // namespace granflux::cfd
