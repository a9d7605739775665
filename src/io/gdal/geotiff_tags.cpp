#include "geotiff_tags.hpp"

#include <cpl_vsi.h>

#include <atomic>
#include <cstring>
#include <span>
#include <stdexcept>

namespace talus::io {
namespace {

constexpr int kSide = 16;  // pixels: the tags that are of use do not depend on it

/// Numbers of a file in the byte order of this machine.
class Numbers {
 public:
  explicit Numbers(std::span<const char> file) : file_(file) {}

  template <class T>
  T at(std::size_t place) const {
    T number;
    std::memcpy(&number, bytes(place, sizeof number).data(), sizeof number);
    return number;
  }
  std::span<const char> bytes(std::size_t place, std::size_t count) const {
    if (place > file_.size() || count > file_.size() - place) throw std::runtime_error("its tags cannot be read");
    return file_.subspan(place, count);
  }

 private:
  std::span<const char> file_;
};

std::size_t size_of_type(std::uint16_t type) {
  switch (type) {
    case TiffTag::Byte:
    case TiffTag::Ascii:
      return 1;
    case TiffTag::Short:
      return 2;
    case TiffTag::Long:
      return 4;
    case TiffTag::Double:
    case TiffTag::Long8:
      return 8;
    default:
      throw std::runtime_error("has a tag of an unknown type");
  }
}

/// The tags of the first directory of a small TIFF.
std::vector<TiffTag> tags_of(const Numbers& file) {
  if (file.at<std::uint16_t>(2) != 42) throw std::runtime_error("its tags cannot be read");
  const std::size_t directory = file.at<std::uint32_t>(4);
  std::vector<TiffTag> tags;
  for (std::size_t i = 0; i < file.at<std::uint16_t>(directory); ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    TiffTag tag{
        file.at<std::uint16_t>(entry), file.at<std::uint16_t>(entry + 2), file.at<std::uint32_t>(entry + 4), {}};
    const std::size_t size = size_of_type(tag.type) * tag.count;
    const auto bytes = file.bytes(size <= 4 ? entry + 8 : file.at<std::uint32_t>(entry + 8), size);
    tag.bytes.assign(bytes.begin(), bytes.end());
    tags.push_back(std::move(tag));
  }
  return tags;
}

}  // namespace

SmallTiff::SmallTiff(int bands, GDALDataType type) {
  static std::atomic<unsigned> number = 0;
  name_ = "/vsimem/talus-" + std::to_string(number++) + ".tif";
  start_gdal();
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) throw std::runtime_error("this GDAL has no driver GTiff");
  const char* const options[] = {"INTERLEAVE=PIXEL", "SPARSE_OK=TRUE", nullptr};
  dataset_.reset(driver->Create(name_.c_str(), kSide, kSide, bands, type, options));
  if (dataset_ == nullptr) throw std::runtime_error("cannot be described");
}

SmallTiff::~SmallTiff() {
  dataset_.reset();
  VSIUnlink(name_.c_str());
  VSIUnlink((name_ + ".aux.xml").c_str());
}

std::vector<TiffTag> SmallTiff::tags() {
  dataset_.reset();
  vsi_l_offset size = 0;
  const GByte* const bytes = VSIGetMemFileBuffer(name_.c_str(), &size, FALSE);
  if (bytes == nullptr) throw std::runtime_error("cannot be described");
  return tags_of(Numbers({reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)}));
}

}  // namespace talus::io
