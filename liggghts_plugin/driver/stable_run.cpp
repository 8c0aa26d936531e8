// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "stable_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/core.h>

#include <granflux/cfd/courant_limit.hpp>
#include <granflux/coupling/throw_together.hpp>

namespace granflux::driver {

namespace {

using cfd::Bound;

// docs/reference/stable_range.md tells where these come from.
constexpr double drag_limit = 1.5, drag_advised = 1;
constexpr double explicit_limit = 2, explicit_advised = 1;
constexpr double advised_cell = 3;                       // diameters
constexpr double density_limit = 1, density_advised = 2; // of (1-eps) / (2 eps)
constexpr double densest_packing = 1 - std::numbers::pi / (3 * std::numbers::sqrt2); // its voids

/// Cell over diameter that a void-fraction kernel needs; 0: any does.
double least_cell_of(const std::string& kernel) {
  return kernel == "centre" ? 3 : kernel == "divided" ? 2 : kernel == "smoothed" ? 0 : 1;
}

double least_cell_edge(const cfd::Mesh& mesh) {
  double least = Bound::none;
  for (const cfd::Block& block : mesh.local) {
    const auto [ni, nj, nk] = block.layout.cells;
    for (int k = 0; k < nk; ++k)
      for (int j = 0; j < nj; ++j)
        for (int i = 0; i < ni; ++i)
          least = std::min(least, block.volume[block.layout.at(i, j, k)]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_DOUBLE, MPI_MIN, mesh.comm);
  return std::cbrt(least);
}

} // namespace

/// Cure of a number that goes with the interval.
std::string StableRun::fewer_steps(double limit, double number) const {
  if (!(number > 0) || time_step_ == 0)
    return "couple_every";
  const double every = interval_ / time_step_ * limit / number;
  if (every >= 1)
    return every < 1e6 ? fmt::format("couple_every up to {}", int(every)) : "couple_every";
  return fmt::format("timestep up to {:.3g} with couple_every 1", time_step_ * every);
}

StableRun::StableRun(const cfd::GasCase& gas_case, const coupling::CouplingOptions& options)
    : particle_bounds_(range_), gas_case_(gas_case), with_heat_(gas_case.energy.has_value()) {
  const double courant = cfd::courant_limit(gas_case.numerics);
  courant_ = range_.add(cfd::courant_bound(gas_case.numerics, [this, courant](double number) {
    return fewer_steps(courant, number) + ", larger [grid] cells, or [numerics] time_scheme = "
                                          "\"implicit\"";
  }));
  friction_ = range_.add(cfd::friction_bound());
  add_drag(options);
  if (with_heat_)
    heat_ = range_.add({.name = "coupling interval / thermal time", .cure = [](double) {
                          return "nothing needed: heat is exchanged exactly";
                        }});
  const double least_cell = least_cell_of(options.void_fraction);
  cell_ = range_.add({.name = "smallest cell / largest diameter",
                      .limit = least_cell > 0 ? least_cell : Bound::none,
                      .advised = advised_cell,
                      .least = true,
                      .cure = [this, least_cell](double number) {
                        return least_cell == 0
                                   ? std::string("nothing needed: the kernel is wide enough")
                                   : fmt::format("[grid] cells of at least {:.3g} m, or [coupling] "
                                                 "void_fraction = \"smoothed\"",
                                                 least_cell_ * least_cell / number);
                      }});
  const std::string width =
      options.void_fraction == "smoothed"
          ? fmt::format("[coupling] smoothing_width above {:g}", options.smoothing_width)
          : "[coupling] void_fraction = \"smoothed\"";
  void_fraction_ =
      range_.add({.name = "least void fraction of a cell",
                  .limit = options.void_fraction_floor,
                  .advised = std::max(densest_packing, options.void_fraction_floor),
                  .least = true,
                  .cure = [width](double) { return width + ", or larger [grid] cells"; }});
  const coupling::ExchangeEffects& effects = options.effects;
  const bool explicit_pressure =
      options.model == coupling::MomentumModel::a && effects.pressure_gradient && effects.two_way;
  density_ = range_.add({.name = "density ratio / ((1-eps) / (2 eps))",
                         .limit = explicit_pressure ? density_limit : Bound::none,
                         .advised = density_advised,
                         .least = true,
                         .cure = [explicit_pressure](double) {
                           return explicit_pressure
                                      ? "[coupling] model = \"b\", or heavier particles"
                                      : "nothing needed: no explicit pressure force";
                         }});
  range_.forget(density_, "no particles yet");
  rows_.resize(range_.size());
  std::iota(rows_.begin(), rows_.end(), std::size_t(0));
}

void StableRun::add_drag(const coupling::CouplingOptions& options) {
  using coupling::DragTreatment;
  if (options.drag_treatment == DragTreatment::implicit_in_both) {
    drag_ = range_.add({.name = "coupling interval / response time",
                        .limit = drag_limit,
                        .advised = drag_advised,
                        .cure = [this](double number) {
                          return fewer_steps(drag_limit, number) +
                                 ", or fixed_group for particles that something holds";
                        }});
    return;
  }
  const char* const cure = ", or [coupling] drag_treatment = \"implicit\"";
  drag_of_step_ = true;
  drag_ = range_.add({.name = "DEM step / response time",
                      .limit = explicit_limit,
                      .advised = explicit_advised,
                      .cure = [this, cure](double number) {
                        const double step = number > 0 ? time_step_ * explicit_limit / number : 0;
                        return fmt::format("timestep up to {:.3g}{}", step, cure);
                      }});
  if (options.drag_treatment == DragTreatment::explicit_in_both && options.effects.two_way)
    slip_ = range_.add({.name = "coupling interval x decay rate of the slip",
                        .limit = explicit_limit,
                        .advised = explicit_advised,
                        .cure = [this, cure](double number) {
                          return fewer_steps(explicit_limit, number) + cure;
                        }});
}

void StableRun::set_mesh(const cfd::Mesh& mesh, const cfd::GasSolver& gas) {
  least_cell_ = least_cell_edge(mesh);
  inlet_courant_rate_ = cfd::courant_rate_of_inlets(mesh, gas_case_);
  friction_rate_ = gas.friction_rate();
}

void StableRun::look(Host& host, const coupling::ParticleView& particles, double time_step,
                     double interval, MPI_Comm comm) {
  time_step_ = time_step;
  interval_ = interval;
  const ParticleJudge judge{.time_step = time_step_,
                            .judge_path = particle_bounds_.contacts_beyond()};
  const ParticleProbe found = judge.look(particles, comm);
  if (found.least_radius < least_radius_ || found.least_mass < least_mass_ || least_radius_ == 0)
    begin_run(host); // others than before
  least_radius_ = found.least_radius;
  least_mass_ = found.least_mass;

  particle_bounds_.set(times_, time_step_, found.speed, found.speed_over_radius);
  if (found.largest_radius > 0)
    range_.set(cell_, least_cell_ / (2 * found.largest_radius));
  else
    range_.forget(cell_, "no particles yet");
  least_density_ = found.least_density;
  range_.set(friction_, friction_rate_ * interval_);
  range_.set(courant_, std::max(courant_number_, courant_of_inlets()));
  if (!found.good)
    coupling::throw_together<NumericalError>(comm, judge.complaint(particles));
}

/// What the gas would have by its inlets alone, or the number that its steps follow.
double StableRun::courant_of_inlets() const {
  const double followed = gas_case_.numerics.courant, number = inlet_courant_rate_ * interval_;
  return followed > 0 ? std::min(followed, number) : number;
}

void StableRun::follow(const coupling::ExchangeReport& report) {
  courant_number_ = report.gas.courant;
  range_.set(courant_, std::max(courant_number_, courant_of_inlets()));
  range_.set(drag_, report.stiffness_max * (drag_of_step_ ? time_step_ / interval_ : 1));
  if (slip_)
    range_.set(*slip_, report.gas_drag_number_max + report.stiffness_max);
  range_.set(void_fraction_, report.void_fraction_min);
  // Of the lightest free particle where they lie densest (docs/stability.md).
  if (const double eps = report.void_fraction_min; least_density_ > 0 && eps < 1)
    range_.set(density_, least_density_ / gas_case_.fluid.density * 2 * eps / (1 - eps));
  if (with_heat_)
    range_.set(heat_, report.heat_stiffness_max);
}

std::string StableRun::likely_cause() const {
  if (const std::string cause = range_.likely_cause(rows_); !cause.empty())
    return "likely cause: " + cause;
  return "no number of the stable range was beyond its limit: look at forces, velocities and "
         "temperatures that the script itself sets" +
         (times_.unknown.empty() ? "" : "; contact times are not known: " + times_.unknown);
}

} // namespace granflux::driver
