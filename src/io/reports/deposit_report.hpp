#pragma once
#include <string>

#include "io/files/json.hpp"
#include "talus/io/reports/score_report.hpp"

/// The patterns of mapped and simulated blocks in words and numbers. docs/mapped-deposits.md, "The score".
namespace talus::io {

/// One sentence per class of size, and one on what lies outside the mapped ground. Empty for blocks of known release.
std::vector<std::string> deposit_sentences(const ScoredRows& scored);
/// The same as JSON; null for blocks of known release.
Json deposits_json(const ScoredRows& scored);

}  // namespace talus::io
