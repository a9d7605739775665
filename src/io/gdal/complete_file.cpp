#include "complete_file.hpp"

#include <algorithm>
#include <cstdlib>

#include "regular_file.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
namespace {

void check_envi(GDALDataset& dataset, const std::string& path, const std::string& file) {
  const char* const offset = dataset.GetMetadataItem("header_offset", "ENVI");
  const auto bytes =
      static_cast<std::uint64_t>(GDALGetDataTypeSizeBytes(dataset.GetRasterBand(1)->GetRasterDataType()));
  const std::uint64_t size = (offset == nullptr ? 0 : std::strtoull(offset, nullptr, 10)) +
                             bytes * static_cast<std::uint64_t>(dataset.GetRasterXSize()) *
                                 static_cast<std::uint64_t>(dataset.GetRasterYSize()) *
                                 static_cast<std::uint64_t>(dataset.GetRasterCount());
  VSIStatBufL status;
  if (VSIStatL(file.c_str(), &status) != 0 || dataset.GetMetadataItem("file_compression", "ENVI") != nullptr) return;
  if (static_cast<std::uint64_t>(status.st_size) < size)
    throw InputError(path + ": is cut off, must have " + std::to_string(size) + " bytes: copy it again");
}

void check_mapinfo(GDALDataset& dataset, const std::string& path, const std::string& file) {
  if (!file.ends_with(".mif") && !file.ends_with(".MIF")) return;
  const std::string stem = file.substr(0, file.size() - 3);
  std::string rows = read_start(stem + "mid", kMostTable);
  if (rows.empty()) rows = read_start(stem + "MID", kMostTable);
  std::int64_t count = 0;
  for (std::size_t at = 0; at < rows.size();) {
    const std::size_t end = std::min(rows.find('\n', at), rows.size());
    if (rows.find_first_not_of(" \r\n", at) < end) ++count;
    at = end + 1;
  }
  const std::int64_t shapes = dataset.GetLayerCount() == 0 ? 0 : dataset.GetLayer(0)->GetFeatureCount();
  if (count > shapes)
    throw InputError(path + ": has " + std::to_string(shapes) + " shapes, and its .mid has " + std::to_string(count) +
                     " rows, must be as many: copy both files again");
}

}  // namespace

void check_complete(GDALDataset& dataset, const std::string& path, const std::string& file, GdalMessages& messages) {
  const std::string driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriver()->GetDescription();
  if (driver == "ENVI") check_envi(dataset, path, file);
  if (driver == "MapInfo File") check_mapinfo(dataset, path, file);
  if (driver == "GeoJSONSeq" && messages.failed())
    throw InputError(path + ": cannot be read as a whole: " + messages.take() + ": copy it again, or mend the line");
}

}  // namespace talus::io
