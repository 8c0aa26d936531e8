# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause

# Target granflux_version: the header granflux/version.hpp with version, revision and compiler, so
# that a program can say which code made a result. Written at every build, touched only on a change.
set(granflux_generated "${CMAKE_BINARY_DIR}/generated")
set(granflux_version_header "${granflux_generated}/granflux/version.hpp")

find_package(Git QUIET)
string(TOUPPER "${CMAKE_BUILD_TYPE}" granflux_build_type)
set(granflux_flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${granflux_build_type}}")
if(GRANFLUX_NATIVE)
  string(APPEND granflux_flags " -march=native")
endif()
string(STRIP "${granflux_flags}" granflux_flags)

add_custom_target(
  granflux_write_version
  COMMAND
    "${CMAKE_COMMAND}" "-DTEMPLATE=${CMAKE_CURRENT_SOURCE_DIR}/cmake/version.hpp.in"
    "-DHEADER=${granflux_version_header}" "-DSOURCE=${CMAKE_CURRENT_SOURCE_DIR}"
    "-DGIT=${GIT_EXECUTABLE}" "-DVERSION=${PROJECT_VERSION}"
    "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
    "-DFLAGS=${granflux_flags}" -P "${CMAKE_CURRENT_SOURCE_DIR}/cmake/write_version.cmake"
  BYPRODUCTS "${granflux_version_header}"
  COMMENT ""
  VERBATIM)

add_library(granflux_version INTERFACE)
target_include_directories(granflux_version INTERFACE "${granflux_generated}")
add_dependencies(granflux_version granflux_write_version)
