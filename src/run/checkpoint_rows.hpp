#pragma once
#include <filesystem>
#include <span>

#include "checkpoint_file.hpp"
#include "talus/simulate/sinks.hpp"

namespace talus::run {

/// Writes rows into a file of a `Checkpoint`, as `simulate` hands them out: their kind, their number, their bytes in
/// memory.
class RowsWriter {
 public:
  explicit RowsWriter(const std::filesystem::path& file) : file_(file) {}
  /// Begins a unit of work: the rows that follow belong to it.
  void put(std::uint64_t unit) {
    file_.put_value('U');
    file_.put_value(unit);
  }
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
  CheckpointFileWriter file_;
};

/// Reads such a file, unit by unit. Throws InputError if it is damaged.
class RowsReader {
 public:
  RowsReader(const std::filesystem::path& file, const std::string& sha256);
  bool done() const { return kind_ == kEnd; }
  std::uint64_t unit() const { return unit_; }  ///< unit whose rows come next
  /// Hands the rows of the unit to the sinks that are set.
  void hand_out(const Sinks& sinks);

 private:
  static constexpr char kEnd = ' ';
  void read_kind();
  CheckpointFileReader in_;
  char kind_ = kEnd;
  std::uint64_t unit_ = 0;
};

/// Hands out the rows of several files in ascending order of their units. Each file has its own units, in ascending
/// order.
void replay_rows(const std::vector<std::unique_ptr<RowsReader>>& files, const Sinks& sinks);

}  // namespace talus::run
