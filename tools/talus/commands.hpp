#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/run/observer.hpp"
#include "talus/simulate/plan/process_group.hpp"

/// What the program does once the command line is understood; returns its exit code.
using Action = std::function<int()>;

/// One subcommand each: adds its options to the program and sets `action` when it is called.
/// @param processes  the processes that do it together; must outlive the action
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
void add_merge(CLI::App& app, Action& action);

/// The options that say which scenario is meant: those of `run` and `check`.
void add_scenario_options(CLI::App& command, talus::io::RunFlags& flags);

using talus::run::Interrupted;  // exit code 130
using talus::run::stop_interrupted;

/// From here on signals that end a program only set the flag that `interrupted` reads, so that no half result is left.
void catch_signals();
bool interrupted();

/// The words that the program was called with.
const std::vector<std::string>& command_line();

/// For options that are numbers with a fraction: from low to high, and a number. (CLI::Range lets "nan" through.)
CLI::Validator between(double low, double high);

/// Throws InputError where a seed is none. (A negative number would else be a huge one.)
void require_seed(std::uint64_t seed);

/// "talus: KIND: TEXT" on stderr, in one line.
void say(const std::string& kind, const std::string& text);
