// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/read_gas_case.hpp>

#include <algorithm>

#include <granflux/cfd/error.hpp>

#include "read_grid.hpp"

namespace granflux::cfd {

namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

Fluid read_fluid(const CaseTable& table, const GridDescription& grid) {
  Fluid fluid;
  fluid.density = table.number("density", positive, "kg/m3");
  fluid.viscosity = table.number("viscosity", positive, "Pa s");
  fluid.gravity_given = table.has("gravity");
  fluid.gravity = table.vector("gravity", Vec3{}, any_number, "m/s2");
  fluid.driving_pressure_gradient =
      table.vector("driving_pressure_gradient", Vec3{}, any_number, "Pa/m");
  fluid.smagorinsky = table.number("smagorinsky", 0.0, zero_to_one, "");
  const auto* box = std::get_if<BoxGrid>(&grid); // of others make_mesh knows which way they close
  for (int d = 0; d < 3; ++d)
    if (fluid.driving_pressure_gradient[d] != 0 && box && !box->periodic[std::size_t(d)])
      table.fail("driving_pressure_gradient",
                 std::string("0 along ") + axis_names[std::size_t(d)] +
                     ", which is not periodic: there, boundaries drive the flow (Pa/m)");
  return fluid;
}

std::optional<Energy> read_energy(CaseFile& file) {
  if (!file.has("energy"))
    return std::nullopt;
  const CaseTable table = file.table("energy");
  Energy energy;
  energy.heat_capacity = table.number("heat_capacity", energy.heat_capacity, positive, "J/(kg K)");
  energy.conductivity = table.number("conductivity", energy.conductivity, not_negative, "W/(m K)");
  energy.initial_temperature =
      table.number("initial_temperature", energy.initial_temperature, positive, "K");
  energy.expansion = table.number("expansion", 0.0, not_negative, "1/K");
  if (energy.expansion == 0)
    table.refuse("reference_temperature", "it needs an expansion > 0");
  energy.reference_temperature =
      table.number("reference_temperature", energy.initial_temperature, positive, "K");
  return energy;
}

/// Heat at a boundary: an inlet brings its temperature, a wall has one, or a flux, or neither.
void read_heat(const CaseTable& table, const std::optional<Energy>& energy,
               BoundaryCondition& condition) {
  if (!energy) {
    for (const char* key : {"temperature", "heat_flux"})
      table.refuse(key, "the case has no [energy] table");
    return;
  }
  const bool wall = condition.kind == BoundaryKind::wall;
  if (!wall)
    table.refuse("heat_flux", "only a wall has a heat flux");
  if (condition.kind == BoundaryKind::slip)
    table.refuse("temperature", "a slip boundary is adiabatic");
  if (table.has("heat_flux")) {
    table.refuse("temperature", "a wall has a temperature or a heat_flux");
    condition.heat = BoundaryCondition::Heat::flux;
    condition.heat_flux = table.number("heat_flux", any_number, "W/m2");
    if (energy->conductivity == 0)
      table.fail("heat_flux", "left out where [energy] conductivity is 0");
  } else if (condition.kind == BoundaryKind::inlet || (wall && table.has("temperature"))) {
    condition.heat = BoundaryCondition::Heat::temperature;
    condition.temperature = table.number("temperature", positive, "K");
  } else if (condition.kind == BoundaryKind::outlet) {
    condition.temperature = table.number("temperature", energy->initial_temperature, positive, "K");
  }
}

void read_inlet(const CaseTable& table, const std::optional<Side>& side,
                BoundaryCondition& condition) {
  condition.velocity = table.vector("velocity", any_number, "m/s");
  if (side && condition.velocity[side->direction] * (side->high ? -1 : 1) < 0)
    table.fail("velocity", "directed into the box: gas leaves through an outlet (m/s)");
  condition.profile = table.choice<BoundaryCondition::Profile>(
      "profile", BoundaryCondition::Profile::uniform,
      {{"uniform", BoundaryCondition::Profile::uniform},
       {"parabolic", BoundaryCondition::Profile::parabolic}});
  if (!side && condition.profile == BoundaryCondition::Profile::parabolic)
    table.fail("profile", "\"uniform\": a parabola needs a rectangle on the side of a box");
  condition.ramp_time = table.number("ramp_time", 0.0, not_negative, "s");
  if (condition.ramp_time == 0)
    table.refuse("ramp_from", "it needs a ramp_time > 0");
  condition.ramp_from = table.number("ramp_from", 0.0, not_negative, "");
}

void read_wall(const CaseTable& table, const std::optional<Side>& side,
               BoundaryCondition& condition) {
  condition.velocity = table.vector("velocity", Vec3{}, any_number, "m/s");
  if (side && condition.velocity[side->direction] != 0)
    table.fail("velocity", std::string("0 along ") + axis_names[std::size_t(side->direction)] +
                               ": a wall moves in its own plane only (m/s)");
  condition.angular_velocity = table.vector("angular_velocity", Vec3{}, any_number, "rad/s");
  if (condition.angular_velocity == Vec3{})
    table.refuse("centre", "it needs an angular_velocity");
  condition.centre = table.vector("centre", Vec3{}, any_number, "m");
}

void refuse_keys_of_others(const CaseTable& table, BoundaryKind kind) {
  const bool inlet = kind == BoundaryKind::inlet;
  if (!inlet && kind != BoundaryKind::wall)
    table.refuse("velocity", "only an inlet or a wall has a velocity");
  if (kind != BoundaryKind::wall)
    for (const char* key : {"angular_velocity", "centre"})
      table.refuse(key, "only a wall turns");
  if (!inlet)
    for (const char* key : {"profile", "ramp_time", "ramp_from"})
      table.refuse(key, std::string("only an inlet has a ") + key);
  if (kind != BoundaryKind::outlet)
    table.refuse("pressure", "only an outlet has a pressure");
}

BoundaryCondition read_condition(const CaseTable& table, const BoundaryPlace& place) {
  BoundaryCondition condition;
  condition.name = place.name;
  condition.kind = table.choice<BoundaryKind>("type", {{"inlet", BoundaryKind::inlet},
                                                       {"outlet", BoundaryKind::outlet},
                                                       {"wall", BoundaryKind::wall},
                                                       {"slip", BoundaryKind::slip},
                                                       {"symmetry", BoundaryKind::slip}});
  refuse_keys_of_others(table, condition.kind);
  if (condition.kind == BoundaryKind::inlet)
    read_inlet(table, place.side, condition);
  if (condition.kind == BoundaryKind::wall)
    read_wall(table, place.side, condition);
  if (condition.kind == BoundaryKind::outlet)
    condition.pressure = table.number("pressure", 0.0, any_number, "Pa");
  return condition;
}

void read_boundaries(CaseFile& file, GasCase& gas_case) {
  bool outlet = false;
  for (const CaseTable& table : file.tables("boundary")) {
    const BoundaryPlace place = read_boundary_place(table, gas_case.grid);
    for (const BoundaryCondition& earlier : gas_case.boundaries)
      if (earlier.name == place.name)
        table.fail("name", "a name of its own: another [[boundary]] has this one");
    gas_case.boundaries.push_back(read_condition(table, place));
    read_heat(table, gas_case.energy, gas_case.boundaries.back());
    outlet = outlet || gas_case.boundaries.back().kind == BoundaryKind::outlet;
  }
  for (std::size_t b = 0; b < gas_case.boundaries.size(); ++b)
    if (const auto& condition = gas_case.boundaries[b];
        !outlet && condition.kind == BoundaryKind::inlet && condition.velocity != Vec3{})
      throw ConfigError(file.name() + ": [[boundary]] \"" + condition.name +
                        "\" is an inlet, but no [[boundary]] has type = \"outlet\": the gas "
                        "could not leave");
}

Numerics read_numerics(const CaseTable& table) {
  Numerics numerics;
  numerics.convection = table.choice<ConvectionScheme>("convection", numerics.convection,
                                                       {{"central", ConvectionScheme::central},
                                                        {"upwind2", ConvectionScheme::upwind2},
                                                        {"limited", ConvectionScheme::limited}});
  numerics.time_scheme = table.choice<TimeScheme>(
      "time_scheme", numerics.time_scheme,
      {{"semi_implicit", TimeScheme::semi_implicit}, {"implicit", TimeScheme::implicit}});
  if (numerics.time_scheme != TimeScheme::implicit)
    table.refuse("implicit_tolerance", "it needs time_scheme = \"implicit\"");
  numerics.implicit_tolerance = table.number("implicit_tolerance", numerics.implicit_tolerance,
                                             {.low = 1e-14, .high = 1e-2}, "");
  numerics.pressure_corrections =
      table.integer("pressure_corrections", numerics.pressure_corrections, 0, 100);
  numerics.pressure_solver =
      table.choice<PressureMethod>("pressure_solver", numerics.pressure_solver,
                                   {{"auto", PressureMethod::automatic},
                                    {"direct", PressureMethod::direct},
                                    {"multigrid", PressureMethod::multigrid},
                                    {"hypre", PressureMethod::hypre}});
  constexpr NumberRange tolerance{.low = 1e-15, .high = 1e-2};
  numerics.pressure_tolerance =
      table.number("pressure_tolerance", numerics.pressure_tolerance, tolerance, "");
  numerics.viscous_tolerance =
      table.number("viscous_tolerance", numerics.viscous_tolerance, tolerance, "");
  numerics.time_step = table.number("time_step", numerics.time_step, positive, "s");
  numerics.courant = table.number("courant", numerics.courant, positive, "");
  numerics.end_time = table.number("end_time", numerics.end_time, positive, "s");
  return numerics;
}

Output read_output(const CaseTable& table) {
  Output output;
  output.fields = table.text("fields", "");
  if (output.fields.empty())
    table.refuse("every", "it needs fields, the path of the files to write");
  else
    output.every = table.number("every", positive, "s");
  output.checkpoint = table.text("checkpoint", "");
  if (output.checkpoint.empty())
    table.refuse("checkpoint_every", "it needs checkpoint, the path of the file to write");
  output.checkpoint_every = table.number("checkpoint_every", 0.0, positive, "s");
  return output;
}

} // namespace

GasCase read_gas_case(CaseFile& file) {
  GasCase gas_case;
  gas_case.grid = read_grid(file);
  gas_case.fluid = read_fluid(file.table("fluid"), gas_case.grid);
  gas_case.energy = read_energy(file);
  read_boundaries(file, gas_case);
  gas_case.initial_velocity = file.table("initial").vector("velocity", Vec3{}, any_number, "m/s");
  gas_case.numerics = read_numerics(file.table("numerics"));
  gas_case.output = read_output(file.table("output"));
  return gas_case;
}

GasCase read_gas_case(const std::string& path, MPI_Comm comm) {
  CaseFile file = CaseFile::read(path, comm);
  file.skip("coupling");
  GasCase gas_case = read_gas_case(file);
  file.finish();
  return gas_case;
}

} // namespace granflux::cfd
