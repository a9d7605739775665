#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace talus::io {

/// A colour, with its opacity: 0 is not there.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0, opacity = 255;
};

/// A picture of up to 256 colours.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< indices of `colours`, row by row from the top
  std::vector<Colour> colours;
};

/// The bytes of a PNG file. Throws std::runtime_error if GDAL cannot make it.
std::string png_of(const Picture& picture);

/// Bytes packed in the zlib format (deflate).
std::string deflated(std::string_view bytes);

/// Bytes as text, for a page.
std::string base64_of(std::string_view bytes);

}  // namespace talus::io
