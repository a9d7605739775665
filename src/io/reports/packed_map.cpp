#include "packed_map.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace talus::io {
namespace {

std::string address_of(const Picture& picture) {
  return "data:image/png;base64," + base64_of(png_of(picture));
}

}  // namespace

std::uint16_t code_of(double value) {
  constexpr int kLowest = -30, kHighest = 41, kMantissas = 900;
  if (!(value >= 0.0) || !std::isfinite(value)) return 0;
  if (value == 0.0) return 1;
  std::array<char, 32> text{};  // "1.23e-05"
  const char* const end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, 2).ptr;
  int exponent = 0;
  std::from_chars(text.data() + (text[5] == '+' ? 6 : 5), end, exponent);
  if (exponent < kLowest) return 1;
  if (exponent > kHighest) return 0;
  const int digits = 100 * (text[0] - '0') + 10 * (text[2] - '0') + (text[3] - '0');
  return static_cast<std::uint16_t>(2 + kMantissas * (exponent - kLowest) + digits - 100);
}

std::string packed_values(std::span<const double> values) {
  std::string bytes(2 * values.size(), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint16_t code = code_of(values[i]);
    bytes[i] = static_cast<char>(code & 255U);
    bytes[values.size() + i] = static_cast<char>(code >> 8U);
  }
  return base64_of(deflated(bytes));
}

std::string picture_of(std::span<const double> values, int width, const MapStyle& style) {
  Picture picture{width, static_cast<int>(values.size()) / width, {}, {{255, 255, 255, 0}}};
  for (const MapClass& one : style.classes) picture.colours.push_back(one.colour);
  picture.pixels.reserve(values.size());
  for (const double value : values) {
    const auto index = style.class_of(value);
    picture.pixels.push_back(index ? static_cast<std::uint8_t>(*index + 1) : std::uint8_t{0});
  }
  return address_of(picture);
}

double light_on(double east, double north) {
  return (0.5 * east - 0.5 * north + std::sqrt(0.5)) / std::sqrt(1.0 + east * east + north * north);
}

std::string relief_of(std::span<const double> heights, int width, double pixel_x, double pixel_y) {
  const int rows = static_cast<int>(heights.size()) / width;
  Picture picture{width, rows, {}, {{255, 255, 255, 0}}};
  for (int grey = 1; grey < 256; ++grey) {
    const auto shade = static_cast<std::uint8_t>(grey);
    picture.colours.push_back({shade, shade, shade, 255});
  }
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < width; ++column) {
      const double here = heights[std::size_t(row) * width + column];
      const auto at = [&](int dx, int dy) {  // the height of a neighbour; beyond the rim, that of the pixel
        const int x = column + dx, y = row + dy;
        const double z = x < 0 || y < 0 || x >= width || y >= rows ? here : heights[std::size_t(y) * width + x];
        return std::isnan(z) ? here : z;
      };
      const double east =
          (at(1, -1) + 2 * at(1, 0) + at(1, 1) - at(-1, -1) - 2 * at(-1, 0) - at(-1, 1)) / (8 * pixel_x);
      const double north =
          (at(-1, -1) + 2 * at(0, -1) + at(1, -1) - at(-1, 1) - 2 * at(0, 1) - at(1, 1)) / (8 * pixel_y);
      const double shade = 90.0 + 165.0 * std::clamp(light_on(east, north), 0.0, 1.0);
      picture.pixels.push_back(std::isnan(shade) ? std::uint8_t{0} : static_cast<std::uint8_t>(shade));
    }
  return address_of(picture);
}

}  // namespace talus::io
