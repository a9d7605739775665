#include "report_frequency.hpp"

#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr std::size_t kMostShown = 20, kMostWords = 200;  // a page stays readable

/// "total = 3, by_true_area = true" of a table of the record.
std::string words_of(const Json& table) {
  std::string text;
  std::size_t shown = 0;
  for (const auto& [key, value] : table.items()) {
    if (shown++ == kMostShown) return text + " and " + std::to_string(table.size() - kMostShown) + " more";
    const std::string number = value.is_number() ? text_of(value.get<double>()) : value.dump();
    text += (text.empty() ? "" : ", ") + shortened(key, kMostWords) + " = " + shortened(number, kMostWords);
  }
  return text;
}

}  // namespace

bool FrequencyFacts::operator==(const FrequencyFacts& other) const {
  if (given.empty() || other.given.empty()) return file == other.file;  // the name is all that is known
  return given == other.given;
}

FrequencyFacts frequency_of(const Json& record) {
  FrequencyFacts facts;
  const Json frequency = record.value("frequency", Json());
  if (!frequency.is_object()) return facts;
  facts.file = shortened(frequency.value("file", "a file"), kMostWords);
  facts.sha256 = shortened(frequency.value("sha256", ""), kMostWords);
  const Json given = frequency.value("given", Json());
  if (!given.is_object()) return facts;
  const Json shares = frequency.value("class_shares", Json());  // null: drawn, or by an earlier version
  facts.given = given.dump() + shares.dump();
  for (const auto& [table, values] : given.items())
    if (const std::string words = words_of(values); !words.empty())
      facts.words += (facts.words.empty() ? "[" : "; [") + shortened(table, kMostWords) + "] " + words;
  if (!shares.is_null()) facts.words += "; the classes of blocks keep their shares of the events";
  return facts;
}

std::string frequency_text(const FrequencyFacts& frequency) {
  const std::string of_run = "those of the run (settings, under Record)";
  if (frequency.file.empty()) return of_run;
  return "those in " + frequency.file + " (" +
         (frequency.words.empty() ? "what it said is not recorded" : frequency.words) +
         (frequency.sha256.empty() ? "" : "; SHA-256 " + frequency.sha256) + "), which take the place of " + of_run;
}

std::string other_frequency_note(const std::string& weighting, const FrequencyFacts& design,
                                 const FrequencyFacts& maps) {
  if (!weighting.starts_with("by the annual frequency") || design == maps) return "";
  return "this design counts by other frequencies than the hazard maps: " + frequency_text(design) + "; the maps by " +
         frequency_text(maps);
}

}  // namespace talus::io
