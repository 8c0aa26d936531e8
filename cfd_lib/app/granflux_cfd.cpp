// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

// granflux_cfd: runs the gas of a case file alone, without particles.

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <mpi.h>
#include <omp.h>

#include <granflux/cfd/case_mesh.hpp>
#include <granflux/cfd/cgns_writer.hpp>
#include <granflux/cfd/checkpoint.hpp>
#include <granflux/cfd/deal_blocks.hpp>
#include <granflux/cfd/error.hpp>
#include <granflux/cfd/gas_solver.hpp>
#include <granflux/cfd/mesh_quality.hpp>
#include <granflux/cfd/out_of_memory.hpp>
#include <granflux/cfd/read_gas_case.hpp>
#include <granflux/version.hpp>

#include "force_history.hpp"
#include "progress.hpp"
#include "stable_steps.hpp"
#include "time_steps.hpp"

namespace {

using namespace granflux;
using namespace granflux::cfd;

struct Options {
  std::string case_file;
  std::string forces;  ///< file for the forces on the walls; empty: none
  std::string restart; ///< checkpoint to continue from; empty: start anew
  int threads = 0;     ///< 0: as OMP_NUM_THREADS says, else one
};

/// Wall-clock seconds of the parts of a run.
struct Seconds {
  double set_up = 0, gas = 0, output = 0;
};

/// Times a piece of work and adds it to a sum.
template <class Work> auto timed(double& sum, Work&& work) {
  struct Stop {
    double& sum;
    double start = MPI_Wtime();
    ~Stop() { sum += MPI_Wtime() - start; }
  } stop{sum};
  return work();
}

/// Mesh and solver know the case, but not which file it came from.
template <class Work> auto naming_file(const std::string& file, Work&& work) {
  try {
    return work();
  } catch (const ConfigError& error) {
    throw ConfigError(file + ": " + error.what());
  }
}

void check_times(const Numerics& numerics, const std::string& file) {
  for (const auto& [key, value] :
       {std::pair{"time_step", numerics.time_step}, std::pair{"end_time", numerics.end_time}})
    if (!(value > 0))
      throw ConfigError(fmt::format("{}: [numerics] {} is missing: a run of the gas alone needs a "
                                    "number > 0 (s)",
                                    file, key));
  constexpr double most = 1e12;
  if (numerics.end_time / numerics.time_step > most)
    throw ConfigError(fmt::format("{}: [numerics] time_step = {}: must be at least end_time / "
                                  "{:g} (s)",
                                  file, numerics.time_step, most));
}

/// Writes the fields at the start, at the end, and at each first step past a multiple of `every`.
class FieldOutput {
public:
  /// `first`: number of the first file.
  FieldOutput(const Mesh& mesh, const Output& output, long first) : every_(output.every) {
    if (!output.fields.empty())
      writer_.emplace(mesh, output.fields, first);
  }
  void write_if_due(const GasSolver& gas, bool at_end) {
    if (!writer_ || !(at_end || gas.time() >= double(next_) * every_ * (1 - 1e-9)))
      return;
    last_ = writer_->write(gas);
    next_ = long(std::floor(gas.time() / every_ * (1 + 1e-9))) + 1;
  }
  /// For a run that goes on: as if all up to this time had been written.
  void skip_to(double time) { next_ = long(std::floor(time / every_ * (1 + 1e-9))) + 1; }
  [[nodiscard]] long files() const { return writer_ ? writer_->next() : 0; }
  [[nodiscard]] const std::string& last() const { return last_; }

private:
  double every_;
  long next_ = 0; ///< multiple of `every` that is written next
  std::optional<CgnsWriter> writer_;
  std::string last_;
};

std::string text_of(const Vec3& v) {
  return fmt::format("{:>12.4e} {:>12.4e} {:>12.4e}", v.x, v.y, v.z);
}

std::int64_t cells_of(const Mesh& mesh) {
  std::int64_t cells = 0;
  for (const BlockInfo& info : mesh.blocks)
    cells += cell_count(info.cells);
  return cells;
}

std::string size_of(const Mesh& mesh) {
  if (!mesh.lattice)
    return fmt::format("{} cells", cells_of(mesh));
  const Index3 n = mesh.lattice->cells();
  return fmt::format("{} x {} x {} cells", n[0], n[1], n[2]);
}

void print_banner(const Mesh& mesh, const GasCase& gas_case, const std::string& file) {
  int ranks = 1;
  MPI_Comm_size(mesh.comm, &ranks);
  fmt::print("granflux_cfd {} ({}, {})\n", version, revision, compiler);
  fmt::print("case {}: {} in {} blocks, {} ranks x {} threads", file, size_of(mesh),
             mesh.blocks.size(), ranks, omp_get_max_threads());
  if (ranks > 1)
    fmt::print(", largest load {:.2f} of the mean", imbalance(mesh));
  fmt::print("\n");
  const Numerics& numerics = gas_case.numerics;
  if (numerics.courant > 0)
    fmt::print("steps of at most {:.6g} s and Courant number {:g} to t = {:.6g} s\n",
               numerics.time_step, numerics.courant, numerics.end_time);
  else
    fmt::print("{} steps of {:.6g} s to t = {:.6g} s\n", TimeSteps(numerics).count(),
               TimeSteps(numerics).next(0, 0), numerics.end_time);
  std::fflush(stdout);
}

/// Collective; rank 0 prints. Throws ConfigError on all ranks where the mesh is too bad.
void report_quality(const Mesh& mesh, bool prints) {
  const MeshQuality quality = measure_quality(mesh);
  if (prints)
    fmt::print("{}\n", describe(quality));
  const std::string warning = quality_warning(quality);
  if (prints)
    fmt::print("{}\n", warning.empty() ? "" : "warning: " + warning + "\n");
  std::fflush(stdout);
}

/// Collective; rank 0 prints.
void print_balances(const GasSolver& gas, bool prints) {
  if (prints)
    fmt::print("\n{:<24} {:>14} {:>14}\n", "boundary", "flux out m3/s", "pressure Pa");
  for (const std::string& name : gas.mesh().boundaries) {
    const double flux = gas.boundary_flux(name), pressure = gas.boundary_pressure(name);
    if (prints)
      fmt::print("{:<24} {:>14.6e} {:>14.6e}\n", name, flux, pressure);
  }
  if (!prints)
    return;
  const Balance& b = gas.balance();
  fmt::print("{:<24} {:>14.6e}\n", "sum of fluxes", b.boundary_volume_flux);
  fmt::print("\n{:<24} {:>12} {:>12} {:>12}\n", "momentum, last step [N]", "x", "y", "z");
  for (const auto& [name, value] :
       {std::pair{"rate of change", b.momentum_change}, std::pair{"convection", b.convection},
        std::pair{"friction", b.friction}, std::pair{"pressure", b.pressure},
        std::pair{"driving gradient", b.driving}, std::pair{"thermal buoyancy", b.thermal_buoyancy},
        std::pair{"residual", b.momentum_residual}})
    fmt::print("{:<24} {}\n", name, text_of(value));
  if (!gas.temperature())
    return;
  fmt::print("\n{:<24} {:>12}\n", "heat, last step [W]", "into the gas");
  for (const auto& [name, value] :
       {std::pair{"rate of change", b.heat_change}, std::pair{"convection", b.heat_convection},
        std::pair{"conduction", b.heat_conduction}, std::pair{"residual", b.heat_residual}})
    fmt::print("{:<24} {:>12.4e}\n", name, value);
}

/// Collective; the slowest rank counts.
void print_times(Seconds seconds, const GasSolver& gas, long steps, bool prints) {
  MPI_Allreduce(MPI_IN_PLACE, &seconds, 3, MPI_DOUBLE, MPI_MAX, gas.mesh().comm);
  if (!prints)
    return;
  const double total = seconds.set_up + seconds.gas + seconds.output;
  fmt::print("\n{:<24} {:>10} {:>7}\n", "part", "seconds", "share");
  for (const auto& [name, value] :
       {std::pair{"set-up", seconds.set_up}, std::pair{"gas", seconds.gas},
        std::pair{"output", seconds.output}, std::pair{"total", total}})
    fmt::print("{:<24} {:>10.3f} {:>6.1f}%\n", name, value, 100 * value / total);
  fmt::print("{:<24} {:>10.1f} ns per cell and step\n", "gas",
             1e9 * seconds.gas / (double(cells_of(gas.mesh())) * double(steps)));
}

std::atomic<int> stop_signal{0};
extern "C" void ask_to_stop(int signal) {
  stop_signal = signal;
}

/// True on all ranks alike once one of them was asked to stop.
bool stop_asked(MPI_Comm comm) {
  int asked = stop_signal;
  MPI_Allreduce(MPI_IN_PLACE, &asked, 1, MPI_INT, MPI_MAX, comm);
  return asked != 0;
}

/// Writes the file that a run continues from, now and then and at the end.
class Checkpoints {
public:
  explicit Checkpoints(const Output& output)
      : path_(output.checkpoint), every_(output.checkpoint_every) {}
  void start(double time) { next_ = time + every_; }
  /// `believable`: else the older state is worth more.
  void write_if_due(const GasSolver& gas, bool at_end, const TimeSteps& steps, long files,
                    bool believable) {
    if (path_.empty() || !believable ||
        !(at_end || (every_ > 0 && gas.time() >= next_ * (1 - 1e-12))))
      return;
    write_checkpoint(path_, gas, {steps.last(), double(files)});
    written_at_ = gas.time();
    while (every_ > 0 && next_ <= gas.time())
      next_ += every_;
  }

  /// Where a run that stopped can be taken up again.
  [[nodiscard]] std::string last_good_state() const {
    if (written_at_)
      return fmt::format("last good state: checkpoint {} of t = {:.6g} s", path_, *written_at_);
    if (path_.empty())
      return "no state was kept: [output] checkpoint names a file for it";
    return "no state was kept yet: [output] checkpoint_every says when";
  }

private:
  std::string path_;
  double every_, next_ = 0;
  std::optional<double> written_at_; ///< simulated time [s]
};

void run(const Options& options, MPI_Comm comm, bool prints) {
  Seconds seconds;
  const std::string& file = options.case_file;
  const GasCase gas_case = read_gas_case(file, comm);
  check_times(gas_case.numerics, file);

  const Mesh mesh = timed(
      seconds.set_up, [&] { return naming_file(file, [&] { return make_mesh(gas_case, comm); }); });
  if (prints)
    print_banner(mesh, gas_case, file);
  naming_file(file, [&] { report_quality(mesh, prints); });
  const BlockFields void_fraction = make_fields(mesh, 1.0);
  std::optional<GasSolver> gas;
  TimeSteps steps(gas_case.numerics);
  long files = 0;
  timed(seconds.set_up, [&] {
    naming_file(file, [&] { gas.emplace(mesh, gas_case); });
    gas->initialise(void_fraction, gas_case.initial_velocity);
    if (options.restart.empty())
      return;
    const std::vector<double> state = read_checkpoint(options.restart, *gas);
    steps.continue_from(state.at(0));
    files = long(state.at(1));
    if (prints)
      fmt::print("continues at t = {:.6g} s, step {}\n\n", gas->time(), gas->steps());
    if (steps.at_end(gas->time()))
      throw ConfigError(fmt::format("{}: [numerics] end_time = {}: the checkpoint {} is already "
                                    "there; give a later one (s)",
                                    file, gas_case.numerics.end_time, options.restart));
  });
  FieldOutput output = naming_file(file, [&] { return FieldOutput(mesh, gas_case.output, files); });
  if (options.restart.empty())
    timed(seconds.output, [&] { output.write_if_due(*gas, false); });
  else
    output.skip_to(gas->time());
  ForceHistory forces(gas_case, options.forces, !options.restart.empty(), comm);
  Checkpoints checkpoints(gas_case.output);
  checkpoints.start(gas->time());

  const long first = gas->steps();
  StableSteps stable(gas_case, *gas, TimeSteps(steps).next(gas->time(), gas->courant_rate()));
  if (prints)
    fmt::print("{}\n", stable.table());
  const auto warn = [&] {
    for (const std::string& warning : stable.new_warnings())
      if (prints)
        fmt::print("warning: t = {:.6g} s: {}\n", gas->time(), warning);
  };
  warn();
  Progress progress(gas->time(), gas_case.numerics.end_time, prints);
  for (bool done = false; !done;) {
    const double rate = gas_case.numerics.courant > 0 ? gas->courant_rate() : 0;
    const double dt = steps.next(gas->time(), rate);
    const StepReport report = timed(seconds.gas, [&] {
      try {
        return gas->advance(dt, void_fraction, nullptr);
      } catch (const NumericalError& error) { // on all ranks alike
        throw NumericalError(fmt::format("{}; {}; {}", error.what(), stable.likely_cause(),
                                         checkpoints.last_good_state()));
      }
    });
    stable.follow(report, dt);
    done = steps.at_end(gas->time());
    const bool stopped = !done && stop_asked(comm);
    timed(seconds.output, [&] {
      output.write_if_due(*gas, done);
      forces.add(*gas);
      checkpoints.write_if_due(*gas, done || stopped, steps, output.files(), stable.believable());
    });
    progress.report(gas->steps(), gas->time(), report);
    warn();
    if (stopped) {
      if (prints)
        fmt::print("\nstopped by a signal at t = {:.6g} s\n", gas->time());
      break;
    }
  }
  print_balances(*gas, prints);
  print_times(seconds, *gas, gas->steps() - first, prints);
  if (prints && output.files() > 0)
    fmt::print("\n{} files, the last {}\n", output.files(), output.last());
}

/// Exit code where the command line asks for no run.
std::optional<int> parse(int argc, char** argv, Options& options, bool prints) {
  CLI::App app{"Runs the gas of a GranFlux case file alone. Start it under mpirun for several "
               "ranks."};
  app.add_option("case", options.case_file, "case file (TOML)")->required();
  app.add_option("--forces", options.forces,
                 "file for the force of the gas on each wall after every step (CSV)");
  app.add_option("--restart", options.restart,
                 "continue from this checkpoint ([output] checkpoint)");
  app.add_option("--threads", options.threads,
                 "OpenMP threads of each rank (default: OMP_NUM_THREADS, else 1)")
      ->check(CLI::Range(1, 1024));
  app.set_version_flag("--version", fmt::format("granflux_cfd {} ({}, {} {})", version, revision,
                                                compiler, compiler_flags));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == 0; // -h or --version
    if (prints)
      app.exit(error);
    return asked ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  return {};
}

void set_threads(int threads) {
  if (threads > 0)
    omp_set_num_threads(threads);
  else if (std::getenv("OMP_NUM_THREADS") == nullptr)
    omp_set_num_threads(1);
}

} // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  std::signal(SIGUSR2, ask_to_stop); // what mpirun hands on
  std::signal(SIGXFSZ, SIG_IGN);     // a file that may not grow is an error of its write
  explain_out_of_memory();
  int provided = 0, rank = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const bool prints = rank == 0;
  int code = EXIT_FAILURE;
  const auto say = [&](const char* what) {
    std::fflush(stdout);
    fmt::print(stderr, "granflux_cfd: error: {}\n", what);
  };
  try {
    Options options;
    if (const std::optional<int> early = parse(argc, argv, options, prints)) {
      code = *early;
    } else {
      set_threads(options.threads);
      run(options, MPI_COMM_WORLD, prints);
      code = EXIT_SUCCESS;
    }
  } catch (const ConfigError& error) { // on all ranks alike, as NumericalError
    if (prints)
      say(error.what());
  } catch (const NumericalError& error) {
    if (prints)
      say(error.what());
  } catch (const std::exception& error) { // perhaps on this rank alone: the others must not wait
    say(error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
  return code;
}
