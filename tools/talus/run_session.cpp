#include "run_session.hpp"

#include "commands.hpp"
#include "run_support.hpp"
#include "talus/base/error.hpp"
#include "talus/io/results/hazard_file.hpp"
#include "talus/simulate/tally/tally_exchange.hpp"

namespace fs = std::filesystem;

RunSession::RunSession(const RunOptions& options, const talus::io::LoadedScenario& loaded, const talus::Part& part,
                 talus::io::OutputFolder* folder, Progress& progress, talus::ProcessGroup& processes)
    : options_(options),
      scenario_(loaded.scenario),
      folder_(folder),
      processes_(processes),
      tally_(scenario_.surface.grid(), scenario_.output.energy_thresholds, scenario_.output.height_thresholds),
      checkpoints_(opened(loaded, part)),
      sinks_(checkpoint().sinks()),
      simulation_(scenario_, part, options.rounds.several(), tally_, sinks_, processes) {
  if (auto weights = talus::AnnualWeights::of(scenario_, options.rounds.several()))
    tally_.keep_hazard(std::move(*weights));
  together(processes_, [this] { checkpoint().restore(simulation_, tally_); });
  sinks_.progress = [&progress](double share) { return progress.update(share) && !interrupted(); };
  sinks_.pause = [this] { return seconds_since_kept() > options_.checkpoint; };
}

/// What is kept in the folder of the leader, which the others must see; or nothing yet.
std::vector<talus::io::Checkpoint> RunSession::opened(const talus::io::LoadedScenario& loaded, const talus::Part& part) {
  const fs::path work = processes_.tell(folder_ != nullptr ? folder_->work().string() : "");
  const bool kept = !processes_.tell(processes_.leads() && fs::exists(work / talus::io::kCheckpointManifest) ? "kept" : "").empty();
  const std::string plan = processes_.tell(talus::io::plan_checksum(loaded));
  std::vector<talus::io::Checkpoint> checkpoints;
  together(processes_, [&] {
    if (talus::io::plan_checksum(loaded) != plan)
      throw talus::InputError(options_.out +
                              ": the processes of the run have read different files, must be the same on "
                              "every machine");
    if (!fs::is_directory(work))
      throw talus::InputError(options_.out +
                              ": its folder cannot be seen by every process, must lie on a file system that all "
                              "machines of the run share");
    if (!kept) {
      checkpoints.emplace_back(work, loaded, part, options_.rounds, processes_);
      return;
    }
    checkpoints.push_back(talus::io::Checkpoint::opened(work, loaded, true, processes_));
    const talus::io::Checkpoint& checkpoint = checkpoints.front();
    if (checkpoint.asked() != options_.rounds)
      throw talus::InputError(options_.out +
                              ": what is kept there was begun with other --rounds, --until-error, --above or "
                              "--most-rounds (" +
                              std::to_string(checkpoint.rounds()) +
                              " rounds are done); give the same, or begin anew (--overwrite)");
    if (checkpoint.part().number != part.number || checkpoint.part().of != part.of)
      throw talus::InputError(options_.out + ": what is kept there is part " + std::to_string(checkpoint.part().number) +
                              "/" + std::to_string(checkpoint.part().of) + "; give that with --part, or another folder");
  });
  return checkpoints;
}

void RunSession::trace(int threads, Progress& progress) {
  while (!enough()) {
    if (simulation_.round_done()) simulation_.next_round();
    if (options_.rounds.several() && simulation_.position().unit == 0)
      progress.begin("round " + std::to_string(simulation_.position().round + 1));
    all_kept_ = false;
    simulation_.advance(threads);
    if (any(simulation_.totals().interrupted || interrupted())) interrupt();
    if (simulation_.round_done()) checkpoint().end_round(simulation_.position().round);
    if (any(seconds_since_kept() > options_.checkpoint)) keep();
  }
}

talus::Totals RunSession::totals() {
  return checkpoint().totals_of_all(simulation_.totals());
}

void RunSession::keep() {
  checkpoint().keep(simulation_, tally_);
  if (folder_ != nullptr) folder_->keep();
  kept_ = Clock::now();
  all_kept_ = true;
}

void RunSession::keep_the_rest() {
  if (is_kept() && !all_kept_) keep();
}

void RunSession::interrupt() {
  if (simulation_.position().unit == 0 && simulation_.position().round == 0) stop_interrupted();
  if (!all_kept_) keep();
  throw Interrupted("interrupted; what was traced is kept, go on with: " + command_to_resume());
}

void RunSession::interrupt_writing() {
  if (processes_.size() == 1) interrupt();
  if (checkpoint().empty()) stop_interrupted();
  throw Interrupted("interrupted; what was kept last goes on with: " + command_to_resume());
}

talus::Accuracy RunSession::accuracy() {
  talus::share_out(tally_, processes_);
  talus::ByteWriter mine;
  mine.put(talus::accuracy_of(tally_, std::uint64_t{rounds_done()} * scenario_.released(), options_.rounds.above));
  talus::Accuracy all;
  for (const std::string& bytes : processes_.gather(mine.bytes())) {
    const auto one = talus::ByteReader(bytes).get<talus::Accuracy>();
    all.half_width = std::max(all.half_width, one.half_width);
    all.cells += one.cells;
  }
  talus::ByteWriter told;
  told.put(all);
  return talus::ByteReader(processes_.tell(told.bytes())).get<talus::Accuracy>();
}

bool RunSession::enough() {
  const talus::Rounds& wanted = options_.rounds;
  const std::uint32_t done = rounds_done();
  if (done == 0) return false;
  if (!simulation_.round_done() && simulation_.position().unit > 0) return false;
  if (!wanted.until_error) return done >= wanted.count;
  return done >= wanted.most || accuracy().half_width < *wanted.until_error;
}
