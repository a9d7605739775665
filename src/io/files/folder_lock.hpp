#pragma once
#include <filesystem>
#include <optional>
#include <utility>

namespace talus::io {

/// Marks a folder as in use until this process ends, however that comes: a lock of the system on a file in it.
class FolderLock {
 public:
  /// The lock of a folder, made where there is none. Held from its first moment: nobody finds it free. Throws
  /// std::runtime_error where the folder cannot be locked.
  static FolderLock made_in(const std::filesystem::path& folder);

  /// What another process may have left in a folder.
  enum class Found { None, InUse, Free };
  /// @param lock  where it is free, it is this process's from now on
  /// @param made  a folder without a lock gets one
  static Found take(const std::filesystem::path& folder, bool made, FolderLock& lock);

  FolderLock() = default;
  FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~FolderLock();

  static constexpr const char* kName = ".lock";

 private:
  explicit FolderLock(int file) : file_(file) {}
  int file_ = -1;
};

}  // namespace talus::io
