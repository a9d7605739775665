#pragma once
#include "commands.hpp"

/// Adds `talus help [COMMAND] [--json]`, which prints what `app` can do.
void add_help(CLI::App& app, Action& action);

/// The description of the program, of its commands and of the parameters of a scenario, for other programs.
std::string help_json(const CLI::App& app);
