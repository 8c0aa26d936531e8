// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mpi.h>
#include <optional>
#include <span>
#include <vector>

#include <granflux/cfd/state_record.hpp>

namespace granflux::testing {

inline bool is_first_rank() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

/// The record of a GasSolver or Coupler: on rank 0, empty elsewhere.
template <class Solver> std::vector<char> saved(const Solver& solver) {
  std::vector<char> record;
  if (!is_first_rank()) {
    solver.save(nullptr);
    return record;
  }
  cfd::RecordWriter out("test", solver.saved_numbers(), [&](const void* bytes, std::size_t count) {
    const auto* from = static_cast<const char*>(bytes);
    record.insert(record.end(), from, from + count);
  });
  solver.save(&out);
  out.finish();
  return record;
}

template <class Solver> void load(Solver& solver, const std::vector<char>& record) {
  std::optional<cfd::RecordReader> in;
  if (is_first_rank())
    in.emplace("test", std::span(record.data(), record.size()));
  solver.load(in ? &*in : nullptr);
}

} // namespace granflux::testing
