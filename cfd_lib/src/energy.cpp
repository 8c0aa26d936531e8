// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "energy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
      spread_(make_fields(mesh)), spread_before_(make_fields(mesh)) {
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

void EnergyEquation::fill_ghosts(BlockFields& temperature,
                                 const FaceConductance& conductance) const {
  halo_.exchange({&temperature});
  boundaries_.fill_temperature(temperature, conductance);
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

/// Heat conducted into each cell, into `spread` [W], for the temperature with its ghosts filled;
/// returns what comes through this rank's boundaries.
double EnergyEquation::conduct(const FaceConductance& conductance, BlockFields& spread,
                               FaceFields& work) {
  double heat = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    diffusion(mesh_.local[b].layout, conductance[b], temperature_[b], spread[b]);
  for (const BoundaryPatch& patch : boundaries_.patches()) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    for (const BoundaryFace& face : patch.faces)
      heat +=
          conductance[b][d][face.face] * (temperature_[b][face.ghost] - temperature_[b][face.cell]);
  }
  if (mesh_.orthogonal || energy_.conductivity == 0)
    return heat;
  gradient(
      mesh_, halo_, boundaries_, [&](std::size_t b) -> const Field& { return temperature_[b]; },
      gradient_);
  return heat + add_cross_diffusion(
                    mesh_, boundaries_, conductance, gradient_,
                    [](const BoundaryCondition& c) {
                      return c.heat == BoundaryCondition::Heat::temperature;
                    },
                    work, [&](std::size_t b) -> Field& { return spread[b]; });
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

/// The new temperature, from rhs_ and spread_before_ (which lack the terms of the new temperature),
/// starting from the old one.
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
    fill_ghosts(temperature_, conductance_);
    conduct(conductance_, spread_, work);
    if (implicit_)
      convect_heat(flux, temperature_, work);
    double squares[2] = {0, 0}; // of the equation's terms, of its defect
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
        defect_[b][c] = rhs_[b][c] + 0.5 * spread_before_[b][c] -
                        inertia_[b][c] * temperature_[b][c] + 0.5 * spread_[b][c];
        if (implicit_)
          defect_[b][c] -= 0.5 * flow_[b][c];
      });
    squares[0] = sum([&](std::size_t b, std::ptrdiff_t c) {
      const double size = std::abs(rhs_[b][c] + 0.5 * spread_before_[b][c]) +
                          inertia_[b][c] * std::abs(temperature_[b][c]);
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

/// What conduction makes of the cells in a step of dt, into `number`: dt times the conductances of
/// a cell's faces, over its heat capacity at the step's start [-]. Up to 2, what Crank-Nicolson
/// leaves of the old temperature is positive. Returns the largest of all ranks.
double EnergyEquation::count_conduction(double dt, BlockFields& number) const {
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Diffusion through(mesh_.local[b].layout, conductance_[b]);
    for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) { number[b][c] = through.faces(c); });
  }
  for (const BoundaryPatch& patch : boundaries_.patches()) { // half as far as a ghost
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    if (boundaries_.condition(patch).heat == BoundaryCondition::Heat::temperature)
      for (const BoundaryFace& face : patch.faces)
        number[b][face.cell] += conductance_[b][d][face.face];
  }
  double most = 0;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Field& volume = mesh_.local[b].volume;
    for_cells(mesh_.local[b].layout,
              [&](std::ptrdiff_t c) { number[b][c] *= dt / (capacity_ * eps_[b][c] * volume[c]); });
    most = max_cells(mesh_.local[b].layout, most, [&](std::ptrdiff_t c) { return number[b][c]; });
  }
  MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, mesh_.comm);
  return most;
}

/// Whether a new temperature lies beyond all that it can come from: the old ones, those given at
/// boundaries, and what convection and the second phase alone would have made of them.
bool EnergyEquation::out_of_bounds() {
  constexpr double negligible = 1e-6; // of the largest temperature
  fill_ghosts(temperature_, conductance_);
  std::array<double, 4> most; // high and -low of what can be, then of what is
  most.fill(-std::numeric_limits<double>::max());
  for (const BoundaryPatch& patch : boundaries_.patches()) {
    using Heat = BoundaryCondition::Heat;
    const BoundaryCondition& condition = boundaries_.condition(patch);
    const Field& now = temperature_[std::size_t(patch.block)];
    for (const BoundaryFace& face : patch.faces) {
      if (condition.heat == Heat::adiabatic)
        continue;
      const double given =
          condition.heat == Heat::temperature ? condition.temperature : now[face.ghost];
      most[0] = std::max(most[0], given);
      most[1] = std::max(most[1], -given);
    }
  }
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Field &now = temperature_[b], &old = temperature_old_[b];
    const auto alone = [&](std::ptrdiff_t c) {
      return (rhs_[b][c] - (implicit_ ? 0.5 * flow_[b][c] : 0)) / inertia_[b][c];
    };
    const auto take = [&](std::size_t at, auto&& term) {
      most[at] = max_cells(mesh_.local[b].layout, most[at], term);
    };
    take(0, [&](std::ptrdiff_t c) { return std::max(old[c], alone(c)); });
    take(1, [&](std::ptrdiff_t c) { return -std::min(old[c], alone(c)); });
    take(2, [&](std::ptrdiff_t c) { return now[c]; });
    take(3, [&](std::ptrdiff_t c) { return -now[c]; });
  }
  MPI_Allreduce(MPI_IN_PLACE, most.data(), 4, MPI_DOUBLE, MPI_MAX, mesh_.comm);
  const double enough = negligible * std::max(std::abs(most[0]), std::abs(most[1]));
  return most[2] > most[0] + enough || most[3] > most[1] + enough;
}

/// Parts the conductances into those of the new and of the old temperature so that nothing negative
/// is left of the old one in any cell: as little beyond Crank-Nicolson's half as that takes.
/// `number` as count_conduction leaves it.
void EnergyEquation::part_conductance(BlockFields& number) {
  halo_.exchange({&number});
  boundaries_.fill_zero_gradient(number);
  conductance_before_ = conductance_;
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    for (std::size_t d = 0; d < 3; ++d)
      for_faces(mesh_.local[b].layout, int(d),
                [&, s = mesh_.local[b].layout.stride[d]](std::ptrdiff_t f) {
                  const double most = std::max(number[b][f - s], number[b][f]);
                  const double of_old = most > 2 ? 1 / most : 0.5;
                  conductance_before_[b][d][f] *= 2 * of_old;
                  conductance_[b][d][f] *= 2 * (1 - of_old);
                });
}

/// The new temperature from the old one, with the conductances as they are parted. Returns what was
/// conducted, and what left with the new temperature, through this rank's boundaries [W].
EnergyEquation::Crossed EnergyEquation::step(const FaceFields& flux, FaceFields& work) {
  const FaceConductance& before = conductance_before_.empty() ? conductance_ : conductance_before_;
  temperature_ = temperature_old_;
  fill_ghosts(temperature_, before);
  Crossed crossed;
  crossed.conducted = 0.5 * conduct(before, spread_before_, work);
  solve(flux, work);

  // As for momentum: what is applied is a divergence, whatever the tolerance.
  fill_ghosts(temperature_, conductance_);
  crossed.conducted += 0.5 * conduct(conductance_, spread_, work);
  if (implicit_)
    crossed.carried = 0.5 * convect_heat(flux, temperature_, work);
  for (std::size_t b = 0; b < mesh_.local.size(); ++b)
    for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
      const double carried = implicit_ ? 0.5 * flow_[b][c] : 0;
      temperature_[b][c] =
          (rhs_[b][c] + 0.5 * spread_before_[b][c] - carried + 0.5 * spread_[b][c]) /
          inertia_[b][c];
    });
  return crossed;
}

/// Crank-Nicolson; if that leaves the bounds, since conduction is fast for the step and
/// temperatures jump, the step is made anew with more of the new temperature where conduction is
/// fast.
EnergyEquation::Crossed EnergyEquation::bounded_step(double dt, const FaceFields& flux,
                                                     FaceFields& work) {
  conductance_before_.clear();
  const bool fast = count_conduction(dt, defect_) > 2;
  const Crossed crossed = step(flux, work);
  if (!fast || !out_of_bounds())
    return crossed;
  count_conduction(dt, defect_);
  part_conductance(defect_);
  return step(flux, work);
}

void EnergyEquation::advance(double dt, double ratio, const FaceFields& flux,
                             const BlockFields& eps, const BlockFields& eps_middle,
                             const BlockFields& eddy_viscosity, const HeatExchange* exchange,
                             FaceFields& work, Balance& balance) {
  set_conductance(eps_middle, eddy_viscosity);
  const double explicit_share = implicit_ ? 0.5 : 1; // of convection
  if (!implicit_)
    for (std::size_t b = 0; b < mesh_.local.size(); ++b)
      for_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
        middle_[b][c] =
            temperature_[b][c] + 0.5 * ratio * (temperature_[b][c] - temperature_old_[b][c]);
      });
  BlockFields& carried = implicit_ ? temperature_ : middle_;
  fill_ghosts(carried, conductance_);
  double outflow = explicit_share * convect_heat(flux, carried, work);
  for (std::size_t b = 0; b < mesh_.local.size(); ++b) {
    const Block& block = mesh_.local[b];
    for_cells(block.layout, [&](std::ptrdiff_t c) {
      const double volume = block.volume[c];
      inertia_[b][c] = capacity_ * eps[b][c] * volume / dt;
      rhs_[b][c] =
          capacity_ * eps_[b][c] * volume / dt * temperature_[b][c] - explicit_share * flow_[b][c];
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
  const Crossed crossed = bounded_step(dt, flux, work);
  outflow += crossed.carried;
  double exchanged = 0;
  for (std::size_t b = 0; b < mesh_.local.size() && exchange; ++b)
    exchanged += sum_cells(mesh_.local[b].layout, [&](std::ptrdiff_t c) {
      return mesh_.local[b].volume[c] *
             (exchange->source[b][c] - exchange->coefficient[b][c] * temperature_[b][c]);
    });
  fill_ghosts(temperature_, conductance_);
  const double heat = sum([&](std::size_t b, std::ptrdiff_t c) {
    return capacity_ * eps[b][c] * mesh_.local[b].volume[c] * temperature_[b][c];
  });
  double terms[] = {(heat - heat_before) / dt, -outflow, crossed.conducted, exchanged, heat / dt};
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
