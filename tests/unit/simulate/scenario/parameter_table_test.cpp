#include "talus/simulate/scenario/parameter_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "talus/simulate/scenario/presets.hpp"

namespace talus {

TEST(Fields, WhatIsSetIsGot) {
  for (const auto& field : ground_fields())
    for (const double share : {0.01, 0.37, 0.999}) {
      Ground ground;
      const double value = field.min + share * (field.max - field.min);
      field.set(ground, value);
      EXPECT_NEAR(field.get(ground), value, 1e-13 * value) << field.key;
    }
  for (const auto& field : scenario_fields()) {
    Scenario scenario;
    const double value = std::floor(field.min + 0.37 * (field.max - field.min)) + 1.0;
    field.set(scenario, value);
    EXPECT_EQ(field.get(scenario), value) << field.key;
  }
}

TEST(Fields, DefaultsAreAllowed) {
  const Scenario fresh;
  for (const auto& field : scenario_fields()) EXPECT_FALSE(fault_of(field, field.get(fresh))) << field.key;
  for (const Preset& preset : presets())
    for (const auto& field : ground_fields())
      EXPECT_FALSE(fault_of(field, field.get(preset.ground))) << preset.name << ' ' << field.key;
}

TEST(Fields, KeysAreUnique) {
  std::set<std::string_view> keys;
  for (const auto& field : ground_fields()) EXPECT_TRUE(keys.insert(field.key).second) << field.key;
  for (const auto& field : scenario_fields()) EXPECT_TRUE(keys.insert(field.key).second) << field.key;
  for (const Bounds& bounds : list_bounds()) EXPECT_TRUE(keys.insert(bounds.key).second) << bounds.key;
}

const Field<Ground>& phi() {
  for (const auto& field : ground_fields())
    if (field.key == "phi") return field;
  throw std::logic_error("no phi");
}

TEST(FrictionAngle, IsInDegrees) {
  Ground ground;
  for (const auto& [angle, tangent] :
       {std::pair{30.0, 1.0 / std::sqrt(3.0)}, {45.0, 1.0}, {60.0, std::sqrt(3.0)}, {15.0, 2.0 - std::sqrt(3.0)}}) {
    phi().set(ground, angle);
    EXPECT_NEAR(ground.tan_phi, tangent, 4e-16 * (1.0 + tangent));
  }
}

TEST(FrictionAngle, IsWrittenAsItWasReadAndReadsBackToTheSameTangent) {
  for (int i = 1; i < 8900; ++i) {
    const double angle = i / 100.0;
    Ground ground, again;
    phi().set(ground, angle);
    EXPECT_EQ(phi().get(ground), angle);
    phi().set(again, phi().get(ground));
    EXPECT_EQ(again.tan_phi, ground.tan_phi) << angle;
  }
}

TEST(Faults, SayWhatIsAllowed) {
  const Bounds closed{"a", "m", "height", 0.0, 5.0}, above{"a", "1", "share", 0.0, 1e6, Bounds::AboveMin},
      between{"a", "deg", "angle", 0.0, 89.0, Bounds::Between},
      whole{"a", "1", "number", 1.0, 9.0, Bounds::Closed, true};
  EXPECT_EQ(fault_of(closed, 6.0), "must be 0 to 5 m (height)");
  EXPECT_EQ(fault_of(above, 0.0), "must be above 0 and at most 1000000 (share)");
  EXPECT_EQ(fault_of(between, 89.0), "must be above 0 and below 89 deg (angle)");
  EXPECT_EQ(fault_of(whole, 1.5), "must be a whole number, 1 to 9 (number)");
  for (const double value : {0.0, 2.5, 5.0}) EXPECT_FALSE(fault_of(closed, value));
  for (const double value : {-1e-9, 5.0000001, std::nan(""), HUGE_VAL, -HUGE_VAL}) EXPECT_TRUE(fault_of(closed, value));
}

}  // namespace talus
