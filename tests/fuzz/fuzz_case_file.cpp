// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// The case file, as fix granflux/couple reads it.

#include <granflux/cfd/case_file.hpp>
#include <granflux/cfd/read_gas_case.hpp>
#include <granflux/coupling/read_coupling.hpp>

#include "fuzz_target.hpp"

const bool granflux::testing::places_and_processes = false;

void granflux::testing::read_input(const std::string& input, const std::string&) {
  auto file = granflux::cfd::CaseFile::parse(input, "input");
  granflux::cfd::read_gas_case(file);
  granflux::coupling::read_coupling(file);
  file.finish();
}
