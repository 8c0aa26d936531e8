// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/coupler.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/coupling/ledger.hpp>
#include <granflux/coupling/throw_together.hpp>

#include "heat_transfer.hpp"
#include "momentum_transfer.hpp"
#include "stopwatch.hpp"
#include "text_of_number.hpp"
#include "void_fraction.hpp"

// The steps of an exchange and their order; what each does stands in the parts.

namespace granflux::coupling {

struct Coupler::Impl {
  Impl(const cfd::GasCase& c, const CouplingOptions& o, MPI_Comm comm)
      : gas_case(c), options(checked(o)), mesh(cfd::make_mesh(c, comm)), halo(mesh), gas(mesh, c),
        transfer(mesh, halo, options, times), void_fraction(mesh, o.void_fraction_floor),
        at_particles(options, gas, transfer), charges(o.effects.any_force(), c.energy.has_value()),
        momentum(parts()), heat(parts(), gas_case), ledger(comm) {}

  static const CouplingOptions& checked(const CouplingOptions& options);
  TransferParts parts() { return {options, gas, transfer, at_particles, charges}; }
  void check(const ParticleView& view) const;

  void advance_alone(double interval);
  void leave_alone(const ParticleView& view, double interval, ExchangeSums& sums);
  void exchange_two_way(const ParticleView& view, double interval, ExchangeSums& sums);
  void exchange_one_way(const ParticleView& view, double interval, ExchangeSums& sums);

  cfd::GasCase gas_case;
  CouplingOptions options;
  CouplingTimes times;
  cfd::Mesh mesh;
  cfd::Halo halo;
  cfd::GasSolver gas;
  GridTransfer transfer;
  VoidFraction void_fraction;
  GasAtParticles at_particles;
  Charges charges;
  MomentumTransfer momentum;
  HeatTransfer heat;
  Ledger ledger;
  ExchangeReport report;
  bool initialised = false;
  bool displaced = false; ///< void_fraction is not 1 everywhere
};

const CouplingOptions& Coupler::Impl::checked(const CouplingOptions& options) {
  if (!(options.coarse_graining >= 1 && std::isfinite(options.coarse_graining)))
    throw ConfigError("coupling: coarse_graining = " + text(options.coarse_graining) +
                      " must be 1 or more: diameter of a parcel over that of its particles");
  return options;
}

/// What particles must be before they are looked at.
void Coupler::Impl::check(const ParticleView& view) const {
  std::string complaint = heat.complaint_about(view);
  if (view.size() > transfer.most_particles())
    complaint = "coupling: " + std::to_string(view.size()) + " particles on one rank; with " +
                "void_fraction = \"" + options.void_fraction + "\" on this grid a rank takes " +
                std::to_string(transfer.most_particles()) + " at most: use more ranks";
  throw_together<ConfigError>(mesh.comm, complaint);
}

/// Gas in which no particle is, nor counts. Where the last one has just gone, the pressure still
/// works on a void fraction below 1: the gas bears all of it.
void Coupler::Impl::advance_alone(double interval) {
  const bool just_left = displaced;
  if (just_left) {
    for (cfd::Field& block : void_fraction.field)
      block.fill(1);
    momentum.free_gas();
    displaced = false;
  }
  const Stopwatch watch(times.gas);
  report.gas =
      gas.advance(interval, void_fraction.field, just_left ? &momentum.on_gas() : nullptr, nullptr);
}

/// No coupled particle is in the grid: the gas costs what it costs without any.
void Coupler::Impl::leave_alone(const ParticleView& view, double interval, ExchangeSums& sums) {
  sums.outside = double(transfer.weights().outside_count());
  std::fill(view.fluid.begin(), view.fluid.end(), FluidState{});
  std::fill(view.heat.begin(), view.heat.end(), HeatState{});
  advance_alone(interval);
}

void Coupler::Impl::exchange_two_way(const ParticleView& view, double interval,
                                     ExchangeSums& sums) {
  void_fraction.find(view, transfer, sums);
  displaced = true;
  at_particles.sample_before(void_fraction.field);
  {
    const Stopwatch watch(times.laws);
    charges.resize(view.size());
    sums += momentum.charge(view, interval);
    if (charges.heat())
      sums += heat.charge(view, interval);
  }
  charges.deposit(transfer);
  if (charges.forces())
    momentum.hand_to_gas(void_fraction.field, interval, sums);
  if (charges.heat())
    heat.hand_to_gas();
  {
    const Stopwatch watch(times.gas);
    report.gas = gas.advance(interval, void_fraction.field, &momentum.on_gas(),
                             charges.heat() ? &heat.on_gas() : nullptr);
  }
  if (charges.forces() || charges.heat())
    at_particles.sample_after();
  const Stopwatch watch(times.laws);
  if (charges.forces())
    sums += momentum.book(view, interval);
  if (charges.heat())
    sums += heat.book(view, interval);
}

void Coupler::Impl::exchange_one_way(const ParticleView& view, double interval,
                                     ExchangeSums& sums) {
  sums.particles = double(transfer.weights().placed_count());
  sums.outside = double(transfer.weights().outside_count());
  advance_alone(interval);
  at_particles.sample_after();
  const Stopwatch watch(times.laws);
  sums += momentum.act(view, interval);
  if (charges.heat())
    sums += heat.act(view, interval);
  sums.solid_volume = sums.particle_volume; // nothing is deposited
}

Coupler::Coupler(const cfd::GasCase& gas_case, const CouplingOptions& options, MPI_Comm comm)
    : impl_(std::make_unique<Impl>(gas_case, options, comm)) {}
Coupler::~Coupler() = default;

void Coupler::initialise(const ParticleView& view, double time) {
  Impl& s = *impl_;
  s.check(view);
  s.transfer.locate(view);
  std::string complaint;
  for (std::size_t p = 0; p < view.size() && s.transfer.weights().outside_count() > 0; ++p) {
    if (s.transfer.placed(p) || (!view.coupled.empty() && !view.coupled[p]))
      continue;
    const auto& [low, high, periodic] = extent();
    complaint = "coupling: particle " + (view.id.empty() ? "" : std::to_string(view.id[p]) + " ") +
                "at " + text(view.position[p]) +
                " m lies outside the gas grid, whose extent is from " + text(low) + " to " +
                text(high) + " m";
    break;
  }
  throw_together<ConfigError>(s.mesh.comm, complaint);

  for (std::size_t p = 0; p < view.size(); ++p)
    view.fluid[p] = {};
  std::fill(view.heat.begin(), view.heat.end(), HeatState{});
  if (s.options.effects.two_way) {
    ExchangeSums sums;
    s.void_fraction.find(view, s.transfer, sums);
    s.displaced = s.transfer.any_placed();
  }
  s.gas.initialise(s.void_fraction.field, s.gas_case.initial_velocity, time);
  s.initialised = true;
}

const ExchangeReport& Coupler::exchange(const ParticleView& view, double interval) {
  Impl& s = *impl_;
  if (!s.initialised)
    throw std::logic_error("Coupler::exchange needs initialise() or load() first");
  s.check(view);
  s.transfer.locate(view);
  ExchangeSums sums;
  if (!s.transfer.any_placed())
    s.leave_alone(view, interval, sums);
  else if (s.options.effects.two_way)
    s.exchange_two_way(view, interval, sums);
  else
    s.exchange_one_way(view, interval, sums);
  s.ledger.close(sums, s.gas.balance(), interval, s.report);
  return s.report;
}

void Coupler::apply(const ParticleView& view, double dt, double share) {
  Impl& s = *impl_;
  if (!s.options.effects.any_force())
    return;
  const Stopwatch watch(s.times.force);
  s.ledger.received(s.momentum.apply(view, dt, share));
}

void Coupler::received_heat(double heat) {
  if (impl_->options.effects.two_way)
    impl_->ledger.received_heat(heat);
}

void Coupler::unapply(const ParticleView& view, double dt, double share) {
  Impl& s = *impl_;
  if (s.options.effects.two_way && s.options.effects.any_force())
    s.ledger.received(s.momentum.unapply(view, dt, share));
}

const ExchangeReport& Coupler::report() const {
  return impl_->report;
}
const CouplingTimes& Coupler::times() const {
  return impl_->times;
}
long Coupler::numbers_sent() const {
  return impl_->transfer.numbers_sent();
}
cfd::GasSolver& Coupler::gas() {
  return impl_->gas;
}
const GridExtent& Coupler::extent() const {
  return impl_->transfer.extent();
}
const cfd::Mesh& Coupler::mesh() const {
  return impl_->mesh;
}

std::uint64_t Coupler::saved_numbers() const {
  int ranks = 1;
  MPI_Comm_size(impl_->mesh.comm, &ranks);
  return 2 + std::uint64_t(ranks) * Ledger::saved_numbers() + impl_->gas.saved_numbers();
}

void Coupler::save(cfd::RecordWriter* out) const {
  const MPI_Comm comm = impl_->mesh.comm;
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const std::vector<double> mine = impl_->ledger.save();
  std::vector<double> all(out ? mine.size() * std::size_t(ranks) : 0);
  MPI_Gather(mine.data(), int(mine.size()), MPI_DOUBLE, all.data(), int(mine.size()), MPI_DOUBLE, 0,
             comm);
  if (out) {
    out->write(impl_->transfer.smoothing_diameter());
    out->write(double(ranks));
    out->write(all);
  }
  impl_->gas.save(out);
}

void Coupler::load(cfd::RecordReader* in) {
  const MPI_Comm comm = impl_->mesh.comm;
  std::array<double, 2> numbers{}; // smoothing diameter, ranks
  std::vector<double> ledgers;
  std::string complaint;
  if (in)
    try {
      numbers = {in->read(), double(in->read_count(in->left()))};
      ledgers.resize(std::size_t(numbers[1]) * Ledger::saved_numbers());
      in->read(ledgers);
    } catch (const ConfigError& e) {
      complaint = e.what();
    }
  throw_together<ConfigError>(comm, complaint);
  MPI_Bcast(numbers.data(), int(numbers.size()), MPI_DOUBLE, 0, comm);
  const auto ranks = std::size_t(numbers[1]);
  ledgers.resize(ranks * Ledger::saved_numbers());
  MPI_Bcast(ledgers.data(), int(ledgers.size()), MPI_DOUBLE, 0, comm);
  impl_->transfer.restore_smoothing_diameter(numbers[0]);
  impl_->ledger.load(ledgers, ranks);
  impl_->gas.load(in);
  impl_->initialised = true;
}

} // namespace granflux::coupling
