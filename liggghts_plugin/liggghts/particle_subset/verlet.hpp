// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <vector>

#include <liggghts/verlet.h>

#include "force_team.hpp"
#include "own_work.hpp"
#include "spatial_order.hpp"
#include "work_report.hpp"

namespace granflux::particle_subset {

class FixNveSphere;
class PairGran;
class RareLook;
class WorkAhead;

/// LIGGGHTS' time step: the calls to fixes, pair style, communication and output in the order and
/// under the conditions of run_style verlet. Forces are cleared by the thread that owns them. Where
/// nobody looks in between, the two half steps of velocity between two positions are taken in one
/// go, with the forces while these are in the cache. Reports at the end of a run where the time
/// went.
class Verlet : public LAMMPS_NS::Verlet {
public:
  using LAMMPS_NS::Verlet::Verlet;

  void setup() override;
  void run(int steps) override;

private:
  void run_steps(int steps);
  void sort_particles();
  void exchange_and_build_lists(LAMMPS_NS::bigint now);
  void compute_forces();
  bool add_part(OwnWork* part, double& seconds, auto&& otherwise);
  void finish_team();
  [[nodiscard]] bool lists_have_aged();
  [[nodiscard]] bool looked_at(LAMMPS_NS::bigint step) const;
  void report();
  void final_integrate();

  bool set_up_ = false;                // setup() was called since the last run
  std::vector<FixNveSphere*> may_owe_; // in this run; empty: nobody may
  bool may_move_ahead_ = false;        // in this run: those that owe, before the step is over
  bool may_clear_ahead_ = false;       // in this run: the forces on them, too
  bool owed_ = false;                  // final_integrate() of this step
  std::vector<const RareLook*> rare_looks_;
  std::vector<WorkAhead*> work_ahead_; // in this run
  bool fixes_before_forces_look_at_none_ = false;
  SpatialOrder order_;
  WorkLoad load_; // sums over the steps of a run
  ForceTeam team_;
  const PairGran* contacts_in_team_ = nullptr; // null: they are not, or are done
  bool cleared_ahead_ = false; // forces on what no other thread sees, when it moved ahead

  /// Takes the forces of the last step off, where contacts are in the team no earlier than they
  /// are added to: they are then written once while they are in the cache.
  struct ClearForces final : OwnWork {
    explicit ClearForces(const Verlet& all) : verlet(all) {}
    const Verlet& verlet;
    bool begin_own_work(int eflag, int vflag) override;
    void start_own_work(int thread, Range own) override;
    void own_work(int thread, Range block) override;

  private:
    void clear_but_ahead(int thread, Range range) const;
    struct alignas(64) Cleared {
      int end;
    };
    std::vector<Cleared> cleared_; // of each thread
  } clear_{*this};

  /// Moves particles on to the next step as soon as the forces on them are complete, and clears
  /// these, unless another thread may still look at them: these move in initial_integrate().
  struct MoveAhead final : OwnWork {
    explicit MoveAhead(const Verlet& all) : verlet(all) {}
    const Verlet& verlet;
    bool begin_own_work(int eflag, int vflag) override;
    void own_work(int thread, Range block) override;
  } move_ahead_{*this};
};

/// Puts Verlet in the place of LIGGGHTS' own where that is about to run spheres.
void take_over_integrator(LAMMPS_NS::LAMMPS& lammps);

} // namespace granflux::particle_subset
