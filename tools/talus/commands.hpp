#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "facts.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/run/observer.hpp"
#include "talus/simulate/plan/process_group.hpp"

/// The work of a subcommand; returns the exit code of the program.
using Action = std::function<int()>;

/// Each adds one subcommand with its options to the program. The subcommand sets `action` if the command line calls it.
/// @param processes  processes that share the run; must outlive the action
void add_run(CLI::App& app, Action& action, talus::ProcessGroup& processes);
void add_check(CLI::App& app, Action& action);
void add_profile(CLI::App& app, Action& action);
void add_presets(CLI::App& app, Action& action);
void add_barrier(CLI::App& app, Action& action);
void add_trace(CLI::App& app, Action& action);
void add_calibrate(CLI::App& app, Action& action);
void add_diagnose(CLI::App& app, Action& action);
void add_score(CLI::App& app, Action& action);
void add_sources(CLI::App& app, Action& action);
void add_hazard(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);

/// Adds the options of `run` and `check` that give the scenario.
void add_scenario_options(CLI::App& command, talus::io::RunFlags& flags);

/// Adds --progress, `machine` or `json`. With `json` every message of `say` becomes a line {"warning": "..."}.
void add_progress(CLI::App& command, std::string& progress);

/// Adds --threads, --quiet, --surface or --effect with the text that they have in most commands.
void add_threads(CLI::App& command, int& threads);
void add_quiet(CLI::App& command, bool& quiet);
void add_surface(CLI::App& command, std::optional<std::string>& surface);
void add_effects(CLI::App& command, std::vector<std::string>& effects);

using talus::run::Interrupted;  // exit code 130
using talus::run::stop_interrupted;

/// Until this is called, a signal ends the program at once, also while it reads: nothing has been written. From now on
/// signals only set the flag that `interrupted` reads, so that no half result is left.
void catch_signals();
bool interrupted();

/// Words of the command line.
const std::vector<std::string>& command_line();

/// Check of an option with a fraction: a number from low to high. (CLI::Range lets "nan" through.)
CLI::Validator between(double low, double high);

/// Check of an option with a seed: a whole number within its bounds. (CLI11 turns -1 into a huge number.)
CLI::Validator seed_number();

/// Check of an option with a number of threads: 1 to 4096, and as many can be started. Under a limit of memory or of
/// processes the library of threads would end the program without an error of ours.
CLI::Validator startable_threads();

/// Check of an option with a number of lanes: 1, 4 or 8, and no more than the processor has.
CLI::Validator lanes_of_machine();

/// The only ways to write on the terminal: each shows control characters of names instead of sending them
/// (`printable`). tests/layers.cmake holds the programs to them.

/// "talus: KIND: TEXT" on stderr, in one line, which is cut if it is very long; with --progress=json {"KIND": "TEXT"},
/// where an empty kind is "message".
void say(const std::string& kind, const std::string& text);

/// On stdout: a text as it is, or as printf formats it.
void print_text(const std::string& text);
[[gnu::format(printf, 1, 2)]] void print(const char* format, ...);
