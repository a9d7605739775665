#include "talus/run/run_session.hpp"

#include <omp.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <functional>

#include "results.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/io/scenario/plan_checksum.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/run/in_every_process.hpp"
#include "talus/run/memory_limit.hpp"
#include "talus/run/summary.hpp"
#include "talus/simulate/tally/tally_exchange.hpp"
#include "tracing.hpp"

namespace talus::run {

namespace fs = std::filesystem;

namespace {

/// The part from the text "I/N"; the whole run from none.
Part part_of(const std::optional<std::string>& given) {
  Part part;
  if (!given) return part;
  const std::string& text = *given;
  char end = '\0';
  const bool digits = text.find_first_not_of("0123456789/") == std::string::npos;  // %u takes a sign and spaces, too
  if (!digits || std::sscanf(text.c_str(), "%9u/%9u%c", &part.number, &part.of, &end) != 2 || part.number < 1 ||
      part.number > part.of)
    throw InputError("--part '" + text + "': must be I/N with I from 1 to N, for example 2/3");
  return part;
}

/// Throws InputError for more than 1e9 blocks of a source cell: they are numbered with 32 bits.
void check_number(const Rounds& rounds, const Scenario& scenario) {
  const std::uint32_t rounds_at_most = rounds.at_most();
  if (std::uint64_t{scenario.trajectories} * rounds_at_most > 1'000'000'000)
    throw InputError(
        std::to_string(rounds_at_most) + " rounds of trajectories = " + std::to_string(scenario.trajectories) +
        ": are more than 1e9 blocks of a source cell; give fewer --rounds, --most-rounds or --trajectories");
}

int threads_of(int asked, const ProcessGroup& processes) {
  if (asked > 0) return asked;
  return processes.size() > 1 ? 1 : omp_get_num_procs();
}

}  // namespace

RunSession::RunSession(RunRequest request, Observer& observer, ProcessGroup& processes)
    : request_(std::move(request)),
      observer_(observer),
      processes_(processes),
      threads_(threads_of(request_.threads, processes)) {}

RunSession::~RunSession() = default;

Outcome RunSession::run() {
  load(check_request());
  observer_.inputs_read();
  if (processes_.largest(observer_.interrupted() ? 1 : 0) > 0) stop_interrupted();
  if (const std::optional<Outcome> done = outcome_of_done()) return *done;
  make_folder();
  warn_of_input();
  begin_record();
  trace();
  return deliver();
}

/// @return the limit of memory [byte]; 0: none
std::size_t RunSession::check_request() {
  std::size_t memory = 0;
  in_every_process(processes_, [&] {
    plan_.part = part_of(request_.part);
    plan_.rounds = request_.rounds;
    if (plan_.rounds.until_error && request_.part)
      throw InputError(
          "--until-error with --part: one part cannot know the error of all; give every part the same --rounds, and "
          "talus merge says what was reached");
    memory = memory_limit_of(request_.memory, threads_);
  });
  return memory;
}

/// Reads and checks the input, the leader first: if it is wrong, only the leader has read it. The processes of a
/// machine share one copy of the terrain. With a limit of memory each has a copy in a file of its own.
void RunSession::load(std::size_t memory) {
  std::optional<SharedMemory> shared;
  const std::string name = "talus-" + std::to_string(getpid()) + "-" + std::to_string(std::time(nullptr));
  if (processes_.size() > 1 && memory == 0) shared.emplace(processes_.tell(name));
  for (const bool leaders_turn : {true, false})
    in_every_process(processes_, [&] {
      if (processes_.leads() == leaders_turn) read_plan(memory, shared ? &*shared : nullptr);
    });
}

void RunSession::read_plan(std::size_t memory, SharedMemory* shared) {
  scratch_ = scratch_file_beside(request_.out, memory);
  plan_.loaded = io::load_scenario(request_.flags, nullptr, {this->memory(), shared}, threads_);
  check_number(plan_.rounds, plan_.loaded.scenario);
}

/// The outcome of a run or part that `resume` finds done: a scheduler may start it again. Nothing if it is not done.
/// Throws InputError if the folder holds a part of another plan.
std::optional<Outcome> RunSession::outcome_of_done() {
  std::optional<Outcome> outcome;
  in_every_process(processes_, [&] {
    if (processes_.leads() && request_.resume && !request_.overwrite) outcome = find_done();
  });
  const auto largest = static_cast<int>(processes_.largest(outcome ? static_cast<std::uint64_t>(*outcome) + 1 : 0));
  if (largest == 0) return {};
  outcome = static_cast<Outcome>(largest - 1);
  if (!processes_.leads()) return outcome;
  if (*outcome == Outcome::TooManyLimits)
    observer_.error("the run is done, but too many trajectories ended at a limit: " + request_.out);
  else
    observer_.message((request_.part ? "part " + *request_.part : "the run") + " is done: " + request_.out);
  return outcome;
}

std::optional<Outcome> RunSession::find_done() const {
  if (!request_.part) {
    const auto status = io::status_of_result(request_.out, io::plan_checksum(plan_.loaded), plan_.rounds);
    const fs::path out = request_.out;
    if (!status && fs::exists(out / "run.json") && !fs::exists(out / io::OutputFolder::kWork))
      throw InputError(request_.out +
                       ": holds a finished run that is not this one (the scenario, a flag or a file is not what it "
                       "was); give a new name, --overwrite --resume to go on with an interrupted run that was to "
                       "replace it, or --overwrite to begin anew");
    if (!status) return {};
    std::error_code ignored;  // a run killed at its very end may have left its checkpoint
    fs::remove_all(out / io::OutputFolder::kWork, ignored);
    return *status == io::kComplete ? Outcome::Done : Outcome::TooManyLimits;
  }
  if (!fs::exists(fs::path(request_.out) / kCheckpointManifest)) return {};
  const auto checkpoint = Checkpoint::opened(request_.out, plan_.loaded, false);
  checkpoint.require_part(plan_.part, request_.out);
  if (checkpoint.asked() != plan_.rounds) return {};
  if (!checkpoint.between_rounds() || checkpoint.rounds() != plan_.rounds.count) return {};
  return Outcome::Done;
}

void RunSession::make_folder() {
  using Unfinished = io::OutputFolder::Unfinished;
  in_every_process(processes_, [&] {
    if (!processes_.leads()) return;
    folder_ = std::make_unique<io::OutputFolder>(request_.out, request_.overwrite,
                                                 request_.resume ? Unfinished::Resume : Unfinished::Refuse);
    for (const io::InputFile& input : plan_.loaded.inputs)  // scenario.toml of an earlier run may be replaced
      if (fs::path(input.path) != folder_->final_path() / "scenario.toml") folder_->protect(input.path);
    if (request_.resume && !request_.part && !fs::exists(folder_->work() / kCheckpointManifest))
      observer_.message("note: nothing is saved that could be resumed in " + request_.out + ": the run begins");
    say_later_results(*folder_, observer_);
  });
}

void RunSession::warn_of_input() {
  for (const std::string& note : plan_.loaded.notes) observer_.message(note);
  const auto low_c = io::coefficient_note(plan_.loaded);
  if (low_c) observer_.message("note: " + *low_c);
  for (const std::string& warning : plan_.loaded.warnings) observer_.warning(warning);
  const Rounds& rounds = plan_.rounds;
  const std::uint64_t all = plan_.loaded.scenario.released() * (rounds.until_error ? 1 : rounds.count);
  if (const auto warning = many_trajectories_warning(all, plan_.part.of)) observer_.warning(*warning);
  const std::size_t sources = plan_.loaded.scenario.sources.size();
  if (request_.part && plan_.part.first(sources) == plan_.part.end(sources))
    observer_.warning("--part " + *request_.part + " is empty: the plan has " + count_text(sources) + " source cells");
}

void RunSession::begin_record() {
  record_.command = request_.command;
  record_.plan = io::plan_checksum(plan_.loaded);
  record_.warnings = plan_.loaded.warnings;
  record_.threads = threads_ * processes_.size();
  record_.ranks = processes_.size();
  record_.lanes = lanes_in(plan_.loaded.scenario.world(), request_.lanes);
}

void RunSession::trace() {
  observer_.begin(plan_.loaded.scenario.released());
  tracing_ = std::make_unique<Tracing>(request_, plan_, Tracing::Means{folder_.get(), observer_, processes_, memory()});
  if (!tracing_->checkpoint().empty())
    observer_.message("going on: " + count_text(tracing_->traced()) + " trajectories were kept");
  const Stopwatch::Lap read = watch_.lap();
  record_.cpu.read = read.cpu;
  record_.wall.read = read.wall;
  with_hint([&] { tracing_->trace(threads_, request_.lanes); });
  const Stopwatch::Lap simulated = watch_.lap();
  record_.totals = tracing_->totals();
  record_.cpu.simulate = record_.totals.cpu_seconds - record_.totals.sink_cpu_seconds;
  record_.wall.simulate = simulated.wall;
  if (plan_.rounds.several()) record_.rounds = {tracing_->rounds_done(), plan_.rounds, tracing_->accuracy()};
}

/// Runs `work`; on failure (a full disk) adds to the error the command that resumes from the checkpoint.
void RunSession::with_hint(const std::function<void()>& work) {
  try {
    work();
  } catch (const Interrupted&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    if (tracing_->checkpoint().empty()) throw;
    throw std::runtime_error(std::string(error.what()) +
                             "; resume from the last save with: " + command_to_resume(request_.command));
  }
}

/// The leader writes the results; the others wait until it tells them how that ended.
Outcome RunSession::deliver() {
  if (request_.part) {
    tracing_->save_checkpoint();
  } else {
    tracing_->save_before_writing();
    collect(tracing_->tally(), processes_);
  }
  constexpr int kInterrupted = -1;
  int ended = 0;
  Interrupted interruption("interrupted");
  try {
    if (processes_.leads())
      with_hint([&] { ended = static_cast<int>(request_.part ? deliver_part() : deliver_results()); });
  } catch (const Interrupted& thrown) {
    interruption = thrown;
    ended = kInterrupted;
  }
  ended = std::stoi(processes_.tell(std::to_string(ended)));
  if (ended == kInterrupted) throw Interrupted(interruption);
  return static_cast<Outcome>(ended);
}

/// Gives the folder of a part its name: the checkpoint is the result.
Outcome RunSession::deliver_part() {
  folder_->commit_work();
  observer_.finish();
  observer_.message("part " + *request_.part + ": " + count_text(record_.totals.released) +
                    " trajectories; results are in " + folder_->final_path().string() +
                    "; talus merge joins the parts");
  return Outcome::Done;
}

/// Writes the results of a whole run and gives the folder its name. OUT/scenario.toml has the trajectories of all
/// rounds; so has the plan from here on.
Outcome RunSession::deliver_results() {
  io::LoadedScenario& loaded = plan_.loaded;
  const std::uint32_t rounds = tracing_->rounds_done();
  tracing_->tally().set_rounds(rounds);
  tracing_->checkpoint().recall(loaded, rounds);
  record_.warnings = loaded.warnings;
  io::set_rounds(loaded, rounds);
  try {
    write_results({loaded, tracing_->checkpoints(), tracing_->tally(), folder_->temporary(), folder_->final_path()},
                  observer_, watch_, record_);
  } catch (const Interrupted&) {
    tracing_->interrupt_writing();
  }
  if (observer_.interrupted()) tracing_->interrupt_writing();
  folder_->commit();
  summarise(record_, loaded, loaded.warnings.size(), folder_->final_path(), observer_);
  return judge_limits(record_.totals, folder_->final_path(), observer_);
}

}  // namespace talus::run
