#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace talus::io {

/// Compresses the bytes of a tile for a TIFF (DEFLATE). Without a predictor: values of maps are shares of whole numbers
/// and bounds that follow from them, and equal ones compress better than differences (docs/performance.md).
std::vector<std::byte> deflated(std::span<const std::byte> bytes);

/// Compresses a tile that stands in a file many times: slower than `deflated`, and smaller.
std::vector<std::byte> deflated_well(std::span<const std::byte> bytes);

/// A complete gzip file of these bytes. Several, one after the other, are a gzip file too.
std::vector<std::byte> gzipped(std::span<const std::byte> bytes);

inline constexpr std::uint16_t kDeflate = 8;  ///< number in the TIFF specification of what `deflated` does

}  // namespace talus::io
