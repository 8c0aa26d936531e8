// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/mesh_quality.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include <granflux/cfd/deal_blocks.hpp>
#include <granflux/cfd/error.hpp>

#include "block_geometry.hpp"

namespace granflux::cfd {

namespace {

using Extreme = MeshQuality::Extreme;

/// As numbers that are large where they are worst, so that all reduce alike.
struct Worst {
  static constexpr double least = -std::numeric_limits<double>::infinity();
  Extreme small_volume{least, 0, {}}, large_volume{least, 0, {}}, angle{least, 0, {}},
      skewness{least, 0, {}}, aspect_ratio{least, 0, {}}, volume_jump{least, 0, {}};
};
constexpr int extremes = 6;
static_assert(sizeof(Worst) == extremes * sizeof(Extreme));

/// The first cell counts where several are equally bad.
void take(Extreme& worst, const Extreme& other) {
  if (other.value > worst.value ||
      (other.value == worst.value &&
       std::tie(other.block, other.cell) < std::tie(worst.block, worst.cell)))
    worst = other;
}

void measure_cell(const Block& block, const Index3& cell, Worst& worst) {
  const std::ptrdiff_t c = block.layout.at(cell);
  const double volume = block.volume[c];
  double widest = 0, narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t d = 0; d < 3; ++d) {
    const Vec3 across =
        0.5 * (get(block.area[d], c) + get(block.area[d], c + block.layout.stride[d]));
    widest = std::max(widest, volume / norm(across));
    narrowest = std::min(narrowest, volume / norm(across));
  }
  take(worst.small_volume, {-volume, block.id, cell});
  take(worst.large_volume, {volume, block.id, cell});
  take(worst.aspect_ratio, {widest / narrowest, block.id, cell});
}

/// The low face in direction d of the cell at `cell`, which may be one past the last.
void measure_face(const Block& block, int d, const Index3& cell, Worst& worst) {
  const std::ptrdiff_t high = block.layout.at(cell);
  const std::ptrdiff_t low = high - block.layout.stride[std::size_t(d)];
  const Vec3 area = get(block.area[std::size_t(d)], high);
  const Vec3 step = get(block.centre, high) - get(block.centre, low);
  const Vec3 to_face = low_face_centre(block, d, high) - get(block.centre, low);
  const double along = dot(area, step);
  Index3 owner = cell;
  if (cell[std::size_t(d)] == block.layout.cells[std::size_t(d)])
    --owner[std::size_t(d)];
  const double angle = std::atan2(norm(cross(area, step)), along) * 180 / std::numbers::pi;
  take(worst.angle, {angle, block.id, owner});
  const Vec3 pierced = (dot(area, to_face) / along) * step;
  take(worst.skewness, {norm(to_face - pierced) / norm(step), block.id, owner});
  const auto [small, large] = std::minmax({block.volume[low], block.volume[high]});
  take(worst.volume_jump, {large / small, block.id, owner});
}

std::string at(const Extreme& extreme) {
  return fmt::format("block {} cell ({}, {}, {})", extreme.block, extreme.cell[0], extreme.cell[1],
                     extreme.cell[2]);
}

} // namespace

MeshQuality measure_quality(const Mesh& mesh) {
  Worst worst;
  for (const Block& block : mesh.local) {
    const Index3 n = block.layout.cells;
    for (int k = 0; k <= n[2]; ++k)
      for (int j = 0; j <= n[1]; ++j)
        for (int i = 0; i <= n[0]; ++i) {
          const Index3 cell{i, j, k};
          const int past = (i == n[0]) + (j == n[1]) + (k == n[2]);
          if (past == 0)
            measure_cell(block, cell, worst);
          for (std::size_t d = 0; d < 3; ++d)
            if (past == int(cell[d] == n[d]))
              measure_face(block, int(d), cell, worst);
        }
  }
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  std::vector<Worst> all(static_cast<std::size_t>(ranks));
  MPI_Allgather(&worst, sizeof(Worst), MPI_BYTE, all.data(), sizeof(Worst), MPI_BYTE, mesh.comm);
  for (const Worst& other : all) {
    take(worst.small_volume, other.small_volume);
    take(worst.large_volume, other.large_volume);
    take(worst.angle, other.angle);
    take(worst.skewness, other.skewness);
    take(worst.aspect_ratio, other.aspect_ratio);
    take(worst.volume_jump, other.volume_jump);
  }
  worst.small_volume.value = -worst.small_volume.value;

  std::int64_t cells = 0;
  for (const BlockInfo& info : mesh.blocks)
    cells += cell_count(info.cells);
  return {cells,          worst.small_volume, worst.large_volume, worst.angle,
          worst.skewness, worst.aspect_ratio, worst.volume_jump};
}

std::string describe(const MeshQuality& q) {
  return fmt::format("mesh: {} cells of {:.3g} m3 ({})\n  to {:.3g} m3 ({});\n"
                     "  at most: non-orthogonality {:.1f} degrees ({}),\n"
                     "  skewness {:.2f} ({}), aspect ratio {:.3g} ({}),\n"
                     "  volume ratio of neighbours {:.2f} ({})",
                     q.cells, q.least_volume.value, at(q.least_volume), q.largest_volume.value,
                     at(q.largest_volume), q.non_orthogonality.value, at(q.non_orthogonality),
                     q.skewness.value, at(q.skewness), q.aspect_ratio.value, at(q.aspect_ratio),
                     q.volume_jump.value, at(q.volume_jump));
}

std::string quality_warning(const MeshQuality& quality) {
  const Extreme& worst = quality.non_orthogonality;
  if (!(worst.value <= largest_non_orthogonality))
    throw ConfigError(fmt::format(
        "grid: at {} the line between two centres makes {:.1f} degrees with the normal of their "
        "face: at most {} are allowed, since the part of the flux that the two do not see is tan "
        "of "
        "it times the rest",
        at(worst), worst.value, largest_non_orthogonality));
  if (worst.value <= doubtful_non_orthogonality)
    return {};
  return fmt::format("non-orthogonality {:.1f} degrees at {} is above {}: expect less accuracy and "
                     "more iterations",
                     worst.value, at(worst), doubtful_non_orthogonality);
}

} // namespace granflux::cfd
