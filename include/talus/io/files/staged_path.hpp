#pragma once
#include <filesystem>
#include <string>
#include <system_error>

namespace talus::io {

/// A file or folder that appears under its name complete, or not at all: it is written under a hidden name beside it,
/// `.NAME.talus-PROCESS`, and renamed when it is on the disk. Without `commit` (an exception, an interruption, a full
/// disk) what has the hidden name is removed.
class StagedPath {
 public:
  enum class Kind { File, Folder };

  /// @param extension  ".gpkg": what the hidden name, too, must end in, as `path` does: `.STEM.talus-PROCESS.gpkg`
  StagedPath(Kind kind, const std::filesystem::path& path, const std::string& extension = {});
  ~StagedPath();
  StagedPath(const StagedPath&) = delete;
  StagedPath& operator=(const StagedPath&) = delete;

  /// Where to write until `commit`.
  const std::filesystem::path& hidden() const { return hidden_; }
  const std::filesystem::path& path() const { return path_; }

  /// Makes the hidden folder, with another name where that is taken: `.NAME.talus-PROCESS-1`.
  /// @return why none can be made; std::errc::file_exists where too many names are taken
  std::error_code make_folder();
  /// What has the hidden name stays where there is no `commit`.
  void keep() { owned_ = false; }

  /// Brings all to the disk and gives it its name. Throws std::runtime_error where it cannot be written.
  /// @return why it cannot have the name
  std::error_code commit() { return give_name(hidden_, path_); }

  /// The same of any file or folder.
  static std::error_code give_name(const std::filesystem::path& hidden, const std::filesystem::path& path);

  /// The beginning of all hidden names for `path`, of whatever process.
  static std::string hidden_prefix(const std::filesystem::path& path, const std::string& extension = {});

 private:
  std::filesystem::path path_, hidden_;
  bool owned_;  // what has the hidden name is removed at the end
};

/// Waits until a file, or the entries of a folder, are on the disk: some file systems tell only now that it is full.
/// Throws std::runtime_error.
void synchronise(const std::filesystem::path& path);

/// The same of a folder with all that is in it.
void synchronise_all(const std::filesystem::path& path);

}  // namespace talus::io
