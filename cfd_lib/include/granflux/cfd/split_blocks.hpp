// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// For each block of a grid the boxes that it is cut into; together they are the block.
using Pieces = std::vector<std::vector<IndexBox>>;

/// The same grid in smaller blocks: the pieces, in their order. Patches are cut along; a piece may
/// face several others, so that no cut has to go on in the next block.
Grid split_blocks(const Grid& grid, const Pieces& pieces);

/// Cuts that give every rank its share when deal_blocks deals the pieces in their order. Blocks are
/// cut only where a share ends inside; where they can be, cuts are short and at cells that are
/// multiples of powers of two, since multigrid joins cells within blocks. Pieces have at least two
/// cells along a direction that is cut; nothing where there are too few cells for that.
std::optional<Pieces> choose_pieces(const Grid& grid, int ranks);

/// The grid itself if its blocks keep the ranks busy (largest load at most 1.1 of the mean) or if
/// no cut makes them busier, else split by choose_pieces. Throws ConfigError where there are fewer
/// blocks than ranks and too few cells to cut.
Grid split_for_ranks(const Grid& grid, int ranks);

} // namespace granflux::cfd
