#include "talus/io/files/staged_files.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string_view>

#include "folder_lock.hpp"
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
    : folder_(folder),
      record_(record),
      lock_(std::make_unique<FolderLock>()),
      staged_(StagedPath::Kind::Folder, folder / fs::path(record).stem()) {
  require_results(folder);
  if (const std::error_code error = staged_.make_folder())
    throw InputError(folder.string() + ": nothing can be written there (" + error.message() + ")");
  *lock_ = FolderLock::made_in(temporary());
  look_at_others();
  if (!fs::exists(folder / record)) return;
  if (!overwrite)
    throw InputError(folder.string() + ": has a " + record + " already; give --overwrite to replace it and its files");
  earlier_ = files_of(folder / record);  // no other process replaces them from here on
}

StagedFiles::~StagedFiles() = default;

/// Each process looks at the others after it has locked its own folder: of two at least one sees the other.
void StagedFiles::look_at_others() const {
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(StagedPath::hidden_prefix(staged_.path())) || name == temporary().filename()) continue;
    FolderLock lock;
    const FolderLock::Found state = FolderLock::take(entry.path(), false, lock);
    if (state == FolderLock::Found::InUse)
      throw InputError(folder_.string() + ": another process is writing its " + record_ + " (into " + name +
                       "); wait until it has ended");
    std::error_code ignored;
    if (state == FolderLock::Found::Free) fs::remove_all(entry.path(), ignored);  // its process was killed
  }
}

std::vector<std::string> StagedFiles::files() const {
  std::vector<std::string> names = files_in(temporary());
  std::erase(names, FolderLock::kName);
  return names;
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
  std::error_code ignored;
  fs::remove(temporary() / FolderLock::kName, ignored);  // the next command is not to remove the folder
  throw std::runtime_error(name + ": cannot be given this name: " + error.message() + "; the new files are kept in " +
                           temporary().string());
}

}  // namespace talus::io
