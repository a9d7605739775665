#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dataset.hpp"

namespace talus::io {

/// A field of a TIFF directory.
struct TiffTag {
  /// Types of values.
  enum Type : std::uint16_t { Byte = 1, Ascii = 2, Short = 3, Long = 4, Double = 12, Long8 = 16 };

  std::uint16_t number, type;
  std::uint64_t count;
  std::string bytes;  ///< the values, in the byte order of this machine
};

/// A GeoTIFF of a few pixels in the memory of GDAL, to learn what GDAL itself writes of a place, a coordinate system,
/// nodata, names and units of bands. Its values are interleaved by pixel.
class SmallTiff {
 public:
  /// Throws std::runtime_error if GDAL cannot make it.
  SmallTiff(int bands, GDALDataType type);
  ~SmallTiff();
  SmallTiff(const SmallTiff&) = delete;
  SmallTiff& operator=(const SmallTiff&) = delete;

  GDALDataset& dataset() { return *dataset_; }
  /// Closes the file. Returns the tags of its directory. Throws std::runtime_error if GDAL has written something else.
  std::vector<TiffTag> tags();

 private:
  std::string name_;
  Dataset dataset_;
};

}  // namespace talus::io
