// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#include <granflux/coupling/coupler.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <omp.h>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/sweep.hpp>
#include <granflux/coupling/drag/laws.hpp>
#include <granflux/coupling/fluid_kick.hpp>
#include <granflux/coupling/ledger.hpp>
#include <granflux/coupling/locate.hpp>
#include <granflux/coupling/nusselt/laws.hpp>
#include <granflux/coupling/particle_block.hpp>
#include <granflux/coupling/smoothing.hpp>
#include <granflux/coupling/throw_together.hpp>
#include <granflux/coupling/weights.hpp>
#include <granflux/coupling/window_exchange.hpp>

// Symbols as in docs/theory_coupling.md: w share of a particle in a cell, S smoothing, T interval.

namespace granflux::coupling {

namespace {

/// K numbers of one particle or one window cell, deposited and sampled together.
template <std::size_t K> struct Values {
  std::array<double, K> of{};

  Values& operator+=(const Values& o) & {
    for (std::size_t k = 0; k < K; ++k)
      of[k] += o.of[k];
    return *this;
  }
  friend Values operator*(Values a, double s) {
    for (double& x : a.of)
      x *= s;
    return a;
  }
};

/// Adds the wall-clock time of its life to a counter.
class Stopwatch {
public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(MPI_Wtime()) {}
  ~Stopwatch() { seconds_ += MPI_Wtime() - start_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

private:
  double& seconds_;
  double start_;
};

/// Sums add(p, sums) over 0 <= p < n, each thread a fixed part, in order of thread.
template <class Sums, class Add> Sums sum_particles(std::size_t n, Add&& add) {
  std::vector<Sums> parts(static_cast<std::size_t>(omp_get_max_threads()));
#pragma omp parallel
  {
    Sums mine;
#pragma omp for schedule(static)
    for (std::ptrdiff_t p = 0; p < std::ptrdiff_t(n); ++p)
      add(std::size_t(p), mine);
    parts[std::size_t(omp_get_thread_num())] = mine;
  }
  Sums total;
  for (const Sums& part : parts)
    total += part;
  return total;
}

/// The same of add(first, count, sums) for blocks of particles.
template <class Sums, class Add> Sums sum_blocks(std::size_t n, Add&& add) {
  const std::size_t blocks = (n + particles_a_block - 1) / particles_a_block;
  return sum_particles<Sums>(blocks, [&](std::size_t b, Sums& sums) {
    const std::size_t first = b * particles_a_block;
    add(first, std::min(particles_a_block, n - first), sums);
  });
}

/// A vector of each particle of a block.
struct VectorLanes {
  Lanes x, y, z;
  void set(std::size_t i, const Vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
  [[nodiscard]] Vec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Lanes& operator[](int d) { return d == 0 ? x : d == 1 ? y : z; }
  const Lanes& operator[](int d) const { return d == 0 ? x : d == 1 ? y : z; }
  VectorLanes& operator*=(const Lanes& factor) & {
    for (Lanes* component : {&x, &y, &z})
      *component = lanes([&](std::size_t i) { return (*component)[i] * factor[i]; });
    return *this;
  }
  [[nodiscard]] CompensatedVec3 sum() const {
    return {coupling::sum(x), coupling::sum(y), coupling::sum(z)};
  }
  [[nodiscard]] CompensatedSum sum_of_norms() const {
    return coupling::sum(
        lanes([&](std::size_t i) { return std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]); }));
  }
};

/// A block of particles as the laws see it. Places without a particle, and particles that are not
/// placed, are in gas alone, without slip.
struct SeenBlock {
  Lanes there;    ///< 1 or 0
  Lanes diameter; ///< of particles, not of parcels [m]; 0 where there is none
  Lanes reynolds, void_fraction;
};

/// How many of those that are there a law is not meant for.
template <class Inside> double count_outside(const SeenBlock& seen, Inside&& inside) {
  double count = 0;
#pragma omp simd reduction(+ : count)
  for (std::size_t i = 0; i < particles_a_block; ++i)
    count += inside(i) ? 0 : seen.there[i];
  return count;
}

/// effective_coefficient() of a block, lambda = b T/m.
Lanes effective_coefficients(const Lanes& b, const Lanes& lambda) {
  Lanes effective = lanes([&](std::size_t i) { return b[i] * (1 + small_lag(lambda[i])); });
  if (!(largest(lambda) < small_lag_limit))
    for (std::size_t i = 0; i < particles_a_block; ++i)
      effective[i] = b[i] * drag_response(lambda[i]).mean;
  return effective;
}

double sphere_volume(double radius) {
  return 4 * std::numbers::pi / 3 * radius * radius * radius;
}

std::string text(const Vec3& x) {
  std::ostringstream out;
  out.precision(10);
  out << '(' << x.x << ", " << x.y << ", " << x.z << ')';
  return out.str();
}

/// Where there is no drag.
struct NoDrag {};

/// How particles respond to drag within a step: exactly; the same but for those held in place; or
/// with their velocity before the step.
enum class Response { exact, exact_unless_fixed, at_once };
template <Response r> using ResponseIs = std::integral_constant<Response, r>;

std::string text(double x) {
  std::ostringstream out;
  out.precision(10);
  out << x;
  return out.str();
}

} // namespace

struct Coupler::Impl {
  Impl(const cfd::GasCase& c, const CouplingOptions& o, MPI_Comm comm)
      : gas_case(c), options(o), mesh(cfd::make_mesh(c, comm)), halo(mesh), gas(mesh, c),
        locator(make_locator(mesh)),
        kernel(VoidFractionKernels::make("void_fraction", o.void_fraction)),
        diameter_over_radius(2 / o.coarse_graining),
        particles_a_parcel(std::pow(o.coarse_graining, 3)), drag(DragLaws::make("drag", o.drag)),
        nusselt(NusseltLaws::make("nusselt", o.nusselt)), exchange(mesh), ledger(comm),
        void_fraction(cfd::make_fields(mesh, 1)) {
    if (!(o.void_fraction_floor > 0 && o.void_fraction_floor < 1))
      throw ConfigError("coupling: void_fraction_floor = " + text(o.void_fraction_floor) +
                        " must lie between 0 and 1");
    const bool serves_grid = std::visit(
        [](const auto& k, const auto& l) {
          return serves<std::remove_cvref_t<decltype(k)>, std::remove_cvref_t<decltype(l)>>;
        },
        kernel, locator);
    if (!serves_grid)
      throw ConfigError("coupling: void_fraction = \"" + o.void_fraction +
                        "\" needs a box grid; for grids fitted to a body there are centre, "
                        "divided and smoothed");
    if (!(o.smoothing_width >= 0 && std::isfinite(o.smoothing_width)))
      throw ConfigError("coupling: smoothing_width = " + text(o.smoothing_width) +
                        " must be a number of particle diameters, 0 or more");
    if (!(o.coarse_graining >= 1 && std::isfinite(o.coarse_graining)))
      throw ConfigError("coupling: coarse_graining = " + text(o.coarse_graining) +
                        " must be 1 or more: diameter of a parcel over that of its particles");
    if (c.energy && c.energy->conductivity == 0 && o.heat_transfer_coefficient == 0)
      throw ConfigError("[energy] conductivity: must be above 0, for Nusselt numbers count in it; "
                        "[coupling] heat_transfer_coefficient does without");
    if (o.effects.two_way) {
      momentum = cfd::make_exchange(mesh);
      for (cfd::Field& fraction : momentum.pressure_fraction)
        fraction.fill(1); // as it stays where gas and particles exert no force
    }
    if (c.energy && o.effects.two_way)
      heat = {.coefficient = cfd::make_fields(mesh), .source = cfd::make_fields(mesh)};
    for (cfd::BlockFields& field : work)
      field = cfd::make_fields(mesh);
  }

  // The stages of an exchange.
  void locate(const ParticleView& view);
  void choose_smoothing(const ParticleView& view);
  template <std::size_t K> void smooth();
  template <std::size_t K> std::span<Values<K>> window();
  template <std::size_t K> void deposit(std::span<const double> values);
  template <std::size_t K> void sample(std::span<double> values);
  void find_void_fraction(const ParticleView& view, ExchangeSums& sums);
  void check_void_fraction(ExchangeSums& sums) const;
  std::string too_little_gas(std::size_t b, double least) const;
  void sample_old_gas();
  template <class Gas>
  SeenBlock see(const ParticleView& view, std::size_t first, std::size_t count, Gas&& gas) const;
  SeenBlock see_flow(const ParticleView& view, std::size_t first, std::size_t count) const;
  SeenBlock see_old_gas(const ParticleView& view, std::size_t first, std::size_t count) const;
  template <class Law>
  Lanes drag_of(const Law& law, const SeenBlock& seen, ExchangeSums& mine) const;
  template <class Law>
  ExchangeSums charge(const Law& law, const ParticleView& view, double interval);
  void set_momentum_exchange();
  void set_exchange(double interval, ExchangeSums& sums);
  void take_drag_at_start(double interval, ExchangeSums& sums);
  void sample_new_gas();
  struct NewGas {
    VectorLanes velocity, pressure_force;
  };
  [[nodiscard]] NewGas see_new_gas(const ParticleView& view, std::size_t first,
                                   std::size_t count) const;
  ExchangeSums book(const ParticleView& view, double interval);
  void check_heat(const ParticleView& view) const;
  template <class Law>
  Lanes conductance_of(const Law& law, const SeenBlock& seen, ExchangeSums& mine) const;
  Lanes heat_response(const Lanes& conductance, const ParticleView& view, std::size_t first,
                      std::size_t count, double interval) const;
  template <class Law>
  ExchangeSums charge_heat(const Law& law, const ParticleView& view, double interval);
  void set_heat_exchange();
  [[nodiscard]] bool with_heat() const { return gas_case.energy.has_value(); }
  // Numbers of a particle in `charged` and `new_gas`: those of momentum come first.
  [[nodiscard]] std::size_t charged_with_momentum() const {
    return options.effects.any_force() ? 4 : 0;
  }
  [[nodiscard]] std::size_t charged_numbers() const {
    return charged_with_momentum() + (with_heat() ? 2 : 0);
  }
  [[nodiscard]] std::size_t flow_numbers() const {
    return options.effects.pressure_gradient ? 6 : 3;
  }
  [[nodiscard]] std::size_t new_gas_numbers() const {
    return flow_numbers() + (with_heat() ? 1 : 0);
  }
  double* charged_to(std::size_t p) { return charged.data() + charged_numbers() * p; }
  [[nodiscard]] const double* new_gas_at(std::size_t p) const {
    return new_gas.data() + new_gas_numbers() * p;
  }
  ExchangeSums book_heat(const ParticleView& view, double interval);

  void advance_alone(double interval);
  void leave_alone(const ParticleView& view, double interval, ExchangeSums& sums);
  void exchange_two_way(const ParticleView& view, double interval, ExchangeSums& sums);
  void exchange_one_way(const ParticleView& view, double interval, ExchangeSums& sums);
  template <class Law>
  ExchangeSums act_on_particles(const Law& law, const ParticleView& view, double interval);
  template <class Law>
  ExchangeSums heat_particles(const Law& law, const ParticleView& view, double interval);
  [[nodiscard]] bool any_placed() const;

  /// Calls use(law) with the law of drag, or NoDrag where there is none.
  template <class Use> auto with_drag(Use&& use) const {
    return options.effects.drag ? std::visit(use, drag) : use(NoDrag{});
  }
  [[nodiscard]] bool explicit_drag() const {
    return options.drag_treatment == DragTreatment::explicit_in_both;
  }
  [[nodiscard]] std::variant<ResponseIs<Response::exact>, ResponseIs<Response::exact_unless_fixed>,
                             ResponseIs<Response::at_once>>
  response(bool some_fixed) const;
  template <Response response, bool with_drag, bool with_pressure, bool two_way>
  Vec3 apply(const ParticleView& view, double dt, double share) const;

  cfd::GasCase gas_case;
  CouplingOptions options;
  cfd::Mesh mesh;
  cfd::Halo halo;
  cfd::GasSolver gas;
  AnyLocator locator;
  AnyKernel kernel;
  double diameter_over_radius; ///< diameter of a particle over the radius of its parcel
  double particles_a_parcel;
  AnyDragLaw drag;
  AnyNusseltLaw nusselt;
  Weights weights;
  WindowExchange exchange;
  std::optional<Smoothing> smoothing;
  double smoothing_diameter = 0; ///< m; 0 until particles have been seen
  Ledger ledger;
  ExchangeReport report;
  CouplingTimes times;
  bool initialised = false;
  bool displaced = false; ///< void_fraction is not 1 everywhere

  cfd::MomentumExchange momentum; ///< empty unless both ways
  cfd::HeatExchange heat;         ///< empty without an energy equation, and unless both ways
  cfd::BlockFields void_fraction;
  std::vector<double> window_values;
  std::array<cfd::BlockFields, 7> work; ///< on gas cells, between messages and solver

  // Per particle: what is deposited or sampled.
  std::vector<double> volume;     ///< V_p [m3]
  std::vector<Values<4>> old_gas; ///< eps, u before the gas step
  /// Where there are forces b_eff, b_eff v - hand-over / T; with heat hA_eff, hA_eff T - hand-over
  /// / interval.
  std::vector<double> charged;
  /// After the gas step: u; grad p where there are pressure forces; the temperature with heat.
  std::vector<double> new_gas;
};

void Coupler::Impl::locate(const ParticleView& view) {
  const Stopwatch watch(times.locate);
  weights.build(kernel, locator, view.position, view.radius, view.coupled);
  exchange.bind(weights.window());
  choose_smoothing(view);
}

/// The width counts in diameters of the largest particle among the first that are coupled.
void Coupler::Impl::choose_smoothing(const ParticleView& view) {
  const bool smooths = std::visit([](const auto& k) { return k.smooths; }, kernel);
  if (!smooths || smoothing)
    return;
  if (smoothing_diameter == 0) {
    for (std::size_t p = 0; p < view.size(); ++p)
      if (weights.placed(p))
        smoothing_diameter = std::max(smoothing_diameter, 2 * view.radius[p]);
    MPI_Allreduce(MPI_IN_PLACE, &smoothing_diameter, 1, MPI_DOUBLE, MPI_MAX, mesh.comm);
  }
  if (smoothing_diameter > 0)
    smoothing.emplace(mesh, halo, options.smoothing_width * smoothing_diameter);
}

/// S on the first K fields of `work`.
template <std::size_t K> void Coupler::Impl::smooth() {
  if (smoothing)
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      smoothing->apply({&work[k]...});
    }
  (std::make_index_sequence<K>());
}

/// K numbers of each cell of the window: what `window_values` held before is lost.
template <std::size_t K> std::span<Values<K>> Coupler::Impl::window() {
  static_assert(sizeof(Values<K>) == K * sizeof(double));
  const std::size_t cells = weights.window().size();
  if (window_values.size() < K * cells)
    window_values.resize(K * cells);
  return {reinterpret_cast<Values<K>*>(window_values.data()), cells};
}

/// Numbers of particles, K each.
template <std::size_t K> std::span<const Values<K>> rows(std::span<const double> numbers) {
  return {reinterpret_cast<const Values<K>*>(numbers.data()), numbers.size() / K};
}
template <std::size_t K> std::span<Values<K>> rows(std::span<double> numbers) {
  return {reinterpret_cast<Values<K>*>(numbers.data()), numbers.size() / K};
}

template <std::size_t K> std::span<double> flat(std::span<Values<K>> values) {
  return {reinterpret_cast<double*>(values.data()), K * values.size()};
}

/// work := S (sum_p w q_p / V)
template <std::size_t K> void Coupler::Impl::deposit(std::span<const double> values) {
  std::array<cfd::BlockFields*, K> fields;
  const std::span<Values<K>> sums = window<K>();
  {
    const Stopwatch watch(times.deposit);
    weights.deposit(rows<K>(values), sums);
    for (std::size_t k = 0; k < K; ++k) {
      fields[k] = &work[k];
      for (cfd::Field& field : work[k])
        field.fill(0);
    }
  }
  {
    const Stopwatch watch(times.messages);
    exchange.deposit(flat(sums), fields);
  }
  const Stopwatch watch(times.deposit);
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      for (std::size_t k = 0; k < K; ++k)
        work[k][b][c] /= mesh.local[b].volume[c];
    });
  smooth<K>();
}

/// values := sum_c w (S work)_c
template <std::size_t K> void Coupler::Impl::sample(std::span<double> values) {
  std::array<const cfd::BlockFields*, K> fields;
  for (std::size_t k = 0; k < K; ++k)
    fields[k] = &work[k];
  {
    const Stopwatch watch(times.sample);
    smooth<K>();
  }
  const std::span<Values<K>> gas_values = window<K>();
  {
    const Stopwatch watch(times.messages);
    exchange.sample(fields, flat(gas_values));
  }
  const Stopwatch watch(times.sample);
  weights.sample(std::span<const Values<K>>(gas_values), rows<K>(values));
}

void Coupler::Impl::find_void_fraction(const ParticleView& view, ExchangeSums& sums) {
  volume.resize(view.size());
  sums += sum_particles<ExchangeSums>(view.size(), [&](std::size_t p, ExchangeSums& mine) {
    volume[p] = weights.placed(p) ? sphere_volume(view.radius[p]) : 0;
    mine.particle_volume += volume[p];
  });
  sums.particles = double(weights.placed_count());
  sums.outside = double(weights.outside_count());
  deposit<1>(volume);
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const cfd::Block& block = mesh.local[b];
    // Before it becomes 1 - eps, which has no digits left for a single small particle.
    sums.solid_volume += cfd::sum_cells(block.layout, [&](std::ptrdiff_t c) {
      void_fraction[b][c] = 1 - work[0][b][c];
      return work[0][b][c] * block.volume[c];
    });
  }
  check_void_fraction(sums);
}

void Coupler::Impl::check_void_fraction(ExchangeSums& sums) const {
  std::string complaint;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const cfd::Block& block = mesh.local[b];
    const double least = -cfd::max_cells(block.layout, -sums.void_fraction_min,
                                         [&](std::ptrdiff_t c) { return -void_fraction[b][c]; });
    // Also true for not-a-number.
    if (!(least >= sums.void_fraction_min) && !(least >= options.void_fraction_floor))
      complaint = too_little_gas(b, least);
    sums.void_fraction_min = least;
  }
  throw_together<NumericalError>(mesh.comm, complaint);
}

/// Names the cell of a block that has the void fraction `least`.
std::string Coupler::Impl::too_little_gas(std::size_t b, double least) const {
  const cfd::Block& block = mesh.local[b];
  for (int k = 0; k < block.layout.cells[2]; ++k)
    for (int j = 0; j < block.layout.cells[1]; ++j)
      for (int i = 0; i < block.layout.cells[0]; ++i) {
        const std::ptrdiff_t c = block.layout.at(i, j, k);
        if (void_fraction[b][c] > least || std::isnan(void_fraction[b][c]) != std::isnan(least))
          continue;
        const Vec3 centre{block.centre[0][c], block.centre[1][c], block.centre[2][c]};
        return "coupling: void fraction " + text(void_fraction[b][c]) + " in cell (" +
               std::to_string(i) + ", " + std::to_string(j) + ", " + std::to_string(k) +
               ") of block " + std::to_string(block.id) + ", centre " + text(centre) +
               " m, is below void_fraction_floor = " + text(options.void_fraction_floor) +
               "; use a wider smoothing (void_fraction = \"smoothed\", smoothing_width) or a "
               "coarser grid";
      }
  return {};
}

void Coupler::Impl::sample_old_gas() {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    work[0][b] = void_fraction[b];
    for (std::size_t d = 0; d < 3; ++d)
      work[1 + d][b] = gas.velocity()[b][d];
  }
  old_gas.resize(weights.particles());
  sample<4>(flat(std::span(old_gas)));
}

/// gas(p): the void fraction at a particle, and the gas velocity [m/s].
template <class Gas>
SeenBlock Coupler::Impl::see(const ParticleView& view, std::size_t first, std::size_t count,
                             Gas&& gas_at) const {
  SeenBlock seen;
  Lanes slip_squared;
  for (std::size_t i = 0; i < particles_a_block; ++i) {
    const std::size_t p = first + i;
    const bool there = i < count && weights.placed(p);
    seen.there[i] = there;
    seen.void_fraction[i] = 1;
    seen.diameter[i] = slip_squared[i] = 0;
    if (!there)
      continue;
    const auto& [eps, velocity] = gas_at(p);
    const Vec3 slip = velocity - view.velocity[p];
    seen.void_fraction[i] = eps;
    seen.diameter[i] = diameter_over_radius * view.radius[p];
    slip_squared[i] = dot(slip, slip);
  }
  const double rho = gas.fluid().density, mu = gas.fluid().viscosity;
  seen.reynolds = lanes([&](std::size_t i) {
    return rho * seen.void_fraction[i] * std::sqrt(slip_squared[i]) * seen.diameter[i] / mu;
  });
  return seen;
}

SeenBlock Coupler::Impl::see_old_gas(const ParticleView& view, std::size_t first,
                                     std::size_t count) const {
  return see(view, first, count, [&](std::size_t p) {
    const auto& [eps, ux, uy, uz] = old_gas[p].of;
    return std::pair(eps, Vec3{ux, uy, uz});
  });
}

/// The gas of this step, as if there were no particles.
SeenBlock Coupler::Impl::see_flow(const ParticleView& view, std::size_t first,
                                  std::size_t count) const {
  return see(view, first, count, [&](std::size_t p) {
    const double* const gas_at = new_gas_at(p);
    return std::pair(1., Vec3{gas_at[0], gas_at[1], gas_at[2]});
  });
}

/// Drag coefficients [kg/s], and what is to be known of them.
template <class Law>
Lanes Coupler::Impl::drag_of(const Law& law, const SeenBlock& seen, ExchangeSums& mine) const {
  const double stokes = particles_a_parcel * 3 * std::numbers::pi * gas.fluid().viscosity;
  const bool all_pressure_on_gas = options.model == MomentumModel::b;
  const auto in = [&](std::size_t i) {
    return DragInput{.reynolds = seen.reynolds[i], .void_fraction = seen.void_fraction[i]};
  };
  mine.law_out_of_range +=
      count_outside(seen, [&](std::size_t i) { return law.valid.contains(in(i)); });
  mine.slip_reynolds_max = std::max(mine.slip_reynolds_max, largest(seen.reynolds));
  return lanes([&](std::size_t i) {
    const double per_eps = stokes * seen.diameter[i] * law(in(i));
    return all_pressure_on_gas ? per_eps : per_eps * seen.void_fraction[i];
  });
}

/// Drag coefficient of every particle, and what the gas is to be charged for it.
template <class Law>
ExchangeSums Coupler::Impl::charge(const Law& law, const ParticleView& view, double interval) {
  charged.resize(charged_numbers() * view.size());
  const bool at_once = options.drag_treatment != DragTreatment::implicit_in_both;
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    Lanes b{}, effective{};
    if constexpr (!std::is_same_v<Law, NoDrag>) {
      b = drag_of(law, see_old_gas(view, first, count), mine);
      Lanes lambda{};
      for (std::size_t i = 0; i < count; ++i)
        if (view.fixed.empty() || !view.fixed[first + i])
          lambda[i] = b[i] * interval / view.mass[first + i];
      mine.stiffness_max = std::max(mine.stiffness_max, largest(lambda));
      effective = at_once ? b : effective_coefficients(b, lambda);
    }
    VectorLanes handed_over;
    for (std::size_t i = 0; i < particles_a_block; ++i) {
      const std::size_t p = first + i;
      if (i >= count || !weights.placed(p)) {
        handed_over.set(i, {});
        if (i < count) {
          view.fluid[p] = {};
          std::fill_n(charged_to(p), charged_with_momentum(), 0);
        }
        continue;
      }
      FluidState& state = view.fluid[p];
      const auto& [eps, ux, uy, uz] = old_gas[p].of;
      state.void_fraction = eps;
      if constexpr (!std::is_same_v<Law, NoDrag>)
        state.drag_coefficient = b[i];
      const Vec3 hand_over = state.impulse - state.booked;
      const Vec3 still = explicit_drag() ? Vec3{ux, uy, uz} : Vec3{};
      const Vec3 source = effective[i] * (view.velocity[p] - still) - hand_over / interval;
      if (charged_with_momentum() > 0) {
        const Values<4> terms{{effective[i], source.x, source.y, source.z}};
        std::copy(terms.of.begin(), terms.of.end(), charged_to(p));
      }
      handed_over.set(i, hand_over);
    }
    mine.handed_over += handed_over.sum();
    mine.exchanged += handed_over.sum_of_norms();
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

/// What all particles are charged with, on the gas.
void Coupler::Impl::set_exchange(double interval, ExchangeSums& sums) {
  const bool forces = charged_with_momentum() > 0;
  if (forces && with_heat())
    deposit<6>(charged);
  else if (forces)
    deposit<4>(charged);
  else if (with_heat())
    deposit<2>(charged);
  if (forces)
    set_momentum_exchange();
  if (forces && explicit_drag())
    take_drag_at_start(interval, sums);
  if (with_heat())
    set_heat_exchange();
}

void Coupler::Impl::set_momentum_exchange() {
  const bool gas_bears_all =
      options.model == MomentumModel::b || !options.effects.pressure_gradient;
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      momentum.drag_coefficient[b][c] = work[0][b][c];
      for (std::size_t d = 0; d < 3; ++d)
        momentum.drag_source[b][d][c] = work[1 + d][b][c];
      momentum.pressure_fraction[b][c] = gas_bears_all ? 1 : void_fraction[b][c];
    });
}

/// The source is the drag of the slip before the gas step: nothing is left to go with the new
/// velocity, neither here nor in the pressure equation.
void Coupler::Impl::take_drag_at_start(double interval, ExchangeSums& sums) {
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    const double largest = cfd::max_cells(mesh.local[b].layout, 0, [&](std::ptrdiff_t c) {
      return momentum.drag_coefficient[b][c] / void_fraction[b][c];
    });
    sums.gas_drag_number_max =
        std::max(sums.gas_drag_number_max, interval * largest / gas.fluid().density);
    momentum.drag_coefficient[b].fill(0);
  }
}

void Coupler::Impl::sample_new_gas() {
  const bool with_pressure = options.effects.pressure_gradient;
  for (std::size_t b = 0; b < mesh.local.size(); ++b) {
    for (std::size_t d = 0; d < 3; ++d) {
      work[d][b] = gas.velocity()[b][d];
      if (with_pressure)
        work[3 + d][b] = gas.pressure_gradient()[b][d];
    }
    if (with_heat())
      work[flow_numbers()][b] = (*gas.temperature())[b];
  }
  new_gas.resize(new_gas_numbers() * weights.particles());
  if (with_pressure && with_heat())
    sample<7>(new_gas);
  else if (with_pressure)
    sample<6>(new_gas);
  else if (with_heat())
    sample<4>(new_gas);
  else
    sample<3>(new_gas);
}

/// What a block of particles meets after the gas step.
Coupler::Impl::NewGas Coupler::Impl::see_new_gas(const ParticleView& view, std::size_t first,
                                                 std::size_t count) const {
  NewGas seen;
  Lanes bearing; // of the pressure gradient [m3]
  const bool bears = options.effects.pressure_gradient && options.model == MomentumModel::a;
  for (std::size_t i = 0; i < particles_a_block; ++i) {
    const std::size_t p = first + i;
    seen.velocity.set(i, {});
    seen.pressure_force.set(i, {});
    bearing[i] = 0;
    if (i >= count || !weights.placed(p))
      continue;
    const double* const gas_at = new_gas_at(p);
    seen.velocity.set(i, {gas_at[0], gas_at[1], gas_at[2]});
    if (bears) {
      seen.pressure_force.set(i, {gas_at[3], gas_at[4], gas_at[5]});
      bearing[i] = -sphere_volume(view.radius[p]);
    }
  }
  seen.pressure_force *= bearing;
  return seen;
}

/// What the gas step took from the gas for each particle.
ExchangeSums Coupler::Impl::book(const ParticleView& view, double interval) {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    NewGas seen = see_new_gas(view, first, count);
    VectorLanes drag_force;
    Lanes effective;
    for (std::size_t i = 0; i < particles_a_block; ++i) {
      const std::size_t p = first + i;
      effective[i] = 0;
      drag_force.set(i, {});
      if (i >= count || !weights.placed(p))
        continue;
      effective[i] = charged_to(p)[0];
      drag_force.set(i, view.velocity[p]);
      if (explicit_drag())
        seen.velocity.set(i, {old_gas[p].of[1], old_gas[p].of[2], old_gas[p].of[3]});
    }
    VectorLanes booked;
    for (int d = 0; d < 3; ++d) {
      Lanes& force = drag_force[d]; // so far the particles' velocity
      force = lanes([&](std::size_t i) { return effective[i] * (seen.velocity[d][i] - force[i]); });
      booked[d] =
          lanes([&](std::size_t i) { return interval * (force[i] + seen.pressure_force[d][i]); });
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!weights.placed(first + i))
        continue;
      FluidState& state = view.fluid[first + i];
      state.gas_velocity = seen.velocity.at(i);
      state.pressure_force = seen.pressure_force.at(i);
      state.impulse = {};
      state.booked = booked.at(i);
    }
    mine.drag += drag_force.sum();
    mine.pressure_force += seen.pressure_force.sum();
    mine.booked += booked.sum();
    mine.exchanged += booked.sum_of_norms();
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

/// Of gas that flows as if there were no particles: void fraction 1, nothing booked.
template <class Law>
ExchangeSums Coupler::Impl::act_on_particles(const Law& law, const ParticleView& view,
                                             double interval) {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    const NewGas seen = see_new_gas(view, first, count);
    Lanes b;
    if constexpr (!std::is_same_v<Law, NoDrag>)
      b = drag_of(law, see_flow(view, first, count), mine);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = first + i;
      FluidState& state = view.fluid[p];
      if (!weights.placed(p)) {
        state = {};
        continue;
      }
      state.void_fraction = 1;
      state.gas_velocity = seen.velocity.at(i);
      state.pressure_force = seen.pressure_force.at(i);
      if constexpr (!std::is_same_v<Law, NoDrag>) {
        state.drag_coefficient = b[i];
        mine.drag += b[i] * (state.gas_velocity - view.velocity[p]);
        if (view.fixed.empty() || !view.fixed[p])
          mine.stiffness_max = std::max(mine.stiffness_max, b[i] * interval / view.mass[p]);
      }
      mine.pressure_force += state.pressure_force;
      mine.particle_volume += sphere_volume(view.radius[p]);
    }
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

/// Throws on all ranks alike where the gas has a temperature and particles have none.
void Coupler::Impl::check_heat(const ParticleView& view) const {
  const bool without = gas_case.energy && view.heat.size() != view.size();
  throw_together<ConfigError>(
      mesh.comm,
      without ? "[energy]: the particles have no temperature that the gas could change" : "");
}

/// Between the gas and particles [W/K].
template <class Law>
Lanes Coupler::Impl::conductance_of(const Law& law, const SeenBlock& seen,
                                    ExchangeSums& mine) const {
  const double given = options.heat_transfer_coefficient;
  const double pi = particles_a_parcel * std::numbers::pi;
  if (given > 0)
    return lanes([&](std::size_t i) { return pi * seen.diameter[i] * seen.diameter[i] * given; });
  const double k = gas_case.energy->conductivity;
  const double prandtl = gas.fluid().viscosity * gas_case.energy->heat_capacity / k;
  const auto in = [&](std::size_t i) {
    return NusseltInput{
        .reynolds = seen.reynolds[i], .prandtl = prandtl, .void_fraction = seen.void_fraction[i]};
  };
  mine.nusselt_out_of_range +=
      count_outside(seen, [&](std::size_t i) { return law.valid.contains(in(i)); });
  return lanes([&](std::size_t i) { return pi * k * seen.diameter[i] * law(in(i)); });
}

/// h A T/(m c) of a block of particles; 0 where the temperature is fixed.
Lanes Coupler::Impl::heat_response(const Lanes& conductance, const ParticleView& view,
                                   std::size_t first, std::size_t count, double interval) const {
  Lanes lambda{};
  for (std::size_t i = 0; i < count; ++i)
    if (view.fixed_temperature.empty() || !view.fixed_temperature[first + i])
      lambda[i] = conductance[i] * interval / view.heat_capacity[first + i];
  return lambda;
}

/// Conductance between gas and every particle, and what the gas is to be charged for it.
template <class Law>
ExchangeSums Coupler::Impl::charge_heat(const Law& law, const ParticleView& view, double interval) {
  const std::size_t momentum_first = charged_with_momentum();
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    const Lanes conductance = conductance_of(law, see_old_gas(view, first, count), mine);
    const Lanes lambda = heat_response(conductance, view, first, count, interval);
    mine.heat_stiffness_max = std::max(mine.heat_stiffness_max, largest(lambda));
    const Lanes effective = effective_coefficients(conductance, lambda);
    Lanes handed_over{};
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = first + i;
      HeatState& state = view.heat[p];
      if (!weights.placed(p)) {
        state = {};
        std::fill_n(charged_to(p) + momentum_first, 2, 0);
        continue;
      }
      state.conductance = conductance[i];
      handed_over[i] = state.received - state.booked;
      double* const terms = charged_to(p) + momentum_first;
      terms[0] = effective[i];
      terms[1] = effective[i] * view.temperature[p] - handed_over[i] / interval;
    }
    mine.heat_handed_over += sum(handed_over);
    mine.heat_exchanged += sum(lanes([&](std::size_t i) { return std::abs(handed_over[i]); }));
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

/// Of gas that keeps its heat: nothing is booked.
template <class Law>
ExchangeSums Coupler::Impl::heat_particles(const Law& law, const ParticleView& view,
                                           double interval) {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    const Lanes conductance = conductance_of(law, see_flow(view, first, count), mine);
    mine.heat_stiffness_max = std::max(
        mine.heat_stiffness_max, largest(heat_response(conductance, view, first, count, interval)));
    for (std::size_t p = first; p < first + count; ++p) {
      HeatState& state = view.heat[p];
      if (!weights.placed(p)) {
        state = {};
        continue;
      }
      state.conductance = conductance[p - first];
      state.gas_temperature = new_gas_at(p)[flow_numbers()];
    }
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

void Coupler::Impl::set_heat_exchange() {
  const std::size_t first = charged_with_momentum();
  for (std::size_t b = 0; b < mesh.local.size(); ++b)
    cfd::for_cells(mesh.local[b].layout, [&](std::ptrdiff_t c) {
      heat.coefficient[b][c] = work[first][b][c];
      heat.source[b][c] = work[first + 1][b][c];
    });
}

/// What the gas step took from the gas for each particle.
ExchangeSums Coupler::Impl::book_heat(const ParticleView& view, double interval) {
  const auto of_block = [&](std::size_t first, std::size_t count, ExchangeSums& mine) {
    Lanes booked{};
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = first + i;
      if (!weights.placed(p))
        continue;
      HeatState& state = view.heat[p];
      state.gas_temperature = new_gas_at(p)[flow_numbers()];
      state.booked = interval * charged_to(p)[charged_with_momentum()] *
                     (state.gas_temperature - view.temperature[p]);
      state.received = 0;
      booked[i] = state.booked;
    }
    mine.heat_booked += sum(booked);
    mine.heat_exchanged += sum(lanes([&](std::size_t i) { return std::abs(booked[i]); }));
  };
  return sum_blocks<ExchangeSums>(view.size(), of_block);
}

std::variant<ResponseIs<Response::exact>, ResponseIs<Response::exact_unless_fixed>,
             ResponseIs<Response::at_once>>
Coupler::Impl::response(bool some_fixed) const {
  if (options.drag_treatment != DragTreatment::implicit_in_both)
    return ResponseIs<Response::at_once>();
  if (some_fixed)
    return ResponseIs<Response::exact_unless_fixed>();
  return ResponseIs<Response::exact>();
}

template <Response response, bool with_drag, bool with_pressure, bool two_way>
Vec3 Coupler::Impl::apply(const ParticleView& view, double dt, double share) const {
  const Vec3 weight_of_gas = -gas.fluid().density * gas.fluid().gravity;
  return sum_particles<Vec3>(view.size(), [&](std::size_t p, Vec3& mine) {
    FluidState& state = view.fluid[p];
    if (!(state.void_fraction > 0)) { // not coupled yet, outside the grid or not in the group
      state.force = {};
      return;
    }
    Vec3 exchanged, buoyancy;
    if constexpr (with_pressure) {
      buoyancy = sphere_volume(view.radius[p]) * weight_of_gas;
      exchanged = state.pressure_force;
    }
    if constexpr (with_drag && response == Response::at_once) {
      const Vec3 drag_force = state.drag_coefficient * (state.gas_velocity - view.velocity[p]);
      exchanged = with_pressure ? drag_force + state.pressure_force : drag_force;
    } else if constexpr (with_drag) {
      Vec3 other = view.force[p];
      if constexpr (with_pressure)
        other = view.force[p] + state.pressure_force + buoyancy;
      double lambda = state.drag_coefficient * dt / view.mass[p];
      if constexpr (response == Response::exact_unless_fixed)
        lambda = view.fixed[p] ? 0 : lambda;
      const Vec3 drag_force =
          exact_drag(state.drag_coefficient, lambda, state.gas_velocity, view.velocity[p], other);
      exchanged = with_pressure ? drag_force + state.pressure_force : drag_force;
    }
    state.force = with_pressure ? exchanged + buoyancy : exchanged;
    view.force[p] += state.force;
    if constexpr (two_way) {
      const Vec3 impulse = share * dt * exchanged;
      state.impulse += impulse;
      mine += impulse;
    }
  });
}

/// Gas in which no particle is, nor counts. Where the last one has just gone, the pressure still
/// works on a void fraction below 1: the gas bears all of it.
void Coupler::Impl::advance_alone(double interval) {
  const bool just_left = displaced;
  if (just_left) {
    for (std::size_t b = 0; b < mesh.local.size(); ++b) {
      void_fraction[b].fill(1);
      momentum.pressure_fraction[b].fill(1);
      momentum.drag_coefficient[b].fill(0);
      for (cfd::Field& component : momentum.drag_source[b])
        component.fill(0);
    }
    displaced = false;
  }
  const Stopwatch watch(times.gas);
  report.gas = gas.advance(interval, void_fraction, just_left ? &momentum : nullptr, nullptr);
}

/// No coupled particle is in the grid: the gas costs what it costs without any.
void Coupler::Impl::leave_alone(const ParticleView& view, double interval, ExchangeSums& sums) {
  sums.outside = double(weights.outside_count());
  std::fill(view.fluid.begin(), view.fluid.end(), FluidState{});
  std::fill(view.heat.begin(), view.heat.end(), HeatState{});
  advance_alone(interval);
}

bool Coupler::Impl::any_placed() const {
  int any = weights.placed_count() > 0;
  MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, mesh.comm);
  return any != 0;
}

void Coupler::Impl::exchange_two_way(const ParticleView& view, double interval,
                                     ExchangeSums& sums) {
  find_void_fraction(view, sums);
  displaced = true;
  sample_old_gas();
  {
    const Stopwatch watch(times.laws);
    sums += with_drag([&](const auto& law) { return charge(law, view, interval); });
    if (with_heat())
      sums +=
          std::visit([&](const auto& law) { return charge_heat(law, view, interval); }, nusselt);
  }
  set_exchange(interval, sums);
  {
    const Stopwatch watch(times.gas);
    report.gas = gas.advance(interval, void_fraction, &momentum, with_heat() ? &heat : nullptr);
  }
  if (charged_numbers() > 0)
    sample_new_gas();
  const Stopwatch watch(times.laws);
  if (options.effects.any_force())
    sums += book(view, interval);
  if (with_heat())
    sums += book_heat(view, interval);
}

void Coupler::Impl::exchange_one_way(const ParticleView& view, double interval,
                                     ExchangeSums& sums) {
  sums.particles = double(weights.placed_count());
  sums.outside = double(weights.outside_count());
  advance_alone(interval);
  sample_new_gas();
  const Stopwatch watch(times.laws);
  sums += with_drag([&](const auto& law) { return act_on_particles(law, view, interval); });
  if (with_heat())
    sums +=
        std::visit([&](const auto& law) { return heat_particles(law, view, interval); }, nusselt);
  sums.solid_volume = sums.particle_volume; // nothing is deposited
}

Coupler::Coupler(const cfd::GasCase& gas_case, const CouplingOptions& options, MPI_Comm comm)
    : impl_(std::make_unique<Impl>(gas_case, options, comm)) {}
Coupler::~Coupler() = default;

void Coupler::initialise(const ParticleView& view, double time) {
  Impl& s = *impl_;
  s.locate(view);
  std::string complaint;
  for (std::size_t p = 0; p < view.size() && s.weights.outside_count() > 0; ++p) {
    if (s.weights.placed(p) || (!view.coupled.empty() && !view.coupled[p]))
      continue;
    const auto& [low, high, periodic] = extent();
    complaint = "coupling: particle " + (view.id.empty() ? "" : std::to_string(view.id[p]) + " ") +
                "at " + text(view.position[p]) +
                " m lies outside the gas grid, whose extent is from " + text(low) + " to " +
                text(high) + " m";
    break;
  }
  throw_together<ConfigError>(s.mesh.comm, complaint);

  s.check_heat(view);
  for (std::size_t p = 0; p < view.size(); ++p)
    view.fluid[p] = {};
  std::fill(view.heat.begin(), view.heat.end(), HeatState{});
  if (s.options.effects.two_way) {
    ExchangeSums sums;
    s.find_void_fraction(view, sums);
    s.displaced = s.any_placed();
  }
  s.gas.initialise(s.void_fraction, s.gas_case.initial_velocity, time);
  s.initialised = true;
}

const ExchangeReport& Coupler::exchange(const ParticleView& view, double interval) {
  Impl& s = *impl_;
  if (!s.initialised)
    throw std::logic_error("Coupler::exchange needs initialise() or load() first");
  s.locate(view);
  s.check_heat(view);
  ExchangeSums sums;
  if (!s.any_placed())
    s.leave_alone(view, interval, sums);
  else if (s.options.effects.two_way)
    s.exchange_two_way(view, interval, sums);
  else
    s.exchange_one_way(view, interval, sums);
  s.ledger.close(sums, s.gas.balance(), interval, s.report);
  return s.report;
}

void Coupler::apply(const ParticleView& view, double dt, double share) {
  Impl& s = *impl_;
  const ExchangeEffects& effects = s.options.effects;
  if (!effects.any_force())
    return;
  const Stopwatch watch(s.times.force);
  const auto choice = [](bool condition) {
    return condition ? std::variant<std::false_type, std::true_type>(std::true_type{})
                     : std::false_type{};
  };
  s.ledger.received(std::visit(
      [&](auto response, auto drag, auto pressure, auto two_way) {
        return s.apply<response, drag, pressure, two_way>(view, dt, share);
      },
      s.response(!view.fixed.empty()), choice(effects.drag), choice(effects.pressure_gradient),
      choice(effects.two_way)));
}

void Coupler::received_heat(double heat) {
  if (impl_->options.effects.two_way)
    impl_->ledger.received_heat(heat);
}

void Coupler::unapply(const ParticleView& view, double dt, double share) {
  Impl& s = *impl_;
  if (!s.options.effects.two_way || !s.options.effects.any_force())
    return;
  const Vec3 weight_of_gas =
      s.options.effects.pressure_gradient ? -s.gas.fluid().density * s.gas.fluid().gravity : Vec3{};
  s.ledger.received(sum_particles<Vec3>(view.size(), [&](std::size_t p, Vec3& mine) {
    FluidState& state = view.fluid[p];
    if (!(state.void_fraction > 0))
      return;
    const Vec3 exchanged = state.force - sphere_volume(view.radius[p]) * weight_of_gas;
    const Vec3 impulse = -share * dt * exchanged;
    state.impulse += impulse;
    mine += impulse;
  }));
}

const ExchangeReport& Coupler::report() const {
  return impl_->report;
}
const CouplingTimes& Coupler::times() const {
  return impl_->times;
}
long Coupler::numbers_sent() const {
  return impl_->exchange.numbers_sent();
}
cfd::GasSolver& Coupler::gas() {
  return impl_->gas;
}
const GridExtent& Coupler::extent() const {
  return std::visit([](const auto& locator) -> const GridExtent& { return locator.extent(); },
                    impl_->locator);
}
const cfd::Mesh& Coupler::mesh() const {
  return impl_->mesh;
}

std::uint64_t Coupler::saved_numbers() const {
  int ranks = 1;
  MPI_Comm_size(impl_->mesh.comm, &ranks);
  return 2 + std::uint64_t(ranks) * Ledger::saved_numbers() + impl_->gas.saved_numbers();
}

void Coupler::save(cfd::RecordWriter* out) const {
  const MPI_Comm comm = impl_->mesh.comm;
  int ranks = 1;
  MPI_Comm_size(comm, &ranks);
  const std::vector<double> mine = impl_->ledger.save();
  std::vector<double> all(out ? mine.size() * std::size_t(ranks) : 0);
  MPI_Gather(mine.data(), int(mine.size()), MPI_DOUBLE, all.data(), int(mine.size()), MPI_DOUBLE, 0,
             comm);
  if (out) {
    out->write(impl_->smoothing_diameter);
    out->write(double(ranks));
    out->write(all);
  }
  impl_->gas.save(out);
}

void Coupler::load(cfd::RecordReader* in) {
  const MPI_Comm comm = impl_->mesh.comm;
  std::array<double, 2> numbers{}; // smoothing diameter, ranks
  std::vector<double> ledgers;
  std::string complaint;
  if (in)
    try {
      numbers = {in->read(), double(in->read_count(in->left()))};
      ledgers.resize(std::size_t(numbers[1]) * Ledger::saved_numbers());
      in->read(ledgers);
    } catch (const ConfigError& e) {
      complaint = e.what();
    }
  throw_together<ConfigError>(comm, complaint);
  MPI_Bcast(numbers.data(), int(numbers.size()), MPI_DOUBLE, 0, comm);
  const auto ranks = std::size_t(numbers[1]);
  ledgers.resize(ranks * Ledger::saved_numbers());
  MPI_Bcast(ledgers.data(), int(ledgers.size()), MPI_DOUBLE, 0, comm);
  impl_->smoothing_diameter = numbers[0];
  impl_->ledger.load(ledgers, ranks);
  impl_->gas.load(in);
  impl_->smoothing.reset();
  impl_->initialised = true;
}

} // namespace granflux::coupling
