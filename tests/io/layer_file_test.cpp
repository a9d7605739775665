// Layers of many rows: those that are inserted without GDAL are those that GDAL inserts, to the byte; those of a
// FlatGeobuf file are those of a GeoPackage.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "io/gdal/geopackage.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

const std::vector<GeoPackage::Column> kColumns{{"number", OFTInteger64}, {"share", OFTReal}, {"name", OFTString}};

/// The layers `points` and `paths`, by `add_bulk_layer` or by GDAL.
void write(const fs::path& path, bool bulk) {
  GeoReference geo;
  OGRSpatialReference system;
  system.importFromEPSG(2056);
  geo.crs_wkt = wkt_of(&system);
  GeoPackage file(path, geo);
  const auto add = [&](const char* name, OGRwkbGeometryType type) {
    return bulk ? file.add_bulk_layer(name, type, kColumns) : file.add_layer(name, type, kColumns);
  };
  OGRLayer *const points = add("points", wkbPoint), *const paths = add("paths", wkbLineStringZM);
  for (int i = 0; i < 200; ++i) {
    const double x = 2600000.1 + 7.3 * i, y = 1200000.7 - 0.1 * i * i;
    const OGRPoint point(x, y);
    OGRLineString line;
    for (int k = 0; k < 2 + i; ++k) line.addPoint(x + k, y - 0.5 * k, 900.0 - k, 0.25 * k);
    for (OGRLayer* layer : {points, paths}) {
      const Feature row(OGRFeature::CreateFeature(layer->GetLayerDefn()));
      if (i % 3 != 1) row->SetField(0, GIntBig{1} << (i % 60));
      i % 3 == 2 ? row->SetFieldNull(1) : row->SetField(1, i % 5 == 0 ? i : i / 7.0);
      if (i % 4 != 3) row->SetField(2, i % 4 == 0 ? "" : "Weisse Wand \xc3\xbc");
      row->SetGeometry(layer == points ? static_cast<const OGRGeometry*>(&point) : &line);
      file.append(layer, *row);
    }
  }
  file.finish();
}

/// All values of a query, one row a line; bytes in hexadecimal digits.
std::string answer(const fs::path& path, const std::string& sql) {
  const Dataset file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr));
  OGRLayer* result = file->ExecuteSQL(sql.c_str(), nullptr, nullptr);
  std::string text;
  while (result != nullptr) {
    const Feature row(result->GetNextFeature());
    if (!row) break;
    for (int i = 0; i < row->GetFieldCount(); ++i) text += std::string(row->GetFieldAsString(i)) + '|';
    text += '\n';
  }
  file->ReleaseResultSet(result);
  return text;
}

TEST(BulkLayer, WritesWhatGdalWrites) {
  start_gdal();
  const fs::path folder = fs::temp_directory_path();
  const std::string process = std::to_string(getpid());
  const fs::path bulk = folder / ("talus-bulk-" + process + ".gpkg"),
                 gdal = folder / ("talus-gdal-" + process + ".gpkg");
  write(bulk, true);
  write(gdal, false);
  for (const std::string layer : {"points", "paths"}) {
    const std::string rows =
        "SELECT fid, hex(geom), number, typeof(number), share, typeof(share), name, typeof(name) FROM " + layer +
        " ORDER BY fid";
    EXPECT_EQ(answer(bulk, rows), answer(gdal, rows)) << layer;
    EXPECT_EQ(answer(bulk, "SELECT rtreecheck('rtree_" + layer + "_geom')"), "ok|\n");
    EXPECT_EQ(answer(bulk, "SELECT HasSpatialIndex('" + layer + "', 'geom')"), "1|\n");
  }
  for (const std::string table :
       {"gpkg_geometry_columns", "gpkg_extensions", "gpkg_spatial_ref_sys", "sqlite_sequence"})
    EXPECT_EQ(answer(bulk, "SELECT * FROM " + table + " ORDER BY 1, 2"),
              answer(gdal, "SELECT * FROM " + table + " ORDER BY 1, 2"))
        << table;
  const std::string contents =
      "SELECT table_name, last_change, srs_id, round(min_x, 6), round(min_y, 6), round(max_x, 6), round(max_y, 6) "
      "FROM gpkg_contents ORDER BY 1";
  EXPECT_EQ(answer(bulk, contents), answer(gdal, contents)) << "GDAL keeps 15 digits of the extent";
  fs::remove(bulk);
  fs::remove(gdal);
}

/// Every row of the layer `paths` as GDAL reads it, sorted.
std::vector<std::string> rows_of(const fs::path& path) {
  const Dataset file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR, nullptr, nullptr, nullptr));
  OGRLayer* layer = file->GetLayerByName("paths");
  std::vector<std::string> rows;
  while (const Feature row{layer->GetNextFeature()}) {
    std::string& text = rows.emplace_back(row->GetGeometryRef()->WkbSize(), '\0');
    row->GetGeometryRef()->exportToWkb(wkbNDR, reinterpret_cast<unsigned char*>(text.data()), wkbVariantIso);
    for (int i = 0; i < row->GetFieldCount(); ++i)
      text += row->IsFieldSetAndNotNull(i) ? std::string("|") + row->GetFieldAsString(i) : "|null";
  }
  std::ranges::sort(rows);
  return rows;
}

TEST(GeoPackage, ThatCannotBeMadeIsCalledByItsFinalName) {
  start_gdal();
  try {
    new_layer_file("/no/such/folder/.cells.talus-123.gpkg", {});
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.find("cells.gpkg: cannot be written: "), 0U) << text;
    EXPECT_EQ(text.find(".talus-"), std::string::npos) << text;
  }
}

TEST(FlatGeobuf, HasTheRowsOfAGeoPackageInTheOrderOfItsIndex) {
  start_gdal();
  const fs::path folder = fs::temp_directory_path() / ("talus-fgb-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const auto write_paths = [&](const std::string& name, int rows) {
    const auto file = new_layer_file(folder / name, {});
    OGRLayer* layer = file->add_bulk_layer("paths", wkbLineStringZM, kColumns);
    const Feature row(OGRFeature::CreateFeature(layer->GetLayerDefn()));
    for (int i = 0; i < rows; ++i) {
      OGRLineString line;
      for (int k = 0; k < 3; ++k) line.addPoint(i * 7919 % 997 + k / 3.0, i % 31, 900.0 - k, 0.25 * k);
      row->SetField(0, i);
      i % 3 == 2 ? row->SetFieldNull(1) : row->SetField(1, i / 7.0);
      row->SetField(2, i % 4 == 0 ? "" : "Weisse Wand \xc3\xbc");
      row->SetGeometry(&line);
      file->append(layer, *row);
    }
    file->finish();
  };
  for (const int rows : {0, 1, 2000}) {
    write_paths("paths.gpkg", rows);
    write_paths("paths.fgb", rows);
    EXPECT_EQ(rows_of(folder / "paths.fgb").size(), static_cast<std::size_t>(rows));
    EXPECT_EQ(rows_of(folder / "paths.fgb"), rows_of(folder / "paths.gpkg"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 2) << "nothing beside the files";
    for (const char* name : {"paths.gpkg", "paths.fgb"}) fs::remove(folder / name);
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace talus::io
