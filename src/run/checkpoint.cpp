#include "talus/run/checkpoint.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "checkpoint_file.hpp"
#include "checkpoint_rows.hpp"
#include "checkpoint_tally.hpp"
#include "io/files/checksum.hpp"
#include "io/files/json.hpp"
#include "io/gdal/regular_file.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/scenario/plan_checksum.hpp"

namespace talus::run {

namespace fs = std::filesystem;

namespace {

using io::plan_checksum;
using io::replace_text;
using Json = nlohmann::ordered_json;
constexpr int kFormat = 9;
constexpr std::int64_t kLargest32 = 0xFFFF'FFFF;

/// "tally-3.bin"; for a process of rank 1 "tally-3-1.bin".
std::string numbered(const std::string& what, std::uint32_t number, int rank = 0) {
  return what + "-" + std::to_string(number) + (rank > 0 ? "-" + std::to_string(rank) : "") + ".bin";
}

Json json_of(const Rounds& asked) {
  Json json{{"count", asked.count}, {"above", asked.above}, {"most", asked.most}};
  if (asked.until_error) json["until_error"] = *asked.until_error;
  return json;
}

std::uint32_t number_of(const Json& json, const char* key, std::int64_t lowest, std::int64_t highest) {
  return static_cast<std::uint32_t>(io::whole_number(json.at(key), lowest, highest));
}

/// The name of a file of a checkpoint. Throws InputError for one that no checkpoint writes, such as "../tally-1.bin".
std::string file_name(const Json& json, std::string_view what) {
  const std::string name = json;
  if (!name.starts_with(what) || !name.ends_with(".bin") || name.find_first_of(std::string("/\\\0", 3)) != name.npos)
    throw InputError("it names the file '" + name.substr(0, 80) + "', must be a '" + std::string(what) +
                     "... .bin' of its own folder");
  return name;
}

Rounds rounds_of(const Json& json) {
  Rounds asked{number_of(json, "count", 1, kMostRounds), {}, json.at("above"), number_of(json, "most", 1, kMostRounds)};
  if (json.contains("until_error")) asked.until_error = json.at("until_error").get<double>();
  return asked;
}

std::string manifest_text(const Json& manifest) {
  return manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// " (seed 2 instead of 1, another content of the file of dem)": what differs between two records of a plan. Empty
/// where no record tells it.
std::string differences(const std::vector<Setting>& before, const std::vector<Setting>& now,
                        const std::vector<io::InputFile>& files_before, const std::vector<io::InputFile>& files_now) {
  std::vector<std::string> words;
  const auto value_in = [](const std::vector<Setting>& settings, const std::string& key) {
    const auto found = std::ranges::find(settings, key, &Setting::key);
    return found == settings.end() ? std::string("none") : found->value;
  };
  const auto without_folder = [](const std::string& value) {  // machines may have the same files in other folders
    return fs::path(value).is_absolute() ? fs::path(value).filename().string() : value;
  };
  for (const Setting& s : now)
    if (const std::string was = value_in(before, s.key); without_folder(was) != without_folder(s.value))
      words.push_back(s.key + " " + s.value + " instead of " + was);
  for (const Setting& s : before)
    if (!std::ranges::count(now, s.key, &Setting::key)) words.push_back("no " + s.key + " instead of " + s.value);
  for (std::string& word : io::changed_inputs(files_before, files_now)) words.push_back(std::move(word));
  return words.empty() ? "" : " (" + listed(words) + ")";
}

/// Pairs of name and checksum, in a manifest.
template <class File>
Json json_of(const std::vector<File>& files) {
  Json list = Json::array();
  for (const File& file : files) list.push_back({{"file", file.name}, {"sha256", file.sha256}});
  return list;
}

}  // namespace

std::string name_of(const Part& part) {
  return std::to_string(part.number) + "/" + std::to_string(part.of);
}

struct Checkpoint::Rows {
  RowsWriter writer;
  std::string name;
};

Checkpoint::Checkpoint(fs::path folder, const LoadedScenario& loaded, ProcessGroup& processes)
    : folder_(std::move(folder)), plan_(plan_checksum(loaded)), loaded_(&loaded), processes_(&processes) {}

Checkpoint::Checkpoint(const fs::path& folder, const LoadedScenario& loaded, const Part& part, const Rounds& asked,
                       ProcessGroup& processes)
    : Checkpoint(folder, loaded, processes) {
  part_ = part;
  asked_ = asked;
  settings_ = loaded.settings;
  notes_ = loaded.notes;
  warnings_ = loaded.warnings;
  inputs_ = loaded.inputs;
  if (processes.leads()) replace_text(folder_ / "scenario.toml", loaded.complete_toml);
}

Checkpoint::Checkpoint(Checkpoint&&) noexcept = default;
Checkpoint& Checkpoint::operator=(Checkpoint&&) noexcept = default;
Checkpoint::~Checkpoint() = default;

Checkpoint Checkpoint::opened(const fs::path& folder, const LoadedScenario& loaded, bool to_go_on,
                              ProcessGroup& processes) {
  Checkpoint checkpoint(folder, loaded, processes);
  checkpoint.read_manifest();
  if (to_go_on && processes.leads()) {
    checkpoint.remove_unnamed();
    replace_text(folder / "scenario.toml", loaded.complete_toml);
  }
  return checkpoint;
}

void Checkpoint::require_part(const Part& asked, const std::string& out) const {
  if (part_.number == asked.number && part_.of == asked.of) return;
  throw InputError(out + ": what is kept there is part " + name_of(part_) +
                   "; give that with --part, or another folder");
}

std::vector<Setting> Checkpoint::settings(std::uint32_t rounds) const {
  std::vector<Setting> settings = settings_;
  for (Setting& setting : settings)
    if (setting.key == "trajectories" && rounds > 1) {
      setting.source = std::to_string(rounds) + " rounds of " + setting.value + ", " + setting.source;
      setting.value = std::to_string(std::uint64_t{loaded_->scenario.trajectories} * rounds);
    }
  return settings;
}

void Checkpoint::recall(LoadedScenario& loaded, std::uint32_t rounds) const {
  std::vector<io::InputFile> inputs = inputs_;
  for (io::InputFile& input : inputs) {
    if (input.role == "scenario" || input.role == io::kFittedModel) continue;  // the complete scenario stands for both
    const auto here = std::ranges::find(loaded.inputs, input.role, &io::InputFile::role);
    if (here != loaded.inputs.end()) input = *here;
  }
  loaded.inputs = std::move(inputs);
  loaded.settings = settings(rounds);
  loaded.notes = notes_;
  loaded.warnings = warnings_;
}

Sinks Checkpoint::sinks() {
  const auto writer = [this]() -> RowsWriter& {
    if (!rows_) {
      const std::string name = numbered("rows-" + std::to_string(generation_ + 1), round_, processes_->rank());
      rows_ = std::make_unique<Rows>(Rows{RowsWriter(folder_ / name), name});
    }
    return rows_->writer;
  };
  Sinks sinks;
  sinks.unit = [writer](std::uint64_t unit) { writer().put(unit); };
  sinks.stops = [writer](std::span<const StopRow> rows) { writer().put(rows); };
  if (loaded_->scenario.output.paths > 0) sinks.paths = [writer](const RecordedPath& path) { writer().put(path); };
  if (!loaded_->scenario.screens.empty())
    sinks.crossings = [writer](std::span<const Crossing> rows) { writer().put(rows); };
  return sinks;
}

/// Closes the files of rows of all processes. The leader gets their names.
void Checkpoint::close_rows(std::uint32_t round) {
  Json mine;
  if (rows_) mine = {{"name", rows_->name}, {"sha256", rows_->writer.finish()}};
  rows_.reset();
  for (const std::string& given : processes_->gather(mine.dump())) {
    const Json file = Json::parse(given);
    if (!file.is_null()) rows_files_.push_back({round, generation_ + 1, file.at("name"), file.at("sha256")});
  }
}

void Checkpoint::end_round(std::uint32_t round) {
  close_rows(round);
  round_ = rounds_ = round + 1;
  units_done_ = 0;
}

void Checkpoint::save(const Simulation& simulation, const Tally& tally) {
  const std::uint32_t next = generation_ + 1;
  const std::string before = numbered("rest", generation_);
  const std::string name = numbered("tally", next, processes_->rank()),
                    reach = numbered("reach", next, processes_->rank());
  const std::vector<SavedFile> tallies = gathered({name, write_tally(folder_ / name, tally)});
  const std::vector<SavedFile> reaches = gathered({reach, write_reaches(folder_ / reach, simulation)});
  const Totals totals = totals_of_all(simulation.totals());
  close_rows(simulation.position().round);
  generation_ = next;
  rounds_ = simulation.position().round + (simulation.round_done() ? 1U : 0U);
  units_done_ = simulation.round_done() ? 0 : simulation.position().unit;
  round_ = rounds_;
  if (processes_->leads()) {
    rest_sha256_ = write_totals(folder_ / numbered("rest", next), totals);
    const std::vector<SavedFile> old_tallies = std::exchange(tallies_, tallies);
    const std::vector<SavedFile> old_reaches = std::exchange(reaches_, reaches);
    write_manifest();
    std::error_code ignored;
    fs::remove(folder_ / before, ignored);
    for (const auto& old : {old_tallies, old_reaches})
      for (const SavedFile& file : old) fs::remove(folder_ / file.name, ignored);
  }
  processes_->tell({});  // no process goes on before what it has traced is saved
}

/// Files of all processes, by rank. Only the leader gets them.
std::vector<Checkpoint::SavedFile> Checkpoint::gathered(const SavedFile& mine) const {
  const std::vector<std::string> names = processes_->gather(mine.name), sums = processes_->gather(mine.sha256);
  std::vector<SavedFile> files;
  for (std::size_t i = 0; i < names.size(); ++i) files.push_back({names[i], sums[i]});
  return files;
}

Totals Checkpoint::totals_of_all(const Totals& mine) const {
  ByteWriter bytes;
  put_totals(mine, bytes);
  Totals sum;
  sum.barriers = BarrierTally(loaded_->scenario.barriers);
  for (const std::string& given : processes_->gather(bytes.bytes())) {
    ByteReader in(given);
    add(sum, get_totals(loaded_->scenario.barriers, in));
  }
  return sum;
}

Totals Checkpoint::add_to(Tally& tally) const {
  for (const SavedFile& file : tallies_) read_tally(folder_ / file.name, file.sha256, tally);
  return saved_totals();
}

Totals Checkpoint::saved_totals() const {
  return read_totals(folder_ / numbered("rest", generation_), rest_sha256_, loaded_->scenario.barriers);
}

void Checkpoint::restore(Simulation& simulation, Tally& tally) const {
  if (empty()) return;
  const auto size = static_cast<std::size_t>(processes_->size()), me = static_cast<std::size_t>(processes_->rank());
  for (std::size_t i = me; i < tallies_.size(); i += size)
    read_tally(folder_ / tallies_[i].name, tallies_[i].sha256, tally);
  Totals none;
  none.barriers = BarrierTally(loaded_->scenario.barriers);
  simulation.restore({rounds_, units_done_}, processes_->leads() ? saved_totals() : none);
  for (const SavedFile& file : reaches_) read_reaches(folder_ / file.name, file.sha256, simulation);
}

void Checkpoint::replay(std::uint32_t round, const Sinks& sinks) const {
  for (auto file = rows_files_.begin(); file != rows_files_.end();) {
    std::vector<std::unique_ptr<RowsReader>> files;  // of one save, one per process
    const RowsFile& first = *file;
    for (; file != rows_files_.end() && file->round == first.round && file->generation == first.generation; ++file)
      if (file->round == round) files.push_back(std::make_unique<RowsReader>(folder_ / file->name, file->sha256));
    replay_rows(files, sinks);
  }
}

void Checkpoint::write_manifest() const {
  Json rows = Json::array();
  for (const RowsFile& file : rows_files_)
    rows.push_back(
        {{"round", file.round}, {"generation", file.generation}, {"file", file.name}, {"sha256", file.sha256}});
  Json settings = Json::array();
  for (const Setting& s : settings_) settings.push_back({s.key, s.value, s.unit, s.source});
  Json json{{"program", "talus"},
            {"version", version()},
            {"format", kFormat},
            {"plan", plan_},
            {"part", part_.number},
            {"of", part_.of},
            {"rounds", json_of(asked_)},
            {"rounds_done", rounds_},
            {"units_done", units_done_},
            {"generation", generation_},
            {"tallies", json_of(tallies_)},
            {"reaches", json_of(reaches_)},
            {"rest_sha256", rest_sha256_},
            {"rows", rows},
            {"settings", settings},
            {"inputs", io::json_of(inputs_)},
            {"notes", notes_},
            {"warnings", warnings_}};
  json["sha256"] = io::sha256_of_bytes(manifest_text(json));  // of the text without this line
  replace_text(folder_ / kCheckpointManifest, manifest_text(json));
}

void Checkpoint::read_manifest() {
  const fs::path file = folder_ / kCheckpointManifest;
  std::error_code none;
  if (!fs::exists(file, none))
    throw InputError(folder_.string() + ": has no " + kCheckpointManifest +
                     ", must be what talus run --part has written");
  const std::string text = io::read_file(file.string(), file.string(), "the record of a part", io::kMostRecord);
  const auto read = [&] {
    Json json = io::parsed_record(text);
    const std::string sha256 = json.at("sha256");
    json.erase("sha256");
    if (sha256 != io::sha256_of_bytes(manifest_text(json))) throw InputError("its checksum is another");
    if (const int format = json.at("format"); format != kFormat || json.at("version").get<std::string>() != version())
      throw InputError("was written by Talus " + json.at("version").get<std::string>() + " in format " +
                       std::to_string(format) + ", this one reads format " + std::to_string(kFormat));
    const std::string plan = json.at("plan");
    const std::uint32_t of = number_of(json, "of", 1, kLargest32);
    part_ = {number_of(json, "part", 1, of), of};
    asked_ = rounds_of(json.at("rounds"));
    rounds_ = number_of(json, "rounds_done", 0, kMostRounds);
    units_done_ = static_cast<std::uint64_t>(io::whole_number(json.at("units_done"), 0, std::int64_t{1} << 62U));
    generation_ = number_of(json, "generation", 0, kLargest32 - 1);
    rest_sha256_ = json.at("rest_sha256");
    for (const Json& s : json.at("settings")) settings_.push_back({s.at(0), s.at(1), s.at(2), s.at(3)});
    for (const Json& input : json.at("inputs"))
      inputs_.push_back({input.at("role"), input.at("path"), input.at("sha256"), {}});
    notes_ = json.at("notes").get<std::vector<std::string>>();
    warnings_ = json.at("warnings").get<std::vector<std::string>>();
    for (const Json& rows : json.at("rows"))
      rows_files_.push_back({number_of(rows, "round", 0, kMostRounds), number_of(rows, "generation", 0, kLargest32),
                             file_name(rows.at("file"), "rows-"), rows.at("sha256")});
    for (const Json& tally : json.at("tallies"))
      tallies_.push_back({file_name(tally.at("file"), "tally-"), tally.at("sha256")});
    for (const Json& reach : json.at("reaches"))
      reaches_.push_back({file_name(reach.at("file"), "reach-"), reach.at("sha256")});
    round_ = rounds_;
    return plan;
  };
  if (io::understood(file, "must be as this version of Talus has written it; run this part again", read) != plan_)
    throw InputError(file.string() +
                     ": belongs to another plan: the scenario, a flag or a file is not what it was when this was "
                     "traced" +
                     differences(settings_, loaded_->settings, inputs_, loaded_->inputs) +
                     ". To go on (--resume) give the same again, with the same seed and trajectories, or begin "
                     "anew (--overwrite); to merge give parts of the plan of the first one");
}

void Checkpoint::remove_unnamed() const {
  std::vector<std::string> named{numbered("rest", generation_)};
  for (const auto& files : {tallies_, reaches_})
    for (const SavedFile& file : files) named.push_back(file.name);
  for (const RowsFile& file : rows_files_) named.push_back(file.name);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    const bool ours = name.starts_with("tally-") || name.starts_with("reach-") || name.starts_with("rest-") ||
                      name.starts_with("rows-") ||
                      name.starts_with(io::StagedPath::hidden_prefix(kCheckpointManifest, ".json")) ||
                      name.starts_with(io::StagedPath::hidden_prefix("scenario.toml", ".toml"));
    if (ours && std::ranges::count(named, name) == 0) fs::remove(entry.path(), ignored);
  }
}

}  // namespace talus::run
