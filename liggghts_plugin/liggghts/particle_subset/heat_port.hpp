// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact_heat.hpp"

namespace granflux::particle_subset {

/// Where pair style and walls find the law of heat and the arrays of the moment.
class HeatPort {
public:
  /// Valid until LIGGGHTS moves, sorts or communicates particles.
  [[nodiscard]] virtual HeatOfContacts heat_of_contacts() = 0;
  /// Gap up to which particles that do not touch exchange heat: the lists must hold them [m].
  [[nodiscard]] virtual double reach() const = 0;
  /// Of owned particles [J]: what is added to it is received in the next step. Null where friction
  /// makes no heat.
  [[nodiscard]] virtual double* parted_heat() = 0;

protected:
  ~HeatPort() = default;
};

} // namespace granflux::particle_subset
