// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <mpi.h>
#include <numbers>
#include <vector>

#include <granflux/coupling/coupler.hpp>

namespace granflux::testing {

struct Particle {
  std::int64_t id = 0;
  Vec3 position, velocity;     ///< m, m/s
  double radius = 0, mass = 0; ///< m, kg
  double fixed = 0;            ///< 1: held in place
  coupling::FluidState fluid;
};

inline double sphere_volume(double radius) {
  return 4 * std::numbers::pi / 3 * radius * radius * radius;
}

inline Particle sphere(std::int64_t id, Vec3 position, Vec3 velocity, double radius, double density,
                       bool fixed = false) {
  return {id, position, velocity, radius, density * sphere_volume(radius), fixed ? 1. : 0., {}};
}

/// A particle engine of vectors: leapfrog, gravity, any further force the test gives, no contacts.
/// Particles belong to the rank whose slab of the box they are in.
class FakeHost {
public:
  Vec3 low, high; ///< the box [m]
  std::array<bool, 3> periodic{};
  int slab_direction = 0;
  Vec3 gravity;
  /// Force on a particle beside gravity and the gas [N]; may be empty.
  std::function<Vec3(const Particle&)> other_force;

  FakeHost(Vec3 box_low, Vec3 box_high, std::array<bool, 3> periodic_directions, MPI_Comm comm)
      : low(box_low), high(box_high), periodic(periodic_directions), comm_(comm) {
    MPI_Comm_rank(comm, &rank_);
    MPI_Comm_size(comm, &ranks_);
  }

  /// Called alike on all ranks; the owner keeps it.
  void add(const Particle& q) {
    if (owner(q.position) == rank_)
      push(q);
  }

  /// Takes out those for which gone(particle) is true; returns their momentum on this rank.
  template <class Gone> Vec3 remove(Gone&& gone) {
    Vec3 momentum;
    std::vector<Particle> kept;
    for (std::size_t p = 0; p < size(); ++p) {
      const Particle q = particle(p);
      if (gone(q))
        momentum += q.mass * q.velocity;
      else
        kept.push_back(q);
    }
    assign(kept);
    return momentum;
  }

  [[nodiscard]] std::size_t size() const { return position.size(); }
  [[nodiscard]] Particle particle(std::size_t p) const {
    return {id[p], position[p], velocity[p], radius[p], mass[p], double(fixed[p]), fluid[p]};
  }
  coupling::ParticleView view() {
    coupling::ParticleView all;
    all.position = position;
    all.velocity = velocity;
    all.force = force;
    all.radius = radius;
    all.mass = mass;
    all.id = id;
    all.fluid = fluid;
    all.fixed = fixed;
    return all;
  }

  /// One leapfrog step: drift, forces, perhaps a coupling step over `interval`, kick.
  void step(coupling::Coupler& coupler, double dt, bool exchange, double interval) {
    for (std::size_t p = 0; p < size(); ++p)
      if (!fixed[p])
        position[p] += dt * velocity[p];
    migrate();
    for (std::size_t p = 0; p < size(); ++p)
      force[p] = mass[p] * gravity + (other_force ? other_force(particle(p)) : Vec3{});
    if (exchange)
      coupler.exchange(view(), interval);
    for (std::size_t p = 0; p < size(); ++p)
      external_impulse += fixed[p] ? Vec3{} : dt * force[p];
    coupler.apply(view(), dt);
    for (std::size_t p = 0; p < size(); ++p) {
      if (fixed[p])
        continue;
      external_impulse += dt * buoyancy(p, coupler);
      velocity[p] += dt / mass[p] * force[p];
    }
  }

  /// Wraps positions and hands every particle to its rank; a particle that leaves the box in a
  /// direction that is not periodic stays where it is.
  void migrate() {
    std::vector<double> mine, all;
    for (std::size_t p = 0; p < size(); ++p) {
      Particle q = particle(p);
      for (int d = 0; d < 3; ++d)
        if (periodic[std::size_t(d)]) {
          const double length = high[d] - low[d];
          q.position[d] -= length * std::floor((q.position[d] - low[d]) / length);
        }
      const auto* numbers = reinterpret_cast<const double*>(&q);
      mine.insert(mine.end(), numbers, numbers + sizeof(Particle) / sizeof(double));
    }
    int count = int(mine.size());
    std::vector<int> counts(std::size_t(ranks_), 0), starts(std::size_t(ranks_), 0);
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
    for (std::size_t r = 1; r < starts.size(); ++r)
      starts[r] = starts[r - 1] + counts[r - 1];
    all.resize(std::size_t(starts.back() + counts.back()));
    MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(),
                   MPI_DOUBLE, comm_);
    std::vector<Particle> own;
    const auto* first = reinterpret_cast<const Particle*>(all.data());
    for (std::size_t p = 0; p < all.size() * sizeof(double) / sizeof(Particle); ++p)
      if (owner(first[p].position) == rank_)
        own.push_back(first[p]);
    std::sort(own.begin(), own.end(),
              [](const Particle& a, const Particle& b) { return a.id < b.id; });
    assign(own);
  }

  /// Sum over all ranks.
  [[nodiscard]] Vec3 total(Vec3 mine) const {
    MPI_Allreduce(MPI_IN_PLACE, &mine.x, 3, MPI_DOUBLE, MPI_SUM, comm_);
    return mine;
  }
  [[nodiscard]] Vec3 momentum() const {
    Vec3 sum;
    for (std::size_t p = 0; p < size(); ++p)
      sum += mass[p] * velocity[p];
    return total(sum);
  }

  std::vector<Vec3> position, velocity, force;
  std::vector<double> radius, mass;
  std::vector<std::int64_t> id;
  std::vector<coupling::FluidState> fluid;
  std::vector<std::uint8_t> fixed;
  Vec3 external_impulse; ///< of gravity, buoyancy and other_force on free particles, this rank

private:
  [[nodiscard]] int owner(const Vec3& x) const {
    const int d = slab_direction;
    const double share = (x[d] - low[d]) / (high[d] - low[d]);
    return std::clamp(int(std::floor(share * ranks_)), 0, ranks_ - 1);
  }
  [[nodiscard]] Vec3 buoyancy(std::size_t p, coupling::Coupler& coupler) const {
    if (!(fluid[p].void_fraction > 0))
      return {};
    return -coupler.gas().fluid().density * sphere_volume(radius[p]) *
           coupler.gas().fluid().gravity;
  }
  void push(const Particle& q) {
    position.push_back(q.position);
    velocity.push_back(q.velocity);
    force.push_back({});
    radius.push_back(q.radius);
    mass.push_back(q.mass);
    id.push_back(q.id);
    fluid.push_back(q.fluid);
    fixed.push_back(q.fixed > 0 ? 1 : 0);
  }
  void assign(const std::vector<Particle>& particles) {
    position.clear(), velocity.clear(), force.clear(), radius.clear(), mass.clear();
    id.clear(), fluid.clear(), fixed.clear();
    for (const Particle& q : particles)
      push(q);
  }

  MPI_Comm comm_;
  int rank_ = 0, ranks_ = 1;
};

static_assert(sizeof(Particle) % sizeof(double) == 0);

} // namespace granflux::testing
