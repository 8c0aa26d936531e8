// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/mesh.hpp>

namespace granflux::cfd {

/// A scalar to be written beside the gas, by its name in the file (32 characters at most).
struct NamedField {
  std::string name;
  const BlockFields* values;
};
/// A vector; its components get X, Y and Z behind the name.
struct NamedVector {
  std::string name;
  const BlockVectors* values;
};

/// Writes fields on cell centres to CGNS files <path>_NNNNNN.cgns, one a time, with one zone for
/// each block and its nodes; ParaView opens them as one time series. The first file of a writer has
/// the boundaries as well, as families, and the links as one-to-one connections, so that
/// read_cgns_grid can read the grid back. A file appears under
/// its name only once it is complete. Values are in SI units. The mesh must outlive the writer.
class CgnsWriter {
public:
  /// `first`: number of the first file, for a run that continues. Throws ConfigError where the
  /// folder does not exist or is not writable. Collective.
  CgnsWriter(const Mesh& mesh, std::string path, long first = 0);

  /// Velocity [m/s], Pressure (dynamic, Pa), VoidFraction, Temperature [K] where it is solved for,
  /// and what else is given. Returns the file's name. Collective; throws NumericalError on all
  /// ranks where the file cannot be written.
  std::string write(const GasSolver& solver, const std::vector<NamedField>& extra = {});
  /// The same for any fields at a time [s].
  std::string write(double time, const std::vector<NamedVector>& vectors,
                    const std::vector<NamedField>& scalars);

  [[nodiscard]] long next() const { return next_; } ///< number of the next file

private:
  const Mesh& mesh_;
  std::string path_;
  long first_, next_;
};

} // namespace granflux::cfd
