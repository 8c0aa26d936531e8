# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause

# Script of GranfluxVersion.cmake: writes HEADER from TEMPLATE; the revision is unknown outside git.
set(REVISION unknown)
if(GIT)
  execute_process(
    COMMAND "${GIT}" -c safe.directory=* -C "${SOURCE}" describe --always --dirty --abbrev=10
    OUTPUT_VARIABLE described
    OUTPUT_STRIP_TRAILING_WHITESPACE
    ERROR_QUIET
    RESULT_VARIABLE failed)
  if(NOT failed)
    set(REVISION "${described}")
  endif()
endif()
configure_file("${TEMPLATE}" "${HEADER}" @ONLY)
