#pragma once
#include <filesystem>

#include "talus/base/open_file.hpp"

namespace talus::io {

/// Marks a folder as in use until this process ends, even if it is killed, by a system lock on a file in it.
class FolderLock {
 public:
  /// Makes the lock of a folder and holds it from the first moment: no other process ever finds it free. Throws
  /// std::runtime_error if the folder cannot be locked.
  static FolderLock made_in(const std::filesystem::path& folder);

  /// State of the lock that another process left in a folder.
  enum class Found { None, InUse, Free };
  /// @param lock  if it is free, this process holds it from now on
  /// @param made  if true, makes the lock in a folder that has none
  static Found take(const std::filesystem::path& folder, bool made, FolderLock& lock);

  FolderLock() = default;

  static constexpr const char* kName = ".lock";

 private:
  explicit FolderLock(int number) : file_(number) {}
  OpenFile file_;
};

}  // namespace talus::io
