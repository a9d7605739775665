#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "talus/base/bounds.hpp"

/// What `talus help --json` says of an option beyond what CLI11 knows of it (name, text, choices, whether it is
/// required or a list). Given where the option is declared, so that there is one description of every option.
struct Facts {
  std::string unit;               ///< "m"; empty: none
  double low = talus::kNotGiven;  ///< bounds; NaN: none, or those of the option's check
  double high = talus::kNotGiven;
  bool above_low = false;                 ///< the lower bound itself is not allowed
  bool below_high = false;                ///< the upper bound itself is not allowed
  std::string standard;                   ///< value where the option is not given; empty: the one that CLI11 holds
  std::string type;                       ///< "file" or "folder"; empty: as CLI11 reads it
  std::vector<std::string> holds;         ///< of a file: raster, vector, toml, csv
  bool written = false;                   ///< the file or folder is written
  std::vector<std::string> choices = {};  ///< of a text; empty: those of the option's check
};

/// Attaches facts to an option.
CLI::Option* with(CLI::Option* option, Facts facts);

/// The facts of an option; empty ones if none are attached.
const Facts& facts_of(const CLI::Option& option);

/// Facts of a file that is read, and of files and folders that are written.
Facts file_of(std::vector<std::string> holds);
Facts new_file_of(std::vector<std::string> holds);
Facts folder_of_results();
Facts new_folder();

/// Facts of a number with these bounds.
Facts number_of(const talus::Bounds& bounds, std::string standard = {});

/// Facts of a scalar of a scenario, "seed", with its bounds and default.
Facts scalar_of(std::string_view key);

/// Facts of an option that has this value where it is not given.
Facts default_of(double value);
Facts default_of(std::string value);
Facts with_unit(std::string unit, double value);

/// Facts of the choice of a surface, of a format of layers, and of a preset.
/// @param standard  the preset where none is given
Facts surface_choice();
Facts vectors_choice();
Facts preset_choice(std::string_view standard);
/// A number of lanes.
Facts lane_choice();
