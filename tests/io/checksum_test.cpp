#include "io/files/checksum.hpp"

#include <set>

#include "files.hpp"

namespace talus::io::test {

std::string sum(const std::string& text) {
  Sha256 s;
  s.add(text);
  return s.digits();
}

// FIPS 180-4 examples (NIST CSRC, "SHA256.pdf" and "SHA2_Additional.pdf").
TEST(Sha256Sum, KnownAnswers) {
  EXPECT_EQ(sum(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sum("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sum("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sum(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256Sum, DoesNotDependOnThePieces) {
  for (const std::size_t length : {55U, 56U, 63U, 64U, 65U, 119U, 120U, 128U}) {
    const std::string text(length, 'x');
    Sha256 s;
    for (const char c : text) s.add({&c, 1});
    EXPECT_EQ(s.digits(), sum(text)) << length;
  }
}

using Sha256Files = Files;

TEST_F(Sha256Files, AShapefileIsItsPartsOneAfterTheOther) {
  for (const char* part : {"shp", "dbf", "shx", "prj"}) write_text(std::string("a.") + part, part);
  EXPECT_EQ(sha256_of_file(path("a.shp")), sum("shpdbfshxprj"));
  EXPECT_EQ(sha256_of_file(write_text("b.csv", "abc")), sum("abc"));
  EXPECT_EQ(sha256_of_file(path("nothing")), "");
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(Sha256Files, ARasterIsAllThatIsReadWithItButItsStatistics) {
  RasterFile placed, unplaced;
  unplaced.placed = false;
  const std::string alone = placed.write(path("alone.tif")), beside = unplaced.write(path("beside.tif"));
  EXPECT_EQ(sha256_of_file(alone), sum(content(alone)));
  EXPECT_EQ(sha256_of_file(beside), sum(content(beside)));
  write_text("beside.tfw", "10\n0\n0\n-10\n600005\n5200075\n");
  const std::string both = sum(content(beside) + content(path("beside.tfw")));
  EXPECT_EQ(sha256_of_file(beside), both);
  write_text("beside.tif.aux.xml", "<PAMDataset><Metadata><MDI key=\"A\">b</MDI></Metadata></PAMDataset>");
  EXPECT_EQ(sha256_of_file(beside), both);
  EXPECT_EQ(sha256_of_file("GTIFF_DIR:1:" + alone), sum(content(alone)));
}

std::string beside(const std::string& band, const std::string& dataset = "") {
  return "<PAMDataset>" + dataset + "<PAMRasterBand band=\"1\">" + band + "</PAMRasterBand></PAMDataset>";
}

// What GDAL 3.6 takes from NAME.aux.xml (gcore/gdalpamdataset.cpp), and what gdalinfo -stats -hist and QGIS write
// there.
TEST_F(Sha256Files, ARasterIsAlsoWhatIsSaidBesideIt) {
  const std::string dem = RasterFile{}.write(path("dem.tif")), alone = sha256_of_file(dem);
  const std::string statistics =
      "<Description>b</Description><Histograms><HistItem><HistMin>1</HistMin></HistItem></Histograms><Metadata>"
      "<MDI key=\"STATISTICS_MEAN\">5</MDI></Metadata><ColorInterp>Gray</ColorInterp>";
  std::set<std::string> sums{alone};
  for (const auto& [band, dataset] : std::vector<std::pair<std::string, std::string>>{
           {"<Scale>0.5</Scale>", ""},
           {"<Offset>300</Offset>", ""},
           {"<Offset>301</Offset>", ""},
           {"<NoDataValue>0</NoDataValue>", ""},
           {"<UnitType>ft</UnitType>", ""},
           {"<ColorInterp>Alpha</ColorInterp>", ""},
           {"", "<PAMRasterBand band=\"2\"><ColorInterp>Gray</ColorInterp></PAMRasterBand>"},  // it was alpha
           {"", "<SRS>EPSG:2056</SRS>"},
           {"", "<GeoTransform>0, 5, 0, 0, 0, -5</GeoTransform>"},
           {"", "<Metadata><MDI key=\"NODATA_VALUES\">0</MDI></Metadata>"},
           {"", "<Metadata domain=\"xml:ESRI\" format=\"xml\"><GeodataXform/></Metadata>"}}) {
    write_text("dem.tif.aux.xml", beside(band, dataset));
    const std::string said = sha256_of_file(dem);
    EXPECT_TRUE(sums.insert(said).second) << band << dataset;
    write_text("dem.tif.aux.xml", beside("\n  " + band + statistics, dataset));
    EXPECT_EQ(sha256_of_file(dem), said) << band << dataset;
  }
  for (const std::string& text :
       {beside(statistics), beside("", "<Metadata domain=\"ENVI\"><MDI key=\"a\">b</MDI></Metadata>"),
        std::string("<PAMDataset/>"), std::string("<PAMDataset>"), std::string()}) {
    write_text("dem.tif.aux.xml", text);
    EXPECT_EQ(sha256_of_file(dem), alone) << text;
  }
}

TEST_F(Sha256Files, ALayerIsAllThatIsReadWithIt) {
  for (const char* end : {"tab", "dat", "map", "id"}) write_text(std::string("a.") + end, end);
  EXPECT_EQ(sha256_of_file(path("a.tab")), sum("tabdatmapid"));
  write_text("B.SHP", "shp");
  write_text("B.DBF", "dbf");
  EXPECT_EQ(sha256_of_file(path("B.SHP")), sum("shpdbf")) << "capitals";
  write_text("c.gpkg", "gpkg");
  write_text("c.gpkg-wal", "wal");
  EXPECT_EQ(sha256_of_file(path("c.gpkg") + "|layername=cliffs"), sum("gpkgwal"));
}

TEST_F(Sha256Files, WhatWasReadHasAChecksum) {
  EXPECT_EQ(recorded_input("dem", write_text("b.csv", "abc")).sha256, sum("abc"));
  EXPECT_THROW(recorded_input("dem", path("nothing")), InputError);
}

}  // namespace talus::io::test
