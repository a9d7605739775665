#include "checkpoint_rows.hpp"

#include "talus/simulate/tally/bytes.hpp"

namespace talus::run {
namespace {

template <class Row>
std::vector<Row> rows_of(CheckpointFileReader& in, std::uint64_t count) {
  if (count > in.left() / sizeof(Row)) in.fail();
  const std::string bytes = in.get(count * sizeof(Row));
  std::vector<Row> rows(count);
  if (count > 0) std::memcpy(rows.data(), bytes.data(), bytes.size());
  return rows;
}

}  // namespace

void RowsWriter::put(const RecordedPath& path) {
  put('P', std::span<const PathPoint>(path.points));
  file_.put_value(path.stop);
}

RowsReader::RowsReader(const std::filesystem::path& file, const std::string& sha256) : in_(file, sha256) {
  read_kind();
  if (!done() && kind_ != 'U') in_.fail();
}

/// Reads the kind of what comes next. For a unit reads its number, too.
void RowsReader::read_kind() {
  if (!in_.get_value(kind_)) {
    kind_ = kEnd;
    in_.finish();
  } else if (kind_ == 'U' && !in_.get_value(unit_)) {
    in_.fail();
  }
}

void RowsReader::hand_out(const Sinks& sinks) {
  for (read_kind(); kind_ != kEnd && kind_ != 'U'; read_kind()) {
    std::uint64_t count = 0;
    if (!in_.get_value(count)) in_.fail();
    if (kind_ == 'S') {
      const auto rows = rows_of<StopRow>(in_, count);
      if (sinks.stops) sinks.stops(rows);
    } else if (kind_ == 'C') {
      const auto rows = rows_of<Crossing>(in_, count);
      if (sinks.crossings) sinks.crossings(rows);
    } else if (kind_ == 'P') {
      RecordedPath path;
      path.points = rows_of<PathPoint>(in_, count);
      if (!in_.get_value(path.stop)) in_.fail();
      if (sinks.paths) sinks.paths(path);
    } else {
      in_.fail();
    }
  }
}

void replay_rows(const std::vector<std::unique_ptr<RowsReader>>& files, const Sinks& sinks) {
  for (;;) {
    RowsReader* next = nullptr;
    for (const auto& file : files)
      if (!file->done() && (next == nullptr || file->unit() < next->unit())) next = file.get();
    if (next == nullptr) return;
    next->hand_out(sinks);
  }
}

}  // namespace talus::run
