#pragma once
// Makes files for the tests of the readers, and checks their InputErrors.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "talus/base/error.hpp"
#include "talus/io/gdal/rasters.hpp"

namespace talus::io::test {

/// A folder of its own for each test, removed at its end.
class Files : public testing::Test {
 protected:
  Files() {
    GDALAllRegister();
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("talus-" + std::to_string(::getpid()) + "-" + info->test_suite_name() + "-" + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Files() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write_text(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

/// A raster file. By default 10 x 8 cells of 10 m at (600 000, 5 200 000) in UTM 32N, height 1000 + 10 row + column
/// with row 0 in the NORTH.
struct RasterFile {
  int columns = 10, rows = 8;
  std::array<double, 6> place{600000.0, 10.0, 0.0, 5200080.0, 0.0, -10.0};
  std::string system = "EPSG:32632";
  GDALDataType type = GDT_Float32;
  std::vector<double> values{};  // row by row from the north; empty: as above
  std::optional<double> nodata{};
  double scale = 1.0, offset = 0.0;
  std::string unit{};
  int bands = 1;
  bool placed = true;

  std::string write(const std::string& path) const {
    GDALDataset* out =
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), columns, rows, bands, type, nullptr);
    auto g = place;
    if (placed) out->SetGeoTransform(g.data());
    OGRSpatialReference srs;
    if (!system.empty() && srs.SetFromUserInput(system.c_str()) == OGRERR_NONE) out->SetSpatialRef(&srs);
    std::vector<double> all = values;
    if (all.empty())
      for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) all.push_back(1000.0 + 10.0 * j + i);
    GDALRasterBand* band = out->GetRasterBand(1);
    if (nodata) band->SetNoDataValue(*nodata);
    if (scale != 1.0) band->SetScale(scale);
    if (offset != 0.0) band->SetOffset(offset);
    if (!unit.empty()) band->SetUnitType(unit.c_str());
    EXPECT_EQ(band->RasterIO(GF_Write, 0, 0, columns, rows, all.data(), columns, rows, GDT_Float64, 0, 0, nullptr),
              CE_None);
    GDALClose(out);
    return path;
  }
};

/// A feature: geometry as WKT ("" for none) and field values as text ("NULL" for NULL).
struct Row {
  std::string wkt;
  std::vector<std::string> values{};
};

/// The lower-left corner of the default RasterFile.
inline constexpr std::array<double, 2> kCorner{600000.0, 5200000.0};

struct Mover : OGRDefaultGeometryVisitor {
  using OGRDefaultGeometryVisitor::visit;
  explicit Mover(std::array<double, 2> by) : by_(by) {}
  void visit(OGRPoint* point) override {
    point->setX(point->getX() + by_[0]);
    point->setY(point->getY() + by_[1]);
  }
  std::array<double, 2> by_;
};

/// A vector file (GeoPackage, or shapefile by its ending). Places in `system`, east or longitude first; in UTM 32N from
/// the lower-left corner of the default RasterFile.
inline std::string write_vector(const std::string& path, const std::string& system,
                                const std::vector<std::pair<std::string, OGRFieldType>>& fields,
                                const std::vector<Row>& rows, OGRwkbGeometryType type = wkbUnknown) {
  const bool shape = path.ends_with(".shp");
  GDALDataset* out = GetGDALDriverManager()
                         ->GetDriverByName(shape ? "ESRI Shapefile" : "GPKG")
                         ->Create(path.c_str(), 0, 0, 0, GDT_Unknown, nullptr);
  OGRSpatialReference srs;
  if (!system.empty()) srs.SetFromUserInput(system.c_str());
  srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRLayer* layer = out->CreateLayer("layer", system.empty() ? nullptr : &srs, type, nullptr);
  for (const auto& [name, kind] : fields) {
    OGRFieldDefn field(name.c_str(), kind);
    layer->CreateField(&field);
  }
  for (const Row& row : rows) {
    OGRFeature feature(layer->GetLayerDefn());
    for (std::size_t i = 0; i < row.values.size(); ++i)
      if (row.values[i] == "NULL")
        feature.SetFieldNull(static_cast<int>(i));
      else
        feature.SetField(static_cast<int>(i), row.values[i].c_str());
    OGRGeometry* geometry = nullptr;
    if (!row.wkt.empty()) {
      EXPECT_EQ(OGRGeometryFactory::createFromWkt(row.wkt.c_str(), nullptr, &geometry), OGRERR_NONE) << row.wkt;
      Mover mover(system == "EPSG:32632" ? kCorner : std::array<double, 2>{});
      geometry->accept(&mover);
      feature.SetGeometryDirectly(geometry);
    }
    EXPECT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
  }
  GDALClose(out);
  return path;
}

/// Checks that a call throws an InputError whose message is one line that holds all `parts`.
inline void expect_input_error(const std::function<void()>& call, const std::vector<std::string>& parts) {
  try {
    call();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
    return;
  }
  FAIL() << "no InputError";
}

/// Whether one of the lines holds the part.
inline bool said(const std::vector<std::string>& lines, const std::string& part) {
  for (const std::string& line : lines)
    if (line.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace talus::io::test
