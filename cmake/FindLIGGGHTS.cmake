# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Finds the packaged LIGGGHTS library (Debian: libliggghts-dev). Defines
#   LIGGGHTS_FOUND
#   LIGGGHTS_VERSION          3.8.0
#   LIGGGHTS_VERSION_STRING   what LAMMPS_NS::Universe::version says, build date included
#   LIGGGHTS_PROGRAM          the stock program, for comparisons; may be missing
#   target LIGGGHTS::LIGGGHTS
# Headers are included as <liggghts/fix.h>: the folder itself must not be on the include path,
# because it holds an error.h, a memory.h and other names of the C library.

find_path(LIGGGHTS_INCLUDE_DIR NAMES liggghts/lammps.h)
find_library(LIGGGHTS_LIBRARY NAMES liggghts)
find_program(LIGGGHTS_PROGRAM NAMES liggghts)

if(LIGGGHTS_LIBRARY)
  # The version is in no installed header; the library carries it as text.
  file(STRINGS "${LIGGGHTS_LIBRARY}" liggghts_text
       REGEX "LIGGGHTS-PUBLIC [0-9.]+, compiled [^,]*, git commit")
  string(REGEX MATCH "LIGGGHTS-PUBLIC ([0-9.]+), compiled [^,]*, git commit [a-z0-9]+"
         LIGGGHTS_VERSION_STRING "${liggghts_text}")
  set(LIGGGHTS_VERSION "${CMAKE_MATCH_1}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LIGGGHTS
  REQUIRED_VARS LIGGGHTS_LIBRARY LIGGGHTS_INCLUDE_DIR LIGGGHTS_VERSION_STRING
  VERSION_VAR LIGGGHTS_VERSION)

if(LIGGGHTS_FOUND AND NOT TARGET LIGGGHTS::LIGGGHTS)
  find_package(MPI REQUIRED COMPONENTS CXX)
  add_library(LIGGGHTS::LIGGGHTS UNKNOWN IMPORTED)
  set_target_properties(LIGGGHTS::LIGGGHTS PROPERTIES
    IMPORTED_LOCATION "${LIGGGHTS_LIBRARY}"
    INTERFACE_LINK_LIBRARIES MPI::MPI_CXX)
  if(NOT LIGGGHTS_INCLUDE_DIR STREQUAL "/usr/include")
    set_property(TARGET LIGGGHTS::LIGGGHTS PROPERTY
      INTERFACE_INCLUDE_DIRECTORIES "${LIGGGHTS_INCLUDE_DIR}")
  endif()
endif()
mark_as_advanced(LIGGGHTS_INCLUDE_DIR LIGGGHTS_LIBRARY LIGGGHTS_PROGRAM)
