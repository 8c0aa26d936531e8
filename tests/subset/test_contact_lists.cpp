// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "spheres.hpp"

namespace granflux::particle_subset::test {
namespace {

/// Spheres of three sizes and two types that press on each other, shaken by a fixed seed.
Spheres heap(int side, double spacing) {
  std::mt19937 generator(20);
  std::uniform_real_distribution<double> shift(-1, 1);
  Spheres s;
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const auto some = [&](double size) {
          const double x = shift(generator), y = shift(generator), z = shift(generator);
          return size * Vec3{x, y, z};
        };
        s.add(spacing * Vec3{double(i), double(j), double(k)} + some(0.1 * spacing), some(0.2),
              some(20), (0.8 + 0.2 * ((i + j + k) % 3)) * 1e-3, 2000, 1 + (i + k) % 2);
      }
  return s;
}

TestMaterial two_types() {
  TestMaterial m;
  m.values = {{"Yeff", 3e6},       {"Geff", 1e6},           {"betaeff", -0.2},
              {"coeffFrict", 0.3}, {"coeffRollFrict", 0.1}, {"cohEnergyDens", 1e4}};
  m.options = {{"tangential_damping", true}};
  m.per_type = 0.1;
  return m;
}

const LawNames all_laws{"hertz", "history", "epsd2", "sjkr"};
constexpr double skin = 3e-4, dt = 1e-6;

void move(Spheres& s) {
  for (std::size_t p = 0; p < s.position.size(); ++p) {
    s.velocity[p] += dt / s.mass[p] * s.force[p];
    s.spin[p] += dt / (0.4 * s.mass[p] * s.radius[p] * s.radius[p]) * s.torque[p];
    s.position[p] += dt * s.velocity[p];
  }
}

Spheres after_steps(int threads, int steps, int between_builds, int side = 6) {
  Spheres s = heap(side, 1.9e-3);
  Contacts contacts(all_laws, two_types(), 2, threads);
  for (int step = 0; step < steps; ++step) {
    if (step % between_builds == 0) {
      if (step > 0)
        contacts.store(s);
      contacts.build(s, skin);
    }
    contacts.forces(s, dt);
    move(s);
  }
  return s;
}

TEST(ContactLists, HoldEveryPairOnceForEachOwner) {
  for (const double spacing : {1.9e-3, 9e-3})
    for (const int threads : {1, 2, 5}) {
      Spheres s = heap(5, spacing);
      Contacts contacts(all_laws, two_types(), 2, threads);
      contacts.build(s, skin);
      std::multiset<std::pair<int, int>> expected, found;
      const Subset subset(s.count(), threads);
      const auto owner = [&](int p) {
        int thread = 0;
        while (!subset.of(thread).holds(p))
          ++thread;
        return thread;
      };
      for (int i = 0; i < s.count(); ++i)
        for (int j = i + 1; j < s.count(); ++j) {
          const auto a = std::size_t(i), b = std::size_t(j);
          if (norm(s.position[a] - s.position[b]) <= s.radius[a] + s.radius[b] + skin)
            for (int copies = owner(i) == owner(j) ? 1 : 2; copies > 0; --copies)
              expected.insert({i, j});
        }
      for (int thread = 0; thread < threads; ++thread) {
        const ThreadContacts& mine = contacts.lists().of(thread);
        for (int row = 0; row < mine.own.size(); ++row) {
          const int p = mine.own.begin + row;
          for (int e = mine.lower.row_begin(row); e < mine.lower.row_end(row); ++e)
            found.insert({mine.lower.partner[std::size_t(e)], p});
          for (int e = mine.upper.row_begin(row); e < mine.upper.row_end(row); ++e)
            found.insert({p, mine.upper.partner[std::size_t(e)]});
        }
      }
      EXPECT_EQ(found, expected) << spacing << ' ' << threads;
    }
}

TEST(ContactLists, UnseenParticlesAreInNoPairOfOtherThreads) {
  for (const int threads : {1, 2, 5}) {
    Spheres s = heap(12, 1.9e-3);
    Contacts contacts(all_laws, two_types(), 2, threads);
    contacts.build(s, skin);
    std::set<int> seen_by_others;
    for (int thread = 0; thread < threads; ++thread) {
      const ThreadContacts& mine = contacts.lists().of(thread);
      for (const ContactRows* rows : {&mine.lower, &mine.upper})
        for (const int p : rows->partner)
          if (!mine.own.holds(p))
            seen_by_others.insert(p);
    }
    EXPECT_EQ(seen_by_others.empty(), threads == 1);
    for (int thread = 0; thread < threads; ++thread) {
      const auto [own, unseen] =
          std::pair(contacts.lists().of(thread).own, contacts.lists().of(thread).unseen);
      EXPECT_TRUE(unseen.begin >= own.begin && unseen.end <= own.end);
      const auto first = seen_by_others.lower_bound(unseen.begin);
      EXPECT_TRUE(first == seen_by_others.end() || *first >= unseen.end) << thread;
      EXPECT_GT(unseen.size(), threads == 2 ? own.size() / 2 : 0) << threads;
      if (threads == 1) {
        EXPECT_EQ(unseen.size(), own.size());
      }
    }
  }
}

TEST(ContactLists, ForcesAreTheSameBitsOnAnyNumberOfThreads) {
  const Spheres one = after_steps(1, 60, 7);
  for (const int threads : {2, 3, 4, 7}) {
    const Spheres many = after_steps(threads, 60, 7);
    EXPECT_EQ(one.force, many.force) << threads;
    EXPECT_EQ(one.torque, many.torque) << threads;
    EXPECT_EQ(one.position, many.position) << threads;
  }
}

TEST(ContactLists, BlockAfterBlockGivesTheSameBits) {
  for (const int threads : {1, 2}) {
    Spheres whole = heap(18, 1.9e-3);
    ASSERT_GT(whole.count() / threads, Subset::block);
    Spheres blocks = whole;
    Contacts one(all_laws, two_types(), 2, threads), other(all_laws, two_types(), 2, threads);
    one.build(whole, skin);
    other.build(blocks, skin);
    for (int step = 0; step < 3; ++step) {
      one.forces(whole, dt);
      other.forces_in_blocks(blocks, dt);
      move(whole);
      move(blocks);
    }
    EXPECT_EQ(whole.force, blocks.force) << threads;
    EXPECT_EQ(whole.torque, blocks.torque) << threads;
  }
}

TEST(ContactForces, WhatAllHaveInCommonGivesTheSameBits) {
  Spheres unknown = heap(8, 1.9e-3);
  constexpr double radius = 1e-3, mass = 8e-6;
  std::fill(unknown.radius.begin(), unknown.radius.end(), radius);
  std::fill(unknown.mass.begin(), unknown.mass.end(), mass);
  std::fill(unknown.type.begin(), unknown.type.end(), 2);
  const std::array known{Alike{.type = 2}, Alike{.radius = radius, .mass = mass},
                         Alike{.type = 2, .radius = radius, .mass = mass}};
  for (const int frozen_group : {0, 1}) {
    unknown.frozen_group = frozen_group;
    for (int p = 0; p < unknown.count(); p += 3)
      unknown.groups[std::size_t(p)] = 2; // free
    Spheres one = unknown;
    Contacts contacts(all_laws, two_types(), 2, 2);
    contacts.build(one, skin);
    for (int step = 0; step < 3; ++step)
      contacts.forces(one, dt);
    for (const Alike& alike : known) {
      Spheres other = unknown;
      other.alike = alike;
      Contacts its(all_laws, two_types(), 2, 2);
      its.build(other, skin);
      for (int step = 0; step < 3; ++step)
        its.forces(other, dt);
      EXPECT_EQ(one.force, other.force);
      EXPECT_EQ(one.torque, other.torque);
    }
  }
}

TEST(ContactLists, MemoryOutlivesTheLists) {
  // Nothing parts within the steps, so that lists built often forget no more than one built once.
  for (const int threads : {1, 3}) {
    const Spheres once = after_steps(threads, 40, 1000);
    const Spheres often = after_steps(threads, 40, 4);
    for (std::size_t p = 0; p < once.position.size(); ++p) {
      EXPECT_LT(norm(once.force[p] - often.force[p]), 1e-12 * (1e-3 + norm(once.force[p])));
      EXPECT_LT(norm(once.torque[p] - often.torque[p]), 1e-12 * (1e-6 + norm(once.torque[p])));
    }
  }
}

TEST(ContactLists, PartnersRememberOppositeSigns) {
  Spheres s = heap(4, 1.9e-3);
  Contacts contacts(all_laws, two_types(), 2, 2);
  contacts.build(s, skin);
  contacts.forces(s, dt);
  contacts.store(s);
  const PartnerHistory kept = contacts.kept();
  int contacts_found = 0;
  for (int i = 0; i < s.count(); ++i)
    for (int a = 0; a < kept.count[i]; ++a) {
      const int j = kept.partner[i][a] - 1;
      int b = 0;
      while (b < kept.count[j] && kept.partner[j][b] != i + 1)
        ++b;
      ASSERT_LT(b, kept.count[j]) << i << ' ' << j;
      for (int d = 0; d < 6; ++d)
        EXPECT_EQ(kept.history[i][6 * a + d], -kept.history[j][6 * b + d]);
      ++contacts_found;
    }
  EXPECT_GT(contacts_found, 100);
}

/// Flags and histories of all rows, after particles have been swapped in pairs that lie `distance`
/// numbers apart.
std::vector<double> remembered(int threads, bool one_sided, int distance) {
  Spheres s = heap(6, 1.9e-3);
  Contacts contacts(all_laws, two_types(), 2, threads);
  contacts.build(s, skin);
  contacts.forces(s, dt);
  contacts.store(s, one_sided);
  const PartnerHistory kept = contacts.kept();
  const auto swap_all = [](int a, int b, auto*... of) { (std::swap(of[a], of[b]), ...); };
  for (int p = 0; distance > 0 && p + distance < s.count(); p += distance + 3)
    swap_all(p, p + distance, s.position.data(), s.velocity.data(), s.spin.data(), s.radius.data(),
             s.mass.data(), s.type.data(), s.tag.data(), kept.count, kept.partner, kept.history);
  contacts.build(s, skin);
  std::vector<double> all;
  for (int thread = 0; thread < threads; ++thread)
    for (const ContactRows* rows :
         {&contacts.lists().of(thread).lower, &contacts.lists().of(thread).upper}) {
      all.insert(all.end(), rows->flags.begin(), rows->flags.end());
      all.insert(all.end(), rows->history.begin(), rows->history.end());
    }
  return all;
}

TEST(ContactLists, OneSideRemembersAsMuchAsBoth) {
  for (const int threads : {1, 3})
    for (const int distance : {0, 1, 7, 100}) {
      const std::vector<double> both = remembered(threads, false, distance);
      EXPECT_GT(std::ranges::count_if(both, [](double h) { return h != 0; }), 2000);
      EXPECT_EQ(remembered(threads, true, distance), both) << threads << ' ' << distance;
    }
}

TEST(ContactLists, MirrorFollowsTheUpperRows) {
  Spheres s = heap(5, 1.9e-3);
  Contacts contacts(all_laws, two_types(), 2, 3);
  contacts.build(s, skin);
  contacts.forces(s, dt);
  for (int thread = 0; thread < 3; ++thread) {
    auto& rows = contacts.lists().of(thread).lower;
    rows.history.assign(rows.history.size(), 77.0);
  }
  contacts.lists().mirror_history();
  Spheres fresh = s;
  contacts.forces(s, dt);
  Contacts other(all_laws, two_types(), 2, 3);
  other.build(fresh, skin);
  other.forces(fresh, dt);
  other.forces(fresh, dt);
  EXPECT_EQ(s.force, fresh.force);
}

TEST(Subset, RangesCoverAllAndBeginOnLines) {
  for (const int count : {0, 1, 7, 8, 100, 12345})
    for (const int threads : {1, 2, 3, 16}) {
      const Subset subset(count, threads);
      int next = 0;
      for (int t = 0; t < threads; ++t) {
        EXPECT_EQ(subset.of(t).begin, next);
        EXPECT_TRUE(next == count || next % Subset::line == 0);
        next = subset.of(t).end;
      }
      EXPECT_EQ(next, count);
    }
}

constexpr int resting = 2; // bit of a group

TEST(ContactLists, PairsAtRestAreNotEvaluated) {
  for (const int threads : {1, 3}) {
    Spheres s = heap(6, 1.9e-3);
    for (int p = 0; p < s.count() / 2; ++p)
      s.groups[std::size_t(p)] |= resting;
    Spheres all = s;
    Contacts some_rest(all_laws, two_types(), 2, threads),
        none_rests(all_laws, two_types(), 2, threads);
    some_rest.build(s, skin, resting);
    none_rests.build(all, skin);
    for (int step = 0; step < 3; ++step) {
      some_rest.forces(s, dt);
      none_rests.forces(all, dt);
    }
    int differ = 0;
    for (std::size_t p = 0; p < s.force.size(); ++p)
      if (s.groups[p] & resting) {
        differ += s.force[p] != all.force[p];
      } else {
        EXPECT_EQ(s.force[p], all.force[p]);
        EXPECT_EQ(s.torque[p], all.torque[p]);
      }
    EXPECT_GT(differ, 50);
  }
}

TEST(ContactLists, PairsAtRestRemember) {
  for (const int threads : {1, 3}) {
    Spheres s = heap(6, 1.9e-3);
    s.groups.assign(s.groups.size(), resting);
    Contacts rested(all_laws, two_types(), 2, threads), awake(all_laws, two_types(), 2, threads);
    for (Contacts* contacts : {&rested, &awake}) {
      contacts->build(s, skin);
      for (int step = 0; step < 3; ++step)
        contacts->forces(s, dt);
      contacts->store(s);
    }
    rested.build(s, skin, resting);
    rested.forces(s, dt);
    EXPECT_EQ(s.force, std::vector<Vec3>(s.force.size()));
    rested.store(s);
    Spheres other = s;
    rested.build(s, skin);
    rested.forces(s, dt);
    awake.build(other, skin);
    awake.forces(other, dt);
    EXPECT_EQ(s.force, other.force);
    EXPECT_EQ(s.torque, other.torque);
  }
}

TEST(ContactLists, NoParticlesAtAll) {
  Spheres s;
  Contacts contacts(all_laws, two_types(), 2, 2);
  contacts.build(s, skin);
  contacts.forces(s, dt);
  contacts.store(s);
  EXPECT_EQ(contacts.lists().of(1).own.size(), 0);
}

} // namespace
} // namespace granflux::particle_subset::test
