// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// The extremes of a mesh, each with the cell where it is found; of a face, that is one of its two.
struct MeshQuality {
  struct Extreme {
    double value = 0;
    int block = 0;
    Index3 cell{};
  };
  std::int64_t cells = 0;
  Extreme least_volume, largest_volume; ///< m3
  /// Angle between a face's normal and the line between the centres on its two sides [degrees].
  Extreme non_orthogonality;
  /// Distance from a face's centre to where that line pierces it, over the line's length.
  Extreme skewness;
  /// Largest over least width of a cell, a width being volume over area across it.
  Extreme aspect_ratio;
  Extreme volume_jump; ///< larger over smaller volume of two neighbours
};

/// Collective; all ranks get the same.
MeshQuality measure_quality(const Mesh& mesh);

/// All of it in one paragraph.
std::string describe(const MeshQuality& quality);

/// What a face's two cells do not see of the flux through it is tan(non-orthogonality) times what
/// they see. Beyond these angles that is 2.7 and 11 times: accuracy suffers, and then the
/// solution of the implicit equations fails.
inline constexpr double doubtful_non_orthogonality = 70, largest_non_orthogonality = 85; // degrees

/// A sentence where the non-orthogonality is doubtful, else empty. Throws ConfigError above the
/// largest.
std::string quality_warning(const MeshQuality& quality);

} // namespace granflux::cfd
