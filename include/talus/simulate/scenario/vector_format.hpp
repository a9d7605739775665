#pragma once
#include <array>
#include <optional>
#include <string_view>

namespace talus {

/// The format of the layers that a run writes. docs/products.md, "FlatGeobuf".
enum class VectorFormat { GeoPackage, FlatGeobuf };

inline constexpr std::array kVectorFormats{VectorFormat::GeoPackage, VectorFormat::FlatGeobuf};

/// "gpkg" or "fgb": in scenarios, and the ending of its files.
constexpr std::string_view name_of(VectorFormat format) {
  return format == VectorFormat::GeoPackage ? "gpkg" : "fgb";
}

/// The format of a name; nothing if there is none.
constexpr std::optional<VectorFormat> vector_format(std::string_view name) {
  for (const VectorFormat format : kVectorFormats)
    if (name == name_of(format)) return format;
  return std::nullopt;
}

}  // namespace talus
