// Files of the writers, read back with GDAL and compared with the values that were given.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "io/files/cog_file.hpp"
#include "io/files/compression.hpp"
#include "io/gdal/dataset.hpp"
#include "talus/base/error.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/run_record.hpp"
#include "talus/io/results/style.hpp"
#include "talus/io/results/write_crossings.hpp"
#include "talus/io/results/write_rasters.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test.
class Write : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("talus-" + std::string(test->name()) + "-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string text_of_file(const fs::path& path) const {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  static OGRSpatialReference system() {
    OGRSpatialReference lv95;
    lv95.importFromEPSG(2056);
    return lv95;
  }

  MapTarget target(int columns, int rows) const {
    const OGRSpatialReference lv95 = system();
    return {folder_, {wkt_of(&lv95), 2600000.0, 1200000.0, 2.0, 3.0}, columns, rows, {}};
  }

  fs::path folder_;
};

constexpr int kMapColumns = 1101, kMapRows = 703;  // two overviews, and edges that are not whole blocks

/// A value that depends on its column, row (from the south) and band; NaN in the south-western corner.
double value_at(int column, int row, std::size_t band) {
  if (column < 40 && row < 40) return std::nan("");
  return (column * 31 + row * 17) % 1009 + 2000.0 * static_cast<double>(band);
}

Map map_of(Map::Kind kind, std::vector<Map::Band> bands) {
  const std::size_t count = bands.size();
  Map map{"energy", "A test", kind, std::move(bands), {}};
  map.fill = [count](const CellWindow& window, std::span<double> values) {
    auto value = values.begin();
    for (int row = window.row; row < window.row + window.rows; ++row)
      for (int c = window.column; c < window.column + window.columns; ++c)
        for (std::size_t b = 0; b < count; ++b) *value++ = value_at(c, row, b);
  };
  return map;
}

/// Writes a map by one thread. False if `proceed` ended it.
bool write_map(const Map& map, const MapTarget& target) {
  MapFile file(map, target);
  bool whole = false;
  for (std::size_t i = 0, parts = file.parts(); i < parts; ++i) {
    if (target.proceed && !target.proceed()) return false;
    whole = file.write_part(i);
  }
  return whole;
}

std::vector<float> read(GDALRasterBand* band) {
  std::vector<float> values(static_cast<std::size_t>(band->GetXSize()) * static_cast<std::size_t>(band->GetYSize()));
  EXPECT_EQ(band->RasterIO(GF_Read, 0, 0, band->GetXSize(), band->GetYSize(), values.data(), band->GetXSize(),
                           band->GetYSize(), GDT_Float32, 0, 0, nullptr),
            CE_None);
  return values;
}

TEST_F(Write, RasterIsACogOfTheRightPlaceAndValues) {
  const Map map = map_of(Map::Kind::Quantity, {{"mean", "kJ"}, {"P95", "kJ"}});
  ASSERT_TRUE(write_map(map, target(kMapColumns, kMapRows)));
  const Dataset file = open_dataset((folder_ / "energy.tif").string(), GDAL_OF_RASTER);
  EXPECT_STREQ(file->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
  EXPECT_STREQ(file->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
  EXPECT_STREQ(file->GetMetadataItem("AREA_OR_POINT"), "Area");
  EXPECT_STREQ(file->GetMetadataItem("TITLE"), "A test");
  double transform[6];
  ASSERT_EQ(file->GetGeoTransform(transform), CE_None);
  EXPECT_EQ(std::vector<double>(transform, transform + 6),
            (std::vector<double>{2600000.0, 2.0, 0.0, 1200000.0, 0.0, -3.0}));
  const OGRSpatialReference lv95 = system();
  EXPECT_TRUE(file->GetSpatialRef()->IsSame(&lv95));
  ASSERT_EQ(file->GetRasterCount(), 2);
  for (int b = 0; b < 2; ++b) {
    GDALRasterBand* band = file->GetRasterBand(b + 1);
    EXPECT_EQ(band->GetRasterDataType(), GDT_Float32);
    EXPECT_EQ(band->GetNoDataValue(), -9999.0);
    EXPECT_STREQ(band->GetDescription(), b == 0 ? "mean" : "P95");
    EXPECT_STREQ(band->GetUnitType(), "kJ");
    const std::vector<float> values = read(band);
    for (int row = 0; row < kMapRows; ++row)
      for (int c = 0; c < kMapColumns; ++c) {
        const double given =
            value_at(c, kMapRows - 1 - row, static_cast<std::size_t>(b));  // the file begins in the north
        ASSERT_EQ(values[static_cast<std::size_t>(row * kMapColumns + c)], std::isnan(given) ? -9999.0 : given)
            << c << ' ' << row;
      }
  }
}

TEST_F(Write, OverviewsKeepTheLargestValue) {
  for (const Map::Kind kind : {Map::Kind::Quantity, Map::Kind::Count}) {
    ASSERT_TRUE(write_map(map_of(kind, {{"a", "1"}, {"b", "1"}}), target(kMapColumns, kMapRows)));
    const Dataset file = open_dataset((folder_ / "energy.tif").string(), GDAL_OF_RASTER);
    GDALRasterBand* band = file->GetRasterBand(2);
    const auto nodata = static_cast<float>(band->GetNoDataValue());
    ASSERT_EQ(band->GetOverviewCount(), 2);
    for (int level = 0; level < 2; ++level) {
      GDALRasterBand* overview = band->GetOverview(level);
      const int factor = 2 << level, width = (kMapColumns + factor - 1) / factor,
                height = (kMapRows + factor - 1) / factor;
      ASSERT_EQ(overview->GetXSize(), width);
      ASSERT_EQ(overview->GetYSize(), height);
      std::vector<float> expected(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), -1.0F);
      for (int row = 0; row < kMapRows; ++row)
        for (int c = 0; c < kMapColumns; ++c) {
          float& largest = expected[static_cast<std::size_t>(row / factor * width + c / factor)];
          const double value = value_at(c, kMapRows - 1 - row, 1);
          if (value > largest) largest = static_cast<float>(value);
        }
      std::replace(expected.begin(), expected.end(), -1.0F, nodata);
      EXPECT_EQ(read(overview), expected) << level;
    }
  }
}

TEST_F(Write, CountsAreUInt32) {
  Map map = map_of(Map::Kind::Count, {{"passages", "count"}});
  map.fill = [](const CellWindow&, std::span<double> values) {
    std::fill(values.begin(), values.end(), std::nan(""));
    values[0] = 0.0;
    values[1] = 4e9;
    values[2] = 1e15;  // more than the type holds
  };
  ASSERT_TRUE(write_map(map, target(5, 1)));
  const Dataset file = open_dataset((folder_ / "energy.tif").string(), GDAL_OF_RASTER);
  GDALRasterBand* band = file->GetRasterBand(1);
  EXPECT_EQ(band->GetRasterDataType(), GDT_UInt32);
  EXPECT_EQ(band->GetNoDataValue(), 4294967295.0);
  std::vector<std::uint32_t> values(5);
  ASSERT_EQ(band->RasterIO(GF_Read, 0, 0, 5, 1, values.data(), 5, 1, GDT_UInt32, 0, 0, nullptr), CE_None);
  EXPECT_EQ(values, (std::vector<std::uint32_t>{0, 4000000000, 4294967294, 4294967295, 4294967295}));
}

TEST_F(Write, EqualMapsGiveEqualBytesAndNothingElse) {
  const Map map = map_of(Map::Kind::Probability, {{"probability", "1"}});
  ASSERT_TRUE(write_map(map, target(kMapColumns, kMapRows)));
  const std::string first = text_of_file(folder_ / "energy.tif");
  ASSERT_TRUE(write_map(map, target(kMapColumns, kMapRows)));
  EXPECT_EQ(text_of_file(folder_ / "energy.tif"), first);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

/// Rectangle of cells with equal values in a map that is quiet everywhere else; known as such by `everywhere` or not.
Map quiet_map(bool known) {
  const auto quiet = [](const CellWindow& w) { return w.row >= 300 || w.column + w.columns <= 512; };
  Map map = map_of(Map::Kind::Quantity, {{"mean", "kJ"}, {"P95", "kJ"}});
  map.smallest_in_overviews = true;
  map.fill = [quiet](const CellWindow& window, std::span<double> values) {
    auto value = values.begin();
    for (int row = window.row; row < window.row + window.rows; ++row)
      for (int c = window.column; c < window.column + window.columns; ++c)
        for (std::size_t b = 0; b < 2; ++b)
          *value++ = quiet({c, row, 1, 1}) ? (b == 0 ? 7.0 : std::nan("")) : value_at(c, row, b);
  };
  if (known)
    map.everywhere = [quiet](const CellWindow& window) -> std::optional<std::vector<double>> {
      if (!quiet(window)) return std::nullopt;
      return std::vector<double>{7.0, std::nan("")};
    };
  return map;
}

TEST_F(Write, OverviewsOfAChangeShowWhatIsFarthestFromZero) {
  Map map{"change", "A test", Map::Kind::Quantity, {{"change", "kJ"}}, {}};
  map.farthest_in_overviews = true;
  map.fill = [](const CellWindow& window, std::span<double> values) {  // -20000, 3, nothing, nothing in turn
    for (std::size_t i = 0; i < values.size(); ++i) {
      const int column = window.column + static_cast<int>(i) % window.columns;
      values[i] = column % 4 == 0 ? -20000.0 : column % 4 == 1 ? 3.0 : std::nan("");
    }
  };
  ASSERT_TRUE(write_map(map, target(600, 600)));
  const Dataset file = open_dataset((folder_ / "change.tif").string(), GDAL_OF_RASTER);
  GDALRasterBand* overview = file->GetRasterBand(1)->GetOverview(0);
  std::vector<float> values(2);
  ASSERT_EQ(overview->RasterIO(GF_Read, 0, 0, 2, 1, values.data(), 2, 1, GDT_Float32, 0, 0, nullptr), CE_None);
  EXPECT_EQ(values, (std::vector{-20000.0F, -9999.0F}));
}

TEST_F(Write, QuietPartsHaveTheBytesOfAnyOther) {
  ASSERT_TRUE(write_map(quiet_map(false), target(kMapColumns, kMapRows)));
  const std::string looked_at = text_of_file(folder_ / "energy.tif");
  ASSERT_TRUE(write_map(quiet_map(true), target(kMapColumns, kMapRows)));
  EXPECT_EQ(text_of_file(folder_ / "energy.tif"), looked_at);
}

/// A map on which nothing happens takes no room: nine bands of zeros and bounds, as those of heights that no block
/// exceeds.
TEST_F(Write, AnEvenMapOfManyBandsTakesLittleRoom) {
  constexpr int kSide = 1024;
  Map map{"energy", "A test", Map::Kind::Probability, std::vector<Map::Band>(9, {"p", "1"}), {}};
  map.fill = [](const CellWindow&, std::span<double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 9 >= 4 && i % 9 % 2 == 0 ? 3.6888725e-06 : 0.0;
  };
  ASSERT_TRUE(write_map(map, target(kSide, kSide)));
  EXPECT_LT(fs::file_size(folder_ / "energy.tif"), 9U * 4U * kSide * kSide / 200U);
}

TEST_F(Write, PartsInAnyOrderGiveTheSameBytes) {
  const Map map = quiet_map(true);
  const MapTarget to = target(kMapColumns, kMapRows);
  ASSERT_TRUE(write_map(map, to));
  const std::string first = text_of_file(folder_ / "energy.tif");
  fs::remove(folder_ / "energy.tif");
  MapFile file(map, to);
  for (std::size_t i = file.parts(); i-- > 0;) {
    EXPECT_FALSE(fs::exists(folder_ / "energy.tif"));
    EXPECT_EQ(file.write_part(i), i == 0);
  }
  EXPECT_EQ(text_of_file(folder_ / "energy.tif"), first);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

/// Bits of row and column in turn, by hand: 5 x 3 tiles, of which two squares of 4 x 4 are cut.
TEST_F(Write, PartsLieSquareAfterSquare) {
  const Map map = map_of(Map::Kind::Quantity, {{"mean", "kJ"}});
  const MapTarget to = target(kMapColumns, kMapRows);
  MapFile file(map, to);
  std::vector<std::uint64_t> places;
  for (std::size_t i = 0; i < file.parts(); ++i) places.push_back(file.place_of(i));
  EXPECT_EQ(places, (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 13, 16, 18, 24}));
}

TEST_F(Write, AMapThatIsNotFinishedLeavesNothing) {
  const Map map = quiet_map(true);
  const MapTarget to = target(kMapColumns, kMapRows);
  {
    MapFile file(map, to);
    file.write_part(0);
    EXPECT_FALSE(fs::is_empty(folder_));
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Write, ALargeFileIsABigTiffOfTheSamePixels) {
  TileStore store(folder_ / "map.tif");
  const std::vector<float> pixels(128 * 128, 5.0F);
  SmallTiff small(1, GDT_Float32);
  const CogLevel level{128, 128, 1, 1, {store.add(deflated(std::as_bytes(std::span(pixels))))}};
  const CogLevel overview{64, 64, 1, 1, {TilePlace{}}};
  CogFormat format{128, kDeflate, small.tags()};
  format.most_small = 0;
  ASSERT_TRUE(write_cog(folder_ / "map.tif", format, std::array{level, overview}, store, {}));
  EXPECT_EQ(text_of_file(folder_ / "map.tif").substr(0, 4), std::string("II+\0", 4));
  const Dataset file = open_dataset((folder_ / "map.tif").string(), GDAL_OF_RASTER);
  EXPECT_STREQ(file->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
  EXPECT_EQ(read(file->GetRasterBand(1)), pixels);
  EXPECT_EQ(file->GetRasterBand(1)->GetOverviewCount(), 1);
}

TEST_F(Write, AnEndedMapLeavesNothing) {
  for (const int allowed : {0, 3, 12}) {
    MapTarget ended = target(kMapColumns, kMapRows);
    int asked = 0;
    ended.proceed = [&asked, allowed] { return asked++ < allowed; };
    EXPECT_FALSE(write_map(map_of(Map::Kind::Quantity, {{"mean", "kJ"}}), ended)) << allowed;
    EXPECT_TRUE(fs::is_empty(folder_));
  }
}

TEST_F(Write, AFolderThatIsGoneIsAnError) {
  MapTarget gone = target(kMapColumns, kMapRows);
  gone.folder /= "none";
  try {
    write_map(map_of(Map::Kind::Quantity, {{"mean", "kJ"}}), gone);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("energy.tif: cannot be created"), std::string::npos) << error.what();
  }
}

TEST_F(Write, FolderAppearsOnlyWhenCommitted) {
  const fs::path out = folder_ / "out";
  {
    const OutputFolder folder(out, false);
    write_text(folder.temporary() / "run.json", "{}");
  }
  EXPECT_TRUE(fs::is_empty(folder_));
  {
    OutputFolder folder(out.string() + "/", false);
    write_text(folder.temporary() / "run.json", "first");
    EXPECT_FALSE(fs::exists(out));
    folder.commit();
  }
  EXPECT_EQ(text_of_file(out / "run.json"), "first");
  EXPECT_THROW(OutputFolder(out, false), InputError);
  {
    OutputFolder folder(out, true);
    write_text(folder.temporary() / "run.json", "second");
    EXPECT_EQ(text_of_file(out / "run.json"), "first");
    EXPECT_THROW(folder.protect(out / "dem.tif"), InputError);
    EXPECT_NO_THROW(folder.protect(folder_ / "dem.tif"));
    EXPECT_NO_THROW(folder.protect(folder_ / "outer" / "dem.tif"));
    folder.commit();
  }
  EXPECT_EQ(text_of_file(out / "run.json"), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
}

TEST_F(Write, AFolderIsWrittenByOneProcessAtATime) {
  using Unfinished = OutputFolder::Unfinished;
  for (const Unfinished unfinished : {Unfinished::Ignore, Unfinished::Refuse, Unfinished::Resume}) {
    const OutputFolder first(folder_ / "out", false, unfinished);
    EXPECT_THROW(OutputFolder(folder_ / "out", false), InputError);
    EXPECT_NO_THROW(OutputFolder(folder_ / "other", false));
    EXPECT_TRUE(fs::exists(first.temporary()));
  }
}

TEST_F(Write, OnlyResultsAreReplaced) {
  write_text(folder_ / "file", "");
  fs::create_directory(folder_ / "mine");
  write_text(folder_ / "mine" / "diary.txt", "");
  EXPECT_THROW(OutputFolder(folder_ / "file", true), InputError);
  EXPECT_THROW(OutputFolder(folder_ / "mine", true), InputError);
  EXPECT_THROW(OutputFolder(folder_ / "file" / "out", true), InputError);
  EXPECT_THROW(OutputFolder("", true), InputError);
  EXPECT_THROW(OutputFolder("/", true), InputError);
}

TEST_F(Write, FoldersAboveAreMadeAndRemovedIfEmpty) {
  { const OutputFolder refused(folder_ / "a" / "b" / "out", false); }
  EXPECT_FALSE(fs::exists(folder_ / "a"));
  {
    OutputFolder folder(folder_ / "a" / "b" / "out", false);
    folder.commit();
  }
  EXPECT_TRUE(fs::is_directory(folder_ / "a" / "b" / "out"));
  { const OutputFolder refused(folder_ / "a" / "c" / "out", false); }
  EXPECT_TRUE(fs::exists(folder_ / "a" / "b"));
  EXPECT_FALSE(fs::exists(folder_ / "a" / "c"));
}

TEST_F(Write, TextOnAFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  fs::create_symlink("/dev/full", folder_ / "run.json");
  EXPECT_THROW(write_text(folder_ / "run.json", "{}"), std::runtime_error);
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder_ / "run.json")));
}

TEST(RunRecord, LimitsAreJudgedByTheirShare) {
  Totals totals;
  totals.released = 10'000;
  totals.limited_blocks = 10;  // exactly the allowed 0.1 %
  EXPECT_FALSE(too_many_limits(totals));
  totals.limited_blocks = 11;
  EXPECT_TRUE(too_many_limits(totals));
}

}  // namespace
}  // namespace talus::io
