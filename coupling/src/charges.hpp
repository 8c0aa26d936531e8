// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "grid_transfer.hpp"

namespace granflux::coupling {

/// What the gas is to be charged for each particle over an interval T: of momentum b_eff and
/// b_eff v - hand-over / T, of heat hA_eff and hA_eff T_p - hand-over / T. Both pass to the cells
/// together.
class Charges {
public:
  Charges(bool forces, bool heat) : of_momentum_(forces ? 4 : 0), of_heat_(heat ? 2 : 0) {}

  [[nodiscard]] bool forces() const { return of_momentum_ > 0; }
  [[nodiscard]] bool heat() const { return of_heat_ > 0; }

  void resize(std::size_t particles) { numbers_.resize((of_momentum_ + of_heat_) * particles); }
  /// Four numbers.
  [[nodiscard]] double* momentum(std::size_t p) { return &numbers_[(of_momentum_ + of_heat_) * p]; }
  /// Two numbers.
  [[nodiscard]] double* heat(std::size_t p) {
    return &numbers_[(of_momentum_ + of_heat_) * p + of_momentum_];
  }
  /// Where heat begins among the fields that deposit() leaves; momentum begins at 0.
  [[nodiscard]] std::size_t first_of_heat() const { return of_momentum_; }

  /// On gas cells, in transfer.work. Collective.
  void deposit(GridTransfer& transfer) const {
    if (forces() && heat())
      transfer.deposit<6>(numbers_);
    else if (forces())
      transfer.deposit<4>(numbers_);
    else if (heat())
      transfer.deposit<2>(numbers_);
  }

private:
  std::size_t of_momentum_, of_heat_; ///< numbers of each particle
  std::vector<double> numbers_;
};

} // namespace granflux::coupling
