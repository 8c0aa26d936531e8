// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "checkpointer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <granflux/cfd/error.hpp>
#include <granflux/cfd/whole_file.hpp>
#include <granflux/coupling/throw_together.hpp>

#include "sealed_file.hpp"

namespace granflux::driver {

namespace {

/// Ranks agree on signals that often: a small message of all, and a delay that nobody notices.
constexpr long steps_between_looks = 10;
constexpr long never = std::numeric_limits<long>::max();

bool is_first(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank == 0;
}

} // namespace

Checkpointer::Checkpointer(std::span<char*> words, MPI_Comm comm)
    : comm_(comm), options_(read_checkpoint_options(words)) {
  std::string complaint;
  if (is_first(comm))
    complaint = cfd::WholeFile(options_.file).failure();
  coupling::throw_together<ConfigError>(comm, complaint);
}

/// By the script's interval.
void Checkpointer::plan(long now) {
  due_ = options_.every > 0 ? (now / options_.every + 1) * options_.every : never;
}

void Checkpointer::start(long now) {
  plan(now);
  look(now / steps_between_looks * steps_between_looks);
  if (due_ <= now)
    due_ = now + 1;
}

void Checkpointer::look(long now) {
  if (now % steps_between_looks != 0)
    return;
  int wish = int(StopSignals::wish());
  MPI_Allreduce(MPI_IN_PLACE, &wish, 1, MPI_INT, MPI_MAX, comm_);
  if (wish == int(StopSignals::Wish::none))
    return;
  stop_ = wish == int(StopSignals::Wish::stop);
  due_ = now + 1;
}

bool Checkpointer::write(long now,
                         const std::function<void(const std::string& path)>& host_writes) {
  std::string complaint;
  if (is_first(comm_)) {
    SealedFile file(options_.file);
    host_writes(file.path());
    if (!file.finish())
      complaint = "checkpoint " + file.failure() +
                  (last_ ? fmt::format("; the one of step {} is still whole", last_->step) : "");
  } else {
    host_writes("");
  }
  coupling::throw_together<NumericalError>(comm_, complaint);
  last_ = {.file = options_.file, .step = now};
  StopSignals::answered();
  plan(now);
  return stop_;
}

std::string Checkpointer::how_to_continue() const {
  return fmt::format("granflux: stopped by a signal after step {}; to continue: the same script "
                     "with 'read_restart {}' in place of what makes box and particles\n",
                     last_->step, last_->file);
}

void check_finite(std::span<const Vec3> values, const std::string& what, MPI_Comm comm) {
  const bool finite =
      std::ranges::all_of(values, [](const Vec3& v) { return std::isfinite(v.x + v.y + v.z); });
  coupling::throw_together<NumericalError>(
      comm, finite ? "" : "no checkpoint is written: " + what + " of a particle is not finite");
}

} // namespace granflux::driver
