#pragma once
#include "commands.hpp"

/// Common parts of the programs talus and talus-mpi.

enum ExitCode { kDone = 0, kFailed = 1, kWrongInput = 2, kInterrupted = 130 };

using AddCommand = std::function<void(CLI::App& app, Action& action)>;

/// Sets up memory, signals and `command_line`. Call it first.
void begin_program(int argc, char** argv);

/// The action that the command line asks for. --help and --version are printed at once; their action does nothing more.
/// Throws InputError.
Action understood(int argc, char** argv, const std::vector<AddCommand>& commands);

/// Runs `program`, reports what it throws, and returns the exit code.
int exit_code_of(const std::function<int()>& program);
