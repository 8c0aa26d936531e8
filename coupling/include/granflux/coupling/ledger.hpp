// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>
#include <vector>

#include <granflux/coupling/compensated_sum.hpp>
#include <granflux/coupling/coupler.hpp>

namespace granflux::coupling {

/// What one rank (or one thread of it) adds to the sums of one exchange.
struct ExchangeSums {
  double particles = 0, outside = 0, law_out_of_range = 0; ///< counts, exact in a double
  CompensatedSum particle_volume; ///< sum V_p of the coupled particles [m3]
  CompensatedSum solid_volume;    ///< sum (1 - eps) V of this rank's cells [m3]
  CompensatedVec3 drag;           ///< sum b_eff (u - v) [N]
  CompensatedVec3 pressure_force; ///< sum -V grad p [N]
  CompensatedVec3 booked;         ///< taken from the gas for the coming interval [N s]
  CompensatedVec3 handed_over;    ///< impulse less booked of the last interval [N s]
  CompensatedSum exchanged;       ///< sum of |booked| + |handed over| [N s]
  double slip_reynolds_max = 0, stiffness_max = 0, gas_drag_number_max = 0;
  double void_fraction_min = 1;
  // The same of heat.
  double nusselt_out_of_range = 0, heat_stiffness_max = 0;
  CompensatedSum heat_booked;      ///< taken from the gas for the coming interval [J]
  CompensatedSum heat_handed_over; ///< received less booked of the last interval [J]
  CompensatedSum heat_exchanged;   ///< sum of |booked| + |handed over| [J]

  ExchangeSums& operator+=(const ExchangeSums& o) &;
};

/// The books of the exchange: what the gas lost, what the particles received, and where the rest
/// is. Every sum is kept to twice the digits of a double, so that the books are the same on any
/// number of ranks and threads and the residuals are those of the method.
class Ledger {
public:
  explicit Ledger(MPI_Comm comm);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  /// Impulse that apply() gave to particles of this rank [N s]; negative when taken back.
  void received(const Vec3& impulse) { applied_ += impulse; }
  /// Heat that particles of this rank took [J].
  void received_heat(double heat) { heat_applied_ += heat; }

  /// Closes the books of one exchange: one reduction over all ranks, then fills the sums of
  /// `report`. `gas` is the balance of the gas step over `interval` [s]. Collective.
  void close(const ExchangeSums& local, const cfd::Balance& gas, double interval,
             ExchangeReport& report);

  /// Numbers that one rank saves.
  static std::size_t saved_numbers();
  [[nodiscard]] std::vector<double> save() const;
  /// Of what so many ranks have saved, one after the other; the same on all ranks. On another
  /// number of them rank 0 continues the books of all. Collective.
  void load(const std::vector<double>& all, std::size_t ranks);

private:
  struct Books;
  /// visit(sum, whether it is the same on all ranks) for every running sum.
  template <class Self, class Visit> static void for_sums(Self& self, Visit&& visit);
  static void add_books(void* in, void* inout, int* count, MPI_Datatype* type);
  void close_heat(const Books& all, double interval, ExchangeReport& report) const;

  MPI_Comm comm_;
  MPI_Datatype type_ = MPI_DATATYPE_NULL;
  MPI_Op op_ = MPI_OP_NULL;
  // Running sums of this rank since the start [N s].
  CompensatedVec3 applied_, booked_, handed_over_;
  CompensatedSum exchanged_;
  CompensatedVec3 from_gas_; ///< by the gas's own balance; the same on all ranks [N s]
  // And of heat [J].
  CompensatedSum heat_applied_, heat_booked_, heat_handed_over_, heat_exchanged_, heat_from_gas_;
};

} // namespace granflux::coupling
