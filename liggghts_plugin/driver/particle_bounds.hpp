// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <granflux/cfd/stable_range.hpp>

#include "contact_time.hpp"

namespace granflux::driver {

/// The rows of a StableRange that the time step of the particles is judged by
/// (docs/reference/stable_range.md).
class ParticleBounds {
public:
  explicit ParticleBounds(cfd::StableRange& range);
  ParticleBounds(const ParticleBounds&) = delete; // the rows' cures hold a pointer to it
  ParticleBounds& operator=(const ParticleBounds&) = delete;

  /// speed, speed_over_radius: largest of a particle [m/s, 1/s].
  void set(const ContactTimes& times, double time_step, double speed, double speed_over_radius);

  /// Whether contacts are known to be beyond what the time step resolves.
  [[nodiscard]] bool contacts_beyond() const {
    return range_.standing(contact_) == cfd::Standing::beyond;
  }

private:
  cfd::StableRange& range_;
  double time_step_ = 0;
  std::size_t contact_, rayleigh_, path_;
};

} // namespace granflux::driver
