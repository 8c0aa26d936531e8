// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

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
    ref = {found->link->block, found->link->donor(ref.cell), ref.shift + found->link->shift};
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
