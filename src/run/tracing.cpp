#include "tracing.hpp"

#include <algorithm>

#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
#include "talus/io/scenario/plan_checksum.hpp"
#include "talus/run/in_every_process.hpp"
#include "talus/simulate/tally/tally_exchange.hpp"
#include "talus/simulate/tally_of.hpp"

namespace talus::run {

namespace fs = std::filesystem;

std::string command_to_resume(const std::vector<std::string>& command) {
  std::string again = !command.empty() && command.front().ends_with("-mpi") ? "mpirun ... " : "";
  for (const std::string& word : command)
    if (word != "--resume") again += shell_word(word) + " ";
  return again + "--resume";
}

Tracing::Tracing(const RunRequest& request, const RunPlan& plan, const Means& means)
    : request_(request),
      plan_(plan),
      folder_(means.folder),
      observer_(means.observer),
      processes_(means.processes),
      tally_(tally_of(plan.loaded.scenario, plan.rounds.at_most(), means.memory)),
      checkpoints_(opened()),
      sinks_(checkpoint().sinks()),
      simulation_(plan.loaded.scenario, plan.part, plan.rounds.several(), tally_, sinks_, processes_) {
  in_every_process(processes_, [this] { checkpoint().restore(simulation_, tally_); });
  sinks_.progress = [this](double share) { return observer_.progress(share) && !observer_.interrupted(); };
  sinks_.pause = [this] { return seconds_since_checkpoint() > request_.checkpoint; };
}

/// Opens the checkpoint in the folder of the leader, or begins one. Throws InputError if a process does not see the
/// folder or has read other files.
std::vector<Checkpoint> Tracing::opened() const {
  const fs::path work = processes_.tell(folder_ != nullptr ? folder_->work().string() : "");
  const bool found =
      !processes_.tell(processes_.leads() && fs::exists(work / kCheckpointManifest) ? "found" : "").empty();
  const std::string plan = processes_.tell(io::plan_checksum(plan_.loaded));
  std::vector<Checkpoint> checkpoints;
  in_every_process(processes_, [&] {
    if (io::plan_checksum(plan_.loaded) != plan)
      throw InputError(request_.out +
                       ": the processes of the run have read different files, "
                       "must be the same on every machine");
    if (!fs::is_directory(work))
      throw InputError(request_.out +
                       ": its folder cannot be seen by every process, "
                       "must lie on a file system that all machines of the run share");
    if (found)
      checkpoints.push_back(resumed(work));
    else
      checkpoints.emplace_back(work, plan_.loaded, plan_.part, plan_.rounds, processes_);
  });
  return checkpoints;
}

Checkpoint Tracing::resumed(const fs::path& work) const {
  Checkpoint checkpoint = Checkpoint::opened(work, plan_.loaded, true, processes_);
  if (checkpoint.asked() != plan_.rounds)
    throw InputError(request_.out +
                     ": what is kept there was begun with other "
                     "--rounds, --until-error, --above or --most-rounds (" +
                     std::to_string(checkpoint.rounds()) +
                     " rounds are done); give the same, or begin anew (--overwrite)");
  checkpoint.require_part(plan_.part, request_.out);
  return checkpoint;
}

void Tracing::trace(int threads, int lanes) {
  for (bool begins = true; !enough(); begins = false) {
    if (simulation_.round_done()) simulation_.next_round();
    if (plan_.rounds.several() &&
        (begins || simulation_.position().unit == 0))  // a resumed run may begin within a round
      observer_.begin_part("round " + std::to_string(simulation_.position().round + 1));
    all_saved_ = false;
    simulation_.advance(threads, lanes);
    if (in_any_process(simulation_.totals().interrupted || observer_.interrupted())) interrupt();
    if (simulation_.round_done()) checkpoint().end_round(simulation_.position().round);
    if (in_any_process(seconds_since_checkpoint() > request_.checkpoint)) save_checkpoint();
  }
}

Totals Tracing::totals() {
  return checkpoint().totals_of_all(simulation_.totals());
}

void Tracing::save_checkpoint() {
  checkpoint().save(simulation_, tally_);
  if (folder_ != nullptr) folder_->keep();
  saved_at_ = Clock::now();
  all_saved_ = true;
}

void Tracing::save_before_writing() {
  constexpr double kMuch = 30.0;  // s; less than that is traced again sooner than it is saved
  const bool needed = processes_.size() > 1 || seconds_since_checkpoint() > kMuch;
  if (!checkpoint().empty() && !all_saved_ && needed) save_checkpoint();
}

void Tracing::interrupt() {
  if (simulation_.position().unit == 0 && simulation_.position().round == 0) stop_interrupted();
  if (!all_saved_) save_checkpoint();
  throw Interrupted("interrupted; the work so far is saved, resume with: " + command_to_resume(request_.command));
}

void Tracing::interrupt_writing() {
  if (processes_.size() == 1) interrupt();
  if (checkpoint().empty()) stop_interrupted();
  throw Interrupted("interrupted; resume from the last save with: " + command_to_resume(request_.command));
}

Accuracy Tracing::accuracy() {
  share_out(tally_, processes_);
  ByteWriter mine;
  mine.put(accuracy_of(tally_, std::uint64_t{rounds_done()} * plan_.loaded.scenario.released(), plan_.rounds.above));
  Accuracy all;
  for (const std::string& bytes : processes_.gather(mine.bytes())) {
    const auto one = ByteReader(bytes).get<Accuracy>();
    all.half_width = std::max(all.half_width, one.half_width);
    all.cells += one.cells;
  }
  ByteWriter told;
  told.put(all);
  return ByteReader(processes_.tell(told.bytes())).get<Accuracy>();
}

bool Tracing::enough() {
  const Rounds& wanted = plan_.rounds;
  const std::uint32_t done = rounds_done();
  if (done == 0) return false;
  if (!simulation_.round_done() && simulation_.position().unit > 0) return false;
  if (!wanted.until_error) return done >= wanted.count;
  return done >= wanted.most || accuracy().half_width < *wanted.until_error;
}

}  // namespace talus::run
