#pragma once
#include <filesystem>
#include <string>
#include <system_error>

namespace talus::io {

/// Throws InputError if a name for results is a link to something that is not there.
void refuse_dangling_link(const std::filesystem::path& path);

/// The file or folder that a name for results stands for: what is written under a link goes to the place it leads to,
/// and the link stays.
std::filesystem::path behind_links(const std::filesystem::path& path);

/// The folder into which a file is written: as it was given, for messages; of a link that of the place it leads to.
std::filesystem::path folder_written(const std::filesystem::path& file);

/// Throws InputError if no file can be written into a folder: before the work, not after it. @param folder  empty: the
/// current one
void refuse_unwritable(const std::filesystem::path& folder);

/// A file or folder that appears under its name complete, or not at all: it is written under a hidden name beside it,
/// `.NAME.talus-PROCESS`, and renamed when it is on the disk. Without `commit` (an exception, an interruption, a full
/// disk) the hidden file or folder is removed.
class StagedPath {
 public:
  enum class Kind { File, Folder };

  /// @param extension  ".gpkg": extension of `path`, which the hidden name gets too: `.STEM.talus-PROCESS.gpkg`
  StagedPath(Kind kind, const std::filesystem::path& path, const std::string& extension = {});
  ~StagedPath();
  StagedPath(const StagedPath&) = delete;
  StagedPath& operator=(const StagedPath&) = delete;

  /// Where to write until `commit`.
  const std::filesystem::path& hidden() const { return hidden_; }
  const std::filesystem::path& path() const { return path_; }

  /// Makes the hidden folder. If its name is taken, it gets another: `.NAME.talus-PROCESS-1`.
  /// @return the error if none can be made; std::errc::file_exists if too many names are taken
  std::error_code make_folder();
  /// Without `commit` the hidden file or folder stays.
  void keep() { owned_ = false; }

  /// Brings all to the disk and gives it its name. Throws std::runtime_error if it cannot be written.
  /// @return the error if it cannot be given the name
  std::error_code commit() { return give_name(hidden_, path_); }

  /// Does the same for any file or folder with a hidden name.
  static std::error_code give_name(const std::filesystem::path& hidden, const std::filesystem::path& path);

  /// Beginning of the hidden names for `path`, the same in every process.
  static std::string hidden_prefix(const std::filesystem::path& path, const std::string& extension = {});

 private:
  std::filesystem::path path_, hidden_;
  bool owned_;  // the destructor removes what has the hidden name
};

/// Waits until a file, or the entries of a folder, are on the disk: some file systems report only then that the disk is
/// full. Throws std::runtime_error.
void synchronise(const std::filesystem::path& path);

/// Does the same for a folder and everything in it.
void synchronise_all(const std::filesystem::path& path);

}  // namespace talus::io
