// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/ledger.hpp>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace granflux::coupling {

/// All that travels in the one reduction of an exchange.
struct Ledger::Books {
  ExchangeSums sums;
  CompensatedVec3 applied, booked_before, handed_over_before;
  CompensatedSum exchanged_before;
  CompensatedSum heat_applied, heat_booked_before, heat_handed_over_before, heat_exchanged_before;

  Books& operator+=(const Books& o) & {
    sums += o.sums;
    applied += o.applied;
    booked_before += o.booked_before;
    handed_over_before += o.handed_over_before;
    exchanged_before += o.exchanged_before;
    heat_applied += o.heat_applied;
    heat_booked_before += o.heat_booked_before;
    heat_handed_over_before += o.heat_handed_over_before;
    heat_exchanged_before += o.heat_exchanged_before;
    return *this;
  }
};

void Ledger::add_books(void* in, void* inout, int* count, MPI_Datatype*) {
  static_assert(std::is_trivially_copyable_v<Books>);
  for (int i = 0; i < *count; ++i) {
    Books a, b;
    char* at = static_cast<char*>(inout) + std::size_t(i) * sizeof(Books);
    std::memcpy(&a, static_cast<char*>(in) + std::size_t(i) * sizeof(Books), sizeof a);
    std::memcpy(&b, at, sizeof b);
    a += b; // in rank order: the lower ranks' sum comes first
    std::memcpy(at, &a, sizeof a);
  }
}

ExchangeSums& ExchangeSums::operator+=(const ExchangeSums& o) & {
  particles += o.particles;
  outside += o.outside;
  law_out_of_range += o.law_out_of_range;
  particle_volume += o.particle_volume;
  solid_volume += o.solid_volume;
  drag += o.drag;
  pressure_force += o.pressure_force;
  booked += o.booked;
  handed_over += o.handed_over;
  exchanged += o.exchanged;
  slip_reynolds_max = std::max(slip_reynolds_max, o.slip_reynolds_max);
  stiffness_max = std::max(stiffness_max, o.stiffness_max);
  gas_drag_number_max = std::max(gas_drag_number_max, o.gas_drag_number_max);
  void_fraction_min = std::min(void_fraction_min, o.void_fraction_min);
  nusselt_out_of_range += o.nusselt_out_of_range;
  heat_stiffness_max = std::max(heat_stiffness_max, o.heat_stiffness_max);
  heat_booked += o.heat_booked;
  heat_handed_over += o.heat_handed_over;
  heat_exchanged += o.heat_exchanged;
  return *this;
}

Ledger::Ledger(MPI_Comm comm) : comm_(comm) {
  MPI_Type_contiguous(int(sizeof(Books)), MPI_BYTE, &type_);
  MPI_Type_commit(&type_);
  MPI_Op_create(add_books, 0, &op_);
}

Ledger::~Ledger() {
  MPI_Op_free(&op_);
  MPI_Type_free(&type_);
}

/// As for momentum, below.
void Ledger::close_heat(const Books& all, double interval, ExchangeReport& report) const {
  const ExchangeSums& sums = all.sums;
  report.nusselt_out_of_range = long(sums.nusselt_out_of_range);
  report.heat_stiffness_max = sums.heat_stiffness_max;
  report.heat_rate = (sums.heat_booked.value() + sums.heat_handed_over.value()) / interval;
  CompensatedSum missing = all.heat_booked_before;
  missing += all.heat_handed_over_before;
  missing += sums.heat_handed_over;
  missing += -all.heat_applied;
  report.heat_to_particles = all.heat_applied.value();
  report.heat_in_transit = sums.heat_booked.value();
  report.heat_carried_out = missing.value();
  report.heat_from_gas = heat_from_gas_.value();
  const double remainder = report.heat_from_gas - report.heat_to_particles -
                           report.heat_in_transit - report.heat_carried_out;
  CompensatedSum exchanged = all.heat_exchanged_before;
  exchanged += sums.heat_exchanged;
  report.heat_residual = remainder == 0 ? 0 : std::abs(remainder) / exchanged.value();
}

void Ledger::close(const ExchangeSums& local, const cfd::Balance& gas, double interval,
                   ExchangeReport& report) {
  Books mine{local,         applied_,     booked_,           handed_over_,   exchanged_,
             heat_applied_, heat_booked_, heat_handed_over_, heat_exchanged_};
  booked_ += local.booked;
  handed_over_ += local.handed_over;
  exchanged_ += local.exchanged;
  from_gas_ += -interval * gas.exchange;
  heat_booked_ += local.heat_booked;
  heat_handed_over_ += local.heat_handed_over;
  heat_exchanged_ += local.heat_exchanged;
  heat_from_gas_ += -interval * gas.heat_exchange;

  Books all;
  MPI_Allreduce(&mine, &all, 1, type_, op_, comm_);
  const ExchangeSums& sums = all.sums;

  report.particles = long(sums.particles);
  report.outside = long(sums.outside);
  report.law_out_of_range = long(sums.law_out_of_range);
  report.slip_reynolds_max = sums.slip_reynolds_max;
  report.stiffness_max = sums.stiffness_max;
  report.gas_drag_number_max = sums.gas_drag_number_max;
  report.void_fraction_min = sums.void_fraction_min;
  report.particle_volume = sums.particle_volume.value();
  const double volume_error = std::abs(sums.solid_volume.value() - report.particle_volume);
  report.volume_residual = volume_error > 0 ? volume_error / report.particle_volume : 0;
  report.pressure_force = sums.pressure_force.value();
  report.drag = sums.drag.value() + sums.handed_over.value() / interval;

  // For particles still here, last interval's booked less impulse is -handed_over. What running
  // sums miss beyond that went with the particles that are no longer here.
  CompensatedVec3 missing = all.booked_before;
  missing += all.handed_over_before;
  missing += sums.handed_over;
  missing += -all.applied;
  report.impulse_to_particles = all.applied.value();
  report.in_transit = sums.booked.value();
  report.carried_out = missing.value();
  report.impulse_from_gas = from_gas_.value();

  const Vec3 remainder = report.impulse_from_gas - report.impulse_to_particles - report.in_transit -
                         report.carried_out;
  CompensatedSum exchanged = all.exchanged_before;
  exchanged += sums.exchanged;
  const double scale = exchanged.value();
  report.momentum_residual = norm(remainder) > 0 ? norm(remainder) / scale : 0;

  close_heat(all, interval, report);

  // Gas and particles as one: the gas's own terms against what the particles' side booked.
  const Vec3 to_particles = (sums.booked.value() + sums.handed_over.value()) / interval;
  const Vec3 open = gas.momentum_change - gas.convection - gas.friction - gas.pressure -
                    gas.driving + to_particles;
  report.budget_residual = norm(open) > 0 ? norm(open) / gas.momentum_scale : 0;
}

template <class Self, class Visit> void Ledger::for_sums(Self& self, Visit&& visit) {
  for (auto* heat : {&self.heat_applied_, &self.heat_booked_, &self.heat_handed_over_,
                     &self.heat_exchanged_, &self.exchanged_})
    visit(*heat, false);
  for (auto* impulse : {&self.applied_, &self.booked_, &self.handed_over_})
    for (auto* component : {&impulse->x, &impulse->y, &impulse->z})
      visit(*component, false);
  for (auto* sum : {&self.heat_from_gas_, &self.from_gas_.x, &self.from_gas_.y, &self.from_gas_.z})
    visit(*sum, true);
}

std::size_t Ledger::saved_numbers() {
  constexpr std::size_t sums = 5 + 3 * 3 + 4;
  return 2 * sums;
}

std::vector<double> Ledger::save() const {
  std::vector<double> state;
  for_sums(*this, [&](const CompensatedSum& sum, bool) {
    state.push_back(sum.high);
    state.push_back(sum.low);
  });
  return state;
}

void Ledger::load(const std::vector<double>& all, std::size_t ranks) {
  int rank = 0, ranks_now = 1;
  MPI_Comm_rank(comm_, &rank);
  MPI_Comm_size(comm_, &ranks_now);
  const bool as_many = ranks == std::size_t(ranks_now);
  std::size_t at = 0;
  for_sums(*this, [&](CompensatedSum& sum, bool same_on_all) {
    const auto of_rank = [&](std::size_t r) {
      const double* numbers = &all[r * saved_numbers() + at];
      return CompensatedSum{numbers[0], numbers[1]};
    };
    sum = as_many ? of_rank(std::size_t(rank)) : same_on_all ? of_rank(0) : CompensatedSum{};
    for (std::size_t r = 0; r < ranks && !as_many && !same_on_all && rank == 0; ++r)
      sum += of_rank(r);
    at += 2;
  });
}

} // namespace granflux::coupling
