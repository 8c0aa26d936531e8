// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_flows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/gas_solver.hpp>

namespace granflux::cfd::validation {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// Numerics of all these runs: second order, and steps that the Courant number sets.
Numerics numerics_of_a_run() {
  Numerics n;
  n.convection = ConvectionScheme::central;
  n.pressure_tolerance = 1e-6; // of each step's increment, which fades as the flow becomes steady
  n.viscous_tolerance = 1e-8;
  return n;
}

/// Advances with steps that hold the Courant number.
class Clock {
public:
  Clock(GasSolver& gas, double courant, double first_step)
      : gas_(gas), one_(make_fields(gas.mesh(), 1)), courant_(courant), dt_(first_step) {}
  void step() {
    const StepReport report = gas_.advance(dt_, one_, nullptr);
    const double wanted = report.courant > 0 ? courant_ / report.courant : 2;
    // Within a tenth the step stays: the equations' matrices do, too.
    if (wanted < 0.95 || wanted > 1.1)
      dt_ *= std::clamp(wanted, 0.5, 1.05);
  }

private:
  GasSolver& gas_;
  BlockFields one_;
  double courant_, dt_;
};

double largest(const BlockVectors& a, const BlockVectors* less, const Layout& layout) {
  double most = 0;
  for (int m = 0; m < 3; ++m)
    for (int k = 0; k < layout.cells[2]; ++k)
      for (int j = 0; j < layout.cells[1]; ++j)
        for (int i = 0; i < layout.cells[0]; ++i) {
          const std::ptrdiff_t c = layout.at(i, j, k);
          most = std::max(most, std::abs(a[0][u(m)][c] - (less ? (*less)[0][u(m)][c] : 0)));
        }
  return most;
}

/// Unit of time `unit`: a turnover. Throws NumericalError where the flow does not become steady.
void settle(
    GasSolver& gas, const Steadiness& steadiness, double unit, double first_step,
    const std::function<void()>& each_step = [] {}) {
  Clock clock(gas, steadiness.courant, first_step);
  const Layout& layout = gas.mesh().local[0].layout;
  double change = 1;
  while (change > steadiness.change) {
    const BlockVectors before = gas.velocity();
    const double start = gas.time();
    if (start > steadiness.most_time * unit)
      throw NumericalError("flow not steady after " + std::to_string(steadiness.most_time) +
                           " units of time: velocity still changes by " + std::to_string(change));
    while (gas.time() < start + unit) {
      clock.step();
      each_step();
    }
    change = largest(gas.velocity(), &before, layout) * unit / (gas.time() - start) /
             largest(gas.velocity(), nullptr, layout);
  }
}

std::vector<double> cavity_nodes(const CavityGrid& grid) {
  std::vector<double> nodes;
  for (int i = 0; i <= grid.cells; ++i) {
    const double s = double(i) / grid.cells, b = grid.stretching;
    nodes.push_back(b == 0 ? s : 0.5 * (1 + std::tanh(b * (2 * s - 1)) / std::tanh(b)));
  }
  nodes.back() = 1;
  return nodes;
}

/// Cavity in the plane of x and z, its walls named x_low and so on.
GasCase cavity(const CavityGrid& grid) {
  GasCase c;
  BoxGrid& box = box_grid(c);
  box.nodes[0] = box.nodes[2] = cavity_nodes(grid);
  box.nodes[1] = {0, 1.0 / grid.cells};
  box.periodic = {false, true, false};
  for (const int d : {0, 2})
    for (const bool high : {false, true}) {
      BoundaryCondition wall;
      wall.name = std::string(1, "xyz"[d]) + (high ? "_high" : "_low");
      box.patches.push_back(
          {wall.name, {d, high}, {-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}});
      c.boundaries.push_back(wall);
    }
  c.fluid.density = 1;
  c.numerics = numerics_of_a_run();
  return c;
}

/// Where a coordinate lies between increasing positions: the lower one and the share of the upper.
std::pair<int, double> between(const std::vector<double>& x, double at) {
  const auto above = std::upper_bound(x.begin(), x.end(), at);
  const int i = std::clamp(int(above - x.begin()) - 1, 0, int(x.size()) - 2);
  return {i, std::clamp((at - x[u(i)]) / (x[u(i + 1)] - x[u(i)]), 0.0, 1.0)};
}

/// Centres of the cells along direction d, of a block with such (a box, or rays of an annulus).
std::vector<double> centres(const std::vector<double>& nodes) {
  std::vector<double> x;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
    x.push_back(0.5 * (nodes[i] + nodes[i + 1]));
  return x;
}

/// Fields of a coarser run of the same cavity, brought to this grid linearly.
template <class Value>
void bring(const Layout& to, const std::vector<double>& fine, const Layout& from,
           const std::vector<double>& coarse, Value&& value) {
  for (int k = 0; k < to.cells[2]; ++k)
    for (int i = 0; i < to.cells[0]; ++i) {
      const auto [ci, s] = between(coarse, fine[u(i)]);
      const auto [ck, t] = between(coarse, fine[u(k)]);
      value(to.at(i, 0, k), [&, ci = ci, ck = ck, s = s, t = t](const Field& q) {
        return (1 - s) * (1 - t) * q[from.at(ci, 0, ck)] + s * (1 - t) * q[from.at(ci + 1, 0, ck)] +
               (1 - s) * t * q[from.at(ci, 0, ck + 1)] + s * t * q[from.at(ci + 1, 0, ck + 1)];
      });
    }
}

/// A mesh and its solver that stay where they are.
struct Run {
  explicit Run(const GasCase& gas_case)
      : mesh(make_mesh(gas_case, MPI_COMM_WORLD)), gas(mesh, gas_case) {
    if (mesh.local.size() != 1 || mesh.blocks.size() != 1)
      throw ConfigError("the flows of the validation run on one rank");
  }
  [[nodiscard]] const Block& block() const { return mesh.local[0]; }
  Mesh mesh;
  GasSolver gas;
};

/// Steady flow in a cavity; begins with the steady flow on every second grid line.
std::unique_ptr<Run> settled_cavity(const std::function<GasCase(const CavityGrid&)>& make,
                                    const CavityGrid& grid, const Steadiness& steadiness,
                                    double unit, double speed) {
  auto run = std::make_unique<Run>(make(grid));
  GasSolver& gas = run->gas;
  if (grid.cells >= 48 && grid.cells % 2 == 0) {
    const CavityGrid coarse_grid{grid.cells / 2, grid.stretching};
    Steadiness rough = steadiness;
    rough.change *= 10; // its own error is far larger
    const auto coarse = settled_cavity(make, coarse_grid, rough, unit, speed);
    const std::vector<double> x = centres(cavity_nodes(coarse_grid));
    BlockVectors velocity = make_vectors(run->mesh);
    BlockFields temperature = make_fields(run->mesh);
    bring(run->block().layout, centres(cavity_nodes(grid)), coarse->block().layout, x,
          [&](std::ptrdiff_t c, auto&& value) {
            for (std::size_t m = 0; m < 3; ++m)
              velocity[0][m][c] = value(coarse->gas.velocity()[0][m]);
            if (gas.temperature())
              temperature[0][c] = value((*coarse->gas.temperature())[0]);
          });
    gas.initialise(make_fields(run->mesh, 1), velocity);
    if (gas.temperature())
      gas.set_temperature(temperature);
  }
  settle(gas, steadiness, unit, 0.1 * steadiness.courant / (grid.cells * speed));
  return run;
}

/// Component m of the velocity on the middle line along direction d (0 or 2), walls' values at the
/// ends.
std::vector<Sample> middle_line(const Run& run, std::size_t m, int d, double low, double high) {
  const Layout& layout = run.block().layout;
  const int n = layout.cells[u(d)];
  const Field& q = run.gas.velocity()[0][m];
  std::vector<Sample> line{{0, low}};
  for (int i = 0; i < n; ++i) {
    double sum = 0; // the line is the face between two cells, or through one
    for (const int beside : {(n - 1) / 2, n / 2})
      sum += 0.5 * q[d == 0 ? layout.at(i, 0, beside) : layout.at(beside, 0, i)];
    line.push_back({run.block().centre[u(d)][layout.at(d == 0 ? i : 0, 0, d == 0 ? 0 : i)], sum});
  }
  line.push_back({1, high});
  return line;
}

/// Largest value of a line, by the parabola through the largest sample and its neighbours.
Sample largest_of(const std::vector<Sample>& line) {
  const auto top =
      std::max_element(line.begin() + 1, line.end() - 1,
                       [](const Sample& a, const Sample& b) { return a.value < b.value; });
  const auto [x0, y0] = *(top - 1);
  const auto [x1, y1] = *top;
  const auto [x2, y2] = *(top + 1);
  const double first = (y1 - y0) / (x1 - x0);
  const double second = ((y2 - y1) / (x2 - x1) - first) / (x2 - x0);
  const double x = 0.5 * (x0 + x1) - 0.5 * first / second;
  return {x, y0 + first * (x - x0) + second * (x - x0) * (x - x1)};
}

} // namespace

double at(const std::vector<Sample>& line, double coordinate) {
  int below = 0;
  while (below + 2 < int(line.size()) && line[u(below + 1)].coordinate <= coordinate)
    ++below;
  const int first = std::clamp(below - 1, 0, int(line.size()) - 4);
  double sum = 0; // Lagrange
  for (int i = first; i < first + 4; ++i) {
    double weight = 1;
    for (int j = first; j < first + 4; ++j)
      if (j != i)
        weight *=
            (coordinate - line[u(j)].coordinate) / (line[u(i)].coordinate - line[u(j)].coordinate);
    sum += weight * line[u(i)].value;
  }
  return sum;
}

LidCavity lid_cavity(double reynolds, const CavityGrid& grid, const Steadiness& steadiness,
                     double viscosity_factor) {
  const auto make = [&](const CavityGrid& g) {
    GasCase c = cavity(g);
    c.fluid.viscosity = viscosity_factor / reynolds;
    c.boundaries.back().velocity = {1, 0, 0}; // z_high
    return c;
  };
  const auto run = settled_cavity(make, grid, steadiness, 1, 1);
  return {middle_line(*run, 0, 2, 0, 1), middle_line(*run, 2, 0, 0, 0), run->gas.time(),
          run->gas.steps()};
}

HeatedCavity heated_cavity(double rayleigh, const CavityGrid& grid, const Steadiness& steadiness,
                           double buoyancy_factor) {
  constexpr double prandtl = 0.71;
  using Heat = BoundaryCondition::Heat;
  const auto make = [&](const CavityGrid& g) {
    GasCase c = cavity(g);
    c.fluid.viscosity = prandtl;
    c.fluid.gravity = {0, 0, -1};
    c.energy = Energy{.heat_capacity = 1,
                      .conductivity = 1,
                      .initial_temperature = 0,
                      .expansion = rayleigh * prandtl * buoyancy_factor,
                      .reference_temperature = 0};
    for (const int side : {0, 1}) { // x_low, x_high
      c.boundaries[u(side)].heat = Heat::temperature;
      c.boundaries[u(side)].temperature = side == 0 ? 0.5 : -0.5;
    }
    return c;
  };
  const double speed = 0.25 * std::sqrt(rayleigh * prandtl); // about the largest
  const auto run = settled_cavity(make, grid, steadiness, 1 / speed, speed);

  HeatedCavity out;
  const Layout& layout = run->block().layout;
  const Field& t = (*run->gas.temperature())[0];
  const std::vector<double> nodes = cavity_nodes(grid);
  for (int k = 0; k < grid.cells; ++k) { // what the solver lets through the walls
    const double height = nodes[u(k + 1)] - nodes[u(k)], half = 0.5 * nodes[1];
    out.nusselt += (0.5 - t[layout.at(0, 0, k)]) / half * height;
    out.nusselt_cold += (t[layout.at(grid.cells - 1, 0, k)] + 0.5) / half * height;
  }
  const Sample across = largest_of(middle_line(*run, 0, 2, 0, 0));
  const Sample up = largest_of(middle_line(*run, 2, 0, 0, 0));
  out.u_max = across.value, out.u_max_at = across.coordinate;
  out.v_max = up.value, out.v_max_at = up.coordinate;
  out.time = run->gas.time();
  out.steps = run->gas.steps();
  return out;
}

namespace {

constexpr double depth = 0.1; // m; nothing depends on it

/// Ratio of neighbouring widths with which n cells from the first width reach across.
double growth_of(double first, double across, int n) {
  const auto reach = [&](double g) { return first * (std::pow(g, n) - 1) / (g - 1); };
  double low = 1 + 1e-9, high = 2;
  if (reach(low) > across || reach(high) < across)
    throw ConfigError("no growth between 1 and 2 brings " + std::to_string(n) + " cells from " +
                      std::to_string(first) + " across " + std::to_string(across));
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (reach(middle) < across ? low : high) = middle;
  }
  return low;
}

GasCase cylinder(double reynolds, const CylinderGrid2D& grid) {
  GasCase c;
  AnnulusGrid annulus;
  annulus.inner_radius = 0.5, annulus.outer_radius = grid.outer_radius, annulus.length = depth;
  annulus.radial = grid.radial, annulus.tangential = grid.tangential, annulus.axial = 1;
  annulus.growth = growth_of(grid.first, grid.outer_radius - 0.5, grid.radial);
  annulus.periodic_axis = true;
  annulus.arcs = {{"stream", grid.outlet_angle, 360 - grid.outlet_angle},
                  {"wake", -grid.outlet_angle, grid.outlet_angle}};
  c.grid = annulus;
  c.fluid.density = 1;
  c.fluid.viscosity = 1 / reynolds;
  BoundaryCondition condition;
  condition.name = "inner";
  c.boundaries.push_back(condition);
  condition.name = "stream";
  condition.kind = BoundaryKind::inlet;
  condition.velocity = {1, 0, 0};
  c.boundaries.push_back(condition);
  condition.name = "wake";
  condition.kind = BoundaryKind::outlet;
  c.boundaries.push_back(condition);
  c.initial_velocity = {1, 0, 0};
  c.numerics = numerics_of_a_run();
  return c;
}

ForceSample force_sample(const GasSolver& gas) {
  const Vec3 force = gas.boundary_force("inner") / (0.5 * depth);
  return {gas.time(), force.x, force.y};
}

/// Distance in radii from the rear of the cylinder to where the gas on its axis stands still.
double wake_length(const Run& run) {
  const Block& block = run.block();
  const Layout& layout = block.layout;
  const Field& q = run.gas.velocity()[0][0];
  const int rays = layout.cells[1];
  std::vector<Sample> axis{{0.5, 0}};
  for (int i = 0; i < layout.cells[0]; ++i) { // the axis lies between the first and the last ray
    const std::ptrdiff_t c = layout.at(i, 0, 0);
    const double near = 0.5 * (q[c] + q[layout.at(i, rays - 1, 0)]);
    const double far = 0.5 * (q[layout.at(i, 1, 0)] + q[layout.at(i, rays - 2, 0)]);
    // The wake is narrow: on an arc the velocity is a parabola of the angle.
    axis.push_back({std::hypot(block.centre[0][c], block.centre[1][c]), (9 * near - far) / 8});
  }
  for (std::size_t i = 1; i + 1 < axis.size(); ++i)
    if (axis[i].value < 0 && axis[i + 1].value >= 0) {
      double low = axis[i].coordinate, high = axis[i + 1].coordinate;
      for (int n = 0; n < 60; ++n) {
        const double middle = 0.5 * (low + high);
        (at(axis, middle) < 0 ? low : high) = middle;
      }
      return (low - 0.5) / 0.5;
    }
  return 0;
}

double pressure_drag(const Run& run) {
  const Block& block = run.block();
  double sum = 0;
  for (int j = 0; j < block.layout.cells[1]; ++j) {
    const std::ptrdiff_t c = block.layout.at(0, j, 0), ghost = c - block.layout.stride[0];
    sum -= 0.5 * (run.gas.pressure()[0][c] + run.gas.pressure()[0][ghost]) * block.area[0][0][c];
  }
  return sum / (0.5 * depth);
}

} // namespace

CylinderFlow steady_cylinder(double reynolds, const CylinderGrid2D& grid,
                             const Steadiness& steadiness) {
  const GasCase c = cylinder(reynolds, grid);
  Run run(c);
  CylinderFlow flow;
  settle(run.gas, steadiness, 1, 0.1 * grid.first,
         [&] { flow.history.push_back(force_sample(run.gas)); });
  flow.drag = flow.history.back().drag;
  flow.pressure_drag = pressure_drag(run);
  flow.wake_length = wake_length(run);
  flow.growth = std::get<AnnulusGrid>(c.grid).growth;
  flow.time = run.gas.time();
  flow.steps = run.gas.steps();
  return flow;
}

CylinderFlow shedding_cylinder(double reynolds, const CylinderGrid2D& grid, double courant,
                               double end_time, int periods) {
  GasCase c = cylinder(reynolds, grid);
  c.initial_velocity = {1, 0.3, 0}; // begins to shed at once
  Run run(c);
  CylinderFlow flow;
  Clock clock(run.gas, courant, 0.1 * grid.first);
  while (run.gas.time() < end_time) {
    clock.step();
    flow.history.push_back(force_sample(run.gas));
  }
  flow.pressure_drag = pressure_drag(run);
  flow.growth = std::get<AnnulusGrid>(c.grid).growth;
  flow.time = run.gas.time();
  flow.steps = run.gas.steps();

  std::vector<double> upwards; // when the lift passes zero, and the sample after it
  std::vector<std::size_t> sample;
  for (std::size_t i = 1; i < flow.history.size(); ++i) {
    const ForceSample &a = flow.history[i - 1], &b = flow.history[i];
    if (a.lift < 0 && b.lift >= 0) {
      upwards.push_back(a.time + (b.time - a.time) * a.lift / (a.lift - b.lift));
      sample.push_back(i);
    }
  }
  if (int(upwards.size()) <= periods)
    throw NumericalError("the wake shed " + std::to_string(upwards.size()) + " times, " +
                         std::to_string(periods) + " periods are wanted: run for longer");
  flow.periods = periods;
  flow.strouhal = periods / (upwards.back() - upwards[upwards.size() - 1 - u(periods)]);
  double least = 0, most = 0, drag = 0, duration = 0;
  for (std::size_t i = sample[sample.size() - 1 - u(periods)]; i < sample.back(); ++i) {
    const double dt = flow.history[i].time - flow.history[i - 1].time;
    drag += dt * flow.history[i].drag, duration += dt;
    least = std::min(least, flow.history[i].lift), most = std::max(most, flow.history[i].lift);
  }
  flow.drag = drag / duration;
  flow.lift = 0.5 * (most - least);
  return flow;
}

} // namespace granflux::cfd::validation
