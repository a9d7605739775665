#include "own_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <set>
#include <span>
#include <string_view>

#include "folder_lock.hpp"
#include "json.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

/// Names of the files that `calibrate` and `diagnose` write, also into the folders of several campaigns.
constexpr std::array<std::string_view, 7> kFitFiles{"calibration.json", "diagnosis.json",   "report.md", "report.html",
                                                    "fitted.toml",      "with_effect.toml", "ranks.svg"};

/// Beginnings of the names of the files of a part.
constexpr std::array<std::string_view, 4> kPartFiles{"tally-", "reach-", "rest-", "rows-"};

/// What other programs leave beside a file that they have read: statistics, overviews, logs of a data base.
constexpr std::array<std::string_view, 5> kBeside{".aux.xml", ".ovr", "-wal", "-shm", "-journal"};

bool is_one_of(const std::string& name, std::span<const std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// What desktops leave in every folder that they show.
constexpr std::array<std::string_view, 3> kOfDesktops{".DS_Store", "Thumbs.db", "desktop.ini"};

/// A hidden file or folder of a program that was killed while it wrote (`StagedPath`), without kept work in it.
bool is_staged(const fs::path& path) {
  const std::string name = path.filename().string();
  std::error_code none;
  return name.starts_with(".") && name.find(".talus-") != std::string::npos &&
         !fs::exists(path / OutputFolder::kWork / "part.json", none);
}

/// A folder of one of several campaigns: it holds a fitted model, and only files of such.
bool is_site(const fs::path& folder) {
  std::error_code none;
  if (!fs::is_directory(folder, none) || fs::is_symlink(folder, none) || !fs::exists(folder / "fitted.toml", none))
    return false;
  return std::ranges::all_of(fs::directory_iterator(folder), [](const fs::directory_entry& entry) {
    return is_fit_file(entry.path().filename().string());
  });
}

/// The pages of `talus report` in a folder of a run, whatever `report -o` called them.
std::vector<std::string> pages_in(const fs::path& folder) {
  std::vector<std::string> pages;
  if (!fs::exists(folder / "run.json")) return pages;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".html" && is_run_page(entry.path()))
      pages.push_back(entry.path().filename().string());
  return pages;
}

/// The names that the records of a folder list, and those that are known by the records that are there.
std::set<std::string> own_names(const fs::path& folder) {
  std::set<std::string> own{"run.json",  "hazard.json",       "compare.json",
                            "part.json", OutputFolder::kWork, FolderLock::kName};
  for (const char* record : {"run.json", "hazard.json", "compare.json"})
    for (std::string& name : files_of_record(folder / record)) own.insert(std::move(name));
  if (fs::exists(folder / "part.json")) own.insert("scenario.toml");
  if (fs::exists(folder / "calibration.json") || fs::exists(folder / "diagnosis.json"))
    own.insert(kFitFiles.begin(), kFitFiles.end());
  for (std::string& name : pages_in(folder)) own.insert(std::move(name));
  for (std::string& name : files_of_designs(folder)) own.insert(std::move(name));
  return own;
}

/// Whether a reader has left this file beside one of ours, or beside a raster that is gone: QGIS writes the statistics
/// of a layer when it closes it.
bool is_beside(const fs::path& folder, const std::string& name, const std::set<std::string>& own) {
  const std::string read = read_file_of(name);
  if (own.contains(read)) return true;
  std::error_code none;
  return read.ends_with(".tif") && !fs::exists(folder / read, none);
}

}  // namespace

bool is_fit_file(const std::string& name) {
  return is_one_of(name, kFitFiles);
}

std::string read_file_of(const std::string& name) {
  for (const std::string_view end : kBeside)
    if (name.ends_with(end)) return name.substr(0, name.size() - end.size());
  return "";
}

void remove_beside(const fs::path& file, const std::vector<std::string>& but) {
  for (const std::string_view end : kBeside) {
    const std::string name = file.filename().string() + std::string(end);
    std::error_code ignored;
    if (std::ranges::find(but, name) == but.end()) fs::remove(file.parent_path() / name, ignored);
  }
}

bool is_design(const fs::path& file) {
  try {
    const Json json = read_record(file);
    return json.is_object() && json.value("program", "") == "talus" && json.contains("screen");
  } catch (const std::exception&) {
    return false;
  }
}

std::vector<std::string> files_of_designs(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().stem().string();
    if (!name.starts_with("barrier_") || entry.path().extension() != kOfDesign.front() || !is_design(entry.path()))
      continue;
    for (const std::string_view end : kOfDesign)
      if (std::string file = name + std::string(end); fs::is_regular_file(folder / file))
        names.push_back(std::move(file));
  }
  return names;
}

bool is_run_page(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return false;
  std::string head(300, '\0');
  std::ifstream(file).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find("content=\"" + kPageMark + "report\"") != std::string::npos;
}

std::vector<std::string> files_of_record(const fs::path& record) {
  std::vector<std::string> names;
  Json json;
  try {
    json = read_record(record);
  } catch (const std::exception&) {
    return names;  // not there, or no record
  }
  if (json.is_object() && json.contains("files") && json["files"].is_array())
    for (const auto& name : json["files"])
      if (name.is_string() && fs::path(name.get<std::string>()).filename() == name.get<std::string>())
        names.push_back(name);
  return names;
}

std::vector<std::string> foreign_in(const fs::path& folder) {
  const std::set<std::string> own = own_names(folder);
  const bool part = fs::exists(folder / "part.json");
  const bool fit = fs::exists(folder / "calibration.json") || fs::exists(folder / "diagnosis.json");
  std::vector<std::string> foreign;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool is_folder = entry.is_directory() && !entry.is_symlink();
    bool ours = is_folder ? name == OutputFolder::kWork : own.contains(name) || is_beside(folder, name, own);
    ours = ours || is_staged(entry.path()) || is_one_of(name, kOfDesktops) || (fit && is_site(entry.path()));
    if (part && !is_folder)
      ours = ours || std::ranges::any_of(kPartFiles, [&](std::string_view start) { return name.starts_with(start); });
    if (!ours) foreign.push_back(name + (is_folder ? "/" : ""));
  }
  std::ranges::sort(foreign);
  return foreign;
}

std::vector<std::string> later_results(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::exists(folder / "run.json")) return names;
  if (fs::exists(folder / "hazard.json")) names = files_of_record(folder / "hazard.json");
  for (std::string& name : files_of_designs(folder)) names.push_back(std::move(name));
  for (std::string& name : pages_in(folder)) names.push_back(std::move(name));
  std::ranges::sort(names);
  return names;
}

}  // namespace talus::io
