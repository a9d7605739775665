#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "map_style.hpp"

/// Values of a map as a page holds them. docs/report.md, "Values behind the click".
namespace talus::io {

/// A value of three significant digits in 16 bits: 0 no value, 1 zero, else 2 + 900 (exponent + 30) + (digits - 100)
/// for digits * 10^(exponent - 2). No value: NaN, infinite, below 0, above 9.99e41; smaller than 1e-30: zero.
std::uint16_t code_of(double value);

/// The codes of values: first their low bytes, then their high bytes, packed by zlib, as base64.
std::string packed_values(std::span<const double> values);

/// A picture of the classes of a style, as a `data:` address of a PNG; what has no class is transparent.
std::string picture_of(std::span<const double> values, int width, const MapStyle& style);

/// Cosine of the angle between a slope and the light from the north-west, 45 degrees high.
/// @param east, north  how much the slope rises that way [m/m]
double light_on(double east, double north);

/// Shaded relief, lit by `light_on`, as a `data:` address. Rows from the north.
/// @param pixel_x, pixel_y  [m]
std::string relief_of(std::span<const double> heights, int width, double pixel_x, double pixel_y);

}  // namespace talus::io
