// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "energy.hpp"

#include <cmath>

#include <granflux/cfd/error.hpp>

namespace granflux::cfd {

EnergyEquation::EnergyEquation(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries,
                               const Fluid& fluid, const Energy& energy, const Numerics& numerics)
    : mesh_(mesh), halo_(halo), boundaries_(boundaries), energy_(energy), numerics_(numerics),
      capacity_(fluid.density * energy.heat_capacity), solver_(mesh, halo),
      temperature_(make_fields(mesh)), temperature_old_(make_fields(mesh)),
      middle_(make_fields(mesh)), eps_(make_fields(mesh)), inertia_(make_fields(mesh)),
      rhs_(make_fields(mesh)), defect_(make_fields(mesh)), flow_(make_fields(mesh)),
      spread_(make_fields(mesh)) {
  for (const Block& block : mesh.local)
    conductance_.push_back({Field(block.layout), Field(block.layout), Field(block.layout)});
  for (const BoundaryCondition& condition : boundaries.conditions())
    if (condition.heat == BoundaryCondition::Heat::flux && energy.conductivity == 0)
      throw ConfigError("boundary \"" + condition.name +
                        "\": a heat flux needs a conductivity above 0 in [energy]");
}

template <class Term> double EnergyEquation::sum(Term&& term) const {
  double total = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    total += sum_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) { return term(b, c); });
  return total;
}

void EnergyEquation::initialise() {
  temperature_ = temperature_old_ = make_fields(mesh_, energy_.initial_temperature);
}

void EnergyEquation::set_temperature(const BlockFields& temperature) {
  temperature_ = temperature_old_ = temperature;
}

void EnergyEquation::fill_ghosts(BlockFields& temperature) const {
  halo_.exchange({&temperature});
  boundaries_.fill_temperature(temperature, conductance_);
}

void EnergyEquation::set_conductance(const BlockFields& eps_middle) {
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Block& block = mesh_.local[b];
    const Field& eps = eps_middle[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const Field& w = block.weight[d];
      const std::ptrdiff_t s = block.layout.stride[d];
      for_faces(block.layout, int(d), [&, s](std::ptrdiff_t f) {
        conductance_[b][d][f] = energy_.conductivity * block.conductance[d][f] *
                                (eps[f - s] + w[f] * (eps[f] - eps[f - s]));
      });
    }
  }
}

/// Heat conducted into the gas through this rank's boundaries [W].
double EnergyEquation::boundary_conduction(const BlockFields& temperature) const {
  double heat = 0;
  for (const BoundaryPatch& patch : boundaries_.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    for (const BoundaryFace& face : patch.faces)
      heat +=
          conductance_[b][d][face.face] * (temperature[b][face.ghost] - temperature[b][face.cell]);
  }
  return heat;
}

void EnergyEquation::advance(double dt, double ratio, const FaceFields& flux,
                             const BlockFields& eps, const BlockFields& eps_middle,
                             const HeatExchange* exchange, FaceFields& work, Balance& balance) {
  set_conductance(eps_middle);
  fill_ghosts(temperature_);
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
      middle_[b][c] =
          temperature_[b][c] + 0.5 * ratio * (temperature_[b][c] - temperature_old_[b][c]);
    });
  fill_ghosts(middle_);
  const Carried carried{.at = [&](std::size_t b) -> const Field& { return middle_[b]; },
                        .out = [&](std::size_t b) -> Field& { return flow_[b]; },
                        .factor = capacity_,
                        .backflow = [](const BoundaryCondition& c) { return c.temperature; }};
  const double outflow = convect(numerics_.convection, mesh_, boundaries_, flux, carried, work);

  double conducted = 0.5 * boundary_conduction(temperature_);
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Block& block = mesh_.local[b];
    diffusion(block.layout, conductance_[b], temperature_[b], spread_[b]);
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      const double volume = block.volume[c];
      inertia_[b][c] = capacity_ * eps[b][c] * volume / dt;
      rhs_[b][c] = capacity_ * eps_[b][c] * volume / dt * temperature_[b][c] - flow_[b][c] +
                   0.5 * spread_[b][c];
      if (exchange) {
        inertia_[b][c] += exchange->coefficient[b][c] * volume;
        rhs_[b][c] += exchange->source[b][c] * volume;
      }
    });
  }
  const double heat_before = sum([&](std::size_t b, std::ptrdiff_t c) {
    return capacity_ * eps_[b][c] * mesh_.local[b].volume[c] * temperature_[b][c];
  });
  temperature_old_ = temperature_;

  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
      defect_[b][c] = rhs_[b][c] - inertia_[b][c] * temperature_[b][c] + 0.5 * spread_[b][c];
    });
  double scale = sum([&](std::size_t b, std::ptrdiff_t c) {
    const double size = std::abs(rhs_[b][c]) + inertia_[b][c] * std::abs(temperature_[b][c]);
    return size * size;
  });
  MPI_Allreduce(MPI_IN_PLACE, &scale, 1, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  if (!std::isfinite(scale))
    throw NumericalError("energy equation: the temperature or its source is not a number");
  const DiffusionSolver::Unknown unknown{
      "energy equation", [&](std::size_t b) -> Field& { return temperature_[b]; },
      [&](BlockFields& q) { boundaries_.fill_temperature_correction(q); }};
  if (scale > 0)
    solver_.solve(unknown, inertia_, conductance_, defect_, std::sqrt(scale),
                  numerics_.viscous_tolerance);

  // As for momentum: the conduction that is applied is a divergence, whatever the tolerance.
  fill_ghosts(temperature_);
  conducted += 0.5 * boundary_conduction(temperature_);
  double exchanged = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Block& block = mesh_.local[b];
    diffusion(block.layout, conductance_[b], temperature_[b], spread_[b]);
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      temperature_[b][c] = (rhs_[b][c] + 0.5 * spread_[b][c]) / inertia_[b][c];
    });
    if (exchange)
      exchanged += sum_cells(block.layout, [&](std::ptrdiff_t c) {
        return block.volume[c] *
               (exchange->source[b][c] - exchange->coefficient[b][c] * temperature_[b][c]);
      });
  }
  fill_ghosts(temperature_);
  const double heat = sum([&](std::size_t b, std::ptrdiff_t c) {
    return capacity_ * eps[b][c] * mesh_.local[b].volume[c] * temperature_[b][c];
  });
  double terms[] = {(heat - heat_before) / dt, -outflow, conducted, exchanged, heat / dt};
  MPI_Allreduce(MPI_IN_PLACE, terms, 5, MPI_DOUBLE, MPI_SUM, mesh_.comm);
  balance.heat_change = terms[0];
  balance.heat_convection = terms[1];
  balance.heat_conduction = terms[2];
  balance.heat_exchange = terms[3];
  balance.heat_residual = terms[0] - terms[1] - terms[2] - terms[3];
  balance.heat_scale = 0;
  for (const double term : terms)
    balance.heat_scale += std::abs(term);
}

} // namespace granflux::cfd
