#include "sitting.hpp"

#include "commands.hpp"
#include "run_support.hpp"
#include "talus/base/error.hpp"
#include "talus/io/hazard_file.hpp"
#include "talus/simulate/team_tally.hpp"

namespace fs = std::filesystem;

Sitting::Sitting(const RunOptions& options, const talus::io::LoadedScenario& loaded, const talus::Part& part,
                 talus::io::OutputFolder* folder, Progress& progress, talus::Team& team)
    : options_(options),
      scenario_(loaded.scenario),
      folder_(folder),
      team_(team),
      tally_(scenario_.surface.grid(), scenario_.output.energy_thresholds, scenario_.output.height_thresholds),
      stores_(opened(loaded, part)),
      sinks_(store().sinks()),
      simulation_(scenario_, part, options.rounds.several(), tally_, sinks_, team) {
  if (auto weights = talus::AnnualWeights::of(scenario_, options.rounds.several()))
    tally_.keep_hazard(std::move(*weights));
  together(team_, [this] { store().restore(simulation_, tally_); });
  sinks_.progress = [&progress](double share) { return progress.update(share) && !interrupted(); };
  sinks_.pause = [this] { return seconds_since_kept() > options_.checkpoint; };
}

/// What is kept in the folder of the leader, which the others must see; or nothing yet.
std::vector<talus::io::Store> Sitting::opened(const talus::io::LoadedScenario& loaded, const talus::Part& part) {
  const fs::path work = team_.tell(folder_ != nullptr ? folder_->work().string() : "");
  const bool kept = !team_.tell(team_.leads() && fs::exists(work / talus::io::kStoreManifest) ? "kept" : "").empty();
  const std::string plan = team_.tell(talus::io::plan_checksum(loaded));
  std::vector<talus::io::Store> stores;
  together(team_, [&] {
    if (talus::io::plan_checksum(loaded) != plan)
      throw talus::InputError(options_.out +
                              ": the processes of the run have read different files, must be the same on "
                              "every machine");
    if (!fs::is_directory(work))
      throw talus::InputError(options_.out +
                              ": its folder cannot be seen by every process, must lie on a file system that all "
                              "machines of the run share");
    if (!kept) {
      stores.emplace_back(work, loaded, part, options_.rounds, team_);
      return;
    }
    stores.push_back(talus::io::Store::opened(work, loaded, true, team_));
    const talus::io::Store& store = stores.front();
    if (store.asked() != options_.rounds)
      throw talus::InputError(options_.out +
                              ": what is kept there was begun with other --rounds, --until-error, --above or "
                              "--most-rounds (" +
                              std::to_string(store.rounds()) +
                              " rounds are done); give the same, or begin anew (--overwrite)");
    if (store.part().number != part.number || store.part().of != part.of)
      throw talus::InputError(options_.out + ": what is kept there is part " + std::to_string(store.part().number) +
                              "/" + std::to_string(store.part().of) + "; give that with --part, or another folder");
  });
  return stores;
}

void Sitting::trace(int threads, Progress& progress) {
  while (!enough()) {
    if (simulation_.round_done()) simulation_.next_round();
    if (options_.rounds.several() && simulation_.position().unit == 0)
      progress.begin("round " + std::to_string(simulation_.position().round + 1));
    all_kept_ = false;
    simulation_.advance(threads);
    if (any(simulation_.totals().interrupted || interrupted())) interrupt();
    if (simulation_.round_done()) store().end_round(simulation_.position().round);
    if (any(seconds_since_kept() > options_.checkpoint)) keep();
  }
}

talus::Totals Sitting::totals() {
  return store().totals_of_all(simulation_.totals());
}

void Sitting::keep() {
  store().keep(simulation_, tally_);
  if (folder_ != nullptr) folder_->keep();
  kept_ = Clock::now();
  all_kept_ = true;
}

void Sitting::keep_the_rest() {
  if (is_kept() && !all_kept_) keep();
}

void Sitting::interrupt() {
  if (simulation_.position().unit == 0 && simulation_.position().round == 0) stop_interrupted();
  if (!all_kept_) keep();
  throw Interrupted("interrupted; what was traced is kept, go on with: " + command_to_resume());
}

void Sitting::interrupt_writing() {
  if (team_.size() == 1) interrupt();
  if (store().empty()) stop_interrupted();
  throw Interrupted("interrupted; what was kept last goes on with: " + command_to_resume());
}

talus::Accuracy Sitting::accuracy() {
  talus::share_out(tally_, team_);
  talus::ByteWriter mine;
  mine.put(talus::accuracy_of(tally_, std::uint64_t{rounds_done()} * scenario_.released(), options_.rounds.above));
  talus::Accuracy all;
  for (const std::string& bytes : team_.gather(mine.bytes())) {
    const auto one = talus::ByteReader(bytes).get<talus::Accuracy>();
    all.half_width = std::max(all.half_width, one.half_width);
    all.cells += one.cells;
  }
  talus::ByteWriter told;
  told.put(all);
  return talus::ByteReader(team_.tell(told.bytes())).get<talus::Accuracy>();
}

bool Sitting::enough() {
  const talus::Rounds& wanted = options_.rounds;
  const std::uint32_t done = rounds_done();
  if (done == 0) return false;
  if (!simulation_.round_done() && simulation_.position().unit > 0) return false;
  if (!wanted.until_error) return done >= wanted.count;
  return done >= wanted.most || accuracy().half_width < *wanted.until_error;
}
