// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "choices.hpp"
#include "history_of_law.hpp"
#include "made_at_wall.hpp"
#include "wall_kernel.hpp"

// The wall kernels of one normal law, in a source file of its own as those of contacts.
namespace granflux::particle_subset {

template <class Law> class WallKernelOf final : public WallKernel {
public:
  [[nodiscard]] int history_size() const override { return Law::history; }
  [[nodiscard]] bool rubs() const override { return Law::rubs; }

  void read(const Material& material, int types) override {
    types_ = types;
    constants_.clear();
    for (int particle = 1; particle <= types; ++particle)
      for (int wall = 1; wall <= types; ++wall)
        constants_.push_back(Law::constants(material, particle, wall));
  }

  void add(const Particles& p, std::span<WallTouch> touches, int wall_type,
           double dt) const override {
    NothingMade nothing;
    if (types_ == 1 || are_of_one_type(p, touches))
      touch_all<true>(p, touches, wall_type, dt, nothing);
    else
      touch_all<false>(p, touches, wall_type, dt, nothing);
  }
  void add_with_heat(const Particles& p, std::span<WallTouch> touches, int wall_type, double dt,
                     const HeatOfWall& heat) const override {
    const auto touch = [&](auto&& made) { touch_all<false>(p, touches, wall_type, dt, made); };
    if constexpr (!Law::rubs)
      if (heat.contacts.keeps_sliders_work_alone()) {
        touch(SlidersWork<Law>(heat));
        return;
      }
    if (heat.contacts.law->options().slider_at_most())
      touch(MadeAtWall<Law, true>(heat, wall_type));
    else
      touch(MadeAtWall<Law, false>(heat, wall_type));
  }

  [[nodiscard]] double left_at_parting(const Particles& p, const WallTouch& last, int wall_type,
                                       double dt) const override {
    if constexpr (Law::history > 0)
      return Law::left_at_parting(constants(p, last.particle, wall_type), touched(p, last), dt,
                                  tangential_history<Law>(last.history),
                                  rolling_history<Law>(last.history));
    else
      return 0;
  }

private:
  static bool are_of_one_type(const Particles& p, std::span<const WallTouch> touches) {
    return std::ranges::all_of(touches, [&](const WallTouch& touch) {
      return p.type[touch.particle] == p.type[touches.front().particle];
    });
  }

  /// `one_material`: all touches are of particles of one type. What a law makes that `made` does
  /// not take, as heat, is not computed.
  template <bool one_material, class Made>
  void touch_all(const Particles& p, std::span<WallTouch> touches, int wall_type, double dt,
                 Made& made) const {
    WallBatch batch;
    for (std::size_t first = 0; first < touches.size(); first += WallBatch::capacity) {
      const auto some =
          touches.subspan(first, std::min(touches.size() - first, std::size_t(batch.capacity)));
      const int count = int(some.size());
      BatchConstants<Law, one_material> of_touch(constants(p, some[0].particle, wall_type));
      // The lanes of the last group that no touch is left for repeat the last touch.
      for (int k = 0; k < count || k % ContactBatch::lanes != 0; ++k) {
        const WallTouch& touch = some[std::size_t(std::min(k, count - 1))];
        batch.set(k, touched(p, touch));
        batch.tangential_history.set(k, tangential_history<Law>(touch.history));
        batch.rolling_history.set(k, rolling_history<Law>(touch.history));
        if constexpr (!one_material)
          of_touch.set(k, constants(p, touch.particle, wall_type));
      }
      evaluate(batch, count, of_touch, dt, made);
      for (int k = 0; k < count; ++k) {
        WallTouch& touch = some[std::size_t(k)];
        const int i = touch.particle;
        keep_history<Law::has_tangential_history>(touch.history, batch.tangential_history.at(k));
        keep_history<Law::has_rolling_history>(touch.history + Law::rolling_offset,
                                               batch.rolling_history.at(k));
        touch.force = batch.force.at(k);
        p.force[i] += touch.force;
        p.torque[i] += batch.torque.at(k);
        made.give(k, p, i, touch.gap);
      }
    }
  }

  [[nodiscard]] const typename Law::Constants& constants(const Particles& p, int particle,
                                                         int wall_type) const {
    const int type = types_ == 1 ? 1 : p.type[particle];
    return constants_[std::size_t((type - 1) * types_ + wall_type - 1)];
  }
  static TouchedWall touched(const Particles& p, const WallTouch& touch) {
    const int i = touch.particle;
    return {.separation = touch.separation,
            .velocity = p.velocity[i] - touch.wall_velocity,
            .spin = p.spin[i],
            .distance = p.radius[i] + touch.gap,
            .radius = p.radius[i],
            .mass = p.mass[i]};
  }
  template <bool has> static void keep_history(double* h, const Vec3& v) {
    if constexpr (has)
      h[0] = v.x, h[1] = v.y, h[2] = v.z;
  }

  int types_ = 0;
  std::vector<typename Law::Constants> constants_;
};

template <class Normal> std::unique_ptr<WallKernel> wall_kernel_with_normal(const LawNames& names) {
  std::unique_ptr<WallKernel> kernel;
  choose(TangentialLaws{}, names.tangential, [&](auto t) {
    choose(RollingLaws{}, names.rolling, [&](auto r) {
      choose(CohesionLaws{}, names.cohesion, [&](auto c) {
        using Law = WallLaw<Normal, decltype(t), decltype(r), decltype(c)>;
        kernel = std::make_unique<WallKernelOf<Law>>();
      });
    });
  });
  return kernel;
}

} // namespace granflux::particle_subset
