#pragma once
#include <filesystem>

#include "talus/io/scenario/loaded_scenario.hpp"
#include "talus/products/screen_summary.hpp"

namespace talus::io {

/// Writes `screens.gpkg` (or `.fgb`): the lines of each screen with the figures of its crossings. docs/products.md.
void write_screens(const std::filesystem::path& file, const LoadedScenario& loaded, const ScreenSummary& summary);

}  // namespace talus::io
