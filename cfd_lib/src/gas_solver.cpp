// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/cfd/gas_solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <granflux/cfd/error.hpp>

#include "block_geometry.hpp"
#include "gas_state.hpp"
#include "state_exchange.hpp"
#include "throw_alike.hpp"

namespace granflux::cfd {

namespace {

FaceFields make_faces(const Mesh& mesh) {
  FaceFields faces;
  for (const Block& block : mesh.local)
    faces.push_back({Field(block.layout), Field(block.layout), Field(block.layout)});
  return faces;
}

/// On rank 0; empty elsewhere.
std::vector<Vec3> of_all_ranks(const Vec3& mine, MPI_Comm comm) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  std::vector<Vec3> all(rank == 0 ? std::size_t(ranks) : 0);
  MPI_Gather(&mine, 3, MPI_DOUBLE, all.data(), 3, MPI_DOUBLE, 0, comm);
  return all;
}

/// This rank's share of what rank 0 has of all ranks; if they were not as many, rank 0 has the sum.
Vec3 own_of(std::vector<Vec3> all, MPI_Comm comm) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &ranks);
  if (rank == 0 && all.size() != std::size_t(ranks)) {
    Vec3 sum;
    for (const Vec3& one : all)
      sum += one;
    all.assign(std::size_t(ranks), {});
    all.front() = sum;
  }
  Vec3 mine;
  MPI_Scatter(all.data(), 3, MPI_DOUBLE, &mine, 3, MPI_DOUBLE, 0, comm);
  return mine;
}

/// Cells to the last, volumes to rounding, which depends on the number of ranks.
void check_same_grid(RecordReader& in, const std::vector<Index3>& given,
                     const std::vector<double>& volumes) {
  bool same = in.read() == double(given.size());
  for (std::size_t g = 0; g < given.size() && same; ++g) {
    for (const int n : given[g])
      same = in.read() == double(n) && same;
    same = std::abs(in.read() - volumes[g]) <= 1e-9 * volumes[g] && same;
  }
  if (!same)
    throw ConfigError("it is of another grid");
}

} // namespace

MomentumExchange make_exchange(const Mesh& mesh) {
  return {make_fields(mesh), make_vectors(mesh), make_fields(mesh, 1)};
}

GasSolver::Impl::Impl(const Mesh& m, const GasCase& c)
    : mesh(m), fluid(c.fluid), numerics(c.numerics), halo(m), boundaries(m, c.boundaries),
      diffusion_solver(m, boundaries),
      pressure_solver(make_pressure_solver(c.numerics.pressure_solver, m, !boundaries.has_outlet(),
                                           c.numerics.pressure_tolerance)),
      eps(make_fields(m, 1)), eps_start(make_fields(m, 1)), eps_middle(make_fields(m, 1)),
      eps_inertia(make_fields(m, 1)), eps_inertia_start(make_fields(m, 1)),
      eps_rate(make_fields(m)), eps_rate_old(make_fields(m)), u(make_vectors(m)), p(make_fields(m)),
      grad_p(make_vectors(m)), drag_slope(make_vectors(m)), flux(make_faces(m)),
      convection(make_vectors(m)), convection_old(make_vectors(m)), a(make_fields(m)),
      r(make_vectors(m)), share(make_fields(m, 1)),
      inertia(make_fields(m)), defect{make_fields(m), make_fields(m), make_fields(m)},
      conductance(make_faces(m)) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    system.coefficient.push_back(
        {Field(mesh.local[b].layout), Field(mesh.local[b].layout), Field(mesh.local[b].layout)});
  system.rhs = make_fields(mesh);
  if (numerics.time_scheme == TimeScheme::implicit)
    implicit = std::make_unique<ImplicitMomentum>(
        ImplicitMomentum{{m, halo, boundaries}, make_vectors(m), make_vectors(m), {}});
  if (!mesh.orthogonal || fluid.smagorinsky > 0) {
    velocity_gradient.fill(make_vectors(m));
    face_work = make_faces(m);
  }
  if (!mesh.orthogonal)
    pressure_slope = make_vectors(m);
  if (fluid.smagorinsky > 0)
    eddy_viscosity = make_fields(m);
  if (c.energy)
    energy = std::make_unique<EnergyEquation>(m, halo, boundaries, fluid, *c.energy, numerics);
}

std::array<double, 5> GasSolver::Impl::state_numbers() const {
  return {time, dt_old, double(steps), double(has_history), double(has_drag)};
}

void GasSolver::Impl::set_state_numbers(const std::array<double, 5>& numbers) {
  time = numbers[0], dt_old = numbers[1], steps = long(numbers[2]);
  has_history = numbers[3] != 0, has_drag = numbers[4] != 0;
}

std::vector<std::vector<Field*>> GasSolver::Impl::state_fields() {
  std::vector<std::vector<Field*>> all;
  const auto add = [&](auto& blocks, auto&& field_of) {
    if (blocks.empty())
      return; // not there in this case
    all.emplace_back();
    for (auto& block : blocks)
      all.back().push_back(&field_of(block));
  };
  const auto itself = [](Field& field) -> Field& { return field; };
  for (BlockFields* scalar : {&eps, &eps_middle, &eps_inertia, &eps_rate, &eps_rate_old, &p})
    add(*scalar, itself);
  for (std::size_t m = 0; m < 3; ++m) {
    const auto component = [m](std::array<Field, 3>& of) -> Field& { return of[m]; };
    for (BlockVectors* vector : {&u, &grad_p, &drag_slope, &convection, &pressure_slope})
      add(*vector, component);
    add(flux, component);
  }
  if (energy)
    for (BlockFields* scalar : energy->state())
      add(*scalar, itself);
  return all;
}

/// Of each block of the grid as given, on all ranks [m3].
std::vector<double> GasSolver::Impl::volumes_given() const {
  std::vector<double> volumes(mesh.given.size());
  for (const Block& block : mesh.local)
    volumes[std::size_t(mesh.info(block).place.block)] +=
        sum_cells(block.layout, [&](std::ptrdiff_t c) { return block.volume[c]; });
  MPI_Allreduce(MPI_IN_PLACE, volumes.data(), int(volumes.size()), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return volumes;
}

GasSolver::GasSolver(const Mesh& mesh, const GasCase& gas_case)
    : impl_(std::make_unique<Impl>(mesh, gas_case)) {
  initialise(make_fields(mesh, 1), gas_case.initial_velocity);
}

GasSolver::~GasSolver() = default;

void GasSolver::initialise(const BlockFields& void_fraction, Vec3 velocity, double time) {
  initialise(void_fraction, make_vectors(impl_->mesh, velocity), time);
}

void GasSolver::initialise(const BlockFields& void_fraction, const BlockVectors& velocity,
                           double time) {
  Impl& s = *impl_;
  s.time = time;
  s.steps = 0;
  s.has_history = false;
  s.eps = s.eps_middle = s.eps_inertia = void_fraction;
  s.steps_at_rest = 0;
  s.eps_rate = s.eps_rate_old = make_fields(s.mesh);
  s.halo.exchange({&s.eps_middle});
  s.boundaries.fill_zero_gradient(s.eps_middle);
  s.p = make_fields(s.mesh);
  s.drag_slope = make_vectors(s.mesh);
  s.has_drag = false;
  s.r = s.u = velocity;
  s.halo.exchange(s.u);
  s.boundaries.fill_velocity(s.u, s.eps_middle, time);
  s.update_velocity_gradient();
  s.a = s.share = make_fields(s.mesh, 1);
  StepReport report;
  s.project(time, Drive::none, nullptr, report);
  s.p = make_fields(s.mesh); // that was a potential, not a pressure
  s.set_pressure_gradient(Drive::given, After::nothing);
  s.own_momentum = s.momentum();
  s.check_finite();
  if (s.energy)
    s.energy->initialise();
}

StepReport GasSolver::advance(double dt, const BlockFields& void_fraction,
                              const MomentumExchange* exchange, const HeatExchange* heat) {
  if (!(dt > 0))
    throw ConfigError("gas: time step " + std::to_string(dt) + " s: must be > 0");
  if (heat && !impl_->energy)
    throw ConfigError("gas: heat is exchanged, but the case has no [energy] table");
  try {
    return impl_->advance(dt, void_fraction, exchange, heat);
  } catch (const NumericalError&) { // on all ranks alike
    impl_->check_finite();          // a cell tells more than a solver that cannot go on
    throw;
  }
}

StepReport GasSolver::Impl::advance(double dt, const BlockFields& void_fraction,
                                    const MomentumExchange* exchange, const HeatExchange* heat) {
  StepReport report;
  const double new_time = time + dt;
  const double ratio = has_history ? dt / dt_old : 0;
  ab_now = implicit ? 0.5 : 1 + 0.5 * ratio;
  ab_old = implicit ? 0 : -0.5 * ratio;

  update_velocity_gradient();
  if (!implicit) {
    std::swap(convection, convection_old);
    outflow_old = outflow;
  }
  if (energy)
    energy->begin(eps);
  report.history_restarted = move_void_fraction(dt, void_fraction);
  set_conductance();
  set_medium(dt, exchange);
  begin_momentum(dt, exchange);
  if (implicit) {
    iterate_implicit(new_time, exchange, report);
  } else {
    predict(new_time, report);
    add_new_friction(new_time);
    project(new_time, Drive::given, exchange, report);
  }
  take_balance(dt, exchange);
  if (!std::isfinite(norm(balance.momentum_residual)))
    check_finite(); // names the cell and throws
  if (energy)
    energy->advance(dt, ratio, flux, eps, eps_middle, eddy_viscosity, heat, face_work, balance);

  measure(dt, report);
  check_courant(dt, report.courant);
  time = new_time;
  dt_old = dt;
  has_history = true;
  ++steps;
  return report;
}

double GasSolver::time() const {
  return impl_->time;
}
long GasSolver::steps() const {
  return impl_->steps;
}
const BlockVectors& GasSolver::velocity() const {
  return impl_->u;
}
const BlockFields& GasSolver::pressure() const {
  return impl_->p;
}
const BlockVectors& GasSolver::pressure_gradient() const {
  return impl_->grad_p;
}
const BlockFields& GasSolver::void_fraction() const {
  return impl_->eps;
}
const BlockFields* GasSolver::temperature() const {
  return impl_->energy ? &impl_->energy->temperature() : nullptr;
}
void GasSolver::set_temperature(const BlockFields& temperature) {
  if (!impl_->energy)
    throw ConfigError("gas: a temperature is set, but the case has no [energy] table");
  impl_->energy->set_temperature(temperature);
}
const Balance& GasSolver::balance() const {
  return impl_->balance;
}
const Mesh& GasSolver::mesh() const {
  return impl_->mesh;
}
const Fluid& GasSolver::fluid() const {
  return impl_->fluid;
}

namespace {

/// Sum over the faces of a named boundary of N terms, over all ranks.
template <std::size_t N, class Term>
std::array<double, N> sum_boundary(const Mesh& mesh, const Boundaries& boundaries,
                                   const std::string& name, Term&& term) {
  std::array<double, N> sums{};
  bool known = false;
  for (const BoundaryCondition& condition : boundaries.conditions())
    known = known || condition.name == name;
  if (!known)
    throw ConfigError("the gas has no boundary named \"" + name + "\"");
  for (const BoundaryPatch& patch : boundaries.patches())
    if (boundaries.condition(patch).name == name)
      for (const BoundaryFace& face : patch.faces) {
        const std::array<double, N> one = term(patch, face);
        for (std::size_t n = 0; n < N; ++n)
          sums[n] += one[n];
      }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), int(N), MPI_DOUBLE, MPI_SUM, mesh.comm);
  return sums;
}

} // namespace

double GasSolver::boundary_pressure(const std::string& boundary) const {
  const Impl& s = *impl_;
  const auto [weighted, area] = sum_boundary<
      2>(s.mesh, s.boundaries, boundary, [&](const BoundaryPatch& patch, const BoundaryFace& face) {
    const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
    const VectorField& area_of = s.mesh.local[b].area[d];
    const double size = norm({area_of[0][face.face], area_of[1][face.face], area_of[2][face.face]});
    return std::array<double, 2>{0.5 * size * (s.p[b][face.cell] + s.p[b][face.ghost]), size};
  });
  return weighted / area;
}

double GasSolver::boundary_flux(const std::string& boundary) const {
  const Impl& s = *impl_;
  return sum_boundary<1>(
      s.mesh, s.boundaries, boundary, [&](const BoundaryPatch& patch, const BoundaryFace& face) {
        return std::array<double, 1>{
            patch.outward *
            s.flux[std::size_t(patch.block)][std::size_t(patch.direction)][face.face]};
      })[0];
}

Vec3 GasSolver::boundary_force(const std::string& boundary) const {
  const Impl& s = *impl_;
  const auto [x, y, z] = sum_boundary<3>(
      s.mesh, s.boundaries, boundary, [&](const BoundaryPatch& patch, const BoundaryFace& face) {
        const auto b = std::size_t(patch.block), d = std::size_t(patch.direction);
        const Block& block = s.mesh.local[b];
        const BoundaryCondition& condition = s.boundaries.condition(patch);
        const std::ptrdiff_t c = face.cell;
        const Vec3 outward = patch.outward * get(block.area[d], face.face);
        double viscosity = s.fluid.viscosity;
        if (!s.eddy_viscosity.empty())
          viscosity += s.eddy_viscosity[b][c];
        viscosity *= s.eps_middle[b][c];

        Vec3 force = 0.5 * (s.p[b][c] + s.p[b][face.ghost]) * outward;
        force -= viscosity * block.conductance[d][face.face] *
                 (get(s.u[b], face.ghost) - get(s.u[b], c));
        const bool given =
            condition.kind == BoundaryKind::wall || condition.kind == BoundaryKind::inlet;
        if (block.skew && given) {
          const Vec3 cross_area = patch.outward * get(block.skew->cross[d], face.face);
          const std::array<Vec3, 3> dual = dual_vectors(block, c);
          for (int m = 0; m < 3; ++m) {
            const Field& q = s.u[b][std::size_t(m)];
            for (std::size_t n = 0; n < 3; ++n) {
              const std::ptrdiff_t stride = block.layout.stride[n];
              force[m] -=
                  0.5 * viscosity * (q[c + stride] - q[c - stride]) * dot(dual[n], cross_area);
            }
          }
        }
        // On a wall n . transposed grad u is -omega x n: by continuity the normal velocity does not
        // vary across it, and along it all that moves is the wall.
        force += viscosity * cross(condition.angular_velocity, outward);
        return std::array<double, 3>{force.x, force.y, force.z};
      });
  return {x, y, z};
}

double GasSolver::friction_rate() const {
  const Impl& s = *impl_;
  double largest = 0;
  for (const Block& block : s.mesh.local) {
    const auto [si, sj, sk] = block.layout.stride;
    const auto& [i, j, k] = block.conductance;
    largest = max_cells(block.layout, largest,
                        [&, si = si, sj = sj, sk = sk, &i = i, &j = j, &k = k](std::ptrdiff_t c) {
                          return 0.5 * (i[c] + i[c + si] + j[c] + j[c + sj] + k[c] + k[c + sk]) /
                                 block.volume[c];
                        });
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, s.mesh.comm);
  return s.fluid.viscosity / s.fluid.density * largest;
}

double GasSolver::courant_rate() const {
  StepReport report;
  impl_->measure(1, report);
  return report.courant;
}

std::uint64_t GasSolver::saved_numbers() const {
  const Impl& s = *impl_;
  int ranks = 1;
  MPI_Comm_size(s.mesh.comm, &ranks);
  return s.state_numbers().size() + 1 + 3 * std::size_t(ranks) + 2 + 4 * s.mesh.given.size() +
         impl_->state_fields().size() * StateExchange(s.mesh).numbers();
}

void GasSolver::save(RecordWriter* out) const {
  const Impl& s = *impl_;
  const std::vector<double> volumes = s.volumes_given();
  const std::vector<Vec3> outflows = of_all_ranks(s.outflow, s.mesh.comm);
  const std::vector<std::vector<Field*>> fields = impl_->state_fields();
  if (out) {
    out->write(s.state_numbers());
    out->write(double(outflows.size()));
    out->write({&outflows.front().x, 3 * outflows.size()});
    out->write(double(s.mesh.given.size()));
    for (std::size_t g = 0; g < volumes.size(); ++g) {
      for (const int n : s.mesh.given[g])
        out->write(double(n));
      out->write(volumes[g]);
    }
    out->write(double(fields.size()));
  }
  const StateExchange exchange(s.mesh);
  for (const std::vector<Field*>& field : fields)
    exchange.gather({field.begin(), field.end()}, out);
}

void GasSolver::load(RecordReader* in) {
  Impl& s = *impl_;
  const std::vector<double> volumes = s.volumes_given();
  const std::vector<std::vector<Field*>> fields = s.state_fields();
  const StateExchange exchange(s.mesh);
  std::array<double, 5> numbers{};
  std::vector<Vec3> outflows;
  std::string error;
  if (in)
    try {
      in->read(numbers);
      outflows.resize(in->read_count(in->left()));
      for (Vec3& one : outflows)
        one = {in->read(), in->read(), in->read()};
      check_same_grid(*in, s.mesh.given, volumes);
      if (in->read() != double(fields.size()) || in->left() != fields.size() * exchange.numbers())
        throw ConfigError("it is of a case with other equations: with or without a temperature, "
                          "on another kind of grid");
    } catch (const ConfigError& e) {
      error = e.what();
    }
  throw_alike(s.mesh.comm, error);
  MPI_Bcast(numbers.data(), int(numbers.size()), MPI_DOUBLE, 0, s.mesh.comm);
  s.set_state_numbers(numbers);
  s.outflow = own_of(outflows, s.mesh.comm);
  for (const std::vector<Field*>& field : fields)
    exchange.scatter(in, field);
  s.steps_at_rest = 0;
  s.own_momentum = s.momentum();
}

} // namespace granflux::cfd
