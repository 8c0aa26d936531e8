// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/boundary.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <granflux/cfd/error.hpp>

#include "block_geometry.hpp"

namespace granflux::cfd {

namespace {

Vec3 unit_normal(const Block& block, const BoundaryPatch& patch, const BoundaryFace& face) {
  const Vec3 area = get(block.area[std::size_t(patch.direction)], face.face);
  return area * (patch.outward / norm(area));
}

BoundaryPatch bind(const Mesh& mesh, int local, const Patch& patch, int condition) {
  const Block& block = mesh.local[std::size_t(local)];
  const auto d = std::size_t(patch.side.direction);
  const std::ptrdiff_t outwards =
      patch.side.high ? block.layout.stride[d] : -block.layout.stride[d];
  // In a direction of one cell between two boundaries there is no next cell inwards.
  Index3 across = patch.cells.lo;
  across[d] += patch.side.high ? -1 : 1;
  const bool has_inner = resolve(mesh, {block.id, across}).has_value();

  BoundaryPatch bound{local, patch.side.direction, patch.side.high ? 1.0 : -1.0, condition, {}};
  for (int k = patch.cells.lo[2]; k < patch.cells.hi[2]; ++k)
    for (int j = patch.cells.lo[1]; j < patch.cells.hi[1]; ++j)
      for (int i = patch.cells.lo[0]; i < patch.cells.hi[0]; ++i) {
        const std::ptrdiff_t c = block.layout.at(i, j, k);
        bound.faces.push_back({c, c + outwards, has_inner ? c - outwards : c,
                               patch.side.high ? c + outwards : c, 1.0});
      }
  return bound;
}

/// Directions along which nothing holds the gas back: periodic, or slip on both sides.
std::array<bool, 3> open_directions(const Mesh& mesh,
                                    const std::vector<BoundaryCondition>& conditions,
                                    const std::vector<int>& condition_of) {
  std::array<bool, 3> open{true, true, true};
  for (const BlockInfo& info : mesh.blocks)
    for (const Patch& patch : info.patches)
      if (!patch.link)
        open[std::size_t(patch.side.direction)] =
            open[std::size_t(patch.side.direction)] &&
            conditions[std::size_t(condition_of[std::size_t(patch.boundary)])].kind ==
                BoundaryKind::slip;
  return open;
}

/// Parabola of mean 1 across each tangential direction that is not open.
void shape_parabolic(const Mesh& mesh, std::vector<BoundaryPatch>& patches, int condition,
                     const std::array<bool, 3>& open) {
  std::array<double, 6> extent; // least, then negative largest coordinate of the boundary's corners
  extent.fill(std::numeric_limits<double>::max());
  const auto each = [&](auto&& body) {
    for (BoundaryPatch& patch : patches)
      if (patch.condition == condition)
        for (BoundaryFace& face : patch.faces)
          body(mesh.local[std::size_t(patch.block)], patch, face);
  };
  const auto corners = [](const Block& block, const BoundaryFace& face) {
    std::ptrdiff_t far = face.cell;
    for (const std::ptrdiff_t stride : block.layout.stride)
      far += stride;
    return std::array<Vec3, 2>{get(block.node, face.cell), get(block.node, far)};
  };
  each([&](const Block& block, const BoundaryPatch&, const BoundaryFace& face) {
    for (const Vec3& x : corners(block, face))
      for (int m = 0; m < 3; ++m) {
        extent[std::size_t(m)] = std::min(extent[std::size_t(m)], x[m]);
        extent[std::size_t(m + 3)] = std::min(extent[std::size_t(m + 3)], -x[m]);
      }
  });
  MPI_Allreduce(MPI_IN_PLACE, extent.data(), 6, MPI_DOUBLE, MPI_MIN, mesh.comm);
  each([&](const Block& block, const BoundaryPatch& patch, BoundaryFace& face) {
    const auto [low, high] = corners(block, face);
    for (int m = 0; m < 3; ++m) {
      const double from = extent[std::size_t(m)], length = -extent[std::size_t(m + 3)] - from;
      if (m == patch.direction || open[std::size_t(m)])
        continue;
      const double a = (low[m] - from) / length, b = (high[m] - from) / length;
      if (b - a < 1 - 1e-9) // mean of 6 s (1-s) over the face, so that the flux is exact
        face.shape *= (3 * (b * b - a * a) - 2 * (b * b * b - a * a * a)) / (b - a);
    }
  });
}

} // namespace

Boundaries::Boundaries(const Mesh& mesh, const std::vector<BoundaryCondition>& conditions)
    : mesh_(mesh), conditions_(conditions) {
  const auto known = [&](const std::string& name) {
    return std::find(mesh.boundaries.begin(), mesh.boundaries.end(), name) != mesh.boundaries.end();
  };
  std::vector<int> condition_of;
  for (const std::string& name : mesh.boundaries) {
    const auto found = std::find_if(conditions_.begin(), conditions_.end(),
                                    [&](const auto& c) { return c.name == name; });
    if (found == conditions_.end())
      throw ConfigError("boundary \"" + name + "\" of the grid has no condition");
    condition_of.push_back(int(found - conditions_.begin()));
  }
  for (const BoundaryCondition& condition : conditions_)
    if (!known(condition.name))
      throw ConfigError("condition for boundary \"" + condition.name +
                        "\": the grid has no boundary of that name");

  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    for (const Patch& patch : mesh.info(mesh.local[b]).patches)
      if (!patch.link)
        patches_.push_back(bind(mesh, int(b), patch, condition_of[std::size_t(patch.boundary)]));

  for (int c = 0; c < int(conditions_.size()); ++c)
    if (conditions_[std::size_t(c)].profile == BoundaryCondition::Profile::parabolic)
      shape_parabolic(mesh, patches_, c, open_directions(mesh, conditions_, condition_of));

  int through = -1; // a wall that moves through itself
  for (const BoundaryPatch& patch : patches_) {
    if (condition(patch).kind != BoundaryKind::wall)
      continue;
    for (const BoundaryFace& face : patch.faces) {
      constexpr double tangential = 1e-6; // of a facet of a round wall, too
      const Vec3 velocity = this->velocity(patch, face, 0);
      const Vec3 normal = unit_normal(mesh.local[std::size_t(patch.block)], patch, face);
      if (std::abs(dot(velocity, normal)) > tangential * norm(velocity))
        through = patch.condition;
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, &through, 1, MPI_INT, MPI_MAX, mesh.comm);
  if (through >= 0)
    throw ConfigError("boundary \"" + conditions_[std::size_t(through)].name +
                      "\": the velocity of a wall must be tangential to it; a wall that turns must "
                      "be round about its axis");
}

bool Boundaries::has_outlet() const {
  return std::any_of(conditions_.begin(), conditions_.end(),
                     [](const auto& c) { return c.kind == BoundaryKind::outlet; });
}

Vec3 Boundaries::velocity(const BoundaryPatch& patch, const BoundaryFace& face, double time) const {
  const BoundaryCondition& c = condition(patch);
  if (c.kind == BoundaryKind::wall) {
    if (c.angular_velocity == Vec3{})
      return c.velocity;
    const Vec3 arm =
        low_face_centre(mesh_.local[std::size_t(patch.block)], patch.direction, face.face) -
        c.centre;
    return c.velocity + cross(c.angular_velocity, arm);
  }
  if (c.kind != BoundaryKind::inlet)
    return {};
  const double share = c.ramp_time > 0 ? std::clamp(time / c.ramp_time, 0.0, 1.0) : 1.0;
  return (c.ramp_from + (1 - c.ramp_from) * share) * face.shape * c.velocity;
}

void Boundaries::fill_velocity(BlockVectors& velocity, const BlockFields& void_fraction,
                               double time) const {
  for (const BoundaryPatch& patch : patches_) {
    const auto b = std::size_t(patch.block);
    const Block& block = mesh_.local[b];
    VectorField& u = velocity[b];
    const BoundaryKind kind = condition(patch).kind;
    for (const BoundaryFace& face : patch.faces) {
      const Vec3 inside = get(u, face.cell);
      Vec3 ghost = inside;
      if (kind == BoundaryKind::inlet)
        ghost = (2 / void_fraction[b][face.cell]) * this->velocity(patch, face, time) - inside;
      else if (kind == BoundaryKind::wall)
        ghost = 2 * this->velocity(patch, face, time) - inside;
      else if (kind == BoundaryKind::slip) {
        const Vec3 n = unit_normal(block, patch, face);
        ghost = inside - 2 * dot(inside, n) * n;
      }
      for (int m = 0; m < 3; ++m)
        u[std::size_t(m)][face.ghost] = ghost[m];
    }
  }
}

double Boundaries::velocity_ghost_factor(const BoundaryPatch& patch, const BoundaryFace& face,
                                         int m) const {
  switch (condition(patch).kind) {
  case BoundaryKind::inlet:
  case BoundaryKind::wall:
    return -1;
  case BoundaryKind::slip: {
    const double n = unit_normal(mesh_.local[std::size_t(patch.block)], patch, face)[m];
    return 1 - 2 * n * n;
  }
  default:
    return 1;
  }
}

void Boundaries::fill_pressure(BlockFields& pressure, const BlockVectors& drag_slope,
                               bool with_given) const {
  for (const BoundaryPatch& patch : patches_) {
    const auto b = std::size_t(patch.block);
    Field& p = pressure[b];
    const VectorField& x = mesh_.local[b].centre;
    const BoundaryCondition& c = condition(patch);
    for (const BoundaryFace& face : patch.faces) {
      if (c.kind == BoundaryKind::outlet) {
        p[face.ghost] = (with_given ? 2 * c.pressure : 0.0) - p[face.cell];
        continue;
      }
      if (face.inner == face.cell) {
        p[face.ghost] = p[face.cell];
        continue;
      }
      const Vec3 outwards = get(x, face.ghost) - get(x, face.cell);
      const Vec3 inwards = get(x, face.inner) - get(x, face.cell);
      const Vec3 here = get(drag_slope[b], face.cell), inside = get(drag_slope[b], face.inner);
      const double smooth = p[face.inner] - p[face.cell] - 0.5 * dot(here + inside, inwards);
      p[face.ghost] = p[face.cell] - smooth * norm(outwards) / norm(inwards) + dot(here, outwards);
    }
  }
}

void Boundaries::move_pressure_ghosts(BlockFields& pressure, const BlockVectors& slope) const {
  for (const BoundaryPatch& patch : patches_) {
    const auto b = std::size_t(patch.block);
    const VectorField& x = mesh_.local[b].centre;
    if (condition(patch).kind == BoundaryKind::outlet)
      continue;
    for (const BoundaryFace& face : patch.faces) {
      if (face.inner == face.cell)
        continue;
      const Vec3 outwards = get(x, face.ghost) - get(x, face.cell);
      const Vec3 inwards = get(x, face.inner) - get(x, face.cell);
      const Vec3 aside = outwards + (norm(outwards) / norm(inwards)) * inwards;
      pressure[b][face.ghost] += dot(get(slope[b], face.cell), aside);
    }
  }
}

void Boundaries::fill_temperature(BlockFields& temperature,
                                  const std::vector<std::array<Field, 3>>& conductance) const {
  using Heat = BoundaryCondition::Heat;
  for (const BoundaryPatch& patch : patches_) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    const BoundaryCondition& c = condition(patch);
    Field& t = temperature[b];
    for (const BoundaryFace& face : patch.faces) {
      t[face.ghost] = t[face.cell];
      if (c.heat == Heat::temperature)
        t[face.ghost] = 2 * c.temperature - t[face.cell];
      else if (c.heat == Heat::flux)
        t[face.ghost] += c.heat_flux * norm(get(mesh_.local[b].area[d], face.face)) /
                         conductance[b][d][face.face];
    }
  }
}

double Boundaries::temperature_ghost_factor(const BoundaryPatch& patch) const {
  return condition(patch).heat == BoundaryCondition::Heat::temperature ? -1 : 1;
}

void Boundaries::fill_zero_gradient(BlockFields& field) const {
  for (const BoundaryPatch& patch : patches_)
    for (const BoundaryFace& face : patch.faces)
      field[std::size_t(patch.block)][face.ghost] = field[std::size_t(patch.block)][face.cell];
}

} // namespace granflux::cfd
