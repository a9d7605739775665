#pragma once
#include <filesystem>
#include <string>

#include "io/files/checksum.hpp"
#include "talus/base/open_file.hpp"

namespace talus::run {

using io::Sha256;

/// Writes a file of a `Checkpoint` and computes its checksum. After `finish` the bytes are on the disk. Throws
/// std::runtime_error with the name and the cause.
class CheckpointFileWriter {
 public:
  explicit CheckpointFileWriter(const std::filesystem::path& file);
  void put(std::string_view bytes);
  template <class T>
  void put_value(const T& value) {
    put({reinterpret_cast<const char*>(&value), sizeof value});
  }
  /// Waits until the bytes are on the disk.
  /// @return the checksum
  std::string finish();

 private:
  [[noreturn]] void fail() const;
  std::filesystem::path path_;
  BufferedFile file_;
  Sha256 sum_;
};

/// Reads such a file. Throws InputError if its bytes are not those that were written: the checksum is compared before
/// the first byte is used.
class CheckpointFileReader {
 public:
  CheckpointFileReader(const std::filesystem::path& file, const std::string& sha256);
  /// The next `count` bytes. Throws InputError if fewer are left.
  std::string get(std::size_t count);
  template <class T>
  bool get_value(T& value) {  // false at the end of the file
    return read(&value, sizeof value);
  }
  void finish();                                ///< throws InputError if bytes are left
  std::uint64_t left() const { return left_; }  ///< bytes to the end
  [[noreturn]] void fail() const;

 private:
  bool read(void* to, std::size_t count);
  std::filesystem::path path_;
  BufferedFile file_;
  std::uint64_t left_ = 0;
};

}  // namespace talus::run
