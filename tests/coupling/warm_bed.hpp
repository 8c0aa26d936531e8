// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include <granflux/coupling/heat_kick.hpp>

#include "fake_host.hpp"

namespace granflux::testing {

/// Spheres held in place, with temperatures.
class WarmBed {
public:
  /// `capacity`: per mass of the spheres [J/(kg K)].
  WarmBed(FakeHost& host, double capacity, double temperature)
      : host_(host), temperature_(host.size(), temperature), heat_(host.size()) {
    for (const double mass : host.mass)
      capacity_.push_back(mass * capacity);
  }

  coupling::ParticleView view() {
    coupling::ParticleView view = host_.view();
    view.temperature = temperature_;
    view.heat_capacity = capacity_;
    view.heat = heat_;
    return view;
  }

  /// A coupling step, then `parts` steps of temperature over its interval. other(p): heat that
  /// particle p receives beside that of the gas [W].
  void step(
      coupling::Coupler& coupler, double interval, int parts,
      const std::function<double(std::size_t)>& other = [](std::size_t) { return 0.; }) {
    coupler.exchange(view(), interval);
    const double dt = interval / parts;
    for (int part = 0; part < parts; ++part) {
      double received = 0;
      for (std::size_t p = 0; p < temperature_.size(); ++p) {
        const double heat =
            coupling::convected_heat(heat_[p], temperature_[p], other(p), capacity_[p], false, dt);
        temperature_[p] += dt * (heat + other(p)) / capacity_[p];
        received += dt * heat;
      }
      coupler.received_heat(received);
    }
    coupler.apply(host_.view(), interval);
  }

  /// Sum of the heat capacities times temperatures, of this rank [J].
  [[nodiscard]] double heat() const {
    double sum = 0;
    for (std::size_t p = 0; p < temperature_.size(); ++p)
      sum += capacity_[p] * temperature_[p];
    return sum;
  }
  [[nodiscard]] const std::vector<double>& temperature() const { return temperature_; }

private:
  FakeHost& host_;
  std::vector<double> temperature_, capacity_;
  std::vector<coupling::HeatState> heat_;
};

} // namespace granflux::testing
