#pragma once
#include "commands.hpp"

/// What the programs talus and talus-mpi have in common.

enum ExitCode { kDone = 0, kFailed = 1, kWrongInput = 2, kInterrupted = 130 };

using AddCommand = std::function<void(CLI::App& app, Action& action)>;

/// First of all: signals, and what `command_line` says.
void begin_program(int argc, char** argv);

/// What the command line asks for; where that is --help, it has been given. Throws InputError.
Action understood(int argc, char** argv, const std::vector<AddCommand>& commands);

/// Runs it, and says what it throws.
int exit_code_of(const std::function<int()>& program);
