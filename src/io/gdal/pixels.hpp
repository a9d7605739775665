#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "dataset.hpp"
#include "talus/terrain/raster.hpp"

namespace talus::io {

/// The pixel of a raster that holds a place.
class PixelFinder {
 public:
  /// Throws InputError if the raster does not say where it lies.
  PixelFinder(GDALDataset& dataset, const std::string& path);

  double column(double x, double y) const;
  double row(double x, double y) const;

 private:
  std::array<double, 6> inverse_{};
};

/// The nodata value that a band declares beside a mask: GDAL then goes by the mask alone.
class NodataBesideMask {
 public:
  explicit NodataBesideMask(GDALRasterBand& band);

  /// Whether a stored value is that one.
  bool is(double stored) const { return given_ && (single_ ? float(stored) == float(value_) : stored == value_); }
  double value() const { return value_; }

 private:
  bool given_ = false, single_;
  double value_ = 0.0;
};

/// Reads single pixels of the first band through a cache of the last tiles of the file.
class PixelReader {
 public:
  /// Throws InputError as `check_text_grid`.
  PixelReader(GDALDataset& dataset, std::string path);

  /// The value of the pixel as stored; NaN if there is none.
  double at(double column, double row);

 private:
  static constexpr int kSide = 256;
  static constexpr std::size_t kTiles = 64;  // 32 MB

  void read(int x, int y, std::vector<double>& values);

  GDALRasterBand& band_;
  std::string path_;
  bool masked_;
  NodataBesideMask nodata_;
  std::map<std::pair<int, int>, std::vector<double>> tiles_;  // by row and column of tiles
  std::pair<int, int> key_{-1, -1};
  const double* tile_ = nullptr;
  std::vector<std::uint8_t> mask_ = std::vector<std::uint8_t>(std::size_t{kSide} * kSide);
  GdalMessages messages_;
};

/// A part of a raster: columns and rows from the north-west, without those at `right` and `bottom`.
struct RasterPart {
  int left = 0, top = 0, right = 0, bottom = 0;

  int columns() const { return right - left; }
  int rows() const { return bottom - top; }
};

/// Cuts a part of a raster into pieces of about two million pixels along the blocks in which the file is packed, whole
/// rows where they are rows: each block is unpacked once, however wide the raster and small the cache of GDAL. From the
/// north-west, row by row of pieces.
std::vector<RasterPart> pieces_of(GDALRasterBand& band, const RasterPart& whole);

/// Visits the cells of a DEM in squares, so that a raster in any direction is read part by part. With a memory limit
/// gives memory back before each square.
template <class Visit>
void in_squares(const Raster<float>& heights, Visit visit) {
  constexpr int kSide = 256;
  const Grid& grid = heights.grid;
  for (int top = grid.rows; top > 0; top -= kSide)
    for (int left = 0; left < grid.columns; left += kSide) {
      heights.values.memory().keep_below_limit();
      for (int row = top - 1; row >= std::max(0, top - kSide); --row)
        for (int column = left; column < std::min(grid.columns, left + kSide); ++column) visit(column, row);
    }
}

}  // namespace talus::io
