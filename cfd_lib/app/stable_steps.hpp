// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <granflux/cfd/courant_limit.hpp>
#include <granflux/cfd/gas_solver.hpp>

namespace granflux::cfd {

/// The numbers that the gas alone stays stable by, before and during a run.
class StableSteps {
public:
  /// `step`: the first [s]. Collective.
  StableSteps(const GasCase& gas_case, const GasSolver& gas, double step)
      : step_(step), friction_rate_(gas.friction_rate()) {
    const double limit = courant_limit(gas_case.numerics);
    courant_ = range_.add(courant_bound(gas_case.numerics, [this, limit](double number) {
      const double longest = number > limit ? step_ * limit / number : step_;
      return fmt::format("[numerics] time_step {:.3g} or less, or courant = {:g}", longest,
                         0.8 * limit);
    }));
    friction_ = range_.add(friction_bound());
    const double rate = std::max(gas.courant_rate(), courant_rate_of_inlets(gas.mesh(), gas_case));
    const double followed = gas_case.numerics.courant;
    range_.set(courant_, followed > 0 ? std::min(followed, rate * step) : rate * step);
    range_.set(friction_, friction_rate_ * step);
  }
  StableSteps(const StableSteps&) = delete; // its rows hold a pointer to it
  StableSteps& operator=(const StableSteps&) = delete;

  [[nodiscard]] std::string table() const { return range_.table("stable range"); }
  /// What has crossed its limit since the last call, each number once.
  std::vector<std::string> new_warnings() { return range_.new_warnings(); }

  /// After a step.
  void follow(const StepReport& report, double step) {
    step_ = step;
    range_.set(courant_, report.courant);
    range_.set(friction_, friction_rate_ * step);
  }

  /// Whether the state of the last step may be kept: at twice the limit waves double within a few
  /// steps.
  [[nodiscard]] bool believable() const { return range_.share(courant_) <= 2; }

  /// Of a step that failed, by the numbers of the last one that did not.
  [[nodiscard]] std::string likely_cause() const {
    if (const std::string cause = range_.likely_cause({courant_}); !cause.empty())
      return "likely cause: " + cause;
    return "all numbers of the stable range were within their limits before: look at boundary "
           "values and fluid properties";
  }

private:
  double step_, friction_rate_;
  StableRange range_;
  std::size_t courant_, friction_;
};

} // namespace granflux::cfd
