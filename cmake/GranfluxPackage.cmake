# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
#
# A Debian package of everything that is installed: `cpack` in the build folder. Shared libraries that the
# programs need become dependencies by themselves (dpkg-shlibdeps).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME granflux)
set(CPACK_PACKAGE_CONTACT "The GranFlux developers <granflux@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
    "Programs granflux (on LIGGGHTS), granflux_lammps (on LAMMPS), granflux_cfd (gas alone) and
granflux-regress, granflux_study, the libraries and headers that they are made of, documents and examples.")
if(GRANFLUX_NATIVE)
  string(APPEND CPACK_PACKAGE_DESCRIPTION
         "\nCompiled for the processor that it was built on: it may fail on others.")
endif()
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
# granflux-regress, granflux_study and the pictures of the examples; headers and libraries
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3, python3-numpy, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, libopenmpi-dev, libcgns-dev, libfmt-dev, libtomlplusplus-dev")
if(HYPRE_FOUND)
  string(APPEND CPACK_DEBIAN_PACKAGE_SUGGESTS ", libhypre-dev")
endif()
include(CPack)
