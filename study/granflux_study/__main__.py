# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
import sys

from granflux_study.command_line import main

sys.exit(main(sys.argv[1:]))
