#include "deposit_report.hpp"

#include <cmath>

#include "talus/base/text.hpp"

namespace talus::io {
namespace {

std::string p_text(const PatternDistance& pattern) {
  std::string text = "p " + with_decimals(pattern.p_value, 2);
  if (pattern.corrected > pattern.p_value)
    text += " (" + with_decimals(pattern.corrected, 2) + " corrected for the number of classes)";
  return text + (pattern.corrected < 0.05 ? ": not the simulated pattern" : "");
}

std::string sentence_of(const std::string& rows, const PatternDistance& pattern) {
  return rows + " rows: " + pattern.group + ": energy distance of the patterns " + with_decimals(pattern.distance, 2) +
         " m, " + with_decimals(100.0 * pattern.share, 1) +
         " % of its largest value (a right model scatters about 0), " + p_text(pattern) + ", " +
         std::to_string(pattern.blocks) + " blocks";
}

/// How many simulated blocks count: those in the mapped polygons, and of these in the strips of these rows.
std::string share_sentence(const ScoredRows& s) {
  const DepositCheck& check = *s.deposits;
  const std::string inside =
      with_decimals(100.0 * check.mapped, 1) + " % of the simulated blocks come to rest " +
      (check.whole_dem ? "on the DEM, all of which counts as mapped" : "inside the mapped polygons");
  if (!check.strips) return inside + "; the others do not count";
  const double share = check.mapped > 0.0 ? check.inside / check.mapped : 0.0;
  return inside + ", " + with_decimals(100.0 * share, 1) + " % of these in the strips that are " +
         (s.rows == "holdout" ? "held out" : "fitted") + "; the others do not count";
}

}  // namespace

std::vector<std::string> deposit_sentences(const ScoredRows& s) {
  if (!s.deposits || std::isnan(s.deposits->inside)) return {};
  const std::string rows = rows_in_words(s.rows);
  std::vector<std::string> sentences;
  for (const PatternDistance& pattern : s.deposits->patterns) sentences.push_back(sentence_of(rows, pattern));
  sentences.push_back(rows + " rows: " + share_sentence(s));
  return sentences;
}

Json deposits_json(const ScoredRows& s) {
  if (!s.deposits) return nullptr;
  Json patterns = Json::array();
  for (const PatternDistance& pattern : s.deposits->patterns)
    patterns.push_back({{"group", pattern.group},
                        {"blocks", pattern.blocks},
                        {"energy_distance_m", json_of(pattern.distance, six_decimals)},
                        {"share", json_of(pattern.share, six_decimals)},
                        {"p_value", json_of(pattern.p_value, six_decimals)},
                        {"p_corrected", json_of(pattern.corrected, six_decimals)}});
  return {{"mapped", json_of(s.deposits->mapped, six_decimals)},
          {"inside", json_of(s.deposits->inside, six_decimals)},
          {"patterns", patterns}};
}

}  // namespace talus::io
