#pragma once
#include <span>
#include <string>
#include <vector>

#include "talus/fit/campaign/campaign.hpp"

namespace talus::io {

// Warnings of values that are in bounds and cannot be right: mostly another unit. docs/closing-the-loop.md, "Warnings".

/// Factor from which the mass of one block contradicts its axes or its diameter: a cuboid has 1.9 times the volume of
/// the ellipsoid in it.
inline constexpr double kMassFactor = 3.0;

/// Warns once if masses contradict axes and density: a mass in tonnes, axes in cm. Spheres of their mass never do.
void warn_of_masses(const std::string& path, std::span<const MeasuredBlock> blocks, std::vector<std::string>& warnings);
/// Warns if masses are those of the diameters beside them times a factor.
///
/// @param ratios  of the masses to those of spheres of the diameters
void warn_of_diameters(const std::string& path, std::vector<double> ratios, std::vector<std::string>& warnings);
/// Warns if the median block is larger or smaller than those that are measured in the field.
void warn_of_median(const std::string& path, std::span<const MeasuredBlock> blocks, std::vector<std::string>& warnings);

/// Height of a release above the ground from which it is doubted [m]: the relief of the DEM, at least 10 m and at most
/// 50 m.
double doubted_height(const Raster<float>& heights);
/// Warns of releases that are high above the ground, or point upwards out of it.
void warn_of_releases(const std::string& path, const Campaign& campaign, std::vector<std::string>& warnings);
/// Warns of blocks whose place of rest is higher than their release lets them get.
void warn_of_rises(const std::string& path, const Campaign& campaign, std::vector<std::string>& warnings);
/// Warns of errors of measurement that are large beside the spread of what was measured.
///
/// @param path  of campaign.toml
void warn_of_errors(const std::string& path, const Campaign& campaign, std::vector<std::string>& warnings);

}  // namespace talus::io
