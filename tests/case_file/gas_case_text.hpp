// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include <granflux/cfd/read_gas_case.hpp>

namespace granflux::test {

/// A duct along z with an inlet below and an outlet above, periodic along y.
inline const std::string good_case = R"([grid]
kind = "box"
origin = [0.0, 0.0, 0.0]
size = [0.044, 0.010, 0.120]
cells = [8, 2, 12]
periodic = [false, true, false]
blocks = [1, 1, 2]

[fluid]
density = 1.2
viscosity = 1.8e-5
gravity = [0.0, 0.0, -9.81]
driving_pressure_gradient = [0.0, -1.5, 0.0]

[energy]
heat_capacity = 1000.0
conductivity = 0.03
initial_temperature = 310.0
expansion = 3e-3
reference_temperature = 300.0

[[boundary]]
name = "bottom"
side = "z_low"
type = "inlet"
velocity = [0.0, 0.0, 0.9]
profile = "parabolic"
ramp_time = 0.1
ramp_from = 0.01
temperature = 320.0

[[boundary]]
name = "top"
side = "z_high"
type = "outlet"
pressure = 5.0

[[boundary]]
name = "left"
side = "x_low"
type = "wall"
velocity = [0.0, 0.0, 0.1]
heat_flux = 25.0

[[boundary]]
name = "right"
side = "x_high"
type = "slip"

[initial]
velocity = [0.0, 0.0, 0.5]

[numerics]
convection = "upwind2"
pressure_solver = "multigrid"
pressure_tolerance = 1e-8
viscous_tolerance = 1e-9
time_step = 1e-4
end_time = 0.2

[output]
fields = "post/gas"
every = 0.01

[coupling]
drag = "gidaspow"
)";

/// The gap between a turning shaft and its bearing.
inline const std::string annulus_case = R"([grid]
kind = "annulus"
axis = "x"
origin = [0.1, 0.2, 0.3]
inner_radius = 0.01
outer_radius = 0.02
length = 0.03
cells = [4, 24, 2]
start_angle = 15
growth = 1.1
periodic_axis = true

[fluid]
density = 1.2
viscosity = 1.8e-5
driving_pressure_gradient = [-1.0, 0.0, 0.0]

[[boundary]]
name = "inner"
type = "wall"

[[boundary]]
name = "above"
angles = [15, 195]
type = "slip"

[[boundary]]
name = "below"
angles = [-165, 15]
type = "wall"
)";

/// A drum with an axis along z.
inline const std::string cylinder_case = R"([grid]
kind = "cylinder"
radius = 0.0762
length = 0.0762
cells = [5, 10, 15]
axial_blocks = 5
core_radius = 0.6
bulge = 0.25
growth = 0.95

[fluid]
density = 1.2
viscosity = 1.8e-5

[[boundary]]
name = "wall"
type = "wall"

[[boundary]]
name = "low"
type = "inlet"
velocity = [0.0, 0.0, 1.0]

[[boundary]]
name = "high"
type = "outlet"
)";

/// A grid from a file that is not there.
inline const std::string cgns_case = R"([grid]
kind = "cgns"
file = "no/such/drum.cgns"
base = "Drum"
scale = 0.001

[fluid]
density = 1.2
viscosity = 1.8e-5

[[boundary]]
name = "shell"
type = "wall"
)";

/// A text with one piece replaced.
inline std::string replaced(std::string text, const std::string& old_text,
                            const std::string& new_text) {
  const std::size_t at = text.find(old_text);
  if (at == std::string::npos)
    throw std::logic_error("the case has no \"" + old_text + "\"");
  return text.replace(at, old_text.size(), new_text);
}

/// The good case with one piece of its text replaced.
inline std::string with(const std::string& old_text, const std::string& new_text) {
  return replaced(good_case, old_text, new_text);
}

/// As granflux_cfd reads a file of that text.
inline cfd::GasCase gas_case_of(const std::string& text) {
  cfd::CaseFile file = cfd::CaseFile::parse(text, "bed.toml");
  file.skip("coupling");
  cfd::GasCase gas_case = cfd::read_gas_case(file);
  file.finish();
  return gas_case;
}

} // namespace granflux::test
