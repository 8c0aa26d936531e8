// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "checkpointer.hpp"

#include <algorithm>
#include <array>
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
/// Who asks for a stop does not wait long for lists to be built.
constexpr double patience = 5; // s
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

void Checkpointer::start(long now, long last) {
  last_of_run_ = last;
  plan(now);
  look(now / steps_between_looks * steps_between_looks);
}

void Checkpointer::lists_are_built(long now) {
  if (wish_ != StopSignals::Wish::none)
    due_ = now;
}

void Checkpointer::look(long now) {
  bool late = false;
  if (now % steps_between_looks == 0) {
    const bool waiting = wish_ != StopSignals::Wish::none;
    const double clock = MPI_Wtime();
    std::array<int, 2> all{int(StopSignals::wish()), waiting && clock - asked_ > patience};
    MPI_Allreduce(MPI_IN_PLACE, all.data(), int(all.size()), MPI_INT, MPI_MAX, comm_);
    wish_ = StopSignals::Wish(all[0]);
    late = all[1];
    if (!waiting)
      asked_ = clock, forced_ = false;
  }
  // In the last step of a run there is nothing left to wait for.
  if (wish_ != StopSignals::Wish::none && (late || now + 1 >= last_of_run_))
    due_ = now + 1, forced_ = true;
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
  const bool stop = wish_ == StopSignals::Wish::stop;
  StopSignals::answered();
  wish_ = StopSignals::Wish::none;
  plan(now);
  return stop;
}

std::string Checkpointer::how_to_continue() const {
  return fmt::format("granflux: stopped by a signal after step {}; to continue: the same script "
                     "with 'read_restart {}' in place of what makes box and particles{}\n",
                     last_->step, last_->file,
                     forced_ ? " (lists were built for it: the same to rounding)" : "");
}

void check_finite(std::span<const Vec3> values, const std::string& what, MPI_Comm comm) {
  const bool finite =
      std::ranges::all_of(values, [](const Vec3& v) { return std::isfinite(v.x + v.y + v.z); });
  coupling::throw_together<NumericalError>(
      comm, finite ? "" : "no checkpoint is written: " + what + " of a particle is not finite");
}

} // namespace granflux::driver
