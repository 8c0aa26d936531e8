// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause

#include <vector>

#include <gtest/gtest.h>

#include <particle_subset/standing_contacts.hpp>

// A frozen particle at a wall at rest: its contact is evaluated once, until anything of it changes.
namespace granflux::particle_subset {
namespace {

struct OneParticle : testing::Test {
  std::vector<Vec3> position{{1, 2, 3}}, velocity{{}}, spin{{}}, force{{}}, torque{{}};
  std::vector<double> radius{0.5};
  Particles all;
  StandingContacts contacts;
  int evaluations = 0;

  OneParticle() {
    all.position = position.data(), all.velocity = velocity.data(), all.spin = spin.data();
    all.radius = radius.data(), all.force = force.data(), all.torque = torque.data();
    contacts.forget(1);
  }

  /// One step in which other parts of it have added 7 N along x already.
  void step() {
    force[0] = {7, 0, 0};
    torque[0] = {0, 5, 0};
    contacts.add(0, all, 0, [this] {
      ++evaluations;
      force[0] += {0, 0, 2};
      torque[0] += {0.25, 0, 0};
    });
    EXPECT_EQ(force[0], (Vec3{7, 0, 2}));
    EXPECT_EQ(torque[0], (Vec3{0.25, 5, 0}));
  }
};

TEST_F(OneParticle, IsEvaluatedOnce) {
  for (int i = 0; i < 100; ++i)
    step();
  EXPECT_EQ(evaluations, 1);
  EXPECT_EQ(contacts.force(0), (Vec3{0, 0, 2}));
}

TEST_F(OneParticle, IsEvaluatedAnewForNewLists) {
  step();
  contacts.forget(1);
  step();
  EXPECT_EQ(evaluations, 2);
}

TEST_F(OneParticle, IsEvaluatedAnewWhereItHasMovedOrGrown) {
  step();
  position[0].y += 1e-9;
  step();
  step();
  EXPECT_EQ(evaluations, 2);
  radius[0] *= 1.001;
  step();
  step();
  EXPECT_EQ(evaluations, 3);
}

TEST_F(OneParticle, IsEvaluatedInEachStepWhileItHasASpeed) {
  for (Vec3* speed : {velocity.data(), spin.data()}) {
    evaluations = 0;
    contacts.forget(1);
    *speed = {0, 0, 1e-9};
    step();
    step();
    EXPECT_EQ(evaluations, 2);
    *speed = {}; // what the dashpot did is no longer right
    step();
    step();
    EXPECT_EQ(evaluations, 3);
    *speed = {0, 0, 1e-9};
    step();
    EXPECT_EQ(evaluations, 4);
    *speed = {};
  }
}

} // namespace
} // namespace granflux::particle_subset
