#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "io/files/checksum.hpp"
#include "io/gdal/dataset.hpp"
#include "talus/base/open_file.hpp"

namespace talus::io {

/// Writes bytes into a gzip file, with a checksum at the end. Little-endian, as every machine that Talus runs on.
class HazardWriter {
 public:
  explicit HazardWriter(const std::filesystem::path& file);
  ~HazardWriter();  ///< without `finish` the file is removed
  HazardWriter(const HazardWriter&) = delete;
  HazardWriter& operator=(const HazardWriter&) = delete;

  void put(const void* bytes, std::size_t count);
  template <class Number>
  void put(Number number) {
    put(&number, sizeof number);
  }
  void finish();

 private:
  void flush();
  void write(const std::string& bytes);
  [[noreturn]] void fail(const std::string& cause) const;

  std::filesystem::path file_;
  OpenFile output_;
  std::uint64_t end_ = 0;  // bytes in the file
  std::string buffer_;
  Sha256 sum_;
};

/// Reads the bytes of such a file. Throws InputError if they are not those that were written.
class HazardReader {
 public:
  explicit HazardReader(const std::filesystem::path& file);

  void get(void* bytes, std::size_t count);
  template <class Number>
  Number get() {
    Number number{};
    get(&number, sizeof number);
    return number;
  }
  /// Reads a count. Throws InputError if it is above `most`.
  std::size_t get_count(std::size_t most);
  /// Compares the checksum.
  void finish();

  const std::string& name() const { return name_; }
  [[noreturn]] void fail() const;

 private:
  void fill();

  std::string name_;
  GdalMessages messages_;
  VsiFile stream_;
  std::string buffer_;
  std::size_t next_ = 0;
  Sha256 sum_;
};

}  // namespace talus::io
