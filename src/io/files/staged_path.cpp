#include "talus/io/files/staged_path.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <stdexcept>

#include "posix_bytes.hpp"
#include "talus/base/error.hpp"
#include "talus/base/hidden_name.hpp"

namespace talus::io {

namespace fs = std::filesystem;

void refuse_dangling_link(const fs::path& path) {
  std::error_code error;
  if (!fs::is_symlink(path, error) || fs::exists(path, error)) return;
  throw InputError(path.string() + ": is a link to " + fs::read_symlink(path, error).string() +
                   ", which is not there; remove the link, or give another name");
}

fs::path behind_links(const fs::path& path) {
  std::error_code error;
  fs::path full = fs::weakly_canonical(fs::absolute(path), error);
  return error ? fs::absolute(path).lexically_normal() : full;
}

fs::path folder_written(const fs::path& file) {
  std::error_code none;
  return fs::is_symlink(file, none) ? behind_links(file).parent_path() : file.parent_path();
}

void refuse_unwritable(const fs::path& folder) {
  const fs::path place = folder.empty() ? fs::current_path() : folder;
  if (access(place.c_str(), W_OK | X_OK) == 0) return;
  throw InputError(place.string() + ": nothing can be written there (" + std::generic_category().message(errno) +
                   "); get the right to write there, or use another folder");
}

StagedPath::StagedPath(Kind kind, const fs::path& path, const std::string& extension)
    : path_(path),
      hidden_(path.parent_path() / (hidden_prefix(path, extension) + std::to_string(getpid()) + extension)),
      owned_(kind == Kind::File) {  // a folder of this name may be another's: see make_folder
  if (hidden_.filename().string().size() > NAME_MAX)
    throw InputError(path.string() + ": the name of the output is too long for its temporary " +
                     (kind == Kind::File ? "file" : "folder") + "; give a shorter one");
}

StagedPath::~StagedPath() {
  std::error_code ignored;
  if (owned_) fs::remove_all(hidden_, ignored);  // after `commit` nothing has this name
}

std::error_code StagedPath::make_folder() {
  constexpr int kAttempts = 100;
  const std::string first = hidden_.string();
  std::error_code error;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt > 0) hidden_ = first + "-" + std::to_string(attempt);
    owned_ = fs::create_directory(hidden_, error);
    if (owned_ || error) return error;
  }
  hidden_ = first;
  return std::make_error_code(std::errc::file_exists);
}

std::error_code StagedPath::give_name(const fs::path& hidden, const fs::path& path) {
  synchronise_all(hidden);
  std::error_code error;
  fs::rename(hidden, path, error);
  if (!error) synchronise(fs::absolute(path).parent_path());
  return error;
}

std::string StagedPath::hidden_prefix(const fs::path& path, const std::string& extension) {
  const std::string name = path.filename().string();
  return talus::hidden_prefix(name.substr(0, name.size() - extension.size()));
}

void synchronise(const fs::path& path) {
  const OpenFile file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file || fsync(file.number()) == 0) return;
  const int cause = errno;
  if (cause != EINVAL && cause != ENOTSUP)
    throw std::runtime_error(final_name(path.filename().string()) + ": cannot be written: " + system_text(cause));
}

void synchronise_all(const fs::path& path) {
  if (fs::is_directory(path))
    for (const auto& entry : fs::recursive_directory_iterator(path)) synchronise(entry.path());
  synchronise(path);
}

}  // namespace talus::io
