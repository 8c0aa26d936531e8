# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
#
# In a build for the thread sanitizer everything that uses OpenMP goes through tsan_openmp.cpp.
if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize=thread")
  return()
endif()
add_library(granflux_tsan_openmp STATIC "${CMAKE_SOURCE_DIR}/tests/support/tsan_openmp.cpp")
target_compile_features(granflux_tsan_openmp PRIVATE cxx_std_20)
target_compile_options(granflux_tsan_openmp PRIVATE -fno-sanitize=thread)
target_link_libraries(granflux_tsan_openmp PRIVATE granflux_warnings ${CMAKE_DL_LIBS})
# Before libgomp, whose functions it takes the place of.
get_target_property(granflux_openmp OpenMP::OpenMP_CXX INTERFACE_LINK_LIBRARIES)
set_target_properties(OpenMP::OpenMP_CXX PROPERTIES INTERFACE_LINK_LIBRARIES
                                                    "granflux_tsan_openmp;${granflux_openmp}")
