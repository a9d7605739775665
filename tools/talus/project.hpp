#pragma once
#include <filesystem>

/// Writes the project of QGIS in a folder of results anew. The results are complete without it: a fault is a warning.
void refresh_project(const std::filesystem::path& folder);

/// Says that a report.html in a folder of results shows what was there before; nothing without one.
void say_old_report(const std::filesystem::path& folder);
