// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/gas_solver.hpp>

namespace granflux::cfd {

/// Writes the force of the gas on every wall of a case after every step: a table of comma-separated
/// values, one column for the time [s] and three [N] for each wall.
class ForceHistory {
public:
  /// Does nothing for an empty path. A run that `continues` adds to the file. Collective; throws
  /// ConfigError where the file cannot be written or the case has no wall.
  ForceHistory(const GasCase& gas_case, const std::string& path, bool continues, MPI_Comm comm) {
    if (path.empty())
      return;
    for (const BoundaryCondition& condition : gas_case.boundaries)
      if (condition.kind == BoundaryKind::wall)
        walls_.push_back(condition.name);
    if (walls_.empty())
      throw ConfigError("--forces " + path + ": the case has no wall");
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    writes_ = rank == 0;
    if (writes_) {
      file_.open(path, continues ? std::ios::app : std::ios::trunc);
      if (!continues)
        write_heading();
    }
    check(path, comm);
  }

  /// Collective.
  void add(const GasSolver& gas) {
    if (walls_.empty())
      return;
    std::string line = fmt::format("{:.9g}", gas.time());
    for (const std::string& wall : walls_) {
      const Vec3 force = gas.boundary_force(wall);
      line += fmt::format(",{:.9g},{:.9g},{:.9g}", force.x, force.y, force.z);
    }
    if (writes_)
      file_ << line << '\n';
  }

private:
  void write_heading() {
    file_ << "time";
    for (const std::string& wall : walls_)
      for (const char axis : {'x', 'y', 'z'})
        file_ << ',' << quoted(wall + " " + axis);
    file_ << '\n';
  }
  /// A name may hold commas and quotation marks.
  static std::string quoted(const std::string& name) {
    std::string out = "\"";
    for (const char c : name)
      out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + '"';
  }
  void check(const std::string& path, MPI_Comm comm) {
    int good = file_.good();
    MPI_Bcast(&good, 1, MPI_INT, 0, comm);
    if (!good)
      throw ConfigError("--forces " + path + ": cannot be written");
  }

  std::vector<std::string> walls_;
  bool writes_ = false;
  std::ofstream file_;
};

} // namespace granflux::cfd
