// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "choices.hpp"
#include "contact_forces.hpp"
#include "contact_kernel.hpp"
#include "kept_work.hpp"
#include "stored_at_parting.hpp"

// The kernels of one normal law with all laws that may go with it. A normal law has a source file
// of its own, so that the compiler works on them side by side.
namespace granflux::particle_subset {

template <class Law> class KernelOf final : public ContactKernel {
public:
  [[nodiscard]] int history_size() const override { return Law::history; }
  [[nodiscard]] bool rubs() const override { return Law::rubs; }

  void read(const Material& material, int types) override {
    types_ = types;
    constants_.clear();
    for (int a = 1; a <= types; ++a)
      for (int b = 1; b <= types; ++b)
        constants_.push_back(Law::constants(material, a, b));
  }

  void add_lower(const Particles& particles, ThreadContacts& contacts, double dt,
                 const HeatOfContacts* heat) const override {
    if (!contacts.lower.partner.empty())
      with_forces(particles, contacts, dt, heat, [](auto& forces) { forces.add_lower(); });
  }

  void add_upper(const Particles& particles, ThreadContacts& contacts, Range block, double dt,
                 const HeatOfContacts* heat) const override {
    with_forces(particles, contacts, dt, heat, [&](auto& forces) { forces.add_upper(block); });
  }

  void add_parted(const Particles& particles, const ThreadContacts& contacts, double dt,
                  const ContactHeat& law, double* heat) const override {
    if constexpr (Law::history > 0) {
      // Memories of those that part lie far from each other.
      constexpr std::size_t ahead = 16;
      const std::vector<PartedPair>& parted = contacts.parted;
      for (std::size_t pair = 0; pair < parted.size(); ++pair) {
        __builtin_prefetch(parted[std::min(pair + ahead, parted.size() - 1)].history);
        const auto& [i, j, history] = parted[pair];
        const double ri = particles.radius[i], rj = particles.radius[j];
        const int type_i = particles.type[i], type_j = particles.type[j];
        const auto& k = constants_[std::size_t((type_i - 1) * types_ + type_j - 1)];
        const double energy =
            law.options().all_dissipated() // else it is not looked at when the two part
                ? left_at_parting<Law>(k, particles, i, j, dt, history)
                : stored_at_parting<Law>(k, ri * rj / (ri + rj), particles.reduced_mass(i, j),
                                         history);
        const double share = law.pair(type_i, type_j).share;
        if (contacts.own.holds(i))
          heat[i] += share * energy;
        if (contacts.own.holds(j))
          heat[j] += (1 - share) * energy;
      }
    }
  }

private:
  void with_forces(const Particles& particles, ThreadContacts& contacts, double dt,
                   const HeatOfContacts* heat, auto&& work) const {
    if constexpr (!Law::rubs)
      if (heat && heat->keeps_sliders_work_alone()) {
        with_heat<KeptWork>(particles, contacts, dt, *heat, work);
        return;
      }
    if (!heat || heat->rests())
      with_heat<WithoutHeat>(particles, contacts, dt, {}, work);
    else if (heat->law->options().slider_at_most())
      with_heat<HeatBatch<HeatMade::by_slider>>(particles, contacts, dt, *heat, work);
    else
      with_heat<HeatBatch<HeatMade::by_any>>(particles, contacts, dt, *heat, work);
  }

  template <class Heat>
  void with_heat(const Particles& particles, ThreadContacts& contacts, double dt,
                 const typename Heat::Source& heat, auto&& work) const {
    const auto* constants = constants_.data();
    if (types_ == 1 || particles.alike.type) {
      ContactForces<Law, true, Heat> forces(particles, contacts, constants, types_, dt, heat);
      work(forces);
    } else {
      ContactForces<Law, false, Heat> forces(particles, contacts, constants, types_, dt, heat);
      work(forces);
    }
  }

  int types_ = 0;
  std::vector<typename Law::Constants> constants_;
};

template <class Normal>
std::unique_ptr<ContactKernel> kernel_with_normal(const LawNames& names, std::string& unknown) {
  std::unique_ptr<ContactKernel> kernel;
  const bool tangential = choose(TangentialLaws{}, names.tangential, [&](auto t) {
    const bool rolling = choose(RollingLaws{}, names.rolling, [&](auto r) {
      const bool cohesion = choose(CohesionLaws{}, names.cohesion, [&](auto c) {
        using Law = ContactLaw<Normal, decltype(t), decltype(r), decltype(c)>;
        kernel = std::make_unique<KernelOf<Law>>();
      });
      if (!cohesion)
        unknown = "cohesion " + names.cohesion;
    });
    if (!rolling)
      unknown = "rolling_friction " + names.rolling;
  });
  if (!tangential)
    unknown = "tangential " + names.tangential;
  return kernel;
}

} // namespace granflux::particle_subset
