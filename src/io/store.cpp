#include "talus/io/store.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "kept_file.hpp"
#include "store_rows.hpp"
#include "talus/base/error.hpp"
#include "talus/base/version.hpp"
#include "talus/io/hazard_file.hpp"
#include "talus/io/output_folder.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;
constexpr int kFormat = 1;

std::string numbered(const char* what, std::uint32_t number) {
  return std::string(what) + "-" + std::to_string(number) + ".bin";
}

void put_totals(const Totals& totals, ByteWriter& out) {
  out.put(totals.ends);
  for (const std::uint64_t n :
       {totals.released, totals.pieces, totals.impacts, totals.psi_dropped, totals.cells_scored})
    out.put(n);
  out.put(totals.length_mm);
  out.put(totals.plan_length_mm);
  out.put(totals.first_limit);
  out.put(totals.sink_cpu_seconds);
  out.put(totals.cpu_seconds);
  totals.barriers.save(out);
}

Totals get_totals(const Barriers& barriers, ByteReader& in) {
  Totals totals;
  totals.ends = in.get<decltype(totals.ends)>();
  for (std::uint64_t* n :
       {&totals.released, &totals.pieces, &totals.impacts, &totals.psi_dropped, &totals.cells_scored})
    *n = in.get<std::uint64_t>();
  totals.length_mm = in.get<std::int64_t>();
  totals.plan_length_mm = in.get<std::int64_t>();
  totals.first_limit = in.get<decltype(totals.first_limit)>();
  totals.sink_cpu_seconds = in.get<double>();
  totals.cpu_seconds = in.get<double>();
  totals.barriers = BarrierTally::restored(barriers, in);
  return totals;
}

/// The tally, region by region: number, length, bytes.
std::string write_tally(const fs::path& file, const Tally& tally) {
  KeptFileWriter out(file);
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
  KeptFileReader in(file, sha256);
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

}  // namespace

struct Store::Rows {
  RowsWriter writer;
  std::string name;
};

Store::Store(fs::path folder, const LoadedScenario& loaded)
    : folder_(std::move(folder)), plan_(plan_checksum(loaded)), loaded_(&loaded) {}

Store::Store(const fs::path& folder, const LoadedScenario& loaded, const Part& part, bool further_rounds)
    : Store(folder, loaded) {
  part_ = part;
  further_rounds_ = further_rounds;
  settings_ = loaded.settings;
  replace_text(folder_ / "scenario.toml", loaded.complete_toml);
}

Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;

Store Store::opened(const fs::path& folder, const LoadedScenario& loaded, bool to_go_on) {
  Store store(folder, loaded);
  store.read_manifest();
  if (to_go_on) {
    store.remove_unnamed();
    replace_text(folder / "scenario.toml", loaded.complete_toml);
  }
  return store;
}

std::vector<Setting> Store::settings(std::uint32_t rounds) const {
  std::vector<Setting> settings = settings_;
  for (Setting& setting : settings)
    if (setting.key == "trajectories" && rounds > 1) {
      setting.source = std::to_string(rounds) + " rounds of " + setting.value + ", " + setting.source;
      setting.value = std::to_string(std::stoull(setting.value) * rounds);
    }
  return settings;
}

Sinks Store::sinks() {
  const auto writer = [this]() -> RowsWriter& {
    if (!rows_) {
      const std::string name = numbered("rows", static_cast<std::uint32_t>(rows_files_.size()) + 1);
      rows_ = std::make_unique<Rows>(Rows{RowsWriter(folder_ / name), name});
    }
    return rows_->writer;
  };
  Sinks sinks;
  sinks.stops = [writer](std::span<const StopRow> rows) { writer().put(rows); };
  if (loaded_->scenario.output.paths > 0) sinks.paths = [writer](const RecordedPath& path) { writer().put(path); };
  if (!loaded_->scenario.screens.empty())
    sinks.crossings = [writer](std::span<const Crossing> rows) { writer().put(rows); };
  return sinks;
}

void Store::close_rows(std::uint32_t round) {
  if (!rows_) return;
  rows_files_.push_back({round, rows_->name, rows_->writer.finish()});
  rows_.reset();
}

void Store::end_round(std::uint32_t round) {
  close_rows(round);
  rounds_ = round + 1;
  units_done_ = 0;
}

void Store::keep(const Simulation& simulation, const Tally& tally) {
  const std::uint32_t before = generation_, next = generation_ + 1;
  tally_sha256_ = write_tally(folder_ / numbered("tally", next), tally);
  ByteWriter rest;
  put_totals(simulation.totals(), rest);
  simulation.save_reaches(rest);
  KeptFileWriter rest_file(folder_ / numbered("rest", next));
  rest_file.put(rest.bytes());
  rest_sha256_ = rest_file.finish();
  close_rows(simulation.position().round);
  generation_ = next;
  rounds_ = simulation.position().round + (simulation.round_done() ? 1U : 0U);
  units_done_ = simulation.round_done() ? 0 : simulation.position().unit;
  write_manifest();
  std::error_code ignored;
  for (const char* what : {"tally", "rest"}) fs::remove(folder_ / numbered(what, before), ignored);
}

Totals Store::add_to(Tally& tally) const {
  read_tally(folder_ / numbered("tally", generation_), tally_sha256_, tally);
  const std::string bytes = checked(numbered("rest", generation_), rest_sha256_);
  ByteReader rest(bytes);
  return get_totals(loaded_->scenario.barriers, rest);
}

void Store::restore(Simulation& simulation, Tally& tally) const {
  if (empty()) return;
  read_tally(folder_ / numbered("tally", generation_), tally_sha256_, tally);
  const std::string bytes = checked(numbered("rest", generation_), rest_sha256_);
  ByteReader rest(bytes);
  const Totals totals = get_totals(loaded_->scenario.barriers, rest);
  simulation.restore({rounds_, units_done_}, totals, rest);
}

void Store::replay(std::uint32_t round, const Sinks& sinks) const {
  for (const RowsFile& file : rows_files_)
    if (file.round == round) replay_rows(folder_ / file.name, file.sha256, sinks);
}

std::string Store::checked(const std::string& name, const std::string& sha256) const {
  KeptFileReader in(folder_ / name, sha256);
  std::error_code error;
  std::string bytes = in.get(fs::file_size(folder_ / name, error));
  in.finish();
  return bytes;
}

void Store::write_manifest() const {
  Json rows = Json::array();
  for (const RowsFile& file : rows_files_)
    rows.push_back({{"round", file.round}, {"file", file.name}, {"sha256", file.sha256}});
  Json settings = Json::array();
  for (const Setting& s : settings_) settings.push_back({s.key, s.value, s.unit, s.source});
  const Json json{{"program", "talus"},
                  {"version", version()},
                  {"format", kFormat},
                  {"plan", plan_},
                  {"part", part_.number},
                  {"of", part_.of},
                  {"further_rounds", further_rounds_},
                  {"rounds_done", rounds_},
                  {"units_done", units_done_},
                  {"generation", generation_},
                  {"tally_sha256", tally_sha256_},
                  {"rest_sha256", rest_sha256_},
                  {"rows", rows},
                  {"settings", settings}};
  replace_text(folder_ / kStoreManifest, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void Store::read_manifest() {
  const fs::path file = folder_ / kStoreManifest;
  std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open())
    throw InputError(folder_.string() + ": has no " + kStoreManifest + ", must be what talus run --part has written");
  std::string plan;
  try {
    const Json json = Json::parse(stream);
    if (json.at("format").get<int>() != kFormat || json.at("version").get<std::string>() != version())
      throw InputError("was written by Talus " + json.at("version").get<std::string>());
    plan = json.at("plan");
    part_ = {json.at("part"), json.at("of")};
    further_rounds_ = json.at("further_rounds");
    rounds_ = json.at("rounds_done");
    units_done_ = json.at("units_done");
    generation_ = json.at("generation");
    tally_sha256_ = json.at("tally_sha256");
    rest_sha256_ = json.at("rest_sha256");
    for (const Json& s : json.at("settings")) settings_.push_back({s.at(0), s.at(1), s.at(2), s.at(3)});
    for (const Json& rows : json.at("rows"))
      rows_files_.push_back({rows.at("round"), rows.at("file"), rows.at("sha256")});
  } catch (const std::exception& error) {
    throw InputError(file.string() + ": cannot be understood (" + error.what() +
                     "), must be as this version of Talus has written it; run this part again");
  }
  if (plan != plan_)
    throw InputError(file.string() +
                     ": belongs to another plan: the scenario, a flag or a file is not what it was when this was "
                     "traced; give the same again, or begin anew (--overwrite)");
}

void Store::remove_unnamed() const {
  std::vector<std::string> named{numbered("tally", generation_), numbered("rest", generation_)};
  for (const RowsFile& file : rows_files_) named.push_back(file.name);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name.starts_with("tally-") || name.starts_with("rest-") || name.starts_with("rows-") ||
                      name.starts_with(".part.json.talus-") || name.starts_with(".scenario.toml.talus-");
    if (ours && std::ranges::count(named, name) == 0) fs::remove(entry.path(), ignored);
  }
}

}  // namespace talus::io
