#include <cmath>

#include "files.hpp"
#include "talus/base/input_faults.hpp"
#include "talus/io/gdal/vectors.hpp"

namespace talus::io::test {

using Fields = std::vector<std::pair<std::string, OGRFieldType>>;

class Attributes : public Files {
 protected:
  Attributes() : terrain_(read_terrain(RasterFile{}.write(path("dem.tif")))) {}

  SourceLayer read(const Fields& fields, const std::vector<std::vector<std::string>>& values) {
    std::vector<Row> rows;
    for (const auto& row : values) rows.push_back({"POINT(5 5)", row});
    return read_sources(write_vector(path("s.gpkg"), "EPSG:32632", fields, rows), terrain_, Range{0.5, 2.0});
  }

  Terrain terrain_;
};

TEST_F(Attributes, AreReadWhateverTheirCase) {
  const SourceLayer layer = read({{"Name", OFTString},
                                  {"FREQUENCY", OFTReal},
                                  {"Diameter", OFTInteger},
                                  {"release_height", OFTReal},
                                  {"vx", OFTReal},
                                  {"VY", OFTReal},
                                  {"vz", OFTInteger64}},
                                 {{"north face", "0.25", "2", "12.5", "1.5", "-2.5", "3"}});
  const SourceFeature& f = layer.features[0];
  EXPECT_EQ(f.name, "north face");
  EXPECT_DOUBLE_EQ(f.frequency, 0.25);
  EXPECT_EQ(f.diameter, (Range{2.0, 2.0}));
  EXPECT_EQ(f.release_height, (Range{12.5, 12.5}));
  EXPECT_EQ(f.velocity, Vec3(1.5, -2.5, 3.0));
}

TEST_F(Attributes, NullIsNotGiven) {
  const SourceLayer layer =
      read({{"frequency", OFTReal},
            {"diameter", OFTReal},
            {"diameter_min", OFTReal},
            {"diameter_max", OFTReal},
            {"release_height", OFTReal},
            {"vx", OFTReal}},
           {{"NULL", "NULL", "NULL", "NULL", "NULL", "NULL"}, {"NULL", "NULL", "0.5", "1.5", "NULL", "NULL"}});
  EXPECT_TRUE(std::isnan(layer.features[0].frequency));
  EXPECT_TRUE(std::isnan(layer.features[0].diameter.low));
  EXPECT_EQ(layer.features[0].release_height, (Range{0.5, 2.0}));
  EXPECT_EQ(layer.features[0].velocity, Vec3(0, 0, 0));
  EXPECT_EQ(layer.features[1].diameter, (Range{0.5, 1.5}));
}

TEST_F(Attributes, AreRecorded) {
  const SourceLayer layer = read({{"diameter", OFTReal}}, {{"0.5"}, {"NULL"}, {"2"}});
  ASSERT_EQ(layer.attributes.size(), 1U);
  EXPECT_EQ(layer.attributes[0].key, "sources.attributes.diameter");
  EXPECT_EQ(layer.attributes[0].value, "0.5 to 2 (2 of 3 features)");
  EXPECT_EQ(layer.attributes[0].unit, "m");
  EXPECT_EQ(layer.attributes[0].source, "attribute diameter of s.gpkg");
}

TEST_F(Attributes, OutOfBoundsNamesFeatureFieldValueAndBounds) {
  expect_input_error(
      [&] {
        read({{"diameter", OFTReal}}, {{"1"}, {"0"}});
      },
      {"s.gpkg: feature 2", "diameter = 0", "0.01 to 50 m", "NULL"});
  expect_input_error(
      [&] {
        read({{"frequency", OFTReal}}, {{"-1"}});
      },
      {"feature 1", "frequency = -1", "0 to 1000000 1/year"});
  expect_input_error(
      [&] {
        read({{"release_height", OFTReal}}, {{"600"}});
      },
      {"feature 1", "release_height = 600", "0 to 500 m"});
  expect_input_error([&] { read({{"vz", OFTReal}}, {{"-201"}}); }, {"feature 1", "vz = -201", "-200 to 200 m/s"});
  expect_input_error(
      [&] {
        read({{"vx", OFTReal}, {"vy", OFTReal}}, {{"150", "150"}});
      },
      {"feature 1", "212.", "at most 200 m/s"});
}

TEST_F(Attributes, DiametersMustAgree) {
  const Fields fields{{"diameter", OFTReal}, {"diameter_min", OFTReal}, {"diameter_max", OFTReal}};
  expect_input_error([&] { read(fields, {{"1", "0.5", "1.5"}}); }, {"feature 1", "diameter = 1", "must be either"});
  expect_input_error([&] { read(fields, {{"NULL", "0.5", "NULL"}}); }, {"diameter_min = 0.5 without diameter_max"});
  expect_input_error([&] { read(fields, {{"NULL", "NULL", "0.5"}}); }, {"diameter_max = 0.5 without diameter_min"});
  expect_input_error([&] { read(fields, {{"NULL", "2", "1"}}); }, {"diameter_min = 2 is larger than diameter_max = 1"});
}

TEST_F(Attributes, AShapefileWithATextForANumberIsRefused) {
  const std::string file =
      write_vector(path("s.shp"), "EPSG:32632", {{"diameter", OFTString}}, {{"POINT(5 5)", {"1,2"}}}, wkbPoint);
  expect_input_error(
      [&] {
        read_sources(file, terrain_, {1, 1});
      },
      {"s.shp: feature 0", "diameter = '1,2'", "with a point for decimals", "replace(the field"});
}

TEST_F(Attributes, AShapefileCutsThePairOfDiameters) {  // GDAL writes diameter_m and diameter_1
  const std::string file =
      write_vector(path("s.shp"), "EPSG:32632", {{"diameter_min", OFTReal}, {"diameter_max", OFTReal}},
                   {{"POINT(5 5)", {"0.5", "1.8"}}}, wkbPoint);
  const Range diameter = read_sources(file, terrain_, {1, 1}).features[0].diameter;
  EXPECT_EQ(diameter.low, 0.5);
  EXPECT_EQ(diameter.high, 1.8);
}

TEST_F(Attributes, NamesThatAShapefileHasCutAreReadInEveryFormat) {  // ogr2ogr cliffs.gpkg cliffs.shp
  const Fields fields{{"diameter_m", OFTReal}, {"diameter_1", OFTReal}, {"release_he", OFTReal}};
  const SourceFeature feature = read(fields, {{"0.5", "1.8", "3"}}).features[0];
  EXPECT_EQ(feature.diameter.low, 0.5);
  EXPECT_EQ(feature.diameter.high, 1.8);
  EXPECT_EQ(feature.release_height.high, 3.0);
  EXPECT_TRUE(std::isnan(read({{"diameter_m", OFTReal}}, {{"0.5"}}).features[0].diameter.low));  // alone: of no pair
}

TEST_F(Attributes, NumbersInATextFieldAreRead) {
  const SourceLayer layer = read({{"diameter", OFTString}}, {{"1.25"}, {" 2 "}, {"NULL"}});
  EXPECT_EQ(layer.features[0].diameter.low, 1.25);
  EXPECT_EQ(layer.features[1].diameter.low, 2.0);
  EXPECT_TRUE(std::isnan(layer.features[2].diameter.low));
  EXPECT_NE(layer.read_note.find("diameter 1.25 to 2 m (2 of 3 features, 1 empty; text, read as numbers)"),
            std::string::npos)
      << layer.read_note;
}

TEST_F(Attributes, EveryFaultIsListed) {
  const Fields fields{{"diameter", OFTReal}, {"release_height", OFTReal}};
  try {
    read(fields, {{"-1", "2"}, {"1", "2"}, {"2000", "-5"}});
    FAIL();
  } catch (const InputFaults& error) {
    ASSERT_EQ(error.faults().size(), 3U);
    EXPECT_NE(error.faults()[0].find("feature 1: field diameter = -1"), std::string::npos);
    EXPECT_NE(error.faults()[1].find("feature 3: field diameter = 2000"), std::string::npos);
    EXPECT_NE(error.faults()[2].find("feature 3: field release_height = -5"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("(and 2 more faults)"), std::string::npos);
  }
}

TEST_F(Attributes, AFeatureWithoutANameHasItsNumber) {
  const SourceLayer layer = read({{"name", OFTString}}, {{"cliff"}, {"NULL"}});
  EXPECT_EQ(layer.features[0].name, "cliff");
  EXPECT_EQ(layer.features[1].name, "2");
}

TEST_F(Attributes, ATextFieldWithoutTextIsNotGiven) {
  EXPECT_TRUE(std::isnan(read({{"diameter", OFTString}}, {{"NULL"}, {""}}).features[0].diameter.low));
}

TEST_F(Attributes, TheNamesOfACsvStayAsTheyStand) {
  const SourceLayer layer = read_sources(write_text("s.csv",
                                                    "x,y,name,diameter\n600005,5200005,0123, 1.5 \n600006,5200005,"
                                                    "2020-01-01,+2\n600007,5200005,12345678901234567891,1e-1\n"),
                                         terrain_, {1, 1});
  ASSERT_EQ(layer.features.size(), 3U);
  EXPECT_EQ(layer.features[0].name, "0123");
  EXPECT_EQ(layer.features[1].name, "2020-01-01");
  EXPECT_EQ(layer.features[2].name, "12345678901234567891");
  EXPECT_EQ(layer.features[0].diameter, (Range{1.5, 1.5}));
  EXPECT_EQ(layer.features[1].diameter, (Range{2, 2}));
  EXPECT_EQ(layer.features[2].diameter, (Range{0.1, 0.1}));
}

TEST_F(Attributes, ACsvHoldsNumbers) {
  const std::string file =
      write_text("s.csv",
                 "id,wkt,diameter,vx,release_height\n1,POINT (600005 5200005),1.5,,3\n2,\"LINESTRING "
                 "(600001 5200001, 600012 5200001)\",,,\n");
  const SourceLayer layer = read_sources(file, terrain_, {1, 1});
  EXPECT_EQ(layer.cells.size(), 3U);
  EXPECT_EQ(layer.features[0].diameter, (Range{1.5, 1.5}));
  EXPECT_EQ(layer.features[0].release_height, (Range{3, 3}));
  EXPECT_TRUE(std::isnan(layer.features[1].diameter.low));
  for (const std::string& warning : layer.warnings)
    EXPECT_NE(warning.find("at the edge of the DEM"), std::string::npos) << warning;
}

}  // namespace talus::io::test
