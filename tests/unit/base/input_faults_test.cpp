#include "talus/base/input_faults.hpp"

#include <gtest/gtest.h>

namespace talus::test {
namespace {

FaultList of_cliffs() {
  return {"cliffs.gpkg", "feature", ""};
}

void add(FaultList& list, const std::string& fault) {
  list.attempt([&] { throw InputError(fault); });
}

/// Adds a fault for each of the features.
void add(FaultList& list, int first, int last, const std::string& fault) {
  for (int i = first; i <= last; ++i) add(list, list.label(i) + fault);
}

InputFaults faults_of(const FaultList& list) {
  try {
    list.stop();
  } catch (const InputFaults& faults) {
    return faults;
  }
  ADD_FAILURE() << "no fault";
  return {{""}, 1};
}

using Lines = std::vector<std::string>;

TEST(FaultList, ThreeOfAKindAndHowManyMore) {
  FaultList list = of_cliffs();
  for (int i = 1; i <= 100; ++i) {
    add(list, i, i, ": field diameter = -" + std::to_string(i) + ".5: must be 0.01 to 50 m");
    if (i == 50) add(list, i, i, ": has no geometry");
  }
  const InputFaults faults = faults_of(list);
  EXPECT_EQ(faults.faults(), (Lines{"cliffs.gpkg: feature 1: field diameter = -1.5: must be 0.01 to 50 m",
                                    "cliffs.gpkg: feature 2: field diameter = -2.5: must be 0.01 to 50 m",
                                    "cliffs.gpkg: feature 3: field diameter = -3.5: must be 0.01 to 50 m",
                                    "cliffs.gpkg: and 97 more like this, in features 4 to 100",
                                    "cliffs.gpkg: feature 50: has no geometry"}));
  EXPECT_EQ(faults.count(), 101U);
  EXPECT_NE(std::string(faults.what()).find("(and 100 more faults)"), std::string::npos) << faults.what();
}

TEST(FaultList, KindsAreInTheOrderInWhichTheyAreMet) {
  FaultList list = of_cliffs();
  for (int i = 1; i <= 5; ++i) {
    add(list, i, i, ": has no a");
    add(list, i, i, ": has no b");
  }
  EXPECT_EQ(faults_of(list).faults(),
            (Lines{"cliffs.gpkg: feature 1: has no a", "cliffs.gpkg: feature 1: has no b",
                   "cliffs.gpkg: feature 2: has no a", "cliffs.gpkg: feature 2: has no b",
                   "cliffs.gpkg: feature 3: has no a", "cliffs.gpkg: and 2 more like this, in features 4 to 5",
                   "cliffs.gpkg: feature 3: has no b", "cliffs.gpkg: and 2 more like this, in features 4 to 5"}));
}

TEST(FaultList, TheRangeIsOfTheFeaturesThatAreNotShownInAnyOrder) {
  FaultList list("trees.csv", "row", " below the header");
  for (const int row : {9, 8, 7, 30, 12, 25}) add(list, row, row, ": is no point");
  EXPECT_EQ(faults_of(list).faults().back(), "trees.csv: and 3 more like this, in rows 12 to 30 below the header");
  FaultList one = of_cliffs();
  add(one, 0, 3, ": is no polygon");
  EXPECT_EQ(faults_of(one).faults().back(), "cliffs.gpkg: and 1 more like this, in feature 3");
}

TEST(FaultList, WhatDiffersInMoreThanNumbersIsAnotherKind) {
  FaultList list = of_cliffs();
  for (const char* fault :
       {": zone '3' is not described", ": zone '4' is not described", ": field f1 = 9: too large",
        ": field f2 = 9: too large", ": field f1 = -9: too small", ": field f1 = 'one': must be a number",
        ": field Ø1 = 9: too large", ": field Ø2 = 9: too large"})
    add(list, 1, 3, fault);
  EXPECT_EQ(faults_of(list).faults().size(), 24U);
}

TEST(FaultList, ValuesOfAnyKindAreOneKind) {
  FaultList list = of_cliffs();
  for (const char* value : {"1e-05", "-3", "0.25", "1e+20", "7"})
    add(list, 1, 1, ": f = " + std::string(value) + ": no");
  for (const char* value : {"a", "1,5", "", "b c"}) add(list, 1, 1, ": t = '" + std::string(value) + "': no");
  EXPECT_EQ(faults_of(list).faults().size(), 8U);  // three and a line of each
}

TEST(FaultList, FaultsOfNoFeatureAreAllListedOnce) {
  FaultList list = of_cliffs();
  for (int i = 0; i < 100; ++i) add(list, "cliffs.csv:5: diameter = '1,5': must be a number");
  for (int i = 0; i < 10; ++i) add(list, "cliffs.csv:" + std::to_string(i) + ": is odd");
  EXPECT_EQ(faults_of(list).faults().size(), 11U);
  EXPECT_EQ(list.count(), 110U);
}

TEST(FaultList, AKindAfterAThousandFaultsOfAnotherIsListed) {
  FaultList list = of_cliffs();
  add(list, 1, 5000, ": field diameter = 99: must be 0.01 to 50 m");
  add(list, 7, 7, ": has no geometry");
  EXPECT_EQ(faults_of(list).faults().back(), "cliffs.gpkg: feature 7: has no geometry");
}

}  // namespace
}  // namespace talus::test
