// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>

#include <granflux/cfd/vec3.hpp>

namespace granflux::coupling {

/// To ten digits, for messages.
inline std::string text(double x) {
  std::ostringstream out;
  out.precision(10);
  out << x;
  return out.str();
}

inline std::string text(const Vec3& x) {
  return '(' + text(x.x) + ", " + text(x.y) + ", " + text(x.z) + ')';
}

} // namespace granflux::coupling
