#include "named_files.hpp"

#include <algorithm>

#include "talus/base/text.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

/// Whether a page shows files of this kind: rasters, and tables of objects and screens.
bool is_shown(const fs::path& file) {
  const std::string name = file.filename().string();
  return file.extension() == ".tif" || name == "objects.csv" || name == "screens_summary.csv";
}

/// "energy.tif: named in run.json, but missing".
void note_missing(const fs::path& folder, const std::string& record, const std::vector<std::string>& files,
                  std::vector<std::string>& notes) {
  std::error_code none;
  std::vector<std::string> missing;
  std::ranges::copy_if(files, std::back_inserter(missing),
                       [&](const std::string& file) { return is_shown(file) && !fs::exists(folder / file, none); });
  if (!missing.empty()) notes.push_back(listed(missing) + ": named in " + record + ", but missing");
}

}  // namespace

NamedFiles::NamedFiles(const fs::path& folder, const RunFacts& run, const std::optional<HazardFacts>& hazard)
    : names_(run.files.begin(), run.files.end()) {
  if (names_.empty()) return;
  note_missing(folder, "run.json", run.files, notes_);
  if (hazard) {
    names_.insert(hazard->files.begin(), hazard->files.end());
    note_missing(folder, "hazard.json", hazard->files, notes_);
  }
  std::error_code none;
  std::vector<std::string> unnamed;
  for (const auto& entry : fs::directory_iterator(folder, none))
    if (const std::string name = entry.path().filename().string(); is_shown(name) && !contains(name))
      unnamed.push_back(name);
  std::ranges::sort(unnamed);
  if (!unnamed.empty())
    notes_.push_back(
        listed(unnamed) + ": not shown, as no record names them, so that they may be of another run" +
        (hazard ? "" : "; for maps and objects of talus hazard, whose hazard.json is not there, repeat it"));
}

}  // namespace talus::io
