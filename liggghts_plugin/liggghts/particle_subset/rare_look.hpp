// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace granflux::particle_subset {

/// A fix that is called at the end of every step, but looks at the motion of particles in few of
/// them: in the others they may move on before.
class RareLook {
public:
  virtual ~RareLook() = default;
  [[nodiscard]] virtual bool looks_at(long step) const = 0;
  /// Whether it looks at forces in any step of a run, those included in which it does not look at
  /// motion: they must then stay until it has been called.
  [[nodiscard]] virtual bool looks_at_forces() const { return true; }
};

} // namespace granflux::particle_subset
