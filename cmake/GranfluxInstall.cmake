# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
#
# What `cmake --install` lays down beside the programs: libraries, headers, a CMake package for
# find_package(GranFlux), documents and examples.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(granflux_cmake_folder "${CMAKE_INSTALL_LIBDIR}/cmake/GranFlux")
set(granflux_doc_folder "${CMAKE_INSTALL_DATAROOTDIR}/doc/granflux")

install(
  TARGETS granflux_cfd_lib granflux_coupling
  EXPORT GranFluxTargets
  ARCHIVE
  FILE_SET HEADERS)
install(TARGETS granflux_cfd)
install(
  EXPORT GranFluxTargets
  NAMESPACE granflux::
  DESTINATION "${granflux_cmake_folder}")

configure_package_config_file(cmake/GranFluxConfig.cmake.in "${CMAKE_BINARY_DIR}/GranFluxConfig.cmake"
                              INSTALL_DESTINATION "${granflux_cmake_folder}")
write_basic_package_version_file("${CMAKE_BINARY_DIR}/GranFluxConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/GranFluxConfig.cmake"
              "${CMAKE_BINARY_DIR}/GranFluxConfigVersion.cmake" cmake/FindCGNS.cmake
              cmake/FindHYPRE.cmake DESTINATION "${granflux_cmake_folder}")

install(FILES README.md CHANGELOG.md LICENSE DESTINATION "${granflux_doc_folder}")
install(FILES LICENSE DESTINATION "${granflux_doc_folder}" RENAME copyright) # Debian's name
install(DIRECTORY LICENSES docs DESTINATION "${granflux_doc_folder}")
install(DIRECTORY examples DESTINATION "${granflux_doc_folder}"
        USE_SOURCE_PERMISSIONS # run.sh and plot.py are programs
        # what runs leave behind
        PATTERN post EXCLUDE
        PATTERN results EXCLUDE
        PATTERN __pycache__ EXCLUDE)
