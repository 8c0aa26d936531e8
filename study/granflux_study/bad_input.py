# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause


class BadInput(Exception):
    """What was given cannot be studied: the message says what, where and what is allowed."""
