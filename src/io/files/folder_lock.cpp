#include "folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace talus::io {

namespace fs = std::filesystem;

FolderLock FolderLock::made_in(const fs::path& folder) {
  const fs::path hidden = folder / (std::string(kName) + "-new");
  FolderLock lock(open(hidden.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  std::error_code error;
  if (!lock.file_ || flock(lock.file_.number(), LOCK_EX | LOCK_NB) != 0) error = {errno, std::system_category()};
  if (!error) fs::rename(hidden, folder / kName, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot be locked: " + error.message());
  return lock;
}

FolderLock::Found FolderLock::take(const fs::path& folder, bool made, FolderLock& lock) {
  const fs::path file = folder / kName;
  FolderLock found(open(file.c_str(), O_RDWR | O_CLOEXEC | (made ? O_CREAT : 0), 0600));
  if (!found.file_) return Found::None;
  if (flock(found.file_.number(), LOCK_EX | LOCK_NB) != 0) return Found::InUse;
  struct stat held {
  }, named{};
  if (fstat(found.file_.number(), &held) != 0 || stat(file.c_str(), &named) != 0 || held.st_ino != named.st_ino)
    return Found::None;  // its process has just ended: the folder has another name or is gone
  lock = std::move(found);
  return Found::Free;
}

}  // namespace talus::io
