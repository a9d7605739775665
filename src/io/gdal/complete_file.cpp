#include "complete_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <vector>

#include "dataset.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
namespace {

/// Throws InputError if a raster of plain numbers is shorter than these and its header.
void check_size(GDALDataset& dataset, const std::string& path, const std::string& file, std::uint64_t header) {
  const auto bytes =
      static_cast<std::uint64_t>(GDALGetDataTypeSizeBytes(dataset.GetRasterBand(1)->GetRasterDataType()));
  const std::uint64_t size = header + bytes * static_cast<std::uint64_t>(dataset.GetRasterXSize()) *
                                          static_cast<std::uint64_t>(dataset.GetRasterYSize()) *
                                          static_cast<std::uint64_t>(dataset.GetRasterCount());
  VSIStatBufL status;
  if (VSIStatL(file.c_str(), &status) == 0 && static_cast<std::uint64_t>(status.st_size) < size)
    throw InputError(path + ": is cut off, must have " + std::to_string(size) + " bytes: copy it again");
}

void check_envi(GDALDataset& dataset, const std::string& path, const std::string& file) {
  const char* const packed = dataset.GetMetadataItem("file_compression", "ENVI");
  if (packed != nullptr && std::atoi(packed) != 0) return;
  const char* const offset = dataset.GetMetadataItem("header_offset", "ENVI");
  check_size(dataset, path, file, offset == nullptr ? 0 : std::strtoull(offset, nullptr, 10));
}

/// The lines of a file that hold more than blanks; 0 if there is none.
std::int64_t filled_lines(const std::string& file) {
  const VsiFile in(VSIFOpenL(file.c_str(), "rb"));
  if (!in) return 0;
  std::vector<char> piece(std::size_t{1} << 20U);
  std::int64_t count = 0;
  bool filled = false;
  while (const std::size_t read = VSIFReadL(piece.data(), 1, piece.size(), in.get()))
    for (const char c : std::span(piece).first(read))
      if (c == '\n')
        count += filled ? 1 : 0, filled = false;
      else
        filled = filled || (c != ' ' && c != '\r');
  return count + (filled ? 1 : 0);
}

void check_mapinfo(GDALDataset& dataset, const std::string& path, const std::string& file) {
  if (!EQUAL(CPLGetExtension(file.c_str()), "mif") || dataset.GetLayerCount() == 0) return;
  const std::string stem = file.substr(0, file.size() - 3);
  const std::int64_t rows = std::max(filled_lines(stem + "mid"), filled_lines(stem + "MID"));
  const std::int64_t shapes = dataset.GetLayer(0)->GetFeatureCount();
  if (rows > shapes)
    throw InputError(path + ": has " + std::to_string(shapes) + " shapes, and its .mid has " + std::to_string(rows) +
                     " rows, must be as many: copy both files again");
}

}  // namespace

void check_complete(GDALDataset& dataset, const std::string& path, const std::string& file, GdalMessages& messages) {
  const std::string driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriver()->GetDescription();
  if (driver == "ENVI") check_envi(dataset, path, file);
  constexpr std::uint64_t kHeaderOfPCRaster = 256;
  if (driver == "PCRaster") check_size(dataset, path, file, kHeaderOfPCRaster);
  if (driver == "MapInfo File") check_mapinfo(dataset, path, file);
  if (driver == "GeoJSONSeq" && messages.failed())
    throw InputError(path + ": cannot be read as a whole: " + messages.take() + ": copy it again, or mend the line");
}

}  // namespace talus::io
