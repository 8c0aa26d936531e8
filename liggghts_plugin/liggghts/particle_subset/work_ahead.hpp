// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "own_work.hpp"

namespace granflux::particle_subset {

/// A fix called between forces and motion that looks at no more of a particle than what forces of
/// this step add to it: it may do its work block by block, for particles that no other thread sees,
/// while that is in the cache.
class WorkAhead {
public:
  virtual ~WorkAhead() = default;
  /// Its part after all others of the forces. Null: it does all when it is called.
  [[nodiscard]] virtual OwnWork* work_ahead() = 0;
};

} // namespace granflux::particle_subset
