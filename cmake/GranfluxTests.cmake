# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause

# granflux_add_test(name
#   SOURCES file...            GoogleTest sources; tests/support/mpi_main.cpp supplies main
#   [LIBS target...]           default granflux::cfd
#   [RANKS 1 2 4] [THREADS 1 2]  default 1 each: CTest runs the program once for every pair
#   [LABELS label...]          'long' keeps a test out of ./test
#   [TIMEOUT seconds])         default 120: a hang is a failure
#
# Builds one program and registers the tests name.r<ranks>.t<threads>.
function(granflux_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT" "SOURCES;LIBS;RANKS;THREADS;LABELS")
  if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES OR NOT arg_SOURCES)
    message(FATAL_ERROR "granflux_add_test(${name}): ${arg_UNPARSED_ARGUMENTS}"
                        "${arg_KEYWORDS_MISSING_VALUES} not understood, or no SOURCES")
  endif()
  if(NOT arg_LIBS)
    set(arg_LIBS granflux::cfd)
  endif()
  if(NOT arg_RANKS)
    set(arg_RANKS 1)
  endif()
  if(NOT arg_THREADS)
    set(arg_THREADS 1)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()

  set(target test_${name})
  add_executable(${target} ${arg_SOURCES})
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_link_libraries(${target} PRIVATE granflux_test_main granflux_warnings ${arg_LIBS})
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests/bin")

  foreach(ranks IN LISTS arg_RANKS)
    foreach(threads IN LISTS arg_THREADS)
      set(test ${name}.r${ranks}.t${threads})
      math(EXPR processors "${ranks} * ${threads}")
      # Each number of ranks and of threads has then been tried with fewer of the other.
      if(processors GREATER 4)
        continue()
      endif()
      math(EXPR ctest_timeout "${arg_TIMEOUT} + 20")
      # mpirun has its own limit, so that it ends every rank before CTest gives mpirun up.
      add_test(NAME ${test} COMMAND ${GRANFLUX_MPIRUN} --timeout ${arg_TIMEOUT} -n ${ranks}
                                    $<TARGET_FILE:${target}>)
      set_tests_properties(
        ${test}
        PROPERTIES LABELS "${arg_LABELS}" PROCESSORS ${processors} TIMEOUT ${ctest_timeout}
                   ENVIRONMENT "OMP_NUM_THREADS=${threads};${GRANFLUX_TEST_ENVIRONMENT}")
    endforeach()
  endforeach()
endfunction()

# granflux_add_program_test(name
#   COMMAND word...            a command line, for whole programs; prefix ${GRANFLUX_MPIRUN} -n 2
#   [LABELS label...] [PROCESSORS n] [TIMEOUT seconds])
function(granflux_add_program_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT;PROCESSORS" "COMMAND;LABELS")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_COMMAND)
    message(FATAL_ERROR "granflux_add_program_test(${name}): no COMMAND, or not understood: "
                        "${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  if(NOT arg_PROCESSORS)
    set(arg_PROCESSORS 1)
  endif()
  add_test(NAME ${name} COMMAND ${arg_COMMAND})
  set_tests_properties(
    ${name} PROPERTIES LABELS "${arg_LABELS}" PROCESSORS ${arg_PROCESSORS} TIMEOUT ${arg_TIMEOUT}
                       # at its end a program cannot tell MPI's leaks from its own; tests can
                       ENVIRONMENT
                       "OMP_NUM_THREADS=1;ASAN_OPTIONS=detect_leaks=0;${GRANFLUX_TEST_ENVIRONMENT}")
endfunction()

set(GRANFLUX_MPIRUN ${MPIEXEC_EXECUTABLE} --oversubscribe --allow-run-as-root --bind-to none)
# Threads and ranks that wait must give way, or a test on a busy machine takes minutes in place of
# seconds; copies between processes through the kernel are forbidden in many containers, and Open MPI
# then complains on every rank.
set(GRANFLUX_TEST_ENVIRONMENT
    "GTEST_COLOR=no" "OMP_WAIT_POLICY=passive" "OMPI_MCA_mpi_yield_when_idle=1" "OMPI_MCA_btl_vader_single_copy_mechanism=none"
    "LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/support/lsan.supp"
    "TSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/tests/support/tsan.supp ignore_noninstrumented_modules=1 halt_on_error=1")

find_package(GTest REQUIRED)
add_library(granflux_test_main STATIC "${CMAKE_SOURCE_DIR}/tests/support/mpi_main.cpp")
target_compile_features(granflux_test_main PUBLIC cxx_std_20)
target_include_directories(granflux_test_main PUBLIC "${CMAKE_SOURCE_DIR}/tests/support")
target_link_libraries(
  granflux_test_main
  PUBLIC GTest::gtest MPI::MPI_CXX
  PRIVATE granflux_warnings)
