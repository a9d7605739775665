#include <gtest/gtest.h>

#include <set>

#include "io/gdal/pixels.hpp"

namespace talus::io {
namespace {

/// An empty GeoTIFF in memory with blocks of a size.
class Packed {
 public:
  Packed(int columns, int rows, int block_columns, int block_rows) {
    start_gdal();
    const bool tiled = block_columns < columns;
    const std::string x = "BLOCKXSIZE=" + std::to_string(block_columns), y = "BLOCKYSIZE=" + std::to_string(block_rows);
    const char* const options[] = {tiled ? "TILED=YES" : "TILED=NO", y.c_str(), tiled ? x.c_str() : nullptr, nullptr};
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    file_.reset(driver->Create("/vsimem/pieces.tif", columns, rows, 1, GDT_Byte, const_cast<char**>(options)));
  }
  ~Packed() {
    file_.reset();
    VSIUnlink("/vsimem/pieces.tif");
  }
  GDALRasterBand& band() { return *file_->GetRasterBand(1); }

 private:
  Dataset file_;
};

/// Checks that the pieces cover a part once, and that no block of the file lies in two of them.
void check_pieces(GDALRasterBand& band, const RasterPart& whole) {
  int block_columns = 0, block_rows = 0;
  band.GetBlockSize(&block_columns, &block_rows);
  std::int64_t pixels = 0;
  std::set<std::pair<int, int>> blocks;
  for (const RasterPart& part : pieces_of(band, whole)) {
    ASSERT_GT(part.columns(), 0);
    ASSERT_GT(part.rows(), 0);
    ASSERT_LE(part.right, whole.right);
    ASSERT_LE(part.bottom, whole.bottom);
    pixels += std::int64_t{part.columns()} * part.rows();
    for (int y = part.top / block_rows; y <= (part.bottom - 1) / block_rows; ++y)
      for (int x = part.left / block_columns; x <= (part.right - 1) / block_columns; ++x)
        EXPECT_TRUE(blocks.emplace(x, y).second) << "block " << x << ", " << y << " is read twice";
  }
  EXPECT_EQ(pixels, std::int64_t{whole.columns()} * whole.rows());
}

TEST(RasterPieces, EachBlockIsReadOnce) {
  const struct {
    int columns, rows, block_columns, block_rows;
  } files[] = {{20000, 1300, 512, 512},  // a national model: a row of tiles is larger than the cache of GDAL
               {5000, 3000, 256, 256},  {3000, 2500, 3000, 1},    {3000, 2500, 3000, 7},
               {40, 30, 16, 16},        {2049, 1025, 2048, 1024}, {5000, 4100, 4096, 2048}};
  for (const auto& of : files) {
    Packed file(of.columns, of.rows, of.block_columns, of.block_rows);
    check_pieces(file.band(), {0, 0, of.columns, of.rows});
    check_pieces(file.band(), {of.columns / 3, of.rows / 5, of.columns - 1, of.rows - 2});
  }
}

TEST(RasterPieces, AStripOfAllRowsIsReadInPieces) {
  Packed file(3000, 5000, 3000, 5000);
  int rows = 0;
  for (const RasterPart& part : pieces_of(file.band(), {0, 0, 3000, 5000})) {
    EXPECT_EQ(part.columns(), 3000);
    EXPECT_LE(part.rows(), 1024);
    rows += part.rows();
  }
  EXPECT_EQ(rows, 5000);
}

}  // namespace
}  // namespace talus::io
