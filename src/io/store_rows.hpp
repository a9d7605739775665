#pragma once
#include <filesystem>
#include <span>

#include "kept_file.hpp"
#include "talus/simulate/simulate.hpp"

namespace talus::io {

/// Rows as `simulate` hands them out, in a file of a `Store`: kind, number, the rows as they lie in memory.
class RowsWriter {
 public:
  explicit RowsWriter(const std::filesystem::path& file) : file_(file) {}
  void put(std::span<const StopRow> rows) { put('S', rows); }
  void put(std::span<const Crossing> rows) { put('C', rows); }
  void put(const RecordedPath& path);
  std::string finish() { return file_.finish(); }

 private:
  template <class Row>
  void put(char kind, std::span<const Row> rows) {
    file_.put_value(kind);
    file_.put_value(static_cast<std::uint64_t>(rows.size()));
    file_.put({reinterpret_cast<const char*>(rows.data()), rows.size_bytes()});
  }
  KeptFileWriter file_;
};

/// Hands the rows of a file to those sinks that are set. Throws InputError where it is damaged.
void replay_rows(const std::filesystem::path& file, const std::string& sha256, const Sinks& sinks);

}  // namespace talus::io
