// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later

#include "wall_kernel.hpp"

#include <vector>

#include "choices.hpp"
#include "history_of_law.hpp"
#include "law/hertz.hpp"
#include "law/hertz_stiffness.hpp"
#include "law/hooke.hpp"
#include "law/hooke_stiffness.hpp"
#include "wall_law.hpp"

namespace granflux::particle_subset {

namespace {

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
    touch_all(p, touches, wall_type, dt, [](const WallTouch&, const Force&) {});
  }
  void add_with_heat(const Particles& p, std::span<WallTouch> touches, int wall_type, double dt,
                     const HeatOfWall& heat) const override {
    if constexpr (!Law::rubs)
      if (heat.contacts.keeps_sliders_work_alone()) {
        KeptAtWall kept(heat);
        touch_all(p, touches, wall_type, dt, [&](const WallTouch& touch, const Force& f) {
          kept.add(touch.particle, f.heat.sliding + f.heat.rolling);
        });
        return;
      }
    const auto add = [&](const WallTouch& touch, const Force& f, const Dissipation& made) {
      const int i = touch.particle;
      heat.add(i, p.type[i], wall_type, p.radius[i], -touch.gap, f.pressing, made);
    };
    if (heat.contacts.law->options().slider_at_most()) // the rest is then not computed
      touch_all(p, touches, wall_type, dt, [&](const WallTouch& touch, const Force& f) {
        add(touch, f, {.sliding = f.heat.sliding, .rolling = f.heat.rolling});
        if constexpr (Law::rubs)
          heat.resist({touch.particle, {}, f.rubbing});
      });
    else
      touch_all(p, touches, wall_type, dt, [&](const WallTouch& touch, const Force& f) {
        add(touch, f, f.heat);
        if (Law::rubs || heat.contacts.law->options().damping)
          heat.resist({touch.particle, f.damping, f.rubbing});
      });
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
  using Force = typename Law::Force;

  /// All in one: what a law makes that is not seen, as heat, is then not computed.
  template <class Seen>
  [[gnu::flatten]] void touch_all(const Particles& p, std::span<WallTouch> touches, int wall_type,
                                  double dt, Seen&& seen) const {
    for (WallTouch& touch : touches) {
      const int i = touch.particle;
      Vec3 tangential = tangential_history<Law>(touch.history);
      Vec3 rolling = rolling_history<Law>(touch.history);
      const auto f =
          Law::force(constants(p, i, wall_type), touched(p, touch), dt, tangential, rolling);
      keep_history<Law::has_tangential_history>(touch.history, tangential);
      keep_history<Law::has_rolling_history>(touch.history + Law::rolling_offset, rolling);
      p.force[i] += f.force;
      p.torque[i] += f.torque;
      touch.force = f.force;
      seen(touch, f);
    }
  }

  [[nodiscard]] const typename Law::Constants& constants(const Particles& p, int particle,
                                                         int wall_type) const {
    return constants_[std::size_t((p.type[particle] - 1) * types_ + wall_type - 1)];
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

template <class Normal> std::unique_ptr<WallKernel> with_normal(const LawNames& names) {
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

} // namespace

std::unique_ptr<WallKernel> make_wall_kernel(const LawNames& names) {
  std::unique_ptr<WallKernel> kernel;
  choose(Choices<Hooke, HookeStiffness, Hertz, HertzStiffness>{}, names.normal,
         [&](auto normal) { kernel = with_normal<decltype(normal)>(names); });
  return kernel;
}

} // namespace granflux::particle_subset
