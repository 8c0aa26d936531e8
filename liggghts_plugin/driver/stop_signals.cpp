// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#include "stop_signals.hpp"

#include <array>
#include <csignal>
#include <cstdlib>
#include <unistd.h>

namespace granflux::driver {

namespace {

constexpr std::array signals{SIGTERM, SIGINT, SIGUSR2, SIGUSR1};

volatile std::sig_atomic_t stop_asked = 0, checkpoint_asked = 0;
int alive = 0;
std::array<struct sigaction, signals.size()> before;

extern "C" void take_signal(int signal) {
  if (signal == SIGUSR1) {
    checkpoint_asked = 1;
    return;
  }
  if (stop_asked) {
    constexpr char text[] = "\nsecond signal: ended without a checkpoint\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof text - 1);
    std::_Exit(EXIT_FAILURE);
  }
  stop_asked = 1;
}

} // namespace

StopSignals::StopSignals() {
  if (alive++ > 0)
    return;
  struct sigaction action {};
  action.sa_handler = take_signal;
  action.sa_flags = SA_RESTART; // output must not break off
  for (std::size_t s = 0; s < signals.size(); ++s)
    sigaction(signals[s], &action, &before[s]);
}

StopSignals::~StopSignals() {
  if (--alive > 0)
    return;
  for (std::size_t s = 0; s < signals.size(); ++s)
    sigaction(signals[s], &before[s], nullptr);
}

StopSignals::Wish StopSignals::wish() {
  return stop_asked ? Wish::stop : checkpoint_asked ? Wish::checkpoint : Wish::none;
}

void StopSignals::answered() {
  checkpoint_asked = 0;
}

} // namespace granflux::driver
