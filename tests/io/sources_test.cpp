#include <algorithm>
#include <cmath>
#include <limits>

#include "files.hpp"
#include "talus/io/gdal/vectors.hpp"

namespace talus::io::test {

// The map: 10 x 8 cells of 10 m, so that the centres are at 5, 15, 25 ... m. Counts are by hand.
class Sources : public Files {
 protected:
  Sources() : terrain_(read_terrain(RasterFile{}.write(path("dem.tif")))) {}

  SourceLayer read(const std::vector<Row>& rows, const std::vector<std::pair<std::string, OGRFieldType>>& fields = {}) {
    return read_sources(write_vector(path("s.gpkg"), "EPSG:32632", fields, rows), terrain_, Range{1.0, 1.0});
  }

  // Column and row (0 in the south) of the source cells.
  static std::vector<std::pair<int, int>> cells(const SourceLayer& layer) {
    std::vector<std::pair<int, int>> list;
    for (const SourceCell& cell : layer.cells)
      list.emplace_back(static_cast<int>(cell.x / 10.0), static_cast<int>(cell.y / 10.0));
    return list;
  }

  Terrain terrain_;
};

using Cells = std::vector<std::pair<int, int>>;

TEST_F(Sources, APolygonGivesTheCellsWhoseCentresItCoversFromTheNorthWest) {
  const SourceLayer layer = read({{"POLYGON((0 0,34 0,34 24,0 24,0 0))"}});
  EXPECT_EQ(cells(layer), (Cells{{0, 1}, {1, 1}, {2, 1}, {0, 0}, {1, 0}, {2, 0}}));
  EXPECT_DOUBLE_EQ(layer.cells[0].x, 5.0);
  EXPECT_DOUBLE_EQ(layer.cells[0].y, 15.0);
  EXPECT_FALSE(layer.cells[0].point);
  ASSERT_EQ(layer.warnings.size(), 1U);  // the lower row and the western column have no terrain on one side
  EXPECT_NE(layer.warnings[0].find("4 source cells or points lie at the edge"), std::string::npos) << layer.warnings[0];
  EXPECT_TRUE(layer.reprojections.empty());
}

/// 60 m x 20 m, the western half of which lies off the DEM; a line has no area.
TEST_F(Sources, TheDrawnAreaIsThatOnTheDem) {
  EXPECT_NEAR(read({{"POLYGON((-30 0,30 0,30 20,-30 20,-30 0))"}}).features[0].drawn_area, 600.0, 1e-6);
  const SourceLayer line = read({{"LINESTRING(5 5,35 5)"}});
  EXPECT_EQ(line.features[0].drawn_area, 0.0);
  EXPECT_FALSE(line.features[0].has_area);
}

TEST_F(Sources, ACentreOnAnEdgeBelongsToOneOfTwoPolygons) {  // squares of 30 m whose edges are lines of centres
  const auto square = [](double west, double south) {
    const auto at = [](double x, double y) { return std::to_string(x) + " " + std::to_string(y); };
    return "POLYGON((" + at(west, south) + "," + at(west + 30, south) + "," + at(west + 30, south + 30) + "," +
           at(west, south + 30) + "," + at(west, south) + "))";
  };
  for (const auto& [east, north] : {std::pair{30.0, 0.0}, std::pair{0.0, 30.0}}) {
    EXPECT_EQ(read({{square(15, 5)}}).cells.size(), 9U);
    const SourceLayer both = read({{square(15, 5)}, {square(15 + east, 5 + north)}});
    Cells all = cells(both);
    std::ranges::sort(all);
    EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
    EXPECT_EQ(both.cells.size(), 18U);
  }
}

TEST_F(Sources, HolesAndPartsAreRight) {  // 5 x 5 cells without 3 x 3 in the middle, and 2 cells apart
  const SourceLayer layer =
      read({{"MULTIPOLYGON(((0 0,50 0,50 50,0 50,0 0),(10 10,40 10,40 40,10 40,10 10)),((60 60,80 60,80 70,60 70,60 "
             "60)))"}});
  EXPECT_EQ(layer.cells.size(), 25U - 9U + 2U);
  for (const auto& [column, row] : cells(layer)) {
    const bool ring = column < 5 && row < 5 && !(column >= 1 && column <= 3 && row >= 1 && row <= 3);
    const bool second = row == 6 && (column == 6 || column == 7);
    EXPECT_TRUE(ring || second) << column << ' ' << row;
  }
  EXPECT_EQ(cells(layer).front(), (std::pair{6, 6}));  // the northern part first
}

TEST_F(Sources, ATinyPolygonGivesTheCellsItTouches) {
  EXPECT_EQ(cells(read({{"POLYGON((18 18,22 18,22 22,18 22,18 18))"}})), (Cells{{1, 2}, {2, 2}, {1, 1}, {2, 1}}));
  EXPECT_EQ(cells(read({{"POLYGON((21 21,23 21,23 23,21 23,21 21))"}})), (Cells{{2, 2}}));
  EXPECT_EQ(cells(read({{"POLYGON((2 11,88 11,88 14,2 14,2 11))"}})).size(),
            9U);  // a strip between two rows of centres
}

TEST_F(Sources, ATinyPartOfAFeatureIsNotLost) {
  EXPECT_EQ(cells(read({{"MULTIPOLYGON(((0 0,20 0,20 10,0 10,0 0)),((71 71,72 71,72 72,71 72,71 71)))"}})),
            (Cells{{7, 7}, {0, 0}, {1, 0}}));
}

TEST_F(Sources, OverlappingPartsGiveACellOnce) {
  EXPECT_EQ(read({{"GEOMETRYCOLLECTION(POLYGON((0 0,20 0,20 20,0 20,0 0)),POLYGON((10 0,30 0,30 20,10 20,10 0)))"}})
                .cells.size(),
            6U);
}

// A map of 60 x 60 cells of 10 m.
class NarrowSources : public Files {
 protected:
  NarrowSources()
      : terrain_(read_terrain(
            RasterFile{.columns = 60, .rows = 60, .place = {600000.0, 10.0, 0.0, 5200600.0, 0.0, -10.0}}.write(
                path("dem.tif")))) {}

  SourceLayer read(const std::string& wkt, const std::string& frequency = "NULL") {
    return read_sources(write_vector(path("s.gpkg"), "EPSG:32632", {{"name", OFTString}, {"frequency", OFTReal}},
                                     {{wkt, {"crest", frequency}}}),
                        terrain_, Range{1.0, 1.0});
  }

  Terrain terrain_;
};

TEST_F(NarrowSources, ARibbonAlongACrestIsToldWhatItLeavesOut) {
  // 3 m wide, west edge at x = 200.5 + 0.008 (y - 53), from y = 53 to 553: in column 20 it touches the rows 5 to 55. It
  // covers the centres at x = 205 where its edge is beyond 202, at y > 240.5: rows 24 to 54. Row 23 is beside them.
  const std::string ribbon = "POLYGON((200.5 53,203.5 53,207.5 553,204.5 553,200.5 53))";
  const SourceLayer layer = read(ribbon);
  EXPECT_EQ(layer.cells.size(), 31U);
  EXPECT_TRUE(said(layer.warnings,
                   "polygon 1 (crest): of the 51 cells that it touches, 18 release nothing, nor does a neighbour of "
                   "them: draw a crest as a line"));
  EXPECT_TRUE(said(read(ribbon, "5").warnings, ", and its 5 events per year all fall on the 31 that release: draw"));
  const SourceLayer line = read("LINESTRING(202 53,206 553)");
  EXPECT_EQ(line.cells.size(), 51U);
  EXPECT_TRUE(line.warnings.empty());
}

TEST_F(NarrowSources, OtherPartsOfTheFeatureRelease) {  // the ribbon of the test before, with what lies on its gap
  const std::string ribbon = "((200.5 53,203.5 53,207.5 553,204.5 553,200.5 53))";
  const SourceLayer wide = read("MULTIPOLYGON(" + ribbon + ",((206 40,250 40,250 260,206 260,206 40)))", "5");
  EXPECT_EQ(wide.cells.size(), 4U * 22U + 31U) << "columns 21 to 24 of rows 4 to 25, beside the gap of the ribbon";
  EXPECT_FALSE(said(wide.warnings, "release nothing"));
  const SourceLayer line = read("GEOMETRYCOLLECTION(POLYGON" + ribbon + ",LINESTRING(202 53,204 303))", "5");
  EXPECT_EQ(line.cells.size(), 50U);
  EXPECT_FALSE(said(line.warnings, "release nothing"));
}

TEST_F(NarrowSources, APolygonAsWideAsTheDiagonalOfACellIsNone) {
  for (int degree = 0; degree < 180; degree += 10) {
    const double c = std::cos(degree * M_PI / 180.0), s = std::sin(degree * M_PI / 180.0);
    const auto at = [&](double along, double across) {
      return std::to_string(303.0 + c * along - s * across) + " " + std::to_string(307.0 + s * along + c * across);
    };
    const double half = 5.0 * std::sqrt(2.0) + 1e-3;
    EXPECT_TRUE(read("POLYGON((" + at(-200, -half) + "," + at(200, -half) + "," + at(200, half) + "," + at(-200, half) +
                     "," + at(-200, -half) + "))")
                    .warnings.empty())
        << degree;
    const double rise = 200.0 * std::tan(15.0 * M_PI / 180.0);  // a corner of 30 degrees
    EXPECT_TRUE(read("POLYGON((" + at(0, 0) + "," + at(200, -rise) + "," + at(200, rise) + "," + at(0, 0) + "))")
                    .warnings.empty())
        << degree;
  }
}

TEST_F(NarrowSources, WhatThePolygonIsBeyondTheDemIsNotKnown) {  // of column 0 it covers 30 cells only 3 m wide
  const SourceLayer layer = read("POLYGON((-50 100,3 100,3 400,8 400,8 500,-50 500,-50 100))");
  EXPECT_EQ(layer.cells.size(), 10U);
  EXPECT_FALSE(said(layer.warnings, "narrower"));
}

TEST_F(Sources, ALineGivesTheCellsItCrosses) {
  EXPECT_EQ(cells(read({{"LINESTRING(5 5,35 5)"}})), (Cells{{0, 0}, {1, 0}, {2, 0}, {3, 0}}));
  EXPECT_EQ(cells(read({{"LINESTRING(2 2,28 12)"}})), (Cells{{2, 1}, {0, 0}, {1, 0}, {2, 0}}));  // y = 10 at x = 22.8
  EXPECT_EQ(cells(read({{"LINESTRING(28 12,2 2)"}})), (Cells{{2, 1}, {0, 0}, {1, 0}, {2, 0}}));
  EXPECT_EQ(cells(read({{"LINESTRING(33 2,33 27)"}})), (Cells{{3, 2}, {3, 1}, {3, 0}}));
  EXPECT_EQ(cells(read({{"LINESTRING(51 51,52 53)"}})), (Cells{{5, 5}}));
  EXPECT_EQ(cells(read({{"MULTILINESTRING((1 1,12 1),(1 71,12 71))"}})), (Cells{{0, 7}, {1, 7}, {0, 0}, {1, 0}}));
  EXPECT_EQ(cells(read({{"LINESTRING(-500 -480,12 14)"}})),
            (Cells{{0, 1}, {1, 1}, {0, 0}}));  // from off the map; y = 10 at x = 7.85
}

TEST_F(Sources, ALineDoesNotReleaseWhereItOnlyTouches) {  // its ends lie on corners and edges of cells
  const Cells three{{1, 2}, {2, 2}, {3, 2}}, diagonal{{3, 4}, {2, 3}, {1, 2}};
  EXPECT_EQ(cells(read({{"LINESTRING(10 25,40 25)"}})), three);
  EXPECT_EQ(cells(read({{"LINESTRING(40 25,10 25)"}})), three);
  EXPECT_EQ(cells(read({{"MULTILINESTRING((10 25,30 25),(30 25,40 25))"}})), three);
  EXPECT_EQ(cells(read({{"LINESTRING(10 20,40 50)"}})), diagonal);
  EXPECT_EQ(cells(read({{"LINESTRING(40 50,10 20)"}})), diagonal);
  EXPECT_EQ(cells(read({{"LINESTRING(10 20,40 20)"}})), cells(read({{"LINESTRING(40 20,10 20)"}})));  // along an edge
  EXPECT_EQ(cells(read({{"LINESTRING(10 20,40 20)"}})).size(), 3U);
  EXPECT_EQ(cells(read({{"LINESTRING(15 15,40 40,40 65)"}})),  // through corners, then along an edge
            cells(read({{"LINESTRING(40 65,40 40,15 15)"}})));
  EXPECT_EQ(cells(read({{"LINESTRING(15 15,40 40)"}})), (Cells{{3, 3}, {2, 2}, {1, 1}}));
  EXPECT_EQ(cells(read({{"LINESTRING(15 45,20 30,15 15)"}})),
            (Cells{{1, 4}, {1, 3}, {1, 2}, {1, 1}}));   // a vertex on an edge
  EXPECT_EQ(cells(read({{"LINESTRING(5 25,55 50)"}})),  // y = 30 at x = 15, 40 at x = 35, 50 at its end
            (Cells{{3, 4}, {4, 4}, {5, 4}, {1, 3}, {2, 3}, {3, 3}, {0, 2}, {1, 2}}));
}

// Length of the segment a-b inside a cell, by clipping it at the four sides.
double length_inside(const Eigen::Vector2d& a, const Eigen::Vector2d& b, int column, int row) {
  double from = 0.0, to = 1.0;
  const Eigen::Vector2d low(10.0 * column, 10.0 * row), d = b - a;
  for (int axis = 0; axis < 2; ++axis) {
    double enter = (low[axis] - a[axis]) / d[axis], leave = (low[axis] + 10.0 - a[axis]) / d[axis];
    if (enter > leave) std::swap(enter, leave);
    from = std::max(from, enter);
    to = std::min(to, leave);
  }
  return std::max(0.0, to - from) * d.norm();
}

TEST_F(Sources, ALineGivesTheCellsItCrossesInAnyDirection) {  // 300 random lines against clipping
  std::uint32_t state = 7;
  const auto random = [&] { return static_cast<double>((state = state * 1664525U + 1013904223U) >> 8) / 16777216.0; };
  std::vector<Row> rows;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> lines;
  for (int i = 0; i < 300; ++i) {
    lines.emplace_back(Eigen::Vector2d(100.0 * random(), 80.0 * random()),
                       Eigen::Vector2d(140.0 * random() - 20.0, 120.0 * random() - 20.0));
    const auto& [a, b] = lines.back();
    rows.push_back({"LINESTRING(" + std::to_string(a.x()) + " " + std::to_string(a.y()) + "," + std::to_string(b.x()) +
                    " " + std::to_string(b.y()) + ")"});
  }
  const SourceLayer layer = read(rows);
  std::vector<std::vector<int>> found(lines.size(), std::vector<int>(80, 0));
  for (const SourceCell& cell : layer.cells)
    ++found[cell.feature][static_cast<int>(cell.y / 10.0) * 10 + static_cast<int>(cell.x / 10.0)];
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (int k = 0; k < 80; ++k) {
      const double length = length_inside(lines[i].first, lines[i].second, k % 10, k / 10);
      if (length > 0.0 && length < 1e-3) continue;  // a corner that is hardly cut
      EXPECT_EQ(found[i][k], length > 0.0 ? 1 : 0)
          << rows[i].wkt << " cell " << k % 10 << ' ' << k / 10 << " length " << length;
    }
}

TEST_F(Sources, APointIsExactlyThere) {
  const SourceLayer layer = read({{"POINT(33.25 47.125)"}, {"MULTIPOINT(1 2,3 4)"}});
  ASSERT_EQ(layer.cells.size(), 3U);
  EXPECT_TRUE(layer.cells[0].point);
  EXPECT_NEAR(layer.cells[0].x, 33.25, 1e-9);
  EXPECT_NEAR(layer.cells[0].y, 47.125, 1e-9);
  EXPECT_EQ(layer.cells[0].feature, 0U);
  EXPECT_EQ(layer.cells[2].feature, 1U);
  EXPECT_NEAR(layer.cells[2].y, 4.0, 1e-9);
}

TEST_F(Sources, KindsMayBeMixedInOneFeature) {
  const SourceLayer layer =
      read({{"GEOMETRYCOLLECTION(POINT(77 77),LINESTRING(1 71,12 71),GEOMETRYCOLLECTION(POLYGON((0 0,10 0,10 10,0 10,0 "
             "0))))"}});
  EXPECT_EQ(cells(layer), (Cells{{0, 7}, {1, 7}, {0, 0}, {7, 7}}));
  EXPECT_TRUE(layer.cells[3].point);
}

TEST_F(Sources,
       CurvesAndHeightsAreRead) {  // a circle of 20 m about a corner: centres at (5,5), (5,15), (15,5) in each quarter
  EXPECT_EQ(read({{"CURVEPOLYGON(CIRCULARSTRING(30 40,50 60,70 40,50 20,30 40))"}}).cells.size(), 12U);
  EXPECT_EQ(read({{"POLYGON Z((0 0 9,20 0 9,20 10 9,0 10 9,0 0 9))"}}).cells.size(), 2U);
  EXPECT_EQ(read({{"POINT ZM(5 5 2000 1)"}}).cells.size(), 1U);
}

TEST_F(Sources, AnInvalidPolygonIsMendedWithAWarning) {  // a bow tie: x = 5 and 35 hold three centres, 15 and 25 one
  const SourceLayer layer = read({{"POLYGON((0 0,40 42,40 0,0 42,0 0))"}});
  EXPECT_EQ(layer.cells.size(), 8U);
  EXPECT_TRUE(
      said(layer.warnings, "feature 1: polygon was invalid (Self-intersection at or near point 600020 5200021)"));
  expect_input_error([&] { read({{"POLYGON((0 0,10 0,20 0,0 0))"}}); },
                     {"s.gpkg: feature 1", "polygon is invalid", "no area is left when it is mended: draw it anew"});
}

TEST_F(Sources, AHoleOfAnInvalidPolygonStaysAHole) {  // 4 x 4 cells
  const std::string square = "POLYGON((0 0,40 0,40 40,0 40,0 0),";
  const std::size_t lane = read({{"POLYGON((0 0,10 0,10 20,20 20,20 0,40 0,40 40,0 40,0 0))"}}).cells.size();
  EXPECT_EQ(lane, 14U);  // the same gap of 1 x 2 cells, drawn in the outer ring
  EXPECT_EQ(read({{square + "(10 0,20 0,20 20,10 20,10 0))"}}).cells.size(), lane) << "shares an edge";
  EXPECT_EQ(read({{square + "(10 -20,20 -20,20 20,10 20,10 -20))"}}).cells.size(), lane) << "reaches beyond";
  EXPECT_EQ(read({{square + "(10 10,30 10,30 20,10 20,10 10),(20 10,30 10,30 30,20 30,20 10))"}}).cells.size(), 13U)
      << "overlaps another: 2 + 2 - 1 cells";
}

TEST_F(Sources, CellsWithoutTerrainAreLeftOut) {
  terrain_.heights.at(1, 0) = std::numeric_limits<float>::quiet_NaN();
  const SourceLayer layer = read({{"POLYGON((0 0,30 0,30 10,0 10,0 0))"}, {"POINT(15 5)"}});
  EXPECT_EQ(cells(layer), (Cells{{0, 0}, {2, 0}}));
  EXPECT_TRUE(said(layer.warnings, "2 source cells or points have no height"));
  expect_input_error([&] { read({{"POINT(15 5)"}}); }, {"s.gpkg", "no heights in any of its 1 cells"});
}

TEST_F(Sources, FeaturesOffTheMapAreNamed) {
  const SourceLayer layer = read({{"POINT(500 5)"}, {"POINT(5 5)"}, {"LINESTRING(-9 -9,-1 -1)"}});
  EXPECT_EQ(layer.cells.size(), 1U);
  EXPECT_EQ(layer.cells[0].feature, 1U);
  EXPECT_EQ(layer.features.size(), 3U);
  EXPECT_TRUE(said(layer.warnings, "wholly off the DEM, which release nothing: FID 1, 3"));
}

TEST_F(Sources, FeaturesThatReleaseNothingLoseTheirEvents) {
  terrain_.heights.at(9, 0) = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::pair<std::string, OGRFieldType>> fields{{"frequency", OFTReal}};
  const std::vector<std::string> all =
      read({{"POINT(500 5)", {"0.3"}}, {"POINT(5 5)", {"2"}}, {"POINT(-9 -9)", {"0.5"}}, {"POINT(95 5)", {"0.25"}}},
           fields)
          .warnings;
  EXPECT_TRUE(
      said(all, "off the DEM, which release nothing: FID 1, 3, and their 0.8 events per year are lost"));  // 0.3 + 0.5
  EXPECT_TRUE(said(all, "no heights, which release nothing: FID 4, and its 0.25 events per year are lost"));
  EXPECT_EQ(std::ranges::count_if(all, is_of_cut_sources), 3) << "and the count of cells without a height";
  for (const char* none : {"0", "NULL"})
    EXPECT_FALSE(said(read({{"POINT(500 5)", {none}}, {"POINT(5 5)", {"2"}}}, fields).warnings, "events per year"));
  EXPECT_FALSE(std::ranges::any_of(read({{"POINT(5 5)", {"2"}}}, fields).warnings, is_of_cut_sources)) << "at the edge";
}

TEST_F(Sources, AllOffTheMapGivesBothExtents) {
  expect_input_error(
      [&] {
        read({{"POINT(1000 5)"}, {"POINT(2000 900)"}});
      },
      {"s.gpkg", "off the DEM", "east 601000 to 602000, north 5200005 to 5200900",
       "east 600000 to 600100, north 5200000 to 5200080", "EPSG:32632"});
}

TEST_F(Sources, EmptyLayersAreRefused) {
  expect_input_error([&] { read({}); }, {"s.gpkg", "no features"});
  expect_input_error([&] { read({{""}, {"POLYGON EMPTY"}}); }, {"s.gpkg", "none of its features has a geometry"});
  EXPECT_TRUE(said(read({{""}, {"POINT(5 5)"}}).warnings,
                   "features without geometry (or with one that cannot be read), which release nothing: FID 1"));
}

TEST_F(Sources, OtherLayersAreNamed) {
  const std::string file = write_vector(path("two.gpkg"), "EPSG:32632", {}, {{"POINT(5 5)"}});
  GDALDataset* out = GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE);
  out->CreateLayer("second", nullptr, wkbPoint, nullptr);
  GDALClose(out);
  expect_input_error([&] { read_sources(file, terrain_, {1, 1}); }, {"layer, second", "'two.gpkg|layername=layer'"});
}

TEST_F(Sources, WithoutASystemTheDemsIsTaken) {
  const std::string file =
      write_vector(path("none.shp"), "", {{"a", OFTInteger}}, {{"POINT(600005 5200005)"}}, wkbPoint);
  const SourceLayer layer = read_sources(file, terrain_, {1, 1});
  EXPECT_EQ(layer.cells.size(), 1U);
  EXPECT_TRUE(said(layer.warnings, "states no coordinate system"));
}

}  // namespace talus::io::test
