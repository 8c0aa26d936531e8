# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause

set(GRANFLUX_PYTHON /usr/bin/python3) # the distribution's, which has the distribution's packages

# granflux_add_python_program(name     executable file bin/<name>
#   PACKAGE folder                     of the sources, with __main__.py
#   SOURCES file...)                   in it
#
# One executable file of Python's own making (zipapp), built and installed beside the other programs.
function(granflux_add_python_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "PACKAGE" "SOURCES")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_PACKAGE OR NOT arg_SOURCES)
    message(FATAL_ERROR "granflux_add_python_program(${name}): no PACKAGE, no SOURCES, or not understood: "
                        "${arg_UNPARSED_ARGUMENTS}")
  endif()
  list(TRANSFORM arg_SOURCES PREPEND "${arg_PACKAGE}/")
  set(program "${CMAKE_BINARY_DIR}/bin/${name}")
  set(tree "${CMAKE_CURRENT_BINARY_DIR}/${name}.tree")
  add_custom_command(
    OUTPUT ${program}
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${tree}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${tree}/${arg_PACKAGE} ${CMAKE_BINARY_DIR}/bin
    COMMAND ${CMAKE_COMMAND} -E copy ${arg_SOURCES} ${tree}/${arg_PACKAGE}
    COMMAND ${CMAKE_COMMAND} -E copy ${arg_PACKAGE}/__main__.py ${tree}
    COMMAND ${GRANFLUX_PYTHON} -m zipapp --compress --python ${GRANFLUX_PYTHON} --output ${program} ${tree}
    DEPENDS ${arg_SOURCES}
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
    COMMENT "Packing ${name}"
    VERBATIM)
  add_custom_target(${name} ALL DEPENDS ${program})
  install(PROGRAMS ${program} TYPE BIN)
endfunction()
