#pragma once
#include <filesystem>

/// Writes the project of QGIS in a folder of results anew. The results are complete without it: a fault is a warning.
void refresh_project(const std::filesystem::path& folder);
