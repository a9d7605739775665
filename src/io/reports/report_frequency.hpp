#pragma once
#include <string>

#include "io/files/json.hpp"

namespace talus::io {

/// Which frequencies a record (hazard.json, barrier_*.json) was made with.
struct FrequencyFacts {
  std::string file;           ///< of `--frequency`; empty: those of the run
  std::string sha256, given;  ///< of the file, and what it says, as recorded; empty in an earlier record
  std::string words;          ///< `given` for readers: "[features] A = 5", and what classes of blocks keep

  /// Whether both are those of the run, or of files that say the same.
  bool operator==(const FrequencyFacts& other) const;
};

FrequencyFacts frequency_of(const Json& record);

/// "those of the run (settings, under Record)", or "those in w.toml ([features] A = 5; SHA-256 ...), ...".
std::string frequency_text(const FrequencyFacts& frequency);

/// A remark on a design that counts by other frequencies than the hazard maps; empty if it does not.
/// @param weighting  what each block counts in the design: "by the annual frequency ..."
std::string other_frequency_note(const std::string& weighting, const FrequencyFacts& design,
                                 const FrequencyFacts& maps);

}  // namespace talus::io
