// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace granflux::driver {

/// A fix of which a restart file holds something.
struct KeptFix {
  std::string id, style;
};

/// What a checkpoint keeps of a run beside what the fixes keep of theirs.
struct CheckpointRecord {
  /// What else the forces of the last step depend on.
  struct Forces {
    double time_step = 0; ///< s
    double with_gas = 0;  ///< 1: the gas's forces are among them
    friend bool operator==(const Forces&, const Forces&) = default;
  } forces;
  double ranks = 0;
  double next_sort = 0; ///< step from which on the host sorts particles again
  std::vector<KeptFix> fixes;
};

/// Rank 0 writes the block of the fix, its length first; without a record there is nothing in it.
/// Throws std::runtime_error where the file takes no more.
void write_checkpoint_record(const std::optional<CheckpointRecord>& record, std::FILE* file);

/// Takes such a block. Throws ConfigError where it is damaged.
std::optional<CheckpointRecord> read_checkpoint_record(const char* block);

/// What the checkpoint holds of a fix must have found that fix: throws ConfigError, naming the
/// first that is not among `present`. Fixes that insert particles may be over and left out.
void check_fixes(const CheckpointRecord& record, std::span<const KeptFix> present);

} // namespace granflux::driver
