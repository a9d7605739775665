#pragma once
#include <string>
#include <vector>

#include "talus/base/text.hpp"
#include "talus/products/maps.hpp"

/// Words, bands and legends that entries of both tables of rasters have (`raster_table`, `hazard_table`).
namespace talus {

inline constexpr const char* kAnyHeightText = "at any height";

inline std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  return at == std::string::npos ? text : text.replace(at, part.size(), by);
}

/// The words for the height at which passages count. @param below  [m]; 0: at any height
inline std::string with_height(const std::string& text, double below) {
  return below > 0.0 ? replaced(text, kAnyHeightText, "lower than " + text_of(below) + " m above the terrain") : text;
}

inline Legend energy_legend(const std::string& band) {
  return {{30, 100, 300, 1000, 3000}, 1.0, "kJ", Palette::Plasma, band};
}

inline std::vector<Map::Band> bounded_bands(const std::string& name, const std::string& unit) {
  return {{name, unit}, {"lower 95 % bound", unit}, {"upper 95 % bound", unit}};
}

}  // namespace talus
