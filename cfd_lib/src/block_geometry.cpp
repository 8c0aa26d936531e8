// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "block_geometry.hpp"

#include <string>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/gradient.hpp>
#include <granflux/cfd/sweep.hpp>

namespace granflux::cfd {

namespace {

constexpr double round_off = 1e-10; ///< relative; nodes may come from a file of 12 digits or so

VectorField make_vector(const Layout& layout) {
  return {Field(layout), Field(layout), Field(layout)};
}
std::array<VectorField, 3> make_vector_per_direction(const Layout& layout) {
  return {make_vector(layout), make_vector(layout), make_vector(layout)};
}

/// Corners of the low face in direction d, in order around it, right-handed about the direction.
std::array<std::ptrdiff_t, 4> corners(const Layout& layout, int d, std::ptrdiff_t c) {
  const std::ptrdiff_t e = layout.stride[std::size_t((d + 1) % 3)];
  const std::ptrdiff_t f = layout.stride[std::size_t((d + 2) % 3)];
  return {c, c + e, c + e + f, c + f};
}

struct Step { ///< across a face, from the centre below to the centre above
  Vec3 area, centres, to_face;
};

Step step_over(const Block& block, int d, std::ptrdiff_t f) {
  const std::ptrdiff_t below = f - block.layout.stride[std::size_t(d)];
  const Vec3 from = get(block.centre, below);
  return {get(block.area[std::size_t(d)], f), get(block.centre, f) - from,
          low_face_centre(block, d, f) - from};
}

} // namespace

Vec3 low_face_centre(const Block& block, int d, std::ptrdiff_t c) {
  Vec3 sum;
  for (const std::ptrdiff_t corner : corners(block.layout, d, c))
    sum += get(block.node, corner);
  return 0.25 * sum;
}

Block make_block(int id, const GridBlock& from) {
  Block block;
  block.id = id;
  block.layout = Layout(from.cells);
  const Layout& layout = block.layout;
  block.node = make_vector(layout);
  block.centre = make_vector(layout);
  block.volume = Field(layout);
  block.area = make_vector_per_direction(layout);
  for (std::size_t d = 0; d < 3; ++d) {
    block.conductance[d] = Field(layout);
    block.weight[d] = Field(layout);
  }
  const auto [ni, nj, nk] = from.cells;
  for (int k = 0; k <= nk; ++k)
    for (int j = 0; j <= nj; ++j)
      for (int i = 0; i <= ni; ++i)
        set(block.node, layout.at(i, j, k), from.node(i, j, k));

  for (int d = 0; d < 3; ++d)
    for_faces(layout, d, [&](std::ptrdiff_t f) {
      const auto [a, b, c, e] = corners(layout, d, f);
      set(block.area[std::size_t(d)], f,
          0.5 * cross(get(block.node, c) - get(block.node, a),
                      get(block.node, e) - get(block.node, b)));
    });
  for (int k = 0; k < nk; ++k)
    for (int j = 0; j < nj; ++j)
      for (int i = 0; i < ni; ++i) {
        const std::ptrdiff_t c = layout.at(i, j, k);
        Vec3 centre;
        for (int corner = 0; corner < 8; ++corner)
          centre += 0.125 * get(block.node, layout.at(i + (corner & 1), j + (corner >> 1 & 1),
                                                      k + (corner >> 2 & 1)));
        double volume = 0; // divergence theorem about the centre
        for (int d = 0; d < 3; ++d) {
          const std::ptrdiff_t high = c + layout.stride[std::size_t(d)];
          const VectorField& area = block.area[std::size_t(d)];
          volume += (dot(get(area, high), low_face_centre(block, d, high) - centre) -
                     dot(get(area, c), low_face_centre(block, d, c) - centre)) /
                    3;
        }
        if (!(volume > 0))
          throw ConfigError("grid: cell (" + std::to_string(i) + ", " + std::to_string(j) + ", " +
                            std::to_string(k) + ") of block " + std::to_string(id) +
                            (from.name.empty() ? "" : " (" + from.name + ")") + " has volume " +
                            std::to_string(volume) +
                            " m3: a cell must have a positive volume (folded or wrongly ordered "
                            "nodes)");
        set(block.centre, c, centre);
        block.volume[c] = volume;
      }
  return block;
}

void add_two_point_metrics(Block& block) {
  for (int d = 0; d < 3; ++d)
    for_faces(block.layout, d, [&](std::ptrdiff_t f) {
      const Step step = step_over(block, d, f);
      const double along = dot(step.area, step.centres);
      block.conductance[std::size_t(d)][f] = along != 0 ? dot(step.area, step.area) / along : 0;
      block.weight[std::size_t(d)][f] = along != 0 ? dot(step.area, step.to_face) / along : 0.5;
    });
}

bool is_orthogonal(const Block& block) {
  double worst = 0;
  for (int d = 0; d < 3; ++d)
    for (int k = 0; k < block.layout.cells[2] + (d == 2); ++k)
      for (int j = 0; j < block.layout.cells[1] + (d == 1); ++j)
        for (int i = 0; i < block.layout.cells[0] + (d == 0); ++i) {
          const Step step = step_over(block, d, block.layout.at(i, j, k));
          const double slant = norm(cross(step.area, step.centres));
          const double beside = norm(cross(step.to_face, step.centres));
          worst = std::max({worst, slant / (norm(step.area) * norm(step.centres)),
                            beside / dot(step.centres, step.centres)});
        }
  return worst <= round_off;
}

void add_skew_metrics(Block& block) {
  const Layout& layout = block.layout;
  SkewMetrics& skew = block.skew.emplace();
  skew.cross = make_vector_per_direction(layout);
  skew.offset = make_vector_per_direction(layout);
  skew.dual = make_vector_per_direction(layout);
  for (int d = 0; d < 3; ++d)
    for_faces(layout, d, [&](std::ptrdiff_t f) {
      const Step step = step_over(block, d, f);
      set(skew.cross[std::size_t(d)], f,
          step.area - block.conductance[std::size_t(d)][f] * step.centres);
      set(skew.offset[std::size_t(d)], f,
          step.to_face - block.weight[std::size_t(d)][f] * step.centres);
    });
  for_cells(layout, [&](std::ptrdiff_t c) {
    const std::array<Vec3, 3> dual = dual_vectors(block, c);
    for (std::size_t d = 0; d < 3; ++d)
      set(skew.dual[d], c, dual[d]);
  });
}

} // namespace granflux::cfd
