#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace talus::io {

/// Compresses a tile for a TIFF: DEFLATE after the predictor for its type. Values are interleaved by pixel.
///
/// @param pixels  [row][column][band]
/// @param width   pixels in a row
std::vector<std::byte> compressed_tile(std::span<const float> pixels, std::size_t width, std::size_t bands);
std::vector<std::byte> compressed_tile(std::span<const std::uint32_t> pixels, std::size_t width, std::size_t bands);

/// A complete gzip file of these bytes. Several, one after the other, are a gzip file too.
std::vector<std::byte> gzipped(std::span<const std::byte> bytes);

/// Numbers of the TIFF specification for what `compressed_tile` does.
inline constexpr std::uint16_t kDeflate = 8;
template <class T>
inline constexpr std::uint16_t kPredictor = 0;
template <>
inline constexpr std::uint16_t kPredictor<std::uint32_t> = 2;  ///< differences of whole numbers
template <>
inline constexpr std::uint16_t kPredictor<float> = 3;  ///< differences of the bytes of floating-point numbers

}  // namespace talus::io
