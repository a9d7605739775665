#include "picture.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <memory>
#include <stdexcept>

#include "dataset.hpp"

namespace talus::io {
namespace {

struct FreeBytes {
  void operator()(void* bytes) const { VSIFree(bytes); }
};

/// A name in memory that no other thread has, with GDAL's file of statistics beside it.
class MemoryFile {
 public:
  MemoryFile() : name_("/vsimem/talus-picture-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".png") {}
  ~MemoryFile() {
    VSIUnlink(name_.c_str());
    VSIUnlink((name_ + ".aux.xml").c_str());
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* name() const { return name_.c_str(); }
  std::string content() const {
    vsi_l_offset size = 0;
    const GByte* const bytes = VSIGetMemFileBuffer(name(), &size, FALSE);
    return bytes == nullptr ? "" : std::string(reinterpret_cast<const char*>(bytes), size);
  }

 private:
  std::string name_;
};

GDALColorTable colour_table(const std::vector<Colour>& colours) {
  GDALColorTable table;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const GDALColorEntry entry{colours[i].red, colours[i].green, colours[i].blue, colours[i].opacity};
    table.SetColorEntry(static_cast<int>(i), &entry);
  }
  return table;
}

}  // namespace

std::string png_of(const Picture& picture) {
  const Dataset memory = memory_dataset(picture.width, picture.height, GDT_Byte);
  GdalMessages messages;
  const auto fail = [&] { throw std::runtime_error("a picture cannot be made as PNG: " + messages.take()); };
  GDALRasterBand& band = *memory->GetRasterBand(1);
  GDALColorTable table = colour_table(picture.colours);
  std::vector<std::uint8_t> pixels = picture.pixels;
  if (band.SetColorTable(&table) != CE_None ||
      band.RasterIO(GF_Write, 0, 0, picture.width, picture.height, pixels.data(), picture.width, picture.height,
                    GDT_Byte, 0, 0, nullptr) != CE_None)
    fail();
  const MemoryFile file;
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("PNG");
  if (driver == nullptr) throw std::runtime_error("a picture cannot be made: this GDAL has no driver PNG");
  const char* const options[] = {"ZLEVEL=9", nullptr};
  Dataset png(driver->CreateCopy(file.name(), memory.get(), FALSE, const_cast<char**>(options), nullptr, nullptr));
  if (!png) fail();
  png.reset();
  std::string bytes = file.content();
  if (bytes.empty()) fail();
  return bytes;
}

std::string deflated(std::string_view bytes) {
  std::size_t size = 0;
  const std::unique_ptr<void, FreeBytes> packed(CPLZLibDeflate(bytes.data(), bytes.size(), 9, nullptr, 0, &size));
  if (!packed) throw std::runtime_error("values cannot be packed: there is no memory");
  return {static_cast<const char*>(packed.get()), size};
}

std::string base64_of(std::string_view bytes) {
  const std::unique_ptr<char, FreeBytes> text(
      CPLBase64Encode(static_cast<int>(bytes.size()), reinterpret_cast<const GByte*>(bytes.data())));
  return text ? text.get() : "";
}

}  // namespace talus::io
