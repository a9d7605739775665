#include "talus/io/files/output_folder.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "folder_lock.hpp"
#include "input_files.hpp"
#include "own_files.hpp"
#include "posix_bytes.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

namespace fs = std::filesystem;

fs::path full_name(const fs::path& path) {
  if (path.empty())
    throw InputError("--out: the name of the folder is empty; give a new folder, for example -o result");
  if (path.string().find("|layer") != std::string::npos)
    throw InputError(path.string() + ": would be read as a layer of a file; give a folder without | in its name");
  fs::path full = behind_links(path);
  if (full.filename().empty()) full = full.parent_path();
  if (full.filename().empty()) throw InputError(path.string() + ": cannot be a folder of results; give a new folder");
  return full;
}

void require_results(const fs::path& folder) {
  std::error_code none;
  if (fs::exists(folder / "run.json", none)) return;
  if (fs::exists(folder / "part.json", none))
    throw InputError(folder.string() +
                     ": is one part of a run (it has a part.json): join the parts first, with talus merge OUT PART..., "
                     "then give that OUT");
  throw InputError(folder.string() + ": is no folder of results (it has no run.json); give the OUT of talus run");
}

namespace {

/// A mount point can neither be renamed nor replaced: this is reported before the run, not after it.
bool is_mount_point(const fs::path& folder) {
  struct stat self {
  }, parent{};
  return stat(folder.c_str(), &self) == 0 && stat(folder.parent_path().c_str(), &parent) == 0 &&
         self.st_dev != parent.st_dev;
}

/// --overwrite replaces a result, never what someone else has put into its folder.
void refuse_foreign_files(const fs::path& folder) {
  const std::vector<std::string> foreign = foreign_in(folder);
  if (!foreign.empty())
    throw InputError(folder.string() + ": --overwrite replaces the files of the earlier result alone, and there are " +
                     "others in this folder: " + listed(foreign) + "; move them, or give a new name");
}

/// The command that has written the results in a folder, by a file that it alone writes.
std::string command_of_results(const fs::path& folder) {
  for (const auto& [file, command] : {std::pair{"calibration.json", "talus calibrate"},
                                      {"diagnosis.json", "talus diagnose"},
                                      {"compare.json", "talus compare"},
                                      {"profile.toml", "talus profile"}})
    if (fs::exists(folder / file)) return command;
  return "talus run";
}

/// --overwrite with the name of another result by mistake must not cost hours of work.
void refuse_other_command(const fs::path& folder, const std::string& command) {
  if (const std::string earlier = command_of_results(folder); earlier != command)
    throw InputError(folder.string() + ": holds results of " + earlier + ", and --overwrite replaces only those of " +
                     command + "; give a new name, or remove the folder yourself");
}

void refuse_taken_name(const fs::path& folder, bool overwrite, const std::string& command) {
  const std::string name = folder.string();
  refuse_dangling_link(folder);
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw InputError(name + ": is a file; give the name of a new folder");
  if (is_mount_point(folder))
    throw InputError(name + ": is a mount point, which cannot be replaced; give a new folder in it, for example " +
                     (folder / "result").string());
  if (fs::is_empty(folder)) return;
  if (!overwrite)
    throw InputError(name + ": the folder is there and not empty; give a new name, or --overwrite to replace it");
  for (const char* mark : {"run.json", "part.json", "calibration.json", "diagnosis.json", "compare.json"})
    if (fs::exists(folder / mark)) {
      refuse_foreign_files(folder);
      return refuse_other_command(folder, command);
    }
  throw InputError(name +
                   ": --overwrite replaces only results of talus, and there is no run.json, part.json, "
                   "calibration.json, diagnosis.json or compare.json in this folder; give a new name, or remove the "
                   "folder yourself");
}

std::string not_readable_text(const fs::path& folder, const fs::filesystem_error& error) {
  return folder.string() + ": cannot be looked at (" + error.code().message() + ")";
}

void make_hidden(StagedPath& staged) {
  const std::string parent = staged.path().parent_path().string();
  const std::error_code error = staged.make_folder();
  if (!error) return;
  if (error == std::errc::no_space_on_device) throw std::runtime_error(parent + ": " + system_text(error.value()));
  if (error == std::errc::file_exists)
    throw std::runtime_error(parent + ": too many temporary folders of talus; remove " +
                             staged.hidden().filename().string() + "*");
  if (error == std::errc::filename_too_long)
    throw InputError(parent + ": the name of the output is too long for its temporary folder; give a shorter one");
  throw InputError(parent + ": no folder can be made there (" + error.message() +
                   "); give an output folder where you may write");
}

/// A hidden folder whose process has ended.
struct Left {
  fs::path path;
  FolderLock lock;
  std::optional<fs::file_time_type> kept;  // time of the last save; nothing: no work was saved
};

/// The hidden folders that ended runs have left, in the order of their last save. This process holds their locks.
/// Throws InputError if another process writes one.
std::vector<Left> left_of(const fs::path& folder) {
  const std::string stem = StagedPath::hidden_prefix(folder);
  std::vector<Left> found;
  if (!fs::is_directory(folder.parent_path())) return found;
  for (const auto& entry : fs::directory_iterator(folder.parent_path())) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(stem)) continue;
    const fs::path work = entry.path() / OutputFolder::kWork, manifest = work / "part.json";
    Left left{entry.path(), {}, {}};
    const FolderLock::Found state = FolderLock::take(work, fs::exists(manifest), left.lock);
    const bool taken = !fs::exists(entry.path());  // renamed a moment ago by another process
    if (state == FolderLock::Found::InUse || taken)
      throw InputError(folder.string() + ": another process is writing it (into " + name +
                       "); wait until it has ended, or give another name");
    if (state == FolderLock::Found::None) continue;  // results that were kept, or no folder of ours
    if (fs::exists(manifest)) left.kept = fs::last_write_time(manifest);
    found.push_back(std::move(left));
  }
  std::ranges::sort(found, {}, &Left::kept);
  return found;
}

/// Whether this is a map that a killed run had finished: `MapFile` gives a map its name last.
bool is_finished_map(const fs::path& file) {
  return file.extension() == ".tif" && !file.stem().has_extension();
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path, bool overwrite, Unfinished unfinished, std::string command)
    : staged_(StagedPath::Kind::Folder, full_name(path)),
      overwrite_(overwrite),
      command_(std::move(command)),
      lock_(std::make_unique<FolderLock>()) {
  const fs::path& final = final_path();
  std::vector<Left> left;
  try {
    refuse_taken_name(final, overwrite, command_);
    left = left_of(final);
  } catch (const fs::filesystem_error& error) {
    throw InputError(not_readable_text(final, error) + "; give another folder");
  }
  if (unfinished == Unfinished::Ignore) std::erase_if(left, [](const Left& folder) { return folder.kept.has_value(); });
  const bool kept = !left.empty() && left.back().kept;
  if (unfinished == Unfinished::Refuse && kept && !overwrite)
    throw InputError(final.string() + ": an interrupted run of this name is kept in " + left.back().path.string() +
                     "; give --resume to go on with it, or --overwrite to begin anew");
  parents_.make(final.parent_path());
  make_hidden(staged_);
  std::error_code ignored;
  if (unfinished == Unfinished::Resume && kept) {
    fs::remove(temporary(), ignored);
    fs::rename(left.back().path, temporary());
    *lock_ = std::move(left.back().lock);
    keep();  // saved work must not be lost; other folders of this name stay, too
    for (const auto& entry : fs::directory_iterator(temporary()))
      if (entry.path().filename() != kWork && !is_finished_map(entry.path())) fs::remove_all(entry.path(), ignored);
    left.clear();
  } else {
    hold_work();
  }
  for (const Left& folder : left) fs::remove_all(folder.path, ignored);
}

OutputFolder::~OutputFolder() = default;

void OutputFolder::hold_work() {
  fs::create_directories(work());
  *lock_ = FolderLock::made_in(work());
}

void OutputFolder::keep_results() {
  keep();
  std::error_code ignored;
  if (!fs::exists(work() / "part.json", ignored)) fs::remove_all(work(), ignored);
}

void OutputFolder::protect(const fs::path& file) const {
  for (const std::string& part : files_of_input(file.string())) {
    std::error_code error;
    const fs::path full = fs::weakly_canonical(part, error);
    if (error) continue;
    const fs::path inside = full.lexically_relative(final_path());
    if (!inside.empty() && *inside.begin() != "..")
      throw InputError(part + ": lies in the folder that --overwrite would replace; give another folder");
  }
}

std::string OutputFolder::later_results_note() const {
  const std::vector<std::string> lost = later_results(final_path());
  return lost.empty() ? std::string()
                      : "note: --overwrite will also remove what later commands have written into " +
                            final_path().string() + ": " + listed(lost);
}

void OutputFolder::commit() {
  commit(temporary());
  std::error_code ignored;
  fs::remove_all(final_path() / kWork, ignored);  // last: until here a killed run can be resumed
}

void OutputFolder::commit_work() {
  commit(work());  // with its lock: until it has its name no other process may take it
  std::error_code ignored;
  fs::remove(final_path() / FolderLock::kName, ignored);
  fs::remove_all(temporary(), ignored);
}

void OutputFolder::commit(const fs::path& folder) {
  const std::string kept = "; the results are kept in " + temporary().string();
  bool replace = false;
  try {  // another process may have made the folder meanwhile
    refuse_taken_name(final_path(), overwrite_, command_);
    replace = overwrite_ && fs::exists(final_path()) && !fs::is_empty(final_path());
  } catch (const InputError& error) {
    keep_results();
    throw InputError(error.what() + kept);
  } catch (const fs::filesystem_error& error) {
    keep_results();
    throw InputError(not_readable_text(error.path1(), error) + kept);
  }
  std::error_code error;
  const fs::path aside = temporary().string() + "-old";
  const auto keep_both = [&] {  // the earlier result and this one
    std::error_code ignored;
    if (replace && fs::exists(aside, ignored)) fs::rename(aside, final_path(), ignored);
    keep_results();
  };
  try {
    synchronise_all(folder);  // before the earlier result is moved aside
    if (replace) fs::rename(final_path(), aside, error);
    if (!error) error = StagedPath::give_name(folder, final_path());  // fails if it has been made meanwhile
  } catch (const std::exception& fault) {                             // of the disk
    keep_both();
    throw std::runtime_error(fault.what() + kept);
  }
  if (error) {
    keep_both();
    throw std::runtime_error(final_path().string() + ": the results cannot be given this name (" + error.message() +
                             "); they are kept in " + temporary().string());
  }
  if (replace && foreign_in(aside).empty())
    fs::remove_all(aside, error);  // else a file has come a moment ago: it stays
}

void write_text(const fs::path& file, std::string_view text, const std::string& name) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  bool good = stream != nullptr && std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  int cause = good ? 0 : errno;
  if (stream != nullptr && std::fclose(stream) != 0 && good) {
    good = false;
    cause = errno;
  }
  if (good) return;
  std::error_code ignored;
  fs::remove(file, ignored);
  throw std::runtime_error((name.empty() ? file.filename().string() : name) +
                           ": cannot be written: " + system_text(cause));
}

void replace_text(const fs::path& file, std::string_view text) {
  const std::string name = file.filename().string();  // not the hidden one
  StagedPath staged(StagedPath::Kind::File, file, file.extension().string());
  write_text(staged.hidden(), text, name);
  if (const std::error_code error = staged.commit())
    throw std::runtime_error(name + ": cannot be written: " + system_text(error.value()));
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

}  // namespace talus::io
