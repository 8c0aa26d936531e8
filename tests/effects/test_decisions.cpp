// SPDX-FileCopyrightText: 2026 The GranFlux developers
// SPDX-License-Identifier: BSD-3-Clause
//
// Decisions on scenes whose answers are known, words of the keyword, and warnings.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <granflux/cfd/error.hpp>

#include "driver/effects.hpp"

#include "scenes.hpp"

using namespace granflux;
using namespace granflux::driver;
using namespace granflux::testing;
using coupling::SceneState;

namespace {

constexpr EffectSet all_available{Effect::gas,        Effect::drag,       Effect::pressure_gradient,
                                  Effect::two_way,    Effect::convection, Effect::buoyancy,
                                  Effect::conduction, Effect::gas_gap,    Effect::radiation,
                                  Effect::friction,   Effect::damping};

TEST(Decisions, HotDiluteFlow) {
  const EffectSet on = decide(hot_dilute(), all_available);
  EXPECT_TRUE(on == (EffectSet{Effect::gas, Effect::drag, Effect::convection, Effect::radiation,
                               Effect::buoyancy} &
                     on));
  for (const Effect effect : {Effect::gas, Effect::drag, Effect::convection, Effect::radiation})
    EXPECT_TRUE(on.has(effect)) << name_of(effect);
  for (const Effect effect :
       {Effect::two_way, Effect::conduction, Effect::gas_gap, Effect::friction, Effect::damping})
    EXPECT_FALSE(on.has(effect)) << name_of(effect);
}

TEST(Decisions, ColdBed) {
  const EffectSet on = decide(cold_bed(), all_available);
  EXPECT_TRUE(on ==
              (EffectSet{Effect::gas, Effect::drag, Effect::pressure_gradient, Effect::two_way}));
}

TEST(Decisions, KilnWithoutGas) {
  const EffectSet on = decide(kiln(), effects_of_heat);
  EXPECT_TRUE(on.has(Effect::conduction));
  EXPECT_FALSE(on.has(Effect::friction));
  EXPECT_FALSE(on.has(Effect::damping));
}

TEST(Decisions, GasOfAKilnIsNotSolvedForItsDrag) {
  SceneState s = kiln();
  s.heat.reset();
  s.gas = coupling::GasOfScene{
      .density = 1.2, .viscosity = 1.8e-5, .wall_speed = 0.16, .length = 0.1524};
  EXPECT_FALSE(decide(s, all_available).any());
  // Where its heat counts it is, and the bed holds it up.
  SceneState warm = kiln();
  warm.gas = s.gas;
  warm.gas->conductivity = 0.026;
  warm.gas->heat_capacity = 1006;
  const EffectSet on = decide(warm, all_available);
  for (const Effect effect : {Effect::gas, Effect::drag, Effect::two_way, Effect::convection})
    EXPECT_TRUE(on.has(effect)) << name_of(effect);
}

TEST(Decisions, NoneWithoutParticles) {
  SceneState s = cold_bed();
  s.particles = {};
  EXPECT_TRUE(decide(s, all_available) == all_available);
}

TEST(Decisions, OnlyWhatIsAvailable) {
  EXPECT_FALSE(
      decide(hot_dilute(), EffectSet{Effect::conduction, Effect::friction}).has(Effect::radiation));
}

EffectsWanted take(std::vector<std::string> words, EffectSet own,
                   std::vector<std::string>* left = nullptr) {
  static const std::vector<std::string> keywords{"case",    "fixed_group", "effects",
                                                 "damping", "conduction",  "friction"};
  std::vector<char*> pointers;
  for (std::string& word : words)
    pointers.push_back(word.data());
  const EffectsWanted wanted = take_effects(pointers, own, keywords);
  if (left)
    left->assign(pointers.begin(), pointers.end());
  return wanted;
}

TEST(Words, Taken) {
  std::vector<std::string> left;
  EffectsWanted wanted =
      take({"case", "a", "effects", "gas", "drag", "fixed_group", "b"}, effects_of_gas, &left);
  EXPECT_TRUE(wanted.named == (EffectSet{Effect::gas, Effect::drag}));
  EXPECT_EQ(left, (std::vector<std::string>{"case", "a", "fixed_group", "b"}));
  // A keyword of the same name as its effect has a value.
  wanted = take({"effects", "conduction", "friction", "damping", "on"}, effects_of_heat, &left);
  EXPECT_TRUE(wanted.named == (EffectSet{Effect::conduction, Effect::friction}));
  EXPECT_EQ(left, (std::vector<std::string>{"damping", "on"}));
  EXPECT_EQ(take({"effects", "auto"}, effects_of_heat).by, EffectsWanted::By::numbers);
  EXPECT_FALSE(take({"effects", "none"}, effects_of_heat).named.any());
  EXPECT_FALSE(take({"case", "effects"}, effects_of_gas).given()); // the name of the file
}

TEST(Words, Refused) {
  const auto text = [](std::vector<std::string> words, EffectSet own) -> std::string {
    try {
      take(std::move(words), own);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return {};
  };
  const auto names = [](const std::string& message, const char* part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  names(text({"effects", "gas", "dragg"}, effects_of_gas),
        "dragg: unknown; there are auto, none, gas, drag");
  names(text({"effects", "conduction"}, effects_of_gas), "of fix granflux/heat");
  names(text({"effects", "gas"}, effects_of_heat), "of fix granflux/couple");
  names(text({"effects", "drag"}, effects_of_gas), "needs the effect gas");
  names(text({"effects"}, effects_of_gas), "no value");
  names(text({"effects", "auto", "gas"}, effects_of_gas), "stands alone");
  names(text({"effects", "auto", "effects", "none"}, effects_of_gas), "twice");
}

TEST(Watch, TellsOnceWhatCrosses) {
  SceneState s = kiln();
  const EffectSet on = decide(s, effects_of_heat);
  EffectWatch watch(effects_of_heat, effects_of_heat, on);
  watch.begin(s);
  EXPECT_EQ(watch.warnings(s), "");
  s.particles.speed = 20;
  const std::string text = watch.warnings(s);
  EXPECT_NE(text.find("WARNING: the effect friction, which is off, now counts"), std::string::npos)
      << text;
  EXPECT_EQ(watch.warnings(s), "");
}

TEST(Watch, LooksEverMoreSeldom) {
  EffectWatch watch;
  std::vector<long> looks;
  for (long step = 1; step <= 4000; ++step)
    if (watch.due(step))
      looks.push_back(step);
  EXPECT_EQ(looks, (std::vector<long>{1, 5, 21, 85, 341, 1341, 2341, 3341}));
  EXPECT_TRUE(watch.due(10)); // steps are counted anew
  EXPECT_FALSE(watch.due(11));
}

TEST(Table, NamesEveryEffect) {
  const SceneState s = kiln();
  const std::string text =
      effects_table(s, effects_of_heat, effects_of_heat, decide(s, effects_of_heat));
  for (const char* name : {"conduction", "gas_gap", "radiation", "friction", "damping",
                           "temperature inside", "not modelled"})
    EXPECT_NE(text.find(name), std::string::npos) << text;
}

} // namespace
