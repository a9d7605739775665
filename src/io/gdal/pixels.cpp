#include "pixels.hpp"

#include <cmath>
#include <cstdint>

#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"
#include "text_grid.hpp"

namespace talus::io {

std::vector<RasterPart> pieces_of(GDALRasterBand& band, const RasterPart& whole) {
  constexpr int kWide = 2048, kHigh = 1024;  // pixels, where a block has fewer
  int block_columns = 1, block_rows = 1;
  band.GetBlockSize(&block_columns, &block_rows);
  const bool striped = block_columns >= band.GetXSize();
  const int columns = striped ? band.GetXSize() : block_columns * std::max(1, kWide / block_columns);
  int rows = std::clamp(kWide * kHigh / columns, 1, kHigh);
  if (block_rows <= rows)
    rows -= rows % block_rows;
  else if (!striped)  // a strip of many rows stays in the cache while its pieces are read, tiles beside it would not
    rows = block_rows;
  const auto after = [](int place, int side) { return place / side * std::int64_t{side} + side; };
  std::vector<RasterPart> pieces;
  for (int top = whole.top; top < whole.bottom; top = pieces.back().bottom)
    for (int left = whole.left; left < whole.right; left = pieces.back().right)
      pieces.push_back({left, top, static_cast<int>(std::min<std::int64_t>(after(left, columns), whole.right)),
                        static_cast<int>(std::min<std::int64_t>(after(top, rows), whole.bottom))});
  return pieces;
}

PixelFinder::PixelFinder(GDALDataset& dataset, const std::string& path) {
  std::array<double, 6> place{};
  if (dataset.GetGeoTransform(place.data()) != CE_None || GDALInvGeoTransform(place.data(), inverse_.data()) == 0)
    throw InputError(path + ": does not say where it lies (no geotransform): georeference it with " +
                     edit_command(path, "-a_ullr WEST NORTH EAST SOUTH"));
}

double PixelFinder::column(double x, double y) const {
  return std::floor(inverse_[0] + inverse_[1] * x + inverse_[2] * y);
}

double PixelFinder::row(double x, double y) const {
  return std::floor(inverse_[3] + inverse_[4] * x + inverse_[5] * y);
}

NodataBesideMask::NodataBesideMask(GDALRasterBand& band) : single_(band.GetRasterDataType() == GDT_Float32) {
  int given = 0;
  value_ = band.GetNoDataValue(&given);
  given_ = given != 0 && (band.GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA)) == 0;
}

PixelReader::PixelReader(GDALDataset& dataset, std::string path)
    : band_(*dataset.GetRasterBand(1)),
      path_(std::move(path)),
      masked_((band_.GetMaskFlags() & GMF_ALL_VALID) == 0),
      nodata_(band_) {
  check_text_grid(dataset, path_);
}

double PixelReader::at(double column, double row) {
  if (!(column >= 0.0 && row >= 0.0 && column < band_.GetXSize() && row < band_.GetYSize())) return kNotGiven;
  const int x = static_cast<int>(column), y = static_cast<int>(row);
  const std::pair<int, int> key{y / kSide, x / kSide};
  if (tile_ == nullptr || key != key_) {
    if (tiles_.size() >= kTiles && !tiles_.contains(key)) tiles_.clear();
    const auto [found, fresh] = tiles_.try_emplace(key);
    if (fresh) read(key.second * kSide, key.first * kSide, found->second);
    key_ = key;
    tile_ = found->second.data();
  }
  return tile_[static_cast<std::size_t>(y % kSide) * kSide + static_cast<std::size_t>(x % kSide)];
}

void PixelReader::read(int x, int y, std::vector<double>& values) {
  values.resize(std::size_t{kSide} * kSide);
  const int columns = std::min(kSide, band_.GetXSize() - x), rows = std::min(kSide, band_.GetYSize() - y);
  const GSpacing line = kSide * sizeof(double);
  if (band_.RasterIO(GF_Read, x, y, columns, rows, values.data(), columns, rows, GDT_Float64, 0, line, nullptr) !=
          CE_None ||
      (masked_ && band_.GetMaskBand()->RasterIO(GF_Read, x, y, columns, rows, mask_.data(), columns, rows, GDT_Byte, 0,
                                                kSide, nullptr) != CE_None))
    throw InputError(path_ + ": cannot be read: " + messages_.take());
  if (!masked_) return;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (mask_[k] == 0 || nodata_.is(values[k])) values[k] = kNotGiven;
}

}  // namespace talus::io
