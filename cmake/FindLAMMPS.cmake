# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
#
# Finds the packaged LAMMPS library (Debian: liblammps-dev). Defines
#   LAMMPS_FOUND
#   LAMMPS_VERSION    20210929: release date, as LAMMPS_NS::LAMMPS::num_ver says it
#   LAMMPS_PROGRAM    the stock program, for comparisons; may be missing
#   target LAMMPS::LAMMPS
# Headers are included as <lammps/fix.h>: the folder itself must not be on the include path, because
# it holds an error.h and other names of the C library.

find_path(LAMMPS_INCLUDE_DIR NAMES lammps/lammps.h)
find_library(LAMMPS_LIBRARY NAMES lammps)
find_program(LAMMPS_PROGRAM NAMES lmp)

if(LAMMPS_LIBRARY)
  # No header holds the version.
  get_filename_component(lammps_folder "${LAMMPS_LIBRARY}" DIRECTORY)
  find_file(LAMMPS_PKGCONFIG NAMES liblammps.pc HINTS "${lammps_folder}/pkgconfig")
  mark_as_advanced(LAMMPS_PKGCONFIG)
endif()
if(LAMMPS_PKGCONFIG)
  file(STRINGS "${LAMMPS_PKGCONFIG}" lammps_text REGEX "^Version: *[0-9]+")
  string(REGEX REPLACE "^Version: *([0-9]+).*" "\\1" LAMMPS_VERSION "${lammps_text}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LAMMPS
  REQUIRED_VARS LAMMPS_LIBRARY LAMMPS_INCLUDE_DIR LAMMPS_VERSION
  VERSION_VAR LAMMPS_VERSION)

if(LAMMPS_FOUND AND NOT TARGET LAMMPS::LAMMPS)
  find_package(MPI REQUIRED COMPONENTS CXX)
  # What a module needs that the host program loads, library and all.
  add_library(LAMMPS::headers INTERFACE IMPORTED)
  set_target_properties(LAMMPS::headers PROPERTIES
    INTERFACE_COMPILE_DEFINITIONS LAMMPS_SMALLBIG
    INTERFACE_LINK_LIBRARIES MPI::MPI_CXX)
  if(NOT LAMMPS_INCLUDE_DIR STREQUAL "/usr/include")
    set_property(TARGET LAMMPS::headers PROPERTY
      INTERFACE_INCLUDE_DIRECTORIES "${LAMMPS_INCLUDE_DIR}")
  endif()
  add_library(LAMMPS::LAMMPS UNKNOWN IMPORTED)
  set_target_properties(LAMMPS::LAMMPS PROPERTIES
    IMPORTED_LOCATION "${LAMMPS_LIBRARY}"
    INTERFACE_LINK_LIBRARIES LAMMPS::headers)
endif()
mark_as_advanced(LAMMPS_INCLUDE_DIR LAMMPS_LIBRARY LAMMPS_PROGRAM)
