// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <liggghts/pointers.h>

#include <granflux/coupling/particle_view.hpp>

namespace LAMMPS_NS {
class FixPropertyAtom;
}

namespace granflux::liggghts {

class FixHeat;

/// The particles of this rank as the coupling library sees them. Positions, velocities and forces
/// are LIGGGHTS' own arrays; the fluid states live in a fix property/atom, so that they move, are
/// deleted and are written to restart files with their particles.
class HostView : private LAMMPS_NS::Pointers {
public:
  /// group_bit: the particles that are coupled. held_bit: further particles held in place, or 0.
  HostView(LAMMPS_NS::LAMMPS* lammps, LAMMPS_NS::FixPropertyAtom& fluid, int group_bit,
           int held_bit);

  /// Held in place are: the groups of `fix freeze`, particles that no integrating fix moves, and
  /// the held group. The fixes may have changed between runs: call before each.
  void find_held();

  /// Valid until LIGGGHTS moves, sorts or communicates particles. `with_id` where errors may have
  /// to name a particle.
  [[nodiscard]] coupling::ParticleView particles(bool with_id);

  /// The same with temperatures, where there are any.
  void set_heat(FixHeat* heat, LAMMPS_NS::FixPropertyAtom* states) {
    heat_ = heat;
    heat_states_ = states;
  }
  [[nodiscard]] coupling::HeatState* heat_states() const;

  /// As fix freeze does, which ran before the fluid force was added.
  void clear_frozen_forces();

private:
  LAMMPS_NS::FixPropertyAtom& fluid_;
  FixHeat* heat_ = nullptr;
  LAMMPS_NS::FixPropertyAtom* heat_states_ = nullptr;
  int group_bit_, held_bit_;
  int frozen_bits_ = 0, moved_bits_ = 0;
  std::vector<std::int64_t> id_;
  std::vector<std::uint8_t> coupled_, fixed_;
};

} // namespace granflux::liggghts
