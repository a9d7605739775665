#include <gdal_priv.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <vector>

#include "fuzz.hpp"

namespace talus::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int kCells = 20;
constexpr double kCell = 5.0, kWest = 2600000.0, kNorth = 1200100.0;

class Site {
 public:
  Site() : folder_(fs::temp_directory_path() / ("talus-fuzz-" + std::to_string(getpid()))) {
    GDALAllRegister();
    fs::create_directories(folder_);
    write_raster("dem.tif", GDT_Float32, [](int column, int row) { return 200.0 - 4.0 * row + 0.1 * (column % 3); });
    write_raster("zones.tif", GDT_Byte, [](int, int row) { return row < 10 ? 1.0 : 2.0; });
    write(folder_ / "cliffs.geojson",
          R"({"type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:2056"}}, "features": [
{"type": "Feature", "properties": {"name": "a", "diameter": 1.2}, "geometry": {"type": "Polygon",
"coordinates": [[[2600020, 1200080], [2600040, 1200080], [2600040, 1200095], [2600020, 1200080]]]}}]})");
  }
  ~Site() {
    std::error_code none;
    fs::remove_all(folder_, none);
  }
  const fs::path& folder() const { return folder_; }

 private:
  template <class Value>
  void write_raster(const char* name, GDALDataType type, Value value) const {
    std::array<double, 6> place{kWest, kCell, 0.0, kNorth, 0.0, -kCell};
    OGRSpatialReference system;
    system.importFromEPSG(2056);
    std::vector<float> row(kCells);
    GDALDataset* file = GetGDALDriverManager()->GetDriverByName("GTiff")->Create((folder_ / name).c_str(), kCells,
                                                                                 kCells, 1, type, nullptr);
    file->SetGeoTransform(place.data());
    file->SetSpatialRef(&system);
    for (int r = 0; r < kCells; ++r) {
      for (int c = 0; c < kCells; ++c) row[static_cast<std::size_t>(c)] = static_cast<float>(value(c, r));
      if (file->GetRasterBand(1)->RasterIO(GF_Write, 0, r, kCells, 1, row.data(), kCells, 1, GDT_Float32, 0, 0) !=
          CE_None)
        __builtin_trap();
    }
    GDALClose(file);
  }

  fs::path folder_;
};

}  // namespace

const fs::path& site() {
  static const Site site;
  return site.folder();
}

}  // namespace talus::fuzz
