// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <mpi.h>
#include <optional>
#include <string>
#include <vector>

#include <granflux/cfd/gas_case.hpp>
#include <granflux/cfd/stable_range.hpp>
#include <granflux/coupling/coupler.hpp>

#include "host.hpp"
#include "particle_bounds.hpp"
#include "particle_probe.hpp"

namespace granflux::driver {

/// The numbers that a coupled run stays stable by, followed from coupling step to coupling step,
/// and what is told of a run that fails (docs/reference/stable_range.md).
class StableRun {
public:
  StableRun(const cfd::GasCase& gas_case, const coupling::CouplingOptions& options);

  /// Once the mesh is there. Collective.
  void set_mesh(const cfd::Mesh& mesh, const cfd::GasSolver& gas);
  /// Before a run: properties of the contacts may have changed. Collective.
  void begin_run(Host& host) { times_ = host.contact_times(); }
  /// Before the particles meet the gas. Throws NumericalError on all ranks for the first that is
  /// not to be believed. time_step: of the particles, interval: of the gas [s]. Collective.
  void look(Host& host, const coupling::ParticleView& particles, double time_step, double interval,
            MPI_Comm comm);
  /// After the exchange over the interval that look() was told.
  void follow(const coupling::ExchangeReport& report);

  [[nodiscard]] std::string table() const { return range_.table("granflux: stable range"); }
  /// What has crossed its limit since the last call, each number once.
  [[nodiscard]] std::vector<std::string> new_warnings() { return range_.new_warnings(); }
  /// Of trouble in a step: the likely cause.
  [[nodiscard]] std::string likely_cause() const;

private:
  [[nodiscard]] double courant_of_inlets() const;
  void add_drag(const coupling::CouplingOptions& options);
  [[nodiscard]] std::string fewer_steps(double limit, double number) const;

  cfd::StableRange range_;
  ParticleBounds particle_bounds_;
  std::size_t courant_, friction_, drag_ = 0, cell_, void_fraction_, heat_ = 0, density_;
  std::optional<std::size_t> slip_; // where drag is explicit in the gas
  bool drag_of_step_ = false;       // the particle step counts, not the coupling interval
  std::vector<std::size_t> rows_;   // all of them
  const cfd::GasCase& gas_case_;
  bool with_heat_;
  ContactTimes times_;
  // Of the mesh.
  double least_cell_ = 0; // edge of a cube as large as the smallest cell [m]
  double inlet_courant_rate_ = 0, friction_rate_ = 0; // 1/s
  double courant_number_ = 0;                         // of the last exchange
  // Of the last look.
  double least_radius_ = 0, least_mass_ = 0; // of the particles that times_ is of
  double least_density_ = 0;                 // kg/m3
  double time_step_ = 0, interval_ = 0;      // s
};

} // namespace granflux::driver
