// The packed spatial index of a layer of points: SQLite finds it sound, and it finds what a scan finds.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "io/gdal/geopackage.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

struct Place {
  double x, y;
};

double share(std::mt19937& random) {
  return static_cast<double>(random()) * 0x1p-32;
}

std::vector<Place> places(int count) {
  std::vector<Place> result;
  std::mt19937 random(1);
  for (int i = 0; i < count; ++i) {
    const double x = 2600000.0 + 1000.0 * share(random);
    result.push_back({x, 1200000.0 + 300.0 * share(random)});
  }
  return result;
}

void write(const fs::path& path, const std::vector<Place>& points) {
  GeoPackage file(path, {});
  OGRLayer* layer = file.add_bulk_layer("points", wkbPoint, {{"number", OFTInteger64}});
  const Feature feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
  for (const Place& place : points) {
    const OGRPoint point(place.x, place.y);
    feature->SetGeometry(&point);
    file.append(layer, *feature);
  }
  file.finish();
}

std::string first_text(GDALDataset& file, const char* sql) {
  OGRLayer* result = file.ExecuteSQL(sql, nullptr, nullptr);
  if (result == nullptr) return "no answer";
  const Feature row(result->GetNextFeature());
  std::string text = row ? row->GetFieldAsString(0) : "no row";
  file.ReleaseResultSet(result);
  return text;
}

// 0: an empty tree; 51 and 52: one node and two; 3000: three levels; 300 000: two runs, four levels.
TEST(PackedIndex, FindsWhatAScanFinds) {
  const fs::path path = fs::temp_directory_path() / ("talus-points-" + std::to_string(getpid()) + ".gpkg");
  for (const int count : {0, 1, 51, 52, 3000, 300'000}) {
    const std::vector<Place> points = places(count);
    write(path, points);
    const Dataset file(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE, nullptr, nullptr, nullptr));
    ASSERT_TRUE(file);
    EXPECT_EQ(first_text(*file, "SELECT rtreecheck('rtree_points_geom')"), "ok") << count;
    EXPECT_EQ(first_text(*file, "SELECT count(*) FROM rtree_points_geom"), std::to_string(count));
    EXPECT_EQ(first_text(*file, "SELECT count(*) FROM sqlite_master WHERE type = 'trigger' AND tbl_name = 'points'"),
              "6");
    OGRLayer* layer = file->GetLayer(0);
    for (const double size : {3.0, 40.0, 2000.0}) {
      const Place low{2600400.0, 1200100.0};
      layer->SetSpatialFilterRect(low.x, low.y, low.x + size, low.y + size);
      const auto inside = std::ranges::count_if(points, [&](const Place& p) {
        return p.x >= low.x && p.x <= low.x + size && p.y >= low.y && p.y <= low.y + size;
      });
      int found = 0;  // one by one: GetFeatureCount takes the boxes of the index, which are rounded to floats
      while (const Feature feature{layer->GetNextFeature()}) ++found;
      EXPECT_EQ(found, inside) << count << ' ' << size;
    }
    if (count == 3000) {  // the index stays sound where a user edits the layer
      layer->SetSpatialFilter(nullptr);
      ASSERT_EQ(file->StartTransaction(), OGRERR_NONE);
      for (int fid = 1; fid <= 1500; ++fid) ASSERT_EQ(layer->DeleteFeature(fid), OGRERR_NONE);
      EXPECT_EQ(first_text(*file, "SELECT rtreecheck('rtree_points_geom')"), "ok");
      EXPECT_EQ(first_text(*file, "SELECT count(*) FROM rtree_points_geom"), "1500");
      ASSERT_EQ(file->CommitTransaction(), OGRERR_NONE);
    }
  }
  fs::remove(path);
}

}  // namespace
}  // namespace talus::io
