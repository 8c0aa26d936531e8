// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <particle_subset/contact_kernel.hpp>

namespace granflux::particle_subset::test {

/// Constants by name, the same for every pair of types unless a test says otherwise.
struct TestMaterial : Material {
  std::map<std::string, double, std::less<>> values;
  std::map<std::string, bool, std::less<>> options;
  double per_type = 0; ///< added share for each type above 1: types differ

  [[nodiscard]] double pair(std::string_view name, int a, int b) const override {
    return scalar(name) * (1 + per_type * (a + b - 2));
  }
  [[nodiscard]] double scalar(std::string_view name) const override {
    const auto found = values.find(name);
    if (found == values.end())
      ADD_FAILURE() << "a law asked for " << name;
    return found == values.end() ? 0 : found->second;
  }
  [[nodiscard]] bool option(std::string_view name) const override {
    const auto found = options.find(name);
    return found != options.end() && found->second;
  }
};

/// Spheres that hold their own arrays, in place of the host.
struct Spheres {
  std::vector<Vec3> position, velocity, spin, force, torque;
  std::vector<double> radius, mass;
  std::vector<int> type, tag, groups;
  Alike alike; ///< as somebody has looked
  int frozen_group = 0;

  [[nodiscard]] int count() const { return int(position.size()); }

  void add(const Vec3& place, const Vec3& v, const Vec3& w, double r, double density,
           int of_type = 1) {
    position.push_back(place);
    velocity.push_back(v);
    spin.push_back(w);
    force.push_back({});
    torque.push_back({});
    radius.push_back(r);
    mass.push_back(density * 4 / 3 * std::numbers::pi * r * r * r);
    type.push_back(of_type);
    tag.push_back(count());
    groups.push_back(1);
  }

  Particles view() {
    return {.owned = count(),
            .all = count(),
            .position = position.data(),
            .velocity = velocity.data(),
            .spin = spin.data(),
            .radius = radius.data(),
            .mass = mass.data(),
            .type = type.data(),
            .tag = tag.data(),
            .groups = groups.data(),
            .alike = alike,
            .frozen_group = frozen_group,
            .force = force.data(),
            .torque = torque.data()};
  }
};

/// The contacts of spheres on some threads, with the memory that the host would keep.
class Contacts {
public:
  Contacts(const LawNames& names, const Material& material, int types, int threads)
      : threads_(threads) {
    std::string unknown;
    kernel_ = make_contact_kernel(names, unknown);
    if (!kernel_)
      throw std::runtime_error(unknown);
    kernel_->read(material, types);
  }

  void build(Spheres& s, double skin, int at_rest = 0) {
    const auto n = std::size_t(s.count());
    count_.resize(n), partner_.resize(n), history_.resize(n);
    lists_.build(s.view(), skin, threads_, kernel_->history_size(), {}, kept(), at_rest);
  }
  void store(Spheres& s, bool one_sided = false) {
    one_sided_ = one_sided;
    lists_.store(s.view(), kept());
  }

  void forces(Spheres& s, double dt) {
    s.force.assign(s.force.size(), {});
    s.torque.assign(s.torque.size(), {});
    const Particles all = s.view();
#pragma omp parallel for num_threads(threads_) schedule(static, 1)
    for (int thread = 0; thread < threads_; ++thread)
      kernel_->add(all, lists_.of(thread), dt);
  }

  /// The same block after block, forces of the last step taken off no sooner than they are added
  /// to.
  void forces_in_blocks(Spheres& s, double dt) {
    const Particles all = s.view();
#pragma omp parallel for num_threads(threads_) schedule(static, 1)
    for (int thread = 0; thread < threads_; ++thread) {
      ThreadContacts& mine = lists_.of(thread);
      int cleared = mine.own.begin;
      const auto clear_up_to = [&](int end) {
        for (; cleared < end; ++cleared)
          all.force[cleared] = all.torque[cleared] = {};
      };
      clear_up_to(mine.reach_of_lower());
      kernel_->add_lower(all, mine, dt);
      for_each_block(mine.own, [&](Range block) {
        clear_up_to(mine.reach_of_block(block));
        kernel_->add_upper(all, mine, block, dt);
      });
    }
  }

  [[nodiscard]] ContactLists& lists() {
    return lists_;
  }
  [[nodiscard]] PartnerHistory kept() {
    return {count_.data(), partner_.data(), history_.data(), one_sided_};
  }

private:
  int threads_;
  std::unique_ptr<ContactKernel> kernel_;
  ContactLists lists_;
  std::vector<int> count_;
  std::vector<int*> partner_;
  std::vector<double*> history_;
  bool one_sided_ = false;
};

} // namespace granflux::particle_subset::test
