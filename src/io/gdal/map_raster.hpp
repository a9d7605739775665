#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dataset.hpp"

namespace talus::io {

/// A part of a raster, for a picture of it in coarser pixels. Rows from the north.
struct MapWindow {
  int column = 0, row = 0;    ///< first cell
  int columns = 0, rows = 0;  ///< cells
  int side = 1;               ///< cells per side of a pixel; the last pixels may hold fewer

  int width() const { return (columns + side - 1) / side; }  ///< pixels
  int height() const { return (rows + side - 1) / side; }
};

/// One value for the cells of a pixel.
enum class PixelValue { Largest, Smallest, Mean };

/// A band of a raster, read part by part: memory for a piece of the file and the pixels that are asked for.
class MapRaster {
 public:
  /// @param band  from 1
  /// Throws InputError if the file is not allowed, cannot be opened, or has no such band.
  MapRaster(const std::string& path, int band);
  /// @param band  its name
  MapRaster(const std::string& path, const std::string& band);

  int columns() const { return band_->GetXSize(); }
  int rows() const { return band_->GetYSize(); }
  int band() const { return band_->GetBand(); }  ///< from 1
  std::string band_name() const { return band_->GetDescription(); }
  std::string unit() const { return band_->GetUnitType(); }
  std::string metadata(const char* key) const;

  /// The pixels of a window, row by row from the north; NaN where no cell has a value.
  std::vector<double> pixels(const MapWindow& window, PixelValue value) const;
  /// The smallest window that holds all cells with a value above 0; nothing if there is none.
  std::optional<MapWindow> positive_cells() const;
  /// Whether any cell has a value above 0. Looks at the smallest overview: those of Talus show the largest value.
  bool any_positive() const;

 private:
  template <class Visit>
  void for_each_value(GDALRasterBand& band, const MapWindow& window, Visit visit) const;

  std::string path_;
  Dataset dataset_;
  GDALRasterBand* band_;
};

}  // namespace talus::io
