#include "talus/physics/effects/registry.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "support/manual.hpp"

namespace talus {
namespace {

using test::numbers_in;

std::string text_of_file(const std::string& path) {
  std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/" + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The part of a page from "## title" to the next one; empty where there is none.
std::string section_of(const std::string& page, const std::string& title) {
  const std::size_t begin = page.find("\n## " + title + "\n");
  if (begin == std::string::npos) return {};
  return page.substr(begin, page.find("\n## ", begin + 1) - begin);
}

/// The cells of the row of a table that begins with a key; none where there is no such row.
std::vector<std::string> row_of(const std::string& section, const std::string& key) {
  const std::size_t begin = section.find("\n| `" + key + "`");
  if (begin == std::string::npos) return {};
  std::istringstream row(section.substr(begin + 2, section.find('\n', begin + 1) - begin - 2));
  std::vector<std::string> cells;
  for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
  return cells;
}

TEST(Registry, HasEachEffectOnce) {
  Effects effects;
  std::set<const void*> members;
  std::set<std::string_view> names;
  for_each_effect(effects, [&](auto& effect) { members.insert(&effect); });
  for (const EffectEntry& entry : effect_entries()) names.insert(entry.name);
  EXPECT_EQ(members.size(), registry::members_of<Effects>());
  EXPECT_EQ(names.size(), members.size());
}

/// Setting a number of an entry changes this number and no other.
TEST(Registry, NumbersAreApart) {
  for (const EffectEntry& entry : effect_entries())
    for (const EffectField& field : entry.fields()) {
      Effects effects;
      const double value = field.get(effects) == field.max ? field.min : field.max;
      field.set(effects, value);
      for (const EffectEntry& other : effect_entries())
        for (const EffectField& number : other.fields())
          EXPECT_EQ(number.get(effects), &number == &field ? value : number.get(Effects{})) << field.key;
    }
}

/// A default is allowed, and a strength is off by default.
TEST(Registry, DefaultsAreAllowedAndOff) {
  const Effects fresh;
  EXPECT_FALSE(fresh.any());
  for (const EffectEntry& entry : effect_entries()) {
    EXPECT_FALSE(entry.acts(fresh)) << entry.name;
    bool strength = false;
    for (const EffectField& field : entry.fields()) {
      EXPECT_GE(field.get(fresh), field.min) << field.key;
      EXPECT_LE(field.get(fresh), field.max) << field.key;
      strength = strength || field.is_strength();
    }
    EXPECT_TRUE(strength) << entry.name << " has no number that switches it off";
  }
}

/// A search that leaves the bounds of a file does not compile, by this check. (Once a search went to 5 where a file may
/// say 3.) A search in multiples of a median is cut off where it is made: test `Candidates`.
TEST(Registry, RefusesASearchBeyondTheBounds) {
  const Bounds bounds{"air-drag.coefficient", "1", "C_d", 0.0, 3.0};
  EXPECT_TRUE(registry::within(bounds, std::nullopt));
  EXPECT_TRUE(registry::within(bounds, SearchRange{.lower = 0.0, .upper = 3.0, .noticed = 1.0}));
  EXPECT_FALSE(registry::within(bounds, SearchRange{.lower = 0.0, .upper = 5.0, .noticed = 1.0}));
  EXPECT_FALSE(registry::within(bounds, SearchRange{.lower = -1.0, .upper = 3.0, .noticed = 1.0}));
}

/// "VegetationDrag" for "vegetation-drag": the name of the tests of an effect.
std::string name_of_tests(std::string_view effect) {
  std::string name;
  bool capital = true;
  for (const char c : effect) {
    if (c != '-') name += capital ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    capital = c == '-';
  }
  return name;
}

/// The text of the tests of single effects.
std::string tests_of_effects() {
  const std::string folder = "tests/unit/physics/effects";
  std::string text;
  for (const auto& file : std::filesystem::directory_iterator(std::string(TALUS_SOURCE_DIR) + "/" + folder))
    text += text_of_file(folder + "/" + file.path().filename().string());
  return text;
}

TEST(Registry, EachEffectHasTestsOfItsOwn) {
  const std::string tests = tests_of_effects();
  for (const EffectEntry& entry : effect_entries())
    EXPECT_NE(tests.find("\nTEST(" + name_of_tests(entry.name) + ", "), std::string::npos)
        << entry.name << " has no TEST(" << name_of_tests(entry.name) << ", ...) in tests/unit/physics/effects";
}

TEST(Registry, EachEffectHasItsSectionInTheDocs) {
  const std::string page = text_of_file("docs/effects.md");
  ASSERT_FALSE(page.empty());
  for (const EffectEntry& entry : effect_entries()) {
    const std::string name(entry.name), section = section_of(page, name);
    EXPECT_NE(page.find("| [" + name + "](#" + name + ") |"), std::string::npos) << name << " is not in the table";
    ASSERT_FALSE(section.empty()) << name << " has no section";
    for (const EffectField& field : entry.fields()) {
      const std::vector<std::string> row =
          row_of(section, std::string(entry.key_of(field)));  // key, unit, bounds, default
      ASSERT_GE(row.size(), 4U) << field.key << " has no row in the table of its section";
      EXPECT_EQ(row[1], " " + std::string(field.unit) + " ") << field.key;
      EXPECT_EQ(numbers_in(row[2]), (std::vector<double>{field.min, field.max})) << field.key;
      EXPECT_EQ(row[2].find("above") != std::string::npos, field.ends == Bounds::AboveMin) << field.key;
      ASSERT_FALSE(numbers_in(row[3]).empty()) << field.key;
      EXPECT_EQ(numbers_in(row[3]).front(), field.get(Effects{})) << field.key;
    }
    if (entry.days_in != nullptr) {
      EXPECT_NE(section.find("`days`"), std::string::npos) << name;
    }
  }
}

}  // namespace
}  // namespace talus
