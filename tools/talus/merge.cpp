#include "talus/run/merge.hpp"

#include <memory>

#include "commands.hpp"
#include "terminal_observer.hpp"

namespace {

using talus::run::MergeRequest;

int run_merge(MergeRequest request, bool quiet) {
  request.command = command_line();
  TerminalObserver observer(Progress::mode_of(quiet, ""), quiet);
  return exit_code(talus::run::merge(request, observer));
}

}  // namespace

void add_merge(CLI::App& app, Action& action) {
  const auto options = std::make_shared<MergeRequest>();
  const auto quiet = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("merge", "Join the parts of a run; the same bits as one run");
  with(command->add_option("out", options->out, "new folder for the results")->required(), new_folder());
  with(command->add_option("parts", options->parts, "folders that talus run --part I/N has written, all of them")
           ->required(),
       folder_of_results());
  command->add_option("--memory", options->memory, "such as 2G: what does not fit lies in a file beside the results");
  command->add_flag("--overwrite", options->overwrite, "replace the folder if it holds an earlier result");
  add_threads(*command, options->threads);
  add_quiet(*command, *quiet);
  command->footer(
      "Example:\n"
      "  talus run scenario.toml --part 1/2 -o part1\n"
      "  talus run scenario.toml --part 2/2 -o part2\n"
      "  talus merge result part1 part2");
  command->callback([&action, options, quiet] { action = [options, quiet] { return run_merge(*options, *quiet); }; });
}
