#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "talus/base/sample.hpp"
#include "talus/fit/diagnose/family_test.hpp"

/// Whether a verdict depends on the random numbers of the fit. docs/diagnosis-evidence.md, "Stability".
namespace talus {

/// The first round of a diagnosis that rests on a base fit of its own.
struct BaseFitVerdict {
  std::uint64_t seed = 1;
  std::string effect;  ///< named, "none" or "unexplained"
  std::string where;
  double p_value = 1.0;              ///< the smallest of the families' corrected ones
  std::vector<FamilyTest> families;  ///< as DiagnosisRound::families
};

struct Stability {
  std::vector<BaseFitVerdict> fits;
  std::size_t reported = 0;  ///< index of the fit that the diagnosis reports
  int left_out = 0;          ///< fits that were not made, as the diagnosis was costly (DiagnosisRules::enough)
};

/// The different verdicts, the most frequent first; of equally frequent ones that of the earlier fit first.
std::vector<std::string> verdicts_of(const Stability& stability);
/// "undecided between X and Y" where the verdicts differ; else empty.
std::string undecided_text(const Stability& stability);
/// "3 of 5 zone forest, 2 of 5 zone meadow" where the fits name one effect at several places; else empty.
std::string places_text(const Stability& stability);
/// Smallest and largest p-value of the fits.
Interval p_range_of(const Stability& stability);
/// That of a family, uncorrected; NaN where it was not tested.
Interval p_range_of(const Stability& stability, const std::string& family);

/// Seed of base fit number `number`; of number 0 the seed itself.
inline std::uint64_t seed_of_fit(std::uint64_t seed, std::size_t number) {
  return seed + number * 1'000'003ULL;  // far from the seeds that users take
}

}  // namespace talus
