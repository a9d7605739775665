#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace talus::io {

/// Beginning of what a page of ours says that made it (its `generator`): "talus report".
inline const std::string kPageMark = "talus ";

/// Whether a file is the design (barrier_ID.json) that `talus barrier` has written.
bool is_design(const std::filesystem::path& file);

/// The ends of the names of the files of a design, after "barrier_ID"; the first one says that the others are ours.
inline constexpr std::array<std::string_view, 4> kOfDesign{".json", ".csv", "_stretches.csv", ".gpkg"};

/// The files of all designs in a folder that are there.
std::vector<std::string> files_of_designs(const std::filesystem::path& folder);

/// Whether a file is a page that `talus report` has written.
bool is_run_page(const std::filesystem::path& file);

/// The files and folders in a folder of results that Talus has not written there, in the order of their names; folders
/// end in "/". Talus's own are:
///   what the records run.json, hazard.json, compare.json and part.json list, and the records;
///   the files of `barrier`, `calibrate`, `diagnose`, with the folders of their campaigns; the page of `report`;
///   what readers leave beside one of these, or beside a raster that is gone (`read_file_of`).
std::vector<std::string> foreign_in(const std::filesystem::path& folder);

/// Files that `hazard`, `barrier` and `report` have added to the results of a run.
std::vector<std::string> later_results(const std::filesystem::path& folder);

/// The file X beside which a reader leaves a file of this name: X.aux.xml, X.ovr, X-wal, X-shm, X-journal; empty where
/// it is no such name.
std::string read_file_of(const std::string& name);

/// Removes what readers have left beside a file (`read_file_of`), before another file gets its name: SQLite takes the
/// log of an earlier GeoPackage for one of the new file, and damages it.
/// @param but  names of files that stay
void remove_beside(const std::filesystem::path& file, const std::vector<std::string>& but = {});

/// The files that a record of results lists in `files`, by their names alone.
std::vector<std::string> files_of_record(const std::filesystem::path& record);

}  // namespace talus::io
