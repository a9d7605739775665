#include "map_bands.hpp"

#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"

namespace talus::io {

MapBands::MapBands(const std::string& path, int columns, int rows)
    : path_(path), dataset_(open_dataset(path, GDAL_OF_RASTER)) {
  if (dataset_->GetRasterXSize() != columns || dataset_->GetRasterYSize() != rows)
    throw InputError(path + ": has " + std::to_string(dataset_->GetRasterXSize()) + " x " +
                     std::to_string(dataset_->GetRasterYSize()) + " cells, must have those of the run, " +
                     std::to_string(columns) + " x " + std::to_string(rows));
  if (const char* const title = dataset_->GetMetadataItem("TITLE")) title_ = title;
  for (auto* const band : dataset_->GetBands()) {
    bands_.push_back({band->GetDescription(), band->GetUnitType()});
    nodata_.push_back(band->GetNoDataValue());
  }
}

std::vector<double> MapBands::read(const CellWindow& window) {
  const auto bands = static_cast<int>(bands_.size());
  std::vector<double> values(window.cells() * bands_.size());
  const GSpacing cell = GSpacing{sizeof(double)} * bands, row = cell * window.columns;
  // GDAL begins in the north, a window in the south: the rows are filled from the last one backwards.
  double* const north = values.data() + (window.cells() - static_cast<std::size_t>(window.columns)) * bands_.size();
  {
    const std::scoped_lock lock(mutex_);
    GdalMessages messages;
    if (dataset_->RasterIO(GF_Read, window.column, dataset_->GetRasterYSize() - window.row - window.rows,
                           window.columns, window.rows, north, window.columns, window.rows, GDT_Float64, bands, nullptr,
                           cell, -row, sizeof(double), nullptr) != CE_None)
      throw InputError(path_ + ": cannot be read: " + messages.take());
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] == nodata_[i % nodata_.size()]) values[i] = kNotGiven;
  return values;
}

}  // namespace talus::io
