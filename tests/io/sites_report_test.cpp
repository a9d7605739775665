#include "talus/io/reports/sites_report.hpp"

#include <gtest/gtest.h>

namespace talus::io {
namespace {

/// Two sites that were not fitted together, with the test of the family of both.
std::string summary_of(double p_value, double p_corrected, bool may_name, const char* note) {
  SitesRecord record;
  JointRound round;
  round.family.name = "block property";
  round.family.p_value = p_value;
  round.family.p_corrected = p_corrected;
  round.family.may_name = may_name;
  round.family.note = note;
  record.diagnosis.rounds = {round};
  return sites_summary(record);
}

/// Blocks of one size at each site tell nothing about a property: that is not "no dependence", and there is no p.
TEST(SitesReport, SaysWhereNoPropertyWasTested) {
  EXPECT_EQ(summary_of(kNotGiven, kNotGiven, false, "two rocks: none can be named"),
            "Whether all sites together depend on a property of the block could not be tested: two rocks: none can be "
            "named.\n");
  EXPECT_EQ(summary_of(0.01, kNotGiven, false, "three rocks: none can be named"),
            "No property of the block can be named for all sites together (p 0.0100): three rocks: none can be "
            "named.\n");
  EXPECT_EQ(
      summary_of(0.4, 0.8, true, "p from 10000 arrangements"),
      "All sites together show no dependence on a property of the block (p 0.4000, 0.8000 corrected): no effect is "
      "named for them.\n");
}

TEST(SitesReport, WarnsOfTheSitesWhoseFoldsSplitGroups) {
  SitesRecord record;
  EXPECT_TRUE(sites_warnings(record).empty());
  record.diagnosis.sites.resize(2);
  record.diagnosis.sites[1].name = "two";
  record.diagnosis.nested.resize(2);
  EXPECT_TRUE(sites_warnings(record).empty());
  record.diagnosis.nested[1].folds.splits_groups = true;
  record.diagnosis.not_nested = "eight rows";
  const std::vector<std::string> warnings = sites_warnings(record);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("eight rows"), std::string::npos);
  EXPECT_EQ(warnings[1].find("two: the folds split groups"), 0U);
}

}  // namespace
}  // namespace talus::io
