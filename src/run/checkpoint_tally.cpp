#include "checkpoint_tally.hpp"

#include <stdexcept>

#include "checkpoint_file.hpp"

namespace talus::run {

namespace fs = std::filesystem;

void put_totals(const Totals& totals, ByteWriter& out) {
  out.put(totals.ends);
  for (const std::uint64_t n : {totals.released, totals.pieces, totals.impacts, totals.psi_dropped, totals.cells_scored,
                                totals.left_blocks, totals.limited_blocks})
    out.put(n);
  out.put(totals.length_mm);
  out.put(totals.plan_length_mm);
  out.put(totals.left_weight);
  out.put(totals.first_limit);
  out.put(totals.sink_cpu_seconds);
  out.put(totals.cpu_seconds);
  totals.barriers.save(out);
}

Totals get_totals(const Barriers& barriers, ByteReader& in) {
  Totals totals;
  totals.ends = in.get<decltype(totals.ends)>();
  for (std::uint64_t* n : {&totals.released, &totals.pieces, &totals.impacts, &totals.psi_dropped, &totals.cells_scored,
                           &totals.left_blocks, &totals.limited_blocks})
    *n = in.get<std::uint64_t>();
  totals.length_mm = in.get<std::int64_t>();
  totals.plan_length_mm = in.get<std::int64_t>();
  totals.left_weight = in.get<std::int64_t>();
  totals.first_limit = in.get<decltype(totals.first_limit)>();
  totals.sink_cpu_seconds = in.get<double>();
  totals.cpu_seconds = in.get<double>();
  totals.barriers = BarrierTally::restored(barriers, in);
  return totals;
}

std::string write_totals(const fs::path& file, const Totals& totals) {
  CheckpointFileWriter out(file);
  ByteWriter bytes;
  put_totals(totals, bytes);
  out.put(bytes.bytes());
  return out.finish();
}

Totals read_totals(const fs::path& file, const std::string& sha256, const Barriers& barriers) {
  CheckpointFileReader in(file, sha256);
  const std::string bytes = in.get(in.left());
  ByteReader reader(bytes);
  try {
    const Totals totals = get_totals(barriers, reader);
    if (reader.empty()) return totals;
  } catch (const std::out_of_range&) {  // too few bytes
  }
  in.fail();
}

std::string write_tally(const fs::path& file, const Tally& tally) {
  CheckpointFileWriter out(file);
  ByteWriter region;
  for (std::size_t i = 0; i < tally.regions(); ++i) {
    region.clear();
    tally.save(i, region);
    if (region.bytes().empty()) continue;
    out.put_value(std::uint64_t{i});
    out.put_value(std::uint64_t{region.bytes().size()});
    out.put(region.bytes());
  }
  return out.finish();
}

void read_tally(const fs::path& file, const std::string& sha256, Tally& tally) {
  CheckpointFileReader in(file, sha256);
  for (std::uint64_t region = 0, length = 0; in.get_value(region);) {
    if (!in.get_value(length) || region >= tally.regions()) in.fail();
    const std::string bytes = in.get(length);
    ByteReader reader(bytes);
    try {
      tally.merge(region, reader);
    } catch (const std::out_of_range&) {
      in.fail();
    }
  }
  in.finish();
}

std::string write_reaches(const fs::path& file, const Simulation& simulation) {
  CheckpointFileWriter out(file);
  simulation.save_reaches([&](std::string_view piece) {
    out.put_value(std::uint64_t{piece.size()});
    out.put(piece);
  });
  return out.finish();
}

void read_reaches(const fs::path& file, const std::string& sha256, Simulation& simulation) {
  CheckpointFileReader in(file, sha256);
  for (std::uint64_t length = 0; in.get_value(length);) {
    const std::string bytes = in.get(length);
    ByteReader reader(bytes);
    try {
      simulation.restore_reach(reader);
    } catch (const std::out_of_range&) {
      in.fail();
    }
  }
  in.finish();
}

}  // namespace talus::run
