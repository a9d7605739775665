#include "talus/simulate/scenario/parameter_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "support/manual.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace talus {

using test::numbers_in;

/// The bounds of keys in docs/scenario.md, by "section.key": column "bounds" of its tables under "### `[section]`".
std::map<std::string, std::string> bounds_in_the_manual() {
  std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/docs/scenario.md");
  std::map<std::string, std::string> found;
  std::string section;
  std::ptrdiff_t column = -1;  // of the bounds in this table
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) section = line.starts_with("### `[") ? line.substr(6, line.find(']') - 6) + "." : "";
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; line.starts_with("| ") && std::getline(row, cell, '|');) cells.push_back(cell);
    if (cells.empty()) column = -1;
    if (cells.empty() || column < 0) {
      const auto name = std::ranges::find(cells, " bounds ");
      column = name == cells.end() ? -1 : name - cells.begin();
      continue;
    }
    const std::string& keys = cells[1];  // "`volume_min`, `volume_max`"
    for (std::size_t at = keys.find('`'); at != keys.npos; at = keys.find('`', keys.find('`', at + 1) + 1))
      found.emplace(section + keys.substr(at + 1, keys.find('`', at + 1) - at - 1),
                    cells[static_cast<std::size_t>(column)]);
  }
  return found;
}

TEST(Fields, TheManualHasTheirBounds) {
  const auto manual = bounds_in_the_manual();
  std::vector<Bounds> all(scenario_fields().begin(), scenario_fields().end());
  all.insert(all.end(), list_bounds().begin(), list_bounds().end());
  int compared = 0;
  for (const Bounds& bounds : all) {
    const auto row = manual.find(std::string(bounds.key));
    if (row == manual.end()) continue;  // of a file of features, or told in words
    const std::string& text = row->second;
    EXPECT_EQ(numbers_in(text), (std::vector<double>{bounds.min, bounds.max})) << bounds.key << ':' << text;
    EXPECT_EQ(text.find("above") != text.npos, bounds.ends != Bounds::Closed) << bounds.key << ':' << text;
    EXPECT_EQ(text.find("whole") != text.npos, bounds.whole) << bounds.key << ':' << text;
    ++compared;
  }
  EXPECT_GE(compared, 22);
}

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
