// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "kick.hpp"

#include <algorithm>

namespace granflux::particle_subset {

namespace {

// A block's vectors are taken as 24 numbers each: no stride of 3, and full vector registers.
constexpr int block = Subset::line;
constexpr int numbers = 3 * block;

bool all_of(int group, const int* mask) {
  int common = group;
  for (int i = 0; i < block; ++i)
    common &= mask[i];
  return common == group;
}

void spread(const double* factor, double* spread_factor) {
  for (int i = 0; i < block; ++i)
    spread_factor[3 * i] = spread_factor[3 * i + 1] = spread_factor[3 * i + 2] = factor[i];
}

struct Factors {
  double linear[numbers], angular[numbers];

  Factors(const HalfKick& half, const double* radius, const double* mass) {
    double a[block], b[block];
    for (int i = 0; i < block; ++i) {
      a[i] = half.half_step / (mass[i] * half.mass_factor);
      b[i] = half.half_step_inertia / (radius[i] * radius[i] * mass[i]);
    }
    spread(a, linear);
    spread(b, angular);
  }
};

template <int halves> void kick_one(const HalfKick& half, const Spheres& s, int i) {
  const double linear = half.half_step / (s.mass[i] * half.mass_factor);
  const double angular = half.half_step_inertia / (s.radius[i] * s.radius[i] * s.mass[i]);
  for (int h = 0; h < halves; ++h)
    for (int d = 3 * i; d < 3 * i + 3; ++d) {
      s.velocity[d] += linear * s.force[d];
      s.angular_velocity[d] += angular * s.torque[d];
    }
}

template <int halves> void kick_block(const HalfKick& half, const Spheres& s, int first) {
  const Factors factor(half, s.radius + first, s.mass + first);
  double* __restrict v = s.velocity + 3 * first;
  double* __restrict omega = s.angular_velocity + 3 * first;
  const double* __restrict f = s.force + 3 * first;
  const double* __restrict torque = s.torque + 3 * first;
  for (int d = 0; d < numbers; ++d) {
    const double change = factor.linear[d] * f[d];
    const double turn = factor.angular[d] * torque[d];
    for (int h = 0; h < halves; ++h) {
      v[d] += change;
      omega[d] += turn;
    }
  }
}

double squared_speed(const double* v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

template <int halves>
double kick_and_move_all(const HalfKick& half, double step, const Spheres& s, Range range) {
  double fastest = 0;
  const auto move_one = [&](int i) {
    if (!(s.mask[i] & half.group))
      return;
    kick_one<halves>(half, s, i);
    for (int d = 3 * i; d < 3 * i + 3; ++d)
      s.position[d] += step * s.velocity[d];
    fastest = std::max(fastest, squared_speed(s.velocity + 3 * i));
  };
  int i = range.begin;
  for (; i + block <= range.end; i += block) {
    if (!all_of(half.group, s.mask + i)) {
      for (int j = i; j < i + block; ++j)
        move_one(j);
      continue;
    }
    kick_block<halves>(half, s, i);
    double* __restrict x = s.position + 3 * i;
    const double* __restrict v = s.velocity + 3 * i;
    for (int d = 0; d < numbers; ++d)
      x[d] += step * v[d];
    for (int j = 0; j < block; ++j)
      fastest = std::max(fastest, squared_speed(v + 3 * j));
  }
  for (; i < range.end; ++i)
    move_one(i);
  return fastest;
}

} // namespace

void kick(const HalfKick& half, const Spheres& s, Range range) {
  int i = range.begin;
  for (; i + block <= range.end; i += block) {
    if (all_of(half.group, s.mask + i))
      kick_block<1>(half, s, i);
    else
      for (int j = i; j < i + block; ++j)
        if (s.mask[j] & half.group)
          kick_one<1>(half, s, j);
  }
  for (; i < range.end; ++i)
    if (s.mask[i] & half.group)
      kick_one<1>(half, s, i);
}

double kick_and_move(const HalfKick& half, int halves, double step, const Spheres& spheres,
                     Range range) {
  return halves == 2 ? kick_and_move_all<2>(half, step, spheres, range)
                     : kick_and_move_all<1>(half, step, spheres, range);
}

void add_weight(const double* acceleration, int group, const double* mass, const int* mask,
                double* force, Range range) {
  double accelerations[numbers];
  for (int d = 0; d < numbers; ++d)
    accelerations[d] = acceleration[d % 3];
  const auto add_to_some = [&](int begin, int end) {
    for (int j = begin; j < end; ++j)
      if (mask[j] & group)
        for (int d = 0; d < 3; ++d)
          force[3 * j + d] += mass[j] * acceleration[d];
  };
  int i = range.begin;
  for (; i + block <= range.end; i += block) {
    if (!all_of(group, mask + i)) {
      add_to_some(i, i + block);
      continue;
    }
    double masses[numbers];
    spread(mass + i, masses);
    double* __restrict f = force + 3 * i;
    for (int d = 0; d < numbers; ++d)
      f[d] += masses[d] * accelerations[d];
  }
  add_to_some(i, range.end);
}

} // namespace granflux::particle_subset
