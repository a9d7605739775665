#include "store_rows.hpp"

#include "talus/simulate/bytes.hpp"

namespace talus::io {
namespace {

template <class Row>
std::vector<Row> rows_of(KeptFileReader& in, std::uint64_t count) {
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

void replay_rows(const std::filesystem::path& file, const std::string& sha256, const Sinks& sinks) {
  KeptFileReader in(file, sha256);
  std::uint64_t count = 0;
  for (char kind = ' '; in.get_value(kind);) {
    if (!in.get_value(count)) in.fail();
    if (kind == 'S') {
      const auto rows = rows_of<StopRow>(in, count);
      if (sinks.stops) sinks.stops(rows);
    } else if (kind == 'C') {
      const auto rows = rows_of<Crossing>(in, count);
      if (sinks.crossings) sinks.crossings(rows);
    } else if (kind == 'P') {
      RecordedPath path;
      path.points = rows_of<PathPoint>(in, count);
      if (!in.get_value(path.stop)) in.fail();
      if (sinks.paths) sinks.paths(path);
    } else {
      in.fail();
    }
  }
  in.finish();
}

}  // namespace talus::io
