// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

inline Vec3 get(const VectorField& field, std::ptrdiff_t c) {
  return {field[0][c], field[1][c], field[2][c]};
}
inline void set(VectorField& field, std::ptrdiff_t c, const Vec3& v) {
  for (int m = 0; m < 3; ++m)
    field[std::size_t(m)][c] = v[m];
}

/// Centre of the low face in direction d of the cell at c, from its four nodes.
Vec3 low_face_centre(const Block& block, int d, std::ptrdiff_t c);

/// Nodes, volumes, centres and face areas of one block's own cells. Throws ConfigError naming
/// block and index where a cell has no positive volume.
Block make_block(int id, const GridBlock& from);

/// What depends on centres beyond the sides as well: conductances, weights, and the skew metrics.
void add_two_point_metrics(Block& block);
/// True if every face is crossed at its centre and at right angles.
bool is_orthogonal(const Block& block);
void add_skew_metrics(Block& block);

} // namespace granflux::cfd
