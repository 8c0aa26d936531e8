# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause

# LIGGGHTS as a library (Debian: libliggghts-dev), which installs headers and a library only.
# Defines LIGGGHTS::LIGGGHTS and LIGGGHTS_INCLUDE_DIR.
find_path(LIGGGHTS_INCLUDE_DIR lammps.h PATH_SUFFIXES liggghts)
find_library(LIGGGHTS_LIBRARY liggghts)
mark_as_advanced(LIGGGHTS_INCLUDE_DIR LIGGGHTS_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LIGGGHTS REQUIRED_VARS LIGGGHTS_LIBRARY LIGGGHTS_INCLUDE_DIR)

if(LIGGGHTS_FOUND AND NOT TARGET LIGGGHTS::LIGGGHTS)
  add_library(LIGGGHTS::LIGGGHTS UNKNOWN IMPORTED)
  set_target_properties(
    LIGGGHTS::LIGGGHTS PROPERTIES IMPORTED_LOCATION "${LIGGGHTS_LIBRARY}"
                                  INTERFACE_INCLUDE_DIRECTORIES "${LIGGGHTS_INCLUDE_DIR}")
endif()
