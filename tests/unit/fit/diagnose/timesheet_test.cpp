#include "talus/fit/diagnose/timesheet.hpp"

#include <gtest/gtest.h>

namespace talus::test {
namespace {

/// Keeps the processor busy for so many of its seconds.
void work(double seconds) {
  const std::clock_t start = std::clock();
  while (static_cast<double>(std::clock() - start) < seconds * CLOCKS_PER_SEC) {
  }
}

TEST(Timesheet, ATimeBelongsToTheOuterPhaseAlone) {
  Timesheet sheet;
  const std::clock_t start = std::clock();
  {
    const Timesheet::Phase fits(sheet, "fits", "air-drag");
    work(0.02);
    const Timesheet::Phase inner(sheet, "comparison");
    work(0.02);
  }
  {
    const Timesheet::Phase comparison(sheet, "comparison");
    work(0.01);
  }
  const double all = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  ASSERT_EQ(sheet.phases().size(), 2U);
  EXPECT_EQ(sheet.phases()[0].effect, "air-drag");
  EXPECT_GE(sheet.phases()[0].cpu, 0.04);
  EXPECT_GE(sheet.phases()[1].cpu, 0.01);
  EXPECT_LE(sheet.phases()[0].cpu + sheet.phases()[1].cpu, all);
}

TEST(Timesheet, SumsUpTheSameWork) {
  Timesheet a, b;
  a.add({"tests", "", 1.0});
  b.add({"fits", "block-mass", 2.0});
  b.add({"tests", "", 0.5});
  a.add(b);
  ASSERT_EQ(a.phases().size(), 2U);
  EXPECT_EQ(a.phases()[0].cpu, 1.5);
  EXPECT_EQ(a.phases()[1].cpu, 2.0);
}

}  // namespace
}  // namespace talus::test
