#include "talus/io/reports/diagnosis_page.hpp"

#include <gtest/gtest.h>

#include "io/reports/diagnosis_summary.hpp"

namespace talus::io {
namespace {

DiagnosisRound round_with(const char* effect, double p_of_place) {
  DiagnosisRound round;
  round.effect = effect;
  round.p_value = p_of_place;
  FamilyTest place, day;
  place.name = "place";
  place.p_value = place.p_corrected = p_of_place;
  day.name = "day";
  day.p_value = day.p_corrected = 0.9;
  round.families = {place, day};
  return round;
}

/// Two rounds of no effect, in both of which the place has p = 0.2.
DiagnosisRecord record_of(double first_level, double later_level) {
  DiagnosisRecord record;
  record.options.first_level = first_level;
  record.options.later_level = later_level;
  record.diagnosis.rounds = {round_with("none", 0.2), round_with("none", 0.2)};
  record.candidates.resize(2);
  record.rounds.resize(2);
  record.errors.resize(1);
  record.unseen = 0;
  return record;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(DiagnosisPage, NamesFamiliesByTheLevelOfTheRound) {
  const std::string depends = "What is left depends on: <b>place</b>",
                    noise = "Nothing is left that differs from noise.";
  const auto page = [](double first, double later) { return diagnosis_page(Campaign{}, record_of(first, later)); };
  EXPECT_EQ(count_of(page(0.05, 0.01), depends), 0U);
  EXPECT_EQ(count_of(page(0.05, 0.01), noise), 2U);
  EXPECT_EQ(count_of(page(0.3, 0.01), depends), 1U);
  EXPECT_EQ(count_of(page(0.3, 0.01), noise), 1U);
  EXPECT_EQ(count_of(page(0.3, 0.3), depends), 2U);
  EXPECT_EQ(count_of(page(0.05, 0.01), "No family of effects is significant"), 1U);
  EXPECT_EQ(count_of(page(0.3, 0.01), "What the ground alone leaves depends on: place (p 0.2), corrected"), 1U);
}

}  // namespace
}  // namespace talus::io
