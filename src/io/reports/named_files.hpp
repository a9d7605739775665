#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "report_facts.hpp"

namespace talus::io {

/// The files of a folder of results that run.json or hazard.json names. Others may be of another run: a page leaves
/// them out and says so, as it says which of the named rasters and tables are missing.
class NamedFiles {
 public:
  NamedFiles(const std::filesystem::path& folder, const RunFacts& run, const std::optional<HazardFacts>& hazard);

  /// Whether a record names a file; true for every file of a run without a list of them.
  bool contains(const std::filesystem::path& name) const { return names_.empty() || names_.contains(name.string()); }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::set<std::string> names_;
  std::vector<std::string> notes_;
};

}  // namespace talus::io
