// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "energy.hpp"

#include <algorithm>
#include <cmath>

#include <granflux/cfd/cross_diffusion.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/gradient.hpp>

namespace granflux::cfd {

EnergyEquation::EnergyEquation(const Mesh& mesh, const Halo& halo, const Boundaries& boundaries,
                               const Fluid& fluid, const Energy& energy, const Numerics& numerics)
    : mesh_(mesh), halo_(halo), boundaries_(boundaries), energy_(energy), numerics_(numerics),
      capacity_(fluid.density * energy.heat_capacity), solver_(mesh, boundaries),
      temperature_(make_fields(mesh)), temperature_old_(make_fields(mesh)),
      middle_(make_fields(mesh)), eps_(make_fields(mesh)), inertia_(make_fields(mesh)),
      rhs_(make_fields(mesh)), defect_(make_fields(mesh)), flow_(make_fields(mesh)),
      spread_(make_fields(mesh)) {
  for (const Block& block : mesh.local)
    conductance_.push_back({Field(block.layout), Field(block.layout), Field(block.layout)});
  if (!mesh.orthogonal)
    gradient_ = make_vectors(mesh);
  if (numerics.time_scheme == TimeScheme::implicit)
    implicit_ = std::make_unique<TransportSolver>(mesh, halo, boundaries);
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

void EnergyEquation::set_conductance(const BlockFields& eps_middle,
                                     const BlockFields& eddy_viscosity) {
  constexpr double turbulent_prandtl = 0.85;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Block& block = mesh_.local[b];
    for (std::size_t d = 0; d < 3; ++d) {
      const Field& w = block.weight[d];
      const std::ptrdiff_t s = block.layout.stride[d];
      const auto on_face = [&, s](const Field& q, std::ptrdiff_t f) {
        return q[f - s] + w[f] * (q[f] - q[f - s]);
      };
      for_faces(block.layout, int(d), [&](std::ptrdiff_t f) {
        double conductivity = energy_.conductivity;
        if (!eddy_viscosity.empty())
          conductivity += energy_.heat_capacity / turbulent_prandtl * on_face(eddy_viscosity[b], f);
        conductance_[b][d][f] = conductivity * block.conductance[d][f] * on_face(eps_middle[b], f);
      });
    }
  }
}

/// Heat conducted into each cell, into spread_ [W], for the temperature with its ghosts filled;
/// returns what comes through this rank's boundaries.
double EnergyEquation::conduct(FaceFields& work) {
  double heat = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    diffusion(mesh_.local[b].layout, conductance_[b], temperature_[b], spread_[b]);
  for (const BoundaryPatch& patch : boundaries_.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    for (const BoundaryFace& face : patch.faces)
      heat += conductance_[b][d][face.face] *
              (temperature_[b][face.ghost] - temperature_[b][face.cell]);
  }
  if (mesh_.orthogonal || energy_.conductivity == 0)
    return heat;
  gradient(
      mesh_, halo_, boundaries_, [&](std::size_t b) -> const Field& { return temperature_[b]; },
      gradient_);
  return heat + add_cross_diffusion(
                    mesh_, boundaries_, conductance_, gradient_,
                    [](const BoundaryCondition& c) {
                      return c.heat == BoundaryCondition::Heat::temperature;
                    },
                    work, [&](std::size_t b) -> Field& { return spread_[b]; });
}

/// Heat that leaves each cell with the flow, into flow_ [W]; returns what leaves through this
/// rank's boundaries. `carried` has its ghosts filled.
double EnergyEquation::convect_heat(const FaceFields& flux, const BlockFields& carried,
                                    FaceFields& work) {
  if (!mesh_.orthogonal)
    gradient(
        mesh_, halo_, boundaries_, [&](std::size_t b) -> const Field& { return carried[b]; },
        gradient_);
  return convect(numerics_.convection, mesh_, boundaries_, flux,
                 Carried{.at = [&](std::size_t b) -> const Field& { return carried[b]; },
                         .out = [&](std::size_t b) -> Field& { return flow_[b]; },
                         .factor = capacity_,
                         .backflow = [](const BoundaryCondition& c) { return c.temperature; },
                         .gradient = mesh_.orthogonal ? nullptr : &gradient_},
                 work);
}

/// The new temperature, from rhs_ (which lacks the terms of the new temperature), starting from
/// the old one.
void EnergyEquation::solve(const FaceFields& flux, FaceFields& work) {
  constexpr int most_passes = 200;
  // One solution does where the solver knows the whole operator.
  const bool once = mesh_.orthogonal && !implicit_;
  const Unknown unknown{"energy equation", [&](std::size_t b) -> Field& { return temperature_[b]; },
                        [&](const BoundaryPatch& patch, const BoundaryFace&) {
                          return boundaries_.temperature_ghost_factor(patch);
                        }};
  if (!implicit_)
    solver_.set_operator(inertia_, conductance_);
  double scale = 0;
  for (int pass = 0; pass < most_passes; ++pass) {
    fill_ghosts(temperature_);
    conduct(work);
    if (implicit_)
      convect_heat(flux, temperature_, work);
    double squares[2] = {0, 0}; // of the equation's terms, of its defect
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
        defect_[b][c] = rhs_[b][c] - inertia_[b][c] * temperature_[b][c] + 0.5 * spread_[b][c];
        if (implicit_)
          defect_[b][c] -= 0.5 * flow_[b][c];
      });
    squares[0] = sum([&](std::size_t b, std::ptrdiff_t c) {
      const double size = std::abs(rhs_[b][c]) + inertia_[b][c] * std::abs(temperature_[b][c]);
      return size * size;
    });
    squares[1] =
        sum([&](std::size_t b, std::ptrdiff_t c) { return defect_[b][c] * defect_[b][c]; });
    MPI_Allreduce(MPI_IN_PLACE, squares, 2, MPI_DOUBLE, MPI_SUM, mesh_.comm);
    if (!std::isfinite(squares[0] + squares[1]))
      throw NumericalError("energy equation: the temperature or its source is not a number");
    if (pass == 0)
      scale = std::sqrt(squares[0]);
    const double enough = numerics_.viscous_tolerance * scale, size = std::sqrt(squares[1]);
    if (size <= enough)
      return;
    if (implicit_) {
      implicit_->set_operator(inertia_, conductance_, flux, capacity_);
      implicit_->solve(unknown, defect_, 0.1, 0.5 * enough);
    } else {
      const double left =
          solver_.correct(unknown, defect_, size, once ? enough : std::max(enough, 0.05 * size))
              .left;
      if (once && left <= enough)
        return;
    }
  }
  throw NumericalError("energy equation: the temperature did not converge in " +
                       std::to_string(most_passes) + " passes: use a smaller time step");
}

void EnergyEquation::advance(double dt, double ratio, const FaceFields& flux,
                             const BlockFields& eps, const BlockFields& eps_middle,
                             const BlockFields& eddy_viscosity, const HeatExchange* exchange,
                             FaceFields& work, Balance& balance) {
  set_conductance(eps_middle, eddy_viscosity);
  fill_ghosts(temperature_);
  const double explicit_share = implicit_ ? 0.5 : 1; // of convection
  if (!implicit_) {
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
        middle_[b][c] =
            temperature_[b][c] + 0.5 * ratio * (temperature_[b][c] - temperature_old_[b][c]);
      });
    fill_ghosts(middle_);
  }
  double outflow = explicit_share * convect_heat(flux, implicit_ ? temperature_ : middle_, work);
  double conducted = 0.5 * conduct(work);
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Block& block = mesh_.local[b];
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      const double volume = block.volume[c];
      inertia_[b][c] = capacity_ * eps[b][c] * volume / dt;
      rhs_[b][c] = capacity_ * eps_[b][c] * volume / dt * temperature_[b][c] -
                   explicit_share * flow_[b][c] + 0.5 * spread_[b][c];
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
  solve(flux, work);

  // As for momentum: what is applied is a divergence, whatever the tolerance.
  fill_ghosts(temperature_);
  conducted += 0.5 * conduct(work);
  if (implicit_)
    outflow += 0.5 * convect_heat(flux, temperature_, work);
  double exchanged = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Block& block = mesh_.local[b];
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      const double carried = implicit_ ? 0.5 * flow_[b][c] : 0;
      temperature_[b][c] = (rhs_[b][c] - carried + 0.5 * spread_[b][c]) / inertia_[b][c];
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
