// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// gas_flow: runs one flow of gas_flows.hpp and prints what was measured as JSON; run_gas compares.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <mpi.h>

#include "gas_flows.hpp"

namespace {

using namespace granflux::cfd::validation;

std::string json(const std::vector<Sample>& line) {
  std::string text;
  for (const auto& [coordinate, value] : line)
    text += fmt::format("{}[{:.9g}, {:.9g}]", text.empty() ? "" : ", ", coordinate, value);
  return "[" + text + "]";
}

void write_history(const CylinderFlow& flow, const std::string& path) {
  std::ofstream file(path);
  file << "time,drag,lift\n";
  for (const ForceSample& s : flow.history)
    file << fmt::format("{:.6f},{:.8f},{:.8f}\n", s.time, s.drag, s.lift);
}

std::string json(const CylinderFlow& f) {
  return fmt::format("{{\"drag\": {:.6g}, \"pressure_drag\": {:.6g}, \"wake_length\": {:.6g}, "
                     "\"lift\": {:.6g}, \"strouhal\": {:.6g}, \"periods\": {}, \"radial\": {}, "
                     "\"time\": {:.6g}, \"steps\": {}}}",
                     f.drag, f.pressure_drag, f.wake_length, f.lift, f.strouhal, f.periods,
                     f.radial, f.time, f.steps);
}

int run(int argc, char** argv) {
  CLI::App app{"Runs a flow of the gas alone that has a published solution; prints what was "
               "measured as JSON."};
  app.require_subcommand(1);
  double number = 100;
  CavityGrid cavity;
  CylinderGrid2D around;
  Steadiness steadiness;
  bool implicit = false;
  std::string history;
  double end_time = 150;
  int periods = 8;
  const auto add_steadiness = [&](CLI::App* flow) {
    flow->add_option("--courant", steadiness.courant, "Courant number");
    flow->add_flag("--implicit", implicit, "Crank-Nicolson for convection, too");
    flow->add_option("--change", steadiness.change, "change in a unit of time that is steady");
  };
  const auto add_cavity = [&](CLI::App* flow, const char* name) {
    flow->add_option(name, number)->required();
    flow->add_option("--cells", cavity.cells, "along each side");
    flow->add_option("--stretching", cavity.stretching, "towards the walls; 0: none");
    add_steadiness(flow);
  };
  CLI::App* lid = app.add_subcommand("lid_cavity", "cavity with a moving lid");
  add_cavity(lid, "--reynolds");
  CLI::App* heated = app.add_subcommand("heated_cavity", "cavity heated from the side");
  add_cavity(heated, "--rayleigh");
  CLI::App* cylinder = app.add_subcommand("cylinder", "cylinder in a free stream");
  cylinder->add_option("--reynolds", number)->required();
  cylinder->add_option("--tangential", around.tangential, "cells around");
  cylinder->add_option("--outer-radius", around.outer_radius, "in diameters");
  cylinder->add_option("--first", around.first, "width of the cells at the cylinder, diameters");
  cylinder->add_option("--growth", around.growth, "of the cells outwards");
  cylinder->add_option("--wake", around.wake, "radius up to which no cell grows beyond --widest");
  cylinder->add_option("--widest", around.widest, "width of cells outwards, in diameters");
  cylinder->add_option("--gather", around.gather, "how much narrower cells behind are, 0 to 1");
  cylinder->add_option("--outlet-angle", around.outlet_angle, "degrees either side of the stream");
  cylinder->add_option("--history", history, "file for the coefficients of all steps (CSV)");
  const auto* sheds =
      cylinder->add_option("--end-time", end_time, "the wake sheds; run up to this");
  cylinder->add_option("--periods", periods, "of shedding that the means are of");
  add_steadiness(cylinder);
  CLI11_PARSE(app, argc, argv);
  if (implicit)
    steadiness.time_scheme = granflux::cfd::TimeScheme::implicit;

  if (*lid) {
    const LidCavity f = lid_cavity(number, cavity, steadiness);
    fmt::print("{{\"u\": {}, \"v\": {}, \"time\": {:.6g}, \"steps\": {}}}\n", json(f.u), json(f.v),
               f.time, f.steps);
  } else if (*heated) {
    const HeatedCavity f = heated_cavity(number, cavity, steadiness);
    fmt::print("{{\"nusselt\": {:.6g}, \"nusselt_cold\": {:.6g}, \"u_max\": {:.6g}, "
               "\"u_max_at\": {:.4g}, \"v_max\": {:.6g}, \"v_max_at\": {:.4g}, \"time\": {:.6g}, "
               "\"steps\": {}}}\n",
               f.nusselt, f.nusselt_cold, f.u_max, f.u_max_at, f.v_max, f.v_max_at, f.time,
               f.steps);
  } else {
    const CylinderFlow f =
        sheds->count() > 0
            ? shedding_cylinder(number, around, steadiness.courant, end_time, periods)
            : steady_cylinder(number, around, steadiness);
    if (!history.empty())
      write_history(f, history);
    fmt::print("{}\n", json(f));
  }
  return EXIT_SUCCESS;
}

} // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int code = EXIT_FAILURE;
  try {
    code = run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gas_flow: error: %s\n", error.what());
  }
  MPI_Finalize();
  return code;
}
