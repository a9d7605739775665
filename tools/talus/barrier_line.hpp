#pragma once
#include <optional>
#include <string>
#include <vector>

#include "talus/io/gdal/crossings_file.hpp"
#include "talus/io/results/run_folder.hpp"
#include "talus/products/barrier_design.hpp"

std::vector<std::string> screen_ids(const talus::io::RunSummary& run);

/// The screen of a run at which a barrier stands. Throws InputError if the run kept no crossings, or has no such
/// screen.
///
/// @param folder  of the run;  id: may be empty where the run has one screen only
const talus::Screen& screen_of(const talus::io::RunSummary& run, const std::string& folder, const std::string& id);

/// Share of the screen where the DEM has no height.
double without_height(const talus::io::RunSummary& run, const talus::Screen& screen);

/// Crossings of a screen in a run. Throws InputError if there are none, or the files are not as `talus run` leaves
/// them.
talus::io::CrossingTable simulated_crossings(const talus::io::RunSummary& run, const std::string& folder,
                                             const talus::Screen& screen);

/// How many blocks left the terrain and did not cross the screen; nothing where the run does not tell which ones left.
std::optional<std::size_t> left_without_crossing(const talus::io::RunSummary& run, const std::string& folder,
                                                 const talus::io::CrossingTable& crossings);

/// The rows of a screen in a file of observed crossings. Throws InputError if it has none.
talus::io::CrossingTable observed_crossings(const std::string& file, const std::string& screen);

/// Notes on rows of a file that count nowhere: of screens that the run does not have, where a misspelt name would lose
/// what was observed, and those that repeat a block, where an inspector who gives all one id would lose the others.
std::vector<std::string> notes_on_observed(const talus::io::CrossingTable& observed, const std::string& file,
                                           const talus::io::RunSummary& run);

/// The first crossing of each block and piece, at its place on the line.
std::vector<talus::LineCrossing> first_crossings(const talus::io::CrossingTable& table, const talus::Screen& screen);

/// All crossings of what falls, with those of blocks and pieces that had crossed the line before.
///
/// @param first  their first crossings, weighed, also of what never falls
std::vector<talus::LineCrossing> with_later_ones(std::vector<talus::LineCrossing> first,
                                                 const talus::io::CrossingTable& table, const talus::Screen& screen);
