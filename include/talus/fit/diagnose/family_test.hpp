#pragma once
#include <string>
#include <vector>

#include "talus/fit/campaign/observe.hpp"

namespace talus {

/// A part of the test of a family, for the reports.
struct FamilyPart {
  std::string name;       ///< "log L1/L2", "day 2", "vegetation-drag", "runout"
  std::string statistic;  ///< what the number is: "correlation", "mean", "variance", "share", "statistic"
  double value = 0.0;
  double p_value = 1.0;  ///< of this part alone; NaN where it has none
};

/// Effects that leave the same kind of trace, tested together by one test of few degrees of freedom.
/// docs/diagnosis-method.md, "The families".
struct FamilyTest {
  std::string name;                  ///< "block property", "place", "day", "instrument", "dispersion"
  std::vector<std::string> members;  ///< effects that may be named if the family is significant
  double p_value = kNotGiven;        ///< NaN: these data cannot test it
  double p_corrected = kNotGiven;    ///< for the number of families that can name something (Holm); NaN of the others
  bool may_name = true;              ///< false: no p-value would be small enough for its members to be named
  bool own_test = false;             ///< not the score tests of its members, so that all of them may be chosen
  std::string note;                  ///< what it needs to be tested, or why it cannot name; how its p-value was found
  std::vector<FamilyPart> parts;
};

}  // namespace talus
