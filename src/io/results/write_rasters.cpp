#include "talus/io/results/write_rasters.hpp"

#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "io/gdal/cause_of_failure.hpp"
#include "io/gdal/dataset.hpp"
#include "talus/base/expect.hpp"
#include "talus/base/version.hpp"
#include "talus/io/files/output_folder.hpp"

namespace talus::io {

namespace fs = std::filesystem;

namespace {

constexpr int kStripe = 64;  // rows in memory

/// Side of the blocks of the finished file; overviews go down to one block.
int block_size(const MapTarget& target) {
  const int size = std::max(target.columns, target.rows);
  return size > 256 ? 512 : size > 128 ? 256 : 128;  // a small map is not filled up to a large block
}

void require(bool good, const char* what) {
  if (!good) throw std::runtime_error(what);
}

GDALDriver* driver(const char* name) {
  GDALDriver* found = GetGDALDriverManager()->GetDriverByName(name);
  if (found == nullptr) throw std::runtime_error(std::string("this GDAL has no driver ") + name);
  return found;
}

/// Value of a cell as it is stored in the file.
template <class T>
T stored(double value);
template <>
float stored<float>(double value) {
  return std::isnan(value) ? static_cast<float>(kNodata) : static_cast<float>(value);
}
template <>
std::uint32_t stored<std::uint32_t>(double value) {
  return std::isnan(value) ? kCountNodata : static_cast<std::uint32_t>(std::min(value, kCountNodata - 1.0));
}

/// The larger of two stored values; nodata is less than any other.
float larger(float a, float b) {
  return std::max(a, b);
}
std::uint32_t larger(std::uint32_t a, std::uint32_t b) {
  return std::max(a + 1U, b + 1U) - 1U;
}  // kCountNodata + 1 is 0

/// The smaller of two stored values; nodata only if both are.
float smaller(float a, float b) {
  const auto nodata = static_cast<float>(kNodata);
  return a == nodata ? b : b == nodata ? a : std::min(a, b);
}
std::uint32_t smaller(std::uint32_t a, std::uint32_t b) {
  return std::min(a, b);
}

template <class T>
constexpr GDALDataType kType = std::is_same_v<T, float> ? GDT_Float32 : GDT_UInt32;

template <class T>
void transfer(GDALRasterBand* band, GDALRWFlag direction, int row, int rows, T* values) {
  const int columns = band->GetXSize();
  require(band->RasterIO(direction, 0, row, columns, rows, values, columns, rows, kType<T>, 0, 0, nullptr) == CE_None,
          "cannot be written");
}

/// Asks the map for its rows, from the north, and writes them. False if `proceed` ended it.
template <class T>
bool fill(GDALDataset& file, const Map& map, const MapTarget& target) {
  TALUS_EXPECT(file.GetRasterCount() == static_cast<int>(map.bands.size()), "a file has the bands of its map");
  const auto columns = static_cast<std::size_t>(target.columns);
  const std::size_t band_size = columns * kStripe;
  std::vector<double> row(map.bands.size() * columns);
  std::vector<T> stripe(map.bands.size() * band_size);
  for (int top = 0; top < target.rows; top += kStripe) {
    const int count = std::min(kStripe, target.rows - top);
    for (int i = 0; i < count; ++i) {
      map.fill_row(target.rows - 1 - (top + i), row);
      for (std::size_t band = 0; band < map.bands.size(); ++band)
        std::transform(&row[band * columns], &row[band * columns] + columns,
                       &stripe[band * band_size + static_cast<std::size_t>(i) * columns], stored<T>);
    }
    for (std::size_t band = 0; band < map.bands.size(); ++band)
      transfer(file.GetRasterBand(static_cast<int>(band) + 1), GF_Write, top, count, &stripe[band * band_size]);
    if (target.proceed && !target.proceed()) return false;
  }
  return true;
}

/// Writes the overview `to`, half as wide and high as `from`: each pixel has the largest or the smallest of the values
/// under it.
template <class T>
void halve(GDALRasterBand* from, GDALRasterBand* to, bool smallest) {
  const auto chosen = [smallest](T a, T b) { return smallest ? smaller(a, b) : larger(a, b); };
  const int wide = from->GetXSize(), narrow = to->GetXSize();
  std::vector<T> fine(static_cast<std::size_t>(wide) * 2 * kStripe), coarse(static_cast<std::size_t>(narrow) * kStripe);
  for (int top = 0; top < to->GetYSize(); top += kStripe) {
    const int count = std::min(kStripe, to->GetYSize() - top);
    const int fine_count = std::min(2 * count, from->GetYSize() - 2 * top);
    transfer(from, GF_Read, 2 * top, fine_count, fine.data());
    for (int y = 0; y < count; ++y) {
      const T* upper = &fine[static_cast<std::size_t>(2 * y) * static_cast<std::size_t>(wide)];
      const T* lower = 2 * y + 1 < fine_count ? upper + wide : upper;
      T* out = &coarse[static_cast<std::size_t>(y) * static_cast<std::size_t>(narrow)];
      for (int x = 0; x < narrow; ++x) {
        const int left = 2 * x, right = std::min(left + 1, wide - 1);
        out[x] = chosen(chosen(upper[left], upper[right]), chosen(lower[left], lower[right]));
      }
    }
    transfer(to, GF_Write, top, count, coarse.data());
  }
}

template <class T>
void add_overviews(GDALDataset& file, int block, bool smallest) {
  std::vector<int> factors;
  for (int size = std::max(file.GetRasterXSize(), file.GetRasterYSize()), factor = 2; size > block; factor *= 2) {
    factors.push_back(factor);
    size = (size + 1) / 2;
  }
  if (factors.empty()) return;
  require(file.BuildOverviews("NONE", static_cast<int>(factors.size()), factors.data(), 0, nullptr, nullptr, nullptr,
                              nullptr) == CE_None,
          "its overviews cannot be made");
  for (int b = 1; b <= file.GetRasterCount(); ++b) {
    GDALRasterBand* from = file.GetRasterBand(b);
    for (int level = 0; level < static_cast<int>(factors.size()); ++level) {
      GDALRasterBand* to = file.GetRasterBand(b)->GetOverview(level);
      require(to != nullptr, "its overviews cannot be made");
      halve<T>(from, to, smallest);
      from = to;
    }
  }
}

void describe(GDALDataset& file, const Map& map, const MapTarget& target) {
  const GeoReference& geo = target.geo;
  double transform[6] = {geo.west, geo.cell_x, 0.0, geo.north, 0.0, -geo.cell_y};
  file.SetGeoTransform(transform);
  OGRSpatialReference system;
  if (!geo.crs_wkt.empty() && system.importFromWkt(geo.crs_wkt.c_str()) == OGRERR_NONE) {
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    file.SetSpatialRef(&system);
  }
  file.SetMetadataItem("AREA_OR_POINT", "Area");
  file.SetMetadataItem("TITLE", map.title.c_str());
  file.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", map.title.c_str());
  file.SetMetadataItem("TIFFTAG_SOFTWARE", ("Talus " + std::string(version())).c_str());
  file.SetMetadataItem("OVERVIEWS", map.smallest_in_overviews ? "smallest value of the cells under a pixel"
                                                              : "largest value of the cells under a pixel");
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    GDALRasterBand* band = file.GetRasterBand(static_cast<int>(b) + 1);
    band->SetDescription(map.bands[b].name.c_str());
    band->SetUnitType(map.bands[b].unit.c_str());
    band->SetNoDataValue(map.kind == Map::Kind::Count ? static_cast<double>(kCountNodata) : kNodata);
  }
}

int CPL_STDCALL still_going(double, const char*, void* target) {
  const auto& proceed = static_cast<const MapTarget*>(target)->proceed;
  return !proceed || proceed() ? TRUE : FALSE;
}

/// Compression of the draft: a large map is mostly empty, and without compression would take tens of gigabytes.
const char* draft_compression(const MapTarget& target) {
  constexpr double kLarge = 16e6;  // cells
  const char* known = driver("GTiff")->GetMetadataItem(GDAL_DMD_CREATIONOPTIONLIST);
  const bool large = static_cast<double>(target.columns) * target.rows > kLarge;
  return large && known != nullptr && std::string_view(known).find("ZSTD") != std::string_view::npos ? "COMPRESS=ZSTD"
                                                                                                     : "COMPRESS=NONE";
}

/// Writes the map and its overviews into `draft`, and from there the finished file.
template <class T>
bool write_as(const Map& map, const MapTarget& target, const fs::path& draft, const fs::path& file) {
  const char* const draft_options[] = {
      "TILED=YES",        "BLOCKXSIZE=512",          "BLOCKYSIZE=64", "INTERLEAVE=BAND",
      "BIGTIFF=IF_SAFER", draft_compression(target), "ZSTD_LEVEL=1",  nullptr};
  const Dataset dataset(driver("GTiff")->Create(draft.c_str(), target.columns, target.rows,
                                                static_cast<int>(map.bands.size()), kType<T>, draft_options));
  require(dataset != nullptr, "cannot be created");
  describe(*dataset, map, target);
  if (!fill<T>(*dataset, map, target)) return false;
  const int block = block_size(target);
  add_overviews<T>(*dataset, block, map.smallest_in_overviews);
  dataset->FlushCache(false);
  const std::string size = "BLOCKSIZE=" + std::to_string(block);
  // Level 6 would be a third slower and 3 % smaller. Blocks with nothing but nodata are left out: they are most of a
  // large map.
  const char* const options[] = {"COMPRESS=DEFLATE",
                                 "LEVEL=3",
                                 "PREDICTOR=YES",
                                 size.c_str(),
                                 "NUM_THREADS=1",
                                 "BIGTIFF=IF_SAFER",
                                 "SPARSE_OK=TRUE",
                                 "OVERVIEWS=FORCE_USE_EXISTING",
                                 nullptr};
  MapTarget asked = target;
  const Dataset finished(driver("COG")->CreateCopy(file.c_str(), dataset.get(), FALSE, options, still_going, &asked));
  if (target.proceed && !target.proceed()) return false;
  require(finished != nullptr, "cannot be written");
  return true;
}

}  // namespace

bool write_map(const Map& map, const MapTarget& target) {
  start_gdal();
  const StagedPath draft(StagedPath::Kind::File, target.folder / (map.name + "_draft.tif"), ".tif");  // never committed
  StagedPath staged(StagedPath::Kind::File, target.folder / (map.name + ".tif"), ".tif");
  GdalMessages messages;
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error(map.name + ".tif: " + what + ": " + cause_of_failure(target.folder, messages.take()));
  };
  bool whole = false;
  try {
    whole = map.kind == Map::Kind::Count ? write_as<std::uint32_t>(map, target, draft.hidden(), staged.hidden())
                                         : write_as<float>(map, target, draft.hidden(), staged.hidden());
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
  if (!whole) return false;
  if (messages.failed()) fail("cannot be written");
  if (const std::error_code error = staged.commit()) fail("cannot be given its name: " + error.message());
  return true;
}

}  // namespace talus::io
