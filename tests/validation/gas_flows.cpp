// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include "gas_flows.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/gas_solver.hpp>

namespace granflux::cfd::validation {

namespace {

constexpr std::size_t u(int i) {
  return std::size_t(i);
}

/// Numerics of all these runs: second order, and steps that the Courant number sets.
Numerics numerics_of_a_run(TimeScheme time_scheme) {
  Numerics n;
  n.time_scheme = time_scheme;
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

/// Runs until what `changed` gives at the end of a time `interval`, by how much the flow is another
/// than at its start, is `steadiness.change` in a unit of time. Throws NumericalError where it
/// never is.
void settle(
    GasSolver& gas, const Steadiness& steadiness, double unit, double interval, double first_step,
    const std::function<double()>& changed, const std::function<void()>& each_step = [] {}) {
  Clock clock(gas, steadiness.courant, first_step);
  double change = 1;
  while (change > steadiness.change) {
    const double start = gas.time();
    if (start > steadiness.most_time * unit)
      throw NumericalError("flow not steady after " + std::to_string(steadiness.most_time) +
                           " units of time: still changes by " + std::to_string(change));
    while (gas.time() < start + interval) {
      clock.step();
      each_step();
    }
    change = changed() * unit / (gas.time() - start);
  }
}

/// Until no velocity component changes by more than `steadiness.change` of the largest one in the
/// time `unit`.
void settle_everywhere(GasSolver& gas, const Steadiness& steadiness, double unit,
                       double first_step) {
  const Layout& layout = gas.mesh().local[0].layout;
  BlockVectors before = gas.velocity();
  settle(gas, steadiness, unit, unit, first_step, [&] {
    const double change =
        largest(gas.velocity(), &before, layout) / largest(gas.velocity(), nullptr, layout);
    before = gas.velocity();
    return change;
  });
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
GasCase cavity(const CavityGrid& grid, TimeScheme time_scheme) {
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
  c.numerics = numerics_of_a_run(time_scheme);
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

/// For each of the fine positions, where it lies between the coarse ones.
std::vector<std::pair<int, double>> places(const std::vector<double>& fine,
                                           const std::vector<double>& coarse) {
  std::vector<std::pair<int, double>> out;
  for (const double x : fine)
    out.push_back(between(coarse, x));
  return out;
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

/// Velocity, and temperature where there is one, of a coarser run of the same flow, brought to this
/// grid linearly: `along` are the places of the cells among the coarse ones, `d` its directions.
void begin_with(Run& run, const Run& coarse, std::array<int, 2> d,
                const std::array<std::vector<std::pair<int, double>>, 2>& along) {
  const Layout &to = run.block().layout, &from = coarse.block().layout;
  const auto cell = [&](const Layout& layout, int a, int b) {
    Index3 c{0, 0, 0};
    c[u(d[0])] = a, c[u(d[1])] = b;
    return layout.at(c[0], c[1], c[2]);
  };
  BlockVectors velocity = make_vectors(run.mesh);
  BlockFields temperature = make_fields(run.mesh);
  for (int b = 0; b < int(along[1].size()); ++b)
    for (int a = 0; a < int(along[0].size()); ++a) {
      const auto [ca, s] = along[0][u(a)];
      const auto [cb, t] = along[1][u(b)];
      const auto value = [&, ca = ca, cb = cb, s = s, t = t](const Field& q) {
        return (1 - s) * ((1 - t) * q[cell(from, ca, cb)] + t * q[cell(from, ca, cb + 1)]) +
               s * ((1 - t) * q[cell(from, ca + 1, cb)] + t * q[cell(from, ca + 1, cb + 1)]);
      };
      const std::ptrdiff_t c = cell(to, a, b);
      for (std::size_t m = 0; m < 3; ++m)
        velocity[0][m][c] = value(coarse.gas.velocity()[0][m]);
      if (run.gas.temperature())
        temperature[0][c] = value((*coarse.gas.temperature())[0]);
    }
  run.gas.initialise(make_fields(run.mesh, 1), velocity);
  if (run.gas.temperature())
    run.gas.set_temperature(temperature);
}

/// What a coarser run need reach: its own error is far larger.
Steadiness rough(Steadiness steadiness) {
  steadiness.change *= 10;
  return steadiness;
}

/// Steady flow in a cavity; begins with the steady flow on every second grid line.
std::unique_ptr<Run> settled_cavity(const std::function<GasCase(const CavityGrid&)>& make,
                                    const CavityGrid& grid, const Steadiness& steadiness,
                                    double unit, double speed) {
  auto run = std::make_unique<Run>(make(grid));
  if (grid.cells >= 48 && grid.cells % 2 == 0) {
    const CavityGrid coarse_grid{grid.cells / 2, grid.stretching};
    const auto coarse = settled_cavity(make, coarse_grid, rough(steadiness), unit, speed);
    const auto along = places(centres(cavity_nodes(grid)), centres(cavity_nodes(coarse_grid)));
    begin_with(*run, *coarse, {0, 2}, {along, along});
  }
  settle_everywhere(run->gas, steadiness, unit, 0.1 * steadiness.courant / (grid.cells * speed));
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
    GasCase c = cavity(g, steadiness.time_scheme);
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
    GasCase c = cavity(g, steadiness.time_scheme);
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

/// Radii of the nodes: cells grow from the first, not beyond the widest as far as the wake reaches,
/// then again so that the last node is the outer radius.
std::vector<double> cylinder_radii(const CylinderGrid2D& grid) {
  std::vector<double> r{0.5};
  double width = grid.first;
  while (r.back() < grid.wake) {
    r.push_back(r.back() + width);
    width = std::min(width * grid.growth, std::max(grid.widest, grid.first));
  }
  const double left = grid.outer_radius - r.back();
  const int cells =
      int(std::ceil(std::log1p(left * (grid.growth - 1) / width) / std::log(grid.growth)));
  const double growth = growth_of(width, left, cells);
  for (int i = 0; i < cells; ++i, width *= growth)
    r.push_back(r.back() + width);
  r.back() = grid.outer_radius;
  return r;
}

/// Angles of the nodes, degrees, from the wake's axis around.
std::vector<double> cylinder_angles(const CylinderGrid2D& grid) {
  std::vector<double> angles;
  for (int j = 0; j <= grid.tangential; ++j) {
    const double s = double(j) / grid.tangential, turn = 2 * std::numbers::pi;
    angles.push_back(360 * (s - grid.gather * std::sin(turn * s) / turn));
  }
  angles.back() = 360;
  return angles;
}

CylinderGrid2D half(CylinderGrid2D grid) {
  grid.tangential /= 2, grid.first *= 2, grid.widest *= 2, grid.growth *= grid.growth;
  return grid;
}

GasCase cylinder(double reynolds, const CylinderGrid2D& grid, TimeScheme time_scheme) {
  GasCase c;
  AnnulusGrid annulus;
  annulus.radii = cylinder_radii(grid), annulus.angles = cylinder_angles(grid);
  annulus.length = depth;
  annulus.radial = int(annulus.radii.size()) - 1, annulus.tangential = grid.tangential;
  annulus.axial = 1, annulus.periodic_axis = true;
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
  c.numerics = numerics_of_a_run(time_scheme);
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
  const auto square_of_angle = [&](std::ptrdiff_t c) {
    const double angle = std::atan2(block.centre[1][c], block.centre[0][c]);
    return angle * angle;
  };
  std::vector<Sample> axis{{0.5, 0}};
  for (int i = 0; i < layout.cells[0]; ++i) { // the axis lies between the first and the last ray
    const std::ptrdiff_t c = layout.at(i, 0, 0), beyond = layout.at(i, 1, 0);
    const double near = 0.5 * (q[c] + q[layout.at(i, rays - 1, 0)]);
    const double far = 0.5 * (q[beyond] + q[layout.at(i, rays - 2, 0)]);
    // The wake is narrow: on an arc the velocity is a parabola of the angle.
    const double a = square_of_angle(c), b = square_of_angle(beyond);
    axis.push_back(
        {std::hypot(block.centre[0][c], block.centre[1][c]), (b * near - a * far) / (b - a)});
  }
  for (std::size_t i = axis.size() - 1; i > 1; --i) // the stream comes back once and for all
    if (axis[i - 1].value < 0 && axis[i].value >= 0) {
      double low = axis[i - 1].coordinate, high = axis[i].coordinate;
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

std::unique_ptr<Run> settled_cylinder(
    double reynolds, const CylinderGrid2D& grid, const Steadiness& steadiness, int coarser,
    const std::function<void(const Run&)>& each_step = [](const Run&) {}) {
  auto run = std::make_unique<Run>(cylinder(reynolds, grid, steadiness.time_scheme));
  if (coarser > 0 && grid.tangential % 2 == 0) {
    const CylinderGrid2D coarse_grid = half(grid);
    const auto coarse = settled_cylinder(reynolds, coarse_grid, rough(steadiness), coarser - 1);
    std::vector<double> around = centres(cylinder_angles(coarse_grid));
    around.insert(around.begin(), around.back() - 360); // the circle closes
    around.push_back(around[1] + 360);
    auto angles = places(centres(cylinder_angles(grid)), around);
    for (auto& [ray, share] : angles)
      --ray;
    begin_with(
        *run, *coarse, {0, 1},
        {places(centres(cylinder_radii(grid)), centres(cylinder_radii(coarse_grid))), angles});
  }
  // Far out, where nothing is measured, cells are too wide to damp the waves of the start. They
  // pass over the cylinder now and then: a long interval.
  constexpr double interval = 10;
  double drag = 0, wake = 0;
  const auto changed = [&] {
    const double old_drag = std::exchange(drag, force_sample(run->gas).drag);
    const double old_wake = std::exchange(wake, wake_length(*run));
    const double change = std::max(std::abs(drag / old_drag - 1), std::abs(wake / old_wake - 1));
    return std::isfinite(change) ? change : 1; // no wake yet
  };
  settle(run->gas, steadiness, 1, interval, 0.1 * grid.first, changed, [&] { each_step(*run); });
  return run;
}

} // namespace

CylinderFlow steady_cylinder(double reynolds, const CylinderGrid2D& grid,
                             const Steadiness& steadiness) {
  CylinderFlow flow;
  constexpr int coarser = 2;
  const auto run = settled_cylinder(reynolds, grid, steadiness, coarser, [&](const Run& r) {
    flow.history.push_back(force_sample(r.gas));
  });
  flow.drag = flow.history.back().drag;
  flow.pressure_drag = pressure_drag(*run);
  flow.wake_length = wake_length(*run);
  flow.radial = run->block().layout.cells[0];
  flow.time = run->gas.time();
  flow.steps = run->gas.steps();
  return flow;
}

CylinderFlow shedding_cylinder(double reynolds, const CylinderGrid2D& grid, double courant,
                               double end_time, int periods) {
  GasCase c = cylinder(reynolds, grid, TimeScheme::semi_implicit);
  c.initial_velocity = {1, 0.3, 0}; // begins to shed at once
  Run run(c);
  CylinderFlow flow;
  Clock clock(run.gas, courant, 0.1 * grid.first);
  while (run.gas.time() < end_time) {
    clock.step();
    flow.history.push_back(force_sample(run.gas));
  }
  flow.pressure_drag = pressure_drag(run);
  flow.radial = run.block().layout.cells[0];
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
