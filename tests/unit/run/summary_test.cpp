#include "talus/run/summary.hpp"

#include <gtest/gtest.h>

#include "talus/io/results/run_record.hpp"
#include "talus/run/gullies.hpp"

namespace talus::run {
namespace {

/// Totals of 100 trajectories, with the number that ended in each way; the others stopped.
Totals of_hundred(std::uint64_t trapped, std::uint64_t left, std::uint64_t limit = 0) {
  Totals totals;
  totals.released = 100;
  totals.ends[static_cast<std::size_t>(End::Stopped)] = 100 - trapped - left - limit;
  totals.ends[static_cast<std::size_t>(End::Trapped)] = trapped;
  totals.ends[static_cast<std::size_t>(End::Left)] = totals.left_blocks = left;
  totals.ends[static_cast<std::size_t>(End::Limit)] = totals.limited_blocks = limit;
  return totals;
}

bool holds(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

TEST(ProfileWarnings, NameWhatAProfileHas) {
  const std::vector<std::string> told = profile_warnings(of_hundred(40, 20));
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].rfind("20 % of the trajectories (20) left the profile", 0), 0U) << told[0];
  EXPECT_EQ(told[1].rfind("40 % of the trajectories (40) were trapped", 0), 0U) << told[1];
  EXPECT_TRUE(holds(told[0], "a longer profile")) << told[0];
  EXPECT_TRUE(holds(told[1], "stops.csv")) << told[1];
  for (const std::string& text : told)
    for (const char* const word : {"DEM", "map", ".tif", "talus check"}) EXPECT_FALSE(holds(text, word)) << text;
}

TEST(ProfileWarnings, AreOfTheSharesOfARun) {  // docs/scenario.md: above 1 % left, above 3 % trapped
  EXPECT_TRUE(profile_warnings(of_hundred(3, 1)).empty());
  EXPECT_EQ(profile_warnings(of_hundred(4, 1)).size(), 1U);
  EXPECT_EQ(profile_warnings(of_hundred(3, 2)).size(), 1U);
  for (const auto& [trapped, left] : {std::pair{3, 1}, {4, 1}, {3, 2}, {4, 2}}) {
    const Totals totals = of_hundred(static_cast<std::uint64_t>(trapped), static_cast<std::uint64_t>(left));
    EXPECT_EQ(profile_warnings(totals).size(), warnings_of(totals).size()) << trapped << ' ' << left;
  }
}

TEST(WarningsOf, NameTheMaps) {
  const std::vector<std::string> told = warnings_of(of_hundred(40, 20), 0, "sample");
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].rfind("20 % of the sample (20) left the DEM", 0), 0U) << told[0];
  EXPECT_TRUE(holds(told[0], "a larger DEM")) << told[0];
  EXPECT_TRUE(holds(told[1], "trapped.tif")) << told[1];
}

TEST(WarningsOf, TellFromTheFirstThatALimitCutShort) {
  Totals totals = of_hundred(0, 0, 1);
  EXPECT_TRUE(warnings_of(totals).empty()) << "1 % are an error, which says more";
  totals.released = 100000;
  const std::vector<std::string> told = warnings_of(totals);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].rfind("0.001 % of the trajectories (1) still moved", 0), 0U) << told[0];
  EXPECT_EQ(profile_warnings(totals), told) << "names no map";
}

TEST(WarningsOf, AreKnownAsThoseThatMapsEndEarly) {  // hazard and barrier repeat them: they find them by their words
  Totals totals = of_hundred(40, 0);
  totals.limited_blocks = totals.ends[static_cast<std::size_t>(End::Limit)] = 4;
  totals.released = 5000;
  totals.ends[static_cast<std::size_t>(End::Trapped)] = 400;
  std::vector<std::string> told = warnings_of(totals);
  ASSERT_EQ(told.size(), 2U) << "of those that are trapped, and of those that a limit cuts short";
  for (std::string& text : gully_warnings({400, std::nullopt}, 5000, "trajectories")) told.push_back(std::move(text));
  ASSERT_EQ(told.size(), 3U);
  for (const std::string& text : told) EXPECT_TRUE(io::says_maps_end_early(text)) << text;
  EXPECT_FALSE(io::says_maps_end_early(warnings_of(of_hundred(0, 20)).at(0))) << "they have notes of their own on it";
}

TEST(EndsText, SaysWhatTheBlocksLeft) {
  EXPECT_EQ(ends_text(of_hundred(40, 20, 5)), "35 stopped, 40 trapped, 20 left the map, 0 caught, 5 at a limit");
  EXPECT_EQ(ends_text(of_hundred(40, 20, 5), "profile"),
            "35 stopped, 40 trapped, 20 left the profile, 0 caught, 5 at a limit");
}

TEST(LimitsText, TellsThoseOfWhichOnlyASmallerPieceIsCutOff) {
  Totals totals = of_hundred(0, 0, 5);
  EXPECT_EQ(limits_text(totals),
            "5 of 100 trajectories (5 %, allowed are 0.1 %) ended at the limit of impacts, time or vertices");
  totals.limited_blocks = 12;
  const std::string text = limits_text(totals);
  EXPECT_EQ(text.rfind("12 of 100 trajectories (12 %", 0), 0U) << text;
  EXPECT_TRUE(text.ends_with(", 7 of them with smaller pieces only")) << text;
}

TEST(ProfileLimitsText, SaysAWayOut) {
  const std::string text = profile_limits_text(of_hundred(0, 0, 5));
  EXPECT_EQ(text.rfind("5 of 100 trajectories (5 %, allowed are 0.1 %) ended at the limit", 0), 0U) << text;
  for (const char* const word : {"stops.csv", "time_limit", "impact_limit", "[model]"})
    EXPECT_TRUE(holds(text, word)) << text;
}

}  // namespace
}  // namespace talus::run
