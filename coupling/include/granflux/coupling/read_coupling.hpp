// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <granflux/cfd/case_file.hpp>
#include <granflux/coupling/coupler.hpp>

namespace granflux::coupling {

/// Takes the [coupling] table from a case file; keys that are absent keep their defaults:
///
///   drag                 name of a drag law            gidaspow
///   void_fraction        name of a kernel              smoothed
///   smoothing_width      in particle diameters, >= 0   3
///   model                "a" or "b"                    a
///   drag_treatment       "explicit", "semi_implicit" or "implicit"   implicit
///   coarse_graining      parcel over particle diameter, >= 1   1
///   void_fraction_floor  between 0 and 1               0.05
///
/// Throws ConfigError; an unknown name is answered with the list of those known.
CouplingOptions read_coupling(cfd::CaseFile& file);

} // namespace granflux::coupling
