// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// How index directions run on across a face that two blocks share, as CGNS writes it: direction d
/// of this block is direction |t[d]| - 1 of the donor, backwards where t[d] < 0.
using Transform = std::array<int, 3>;

/// The link across a face on which node `begin` of this block is node `donor_begin` of the donor.
Link make_link(int donor, const Index3& begin, const Index3& donor_begin,
               const Transform& transform, const Vec3& shift = {});

/// The cells of a block along one of its sides.
IndexBox layer(const Index3& cells, const Side& side);

/// A side that is one boundary.
Patch boundary_side(const Index3& cells, const Side& side, int boundary);

/// The donor's patch that answers `patch`, a link of block `id`.
Patch answer(int id, const Patch& patch);

/// Joins the whole side of one block to a whole side of another, or of its own, in both directions;
/// which side of the donor it is follows from the transform. `shift`: see Link.
void join_sides(Grid& grid, int id, const Side& side, int donor, const Transform& transform,
                const Vec3& shift = {});

} // namespace granflux::cfd
