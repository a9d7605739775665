#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus::io {

/// "source,block" of each block of a finished run that left the terrain: the rows of `exits.gpkg` or `exits.fgb`, or of
/// a profile those of `stops.csv` that left. Nothing if the folder has none of these files; fewer than run.json
/// counts if a file was changed. Throws InputError if GDAL cannot open the file.
std::optional<std::vector<std::string>> blocks_that_left(const std::filesystem::path& folder);

}  // namespace talus::io
