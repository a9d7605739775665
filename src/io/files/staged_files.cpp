#include "talus/io/files/staged_files.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>

#include "json.hpp"
#include "own_files.hpp"
#include "talus/base/error.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

/// The files that a record names, and the record.
std::vector<std::string> files_of(const fs::path& record) {
  std::vector<std::string> names = files_of_record(record);
  names.push_back(record.filename().string());
  return names;
}

}  // namespace

StagedFiles::StagedFiles(const fs::path& folder, const std::string& record, bool overwrite)
    : folder_(folder), record_(record), staged_(StagedPath::Kind::Folder, folder / fs::path(record).stem()) {
  require_results(folder);
  if (fs::exists(folder / record)) {
    if (!overwrite)
      throw InputError(folder.string() + ": has a " + record +
                       " already; give --overwrite to replace it and its files");
    earlier_ = files_of(folder / record);
  }
  std::error_code ignored;
  fs::remove_all(temporary(), ignored);  // left by a killed process of the same number
  if (const std::error_code error = staged_.make_folder())
    throw InputError(folder.string() + ": nothing can be written there (" + error.message() + ")");
}

std::vector<std::string> StagedFiles::files() const {
  return files_in(temporary());
}

std::vector<std::string> StagedFiles::to_remove() const {
  const std::vector<std::string> names = files();
  std::vector<std::string> found;
  for (const std::string& name : earlier_)
    if (std::ranges::count(names, name) == 0 && fs::exists(folder_ / name)) found.push_back(name);
  return found;
}

void StagedFiles::commit() {
  // Also what a reader, as QGIS, has left beside an earlier file, or has written after that was gone.
  const auto is_earlier = [&](const std::string& name) {
    if (std::ranges::count(earlier_, name) > 0) return true;
    const std::string read = read_file_of(name);
    return !read.empty() && (std::ranges::count(earlier_, read) > 0 || !fs::exists(folder_ / read));
  };
  for (const std::string& name : files())
    if (fs::exists(folder_ / name) && !is_earlier(name))
      throw InputError((folder_ / name).string() + ": is there and none of the files of an earlier " + record_ +
                       ", so it is not replaced; move it, or give it another name");
  const std::vector<std::string> names = files(), without_successor = to_remove();
  std::error_code ignored;
  mark_incomplete(names);
  for (const std::string& name : names) {
    if (name == record_) continue;
    remove_beside(folder_ / name, names);
    give_name(name);  // in place of an earlier file, which is there until then
  }
  for (const std::string& name : without_successor) {
    remove_beside(folder_ / name, names);
    fs::remove(folder_ / name, ignored);
  }
  if (std::ranges::count(names, record_) > 0) give_name(record_);
}

/// Puts a record in place that names the earlier files and the new ones. If the program is killed now, a reader of the
/// record refuses them, and the next command knows which to replace.
void StagedFiles::mark_incomplete(const std::vector<std::string>& names) {
  std::set<std::string> all(earlier_.begin(), earlier_.end());
  all.insert(names.begin(), names.end());
  all.erase(record_);
  Json json{{"program", "talus"}, {"status", kIncomplete}, {"files", all}};
  replace_text(folder_ / record_, json_text(json));
}

void StagedFiles::give_name(const std::string& name) {
  const std::error_code error = StagedPath::give_name(temporary() / name, folder_ / name);
  if (!error) return;
  staged_.keep();
  throw std::runtime_error(name + ": cannot be given this name: " + error.message() + "; the new files are kept in " +
                           temporary().string());
}

}  // namespace talus::io
