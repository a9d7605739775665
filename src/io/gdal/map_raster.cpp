#include "map_raster.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pixels.hpp"
#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
MapRaster::MapRaster(const std::string& path, int band)
    : path_(path),
      dataset_(open_dataset(path, GDAL_OF_RASTER)),
      band_(band >= 1 && band <= dataset_->GetRasterCount() ? dataset_->GetRasterBand(band) : nullptr) {
  if (band_ == nullptr)
    throw InputError(path + ": has " + std::to_string(dataset_->GetRasterCount()) + " bands, must have band " +
                     std::to_string(band) + ", as talus has written it");
}

MapRaster::MapRaster(const std::string& path, const std::string& band)
    : path_(path), dataset_(open_dataset(path, GDAL_OF_RASTER)), band_(nullptr) {
  for (auto* const candidate : dataset_->GetBands())
    if (band == candidate->GetDescription()) band_ = candidate;
  if (band_ == nullptr) throw InputError(path + ": has no band `" + band + "`, must have it, as talus has written it");
}

std::string MapRaster::metadata(const char* key) const {
  const char* const text = dataset_->GetMetadataItem(key);
  return text == nullptr ? "" : text;
}

/// Calls `visit(column, row, value)` for the cells of a window that have a value.
/// @param band  of the dataset, or an overview of one
template <class Visit>
void MapRaster::for_each_value(GDALRasterBand& band, const MapWindow& window, Visit visit) const {
  GdalMessages messages;
  std::vector<double> values;
  std::vector<std::uint8_t> mask;
  const bool masked = (band.GetMaskFlags() & GMF_ALL_VALID) == 0;
  int given = 0;
  const double scale = band.GetScale(&given), offset = band.GetOffset();
  const RasterPart whole{window.column, window.row, window.column + window.columns, window.row + window.rows};
  for (const RasterPart& part : pieces_of(band, whole)) {
    const int columns = part.columns(), rows = part.rows();
    values.resize(std::size_t(columns) * rows);
    if (masked) mask.resize(values.size());
    if (band.RasterIO(GF_Read, part.left, part.top, columns, rows, values.data(), columns, rows, GDT_Float64, 0, 0,
                      nullptr) != CE_None ||
        (masked && band.GetMaskBand()->RasterIO(GF_Read, part.left, part.top, columns, rows, mask.data(), columns, rows,
                                                GDT_Byte, 0, 0, nullptr) != CE_None))
      throw InputError(path_ + ": cannot be read: " + messages.take());
    for (std::size_t i = 0; i < values.size(); ++i)
      if ((!masked || mask[i] != 0) && std::isfinite(values[i]))
        visit(part.left + static_cast<int>(i % columns), part.top + static_cast<int>(i / columns),
              values[i] * scale + offset);
  }
}

std::vector<double> MapRaster::pixels(const MapWindow& window, PixelValue kind) const {
  std::vector<double> pixels(std::size_t(window.width()) * window.height(), kNotGiven);
  std::vector<std::uint32_t> counts(kind == PixelValue::Mean ? pixels.size() : 0);
  for_each_value(*band_, window, [&](int column, int row, double value) {
    const std::size_t at =
        std::size_t((row - window.row) / window.side) * window.width() + (column - window.column) / window.side;
    double& pixel = pixels[at];
    if (kind == PixelValue::Mean) {
      pixel = counts[at]++ == 0 ? value : pixel + value;
      return;
    }
    if (std::isnan(pixel) || (kind == PixelValue::Largest ? value > pixel : value < pixel)) pixel = value;
  });
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) pixels[i] /= counts[i];
  return pixels;
}

std::optional<MapWindow> MapRaster::positive_cells() const {
  int left = columns(), top = rows(), right = -1, bottom = -1;
  for_each_value(*band_, {0, 0, columns(), rows(), 1}, [&](int column, int row, double value) {
    if (!(value > 0.0)) return;
    left = std::min(left, column);
    right = std::max(right, column);
    top = std::min(top, row);
    bottom = std::max(bottom, row);
  });
  if (right < 0) return std::nullopt;
  return MapWindow{left, top, right - left + 1, bottom - top + 1, 1};
}

bool MapRaster::any_positive() const {
  const int overviews = band_->GetOverviewCount();
  GDALRasterBand& band = overviews > 0 ? *band_->GetOverview(overviews - 1) : *band_;
  bool any = false;
  for_each_value(band, {0, 0, band.GetXSize(), band.GetYSize(), 1},
                 [&any](int, int, double value) { any = any || value > 0.0; });
  return any;
}

}  // namespace talus::io
