// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/join_blocks.hpp>

#include <algorithm>
#include <cstdlib>

namespace granflux::cfd {

Link make_link(int donor, const Index3& begin, const Index3& donor_begin,
               const Transform& transform, const Vec3& shift) {
  Link link;
  link.block = donor;
  link.shift = shift;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto a = std::size_t(std::abs(transform[d]) - 1);
    const int sign = transform[d] < 0 ? -1 : 1;
    link.axis[a] = int(d);
    link.sign[a] = sign;
    // Cell c lies between nodes c and c + 1; where the order turns, the donor's begins at the
    // image of the latter.
    link.offset[a] = donor_begin[a] - sign * begin[d] - (sign < 0 ? 1 : 0);
  }
  return link;
}

IndexBox layer(const Index3& cells, const Side& side) {
  IndexBox box{{0, 0, 0}, cells};
  const auto d = std::size_t(side.direction);
  box.lo[d] = side.high ? cells[d] - 1 : 0;
  box.hi[d] = box.lo[d] + 1;
  return box;
}

Patch boundary_side(const Index3& cells, const Side& side, int boundary) {
  return {side, layer(cells, side), boundary, std::nullopt};
}

Patch answer(int id, const Patch& patch) {
  const Link& link = *patch.link;
  const auto normal = std::size_t(patch.side.direction);
  IndexBox ghosts = patch.cells;
  ghosts.lo[normal] += patch.side.high ? 1 : -1;
  ghosts.hi[normal] = ghosts.lo[normal] + 1;
  const Index3 first = link.donor(ghosts.lo),
               last = link.donor({ghosts.hi[0] - 1, ghosts.hi[1] - 1, ghosts.hi[2] - 1});
  Patch back;
  back.link.emplace();
  back.link->block = id;
  back.link->shift = -link.shift;
  for (std::size_t a = 0; a < 3; ++a) {
    back.cells.lo[a] = std::min(first[a], last[a]);
    back.cells.hi[a] = std::max(first[a], last[a]) + 1;
    const auto d = std::size_t(link.axis[a]);
    back.link->axis[d] = int(a);
    back.link->sign[d] = link.sign[a];
    back.link->offset[d] = -link.sign[a] * link.offset[a];
    if (d == normal)
      back.side = {int(a), patch.side.high == (link.sign[a] < 0)};
  }
  return back;
}

void join_sides(Grid& grid, int id, const Side& side, int donor, const Transform& transform,
                const Vec3& shift) {
  const Index3 cells = grid.blocks[std::size_t(id)].cells;
  const Index3 donor_cells = grid.blocks[std::size_t(donor)].cells;
  Index3 begin{}, donor_begin{};
  for (std::size_t d = 0; d < 3; ++d) {
    const auto a = std::size_t(std::abs(transform[d]) - 1);
    const bool turned = transform[d] < 0;
    if (int(d) == side.direction) {
      begin[d] = side.high ? cells[d] : 0;
      donor_begin[a] = side.high == turned ? donor_cells[a] : 0;
    } else {
      donor_begin[a] = turned ? donor_cells[a] : 0;
    }
  }
  const Patch patch{side, layer(cells, side), -1,
                    make_link(donor, begin, donor_begin, transform, shift)};
  grid.blocks[std::size_t(id)].patches.push_back(patch);
  grid.blocks[std::size_t(donor)].patches.push_back(answer(id, patch));
}

} // namespace granflux::cfd
