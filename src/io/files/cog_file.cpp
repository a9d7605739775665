#include "cog_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include "posix_bytes.hpp"

namespace talus::io {
namespace {

/// Numbers of tags, in the TIFF specification.
enum TagNumber : std::uint16_t {
  kSubfileType = 254,
  kImageWidth = 256,
  kImageLength = 257,
  kCompressionTag = 259,
  kDescription = 270,
  kStripOffsets = 273,
  kRowsPerStrip = 278,
  kStripByteCounts = 279,
  kSoftware = 305,
  kTileWidth = 322,
  kTileLength = 323,
  kTileOffsets = 324,
  kTileByteCounts = 325,
  kGdalMetadata = 42112
};
constexpr std::array<std::uint16_t, 10> kOfTheFile{kSubfileType,  kImageWidth,   kImageLength, kCompressionTag,
                                                   kStripOffsets, kRowsPerStrip, kTileWidth,   kStripByteCounts,
                                                   kTileLength,   kTileOffsets};

/// What GDAL calls a COG: it reads this after the header. If it changes the file, it writes YES at the end.
constexpr std::string_view kClaim =
    "LAYOUT=IFDS_BEFORE_DATA\nBLOCK_ORDER=ROW_MAJOR\nBLOCK_LEADER=SIZE_AS_UINT4\nBLOCK_TRAILER=LAST_4_BYTES_REPEATED\n"
    "KNOWN_INCOMPATIBLE_EDITION=NO\n ";
constexpr std::size_t kAround = 4;  // bytes before and after a tile: its size, and its last bytes again

std::string claim() {
  std::string size = std::to_string(kClaim.size());
  std::string text =
      "GDAL_STRUCTURAL_METADATA_SIZE=" + std::string(6 - size.size(), '0') + size + " bytes\n" + std::string(kClaim);
  if (text.size() % 2 != 0) text += '\0';  // directories begin at an even place
  return text;
}

template <class T>
void put(std::string& to, T number) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &number, sizeof number);
  to.append(bytes.data(), bytes.size());
}

template <class T>
TiffTag tag_of(std::uint16_t number, std::uint16_t type, std::initializer_list<T> values) {
  TiffTag tag{number, type, values.size(), {}};
  for (const T value : values) put(tag.bytes, value);
  return tag;
}

TiffTag long_tag(std::uint16_t number, int value) {
  return tag_of(number, TiffTag::Long, {static_cast<std::uint32_t>(value)});
}

TiffTag short_tag(std::uint16_t number, int value) {
  return tag_of(number, TiffTag::Short, {static_cast<std::uint16_t>(value)});
}

/// Tags of GDAL that an overview has too: the layout of its pixels, and nodata.
bool is_of_pixels(std::uint16_t number) {
  constexpr std::uint16_t kNodataTag = 42113, kLastOfPixels = 339;
  return number == kNodataTag || (number <= kLastOfPixels && number != kDescription && number != kSoftware);
}

/// Writes numbers and directories of a TIFF with places of 4 bytes, or of 8 (BigTIFF).
class Layout {
 public:
  explicit Layout(bool big) : big_(big) {}

  std::string header() const {
    std::string out(std::endian::native == std::endian::little ? "II" : "MM");
    put<std::uint16_t>(out, big_ ? 43 : 42);
    if (big_) put<std::uint16_t>(out, 8), put<std::uint16_t>(out, 0);
    put_place(out, out.size() + width() + claim().size());
    return out + claim();
  }

  /// @param place  of the directory in the file
  std::string directory(std::vector<TiffTag> tags, std::uint64_t place, bool last) const {
    std::ranges::sort(tags, {}, &TiffTag::number);
    const std::size_t count_size = big_ ? 8 : 2, entry_size = big_ ? 20 : 12;
    std::uint64_t next = place + count_size + entry_size * tags.size() + width();
    std::string entries, values;
    big_ ? put<std::uint64_t>(entries, tags.size())
         : put<std::uint16_t>(entries, static_cast<std::uint16_t>(tags.size()));
    for (TiffTag& tag : tags) {
      put(entries, tag.number), put(entries, tag.type), put_place(entries, tag.count);
      if (tag.bytes.size() % 2 != 0) tag.bytes += '\0';  // values begin at an even place
      if (tag.bytes.size() > width()) {
        put_place(entries, next + values.size());
        values += tag.bytes;
      } else {
        tag.bytes.resize(width());
        entries += tag.bytes;
      }
    }
    put_place(entries, last ? 0 : next + values.size());
    return entries + values;
  }

  TiffTag places_tag(std::uint16_t number, std::span<const std::uint64_t> places) const {
    TiffTag tag{number, big_ ? TiffTag::Long8 : TiffTag::Long, places.size(), {}};
    for (const std::uint64_t place : places) put_place(tag.bytes, place);
    return tag;
  }

 private:
  std::size_t width() const { return big_ ? 8 : 4; }
  void put_place(std::string& to, std::uint64_t place) const {
    big_ ? put(to, place) : put(to, static_cast<std::uint32_t>(place));
  }

  bool big_;
};

/// Tags of a resolution. @param offsets  places of its tiles in the file
std::vector<TiffTag> tags_of(const CogFormat& format, const CogLevel& level, bool overview, const Layout& layout,
                             std::span<const std::uint64_t> offsets) {
  std::vector<TiffTag> tags;
  for (const TiffTag& tag : format.tags)
    if (std::ranges::count(kOfTheFile, tag.number) == 0 && tag.number != kTileByteCounts &&
        (!overview || is_of_pixels(tag.number)))
      tags.push_back(tag);
  if (overview) tags.push_back(long_tag(kSubfileType, 1));
  tags.push_back(long_tag(kImageWidth, level.columns));
  tags.push_back(long_tag(kImageLength, level.rows));
  tags.push_back(short_tag(kCompressionTag, format.compression));
  tags.push_back(short_tag(kTileWidth, format.side));
  tags.push_back(short_tag(kTileLength, format.side));
  tags.push_back(layout.places_tag(kTileOffsets, offsets));
  TiffTag sizes{kTileByteCounts, TiffTag::Long, level.tiles.size(), {}};
  for (const TilePlace& tile : level.tiles) put(sizes.bytes, tile.size);
  tags.push_back(std::move(sizes));
  return tags;
}

/// The places of tiles in the file, level by level.
using Offsets = std::vector<std::vector<std::uint64_t>>;

/// Everything before the tiles.
std::string head(const CogFormat& format, std::span<const CogLevel> levels, const Offsets& offsets,
                 const Layout& layout) {
  std::string bytes = layout.header();
  for (std::size_t i = 0; i < levels.size(); ++i)
    bytes +=
        layout.directory(tags_of(format, levels[i], i > 0, layout, offsets[i]), bytes.size(), i + 1 == levels.size());
  return bytes;
}

/// Places of tiles in the file, if the first begins at `begin`.
Offsets offsets_of(std::span<const CogLevel> levels, std::uint64_t begin) {
  Offsets offsets(levels.size());
  for (std::size_t i = levels.size(); i-- > 0;)
    for (const TilePlace& tile : levels[i].tiles) {
      offsets[i].push_back(tile.size == 0 ? 0 : begin + kAround);
      if (tile.size > 0) begin += tile.size + 2 * kAround;
    }
  return offsets;
}

/// The size of a tile, the lowest byte first, as it stands before the tile.
std::array<std::byte, kAround> leader_of(std::uint32_t size) {
  std::array<std::byte, kAround> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(size >> (8 * i));
  return bytes;
}

/// Appends to a new file, much at once.
class CogWriter {
 public:
  explicit CogWriter(const std::filesystem::path& path) : file_(create_file(path)) {}

  void append(std::span<const std::byte> bytes) {
    constexpr std::size_t kBuffer = std::size_t{1} << 20U;
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    if (buffer_.size() >= kBuffer) flush();
  }
  void flush() {
    write_bytes(file_, buffer_, end_);
    end_ += buffer_.size();
    buffer_.clear();
  }

 private:
  OpenFile file_;
  std::vector<std::byte> buffer_;
  std::uint64_t end_ = 0;
};

}  // namespace

bool write_cog(const std::filesystem::path& path, const CogFormat& format, std::span<const CogLevel> levels,
               const TileStore& tiles, const std::function<bool()>& proceed) {
  Offsets none;
  std::uint64_t bytes = 0;  // of tiles
  for (const CogLevel& level : levels) {
    none.emplace_back(level.tiles.size());
    for (const TilePlace& tile : level.tiles) bytes += tile.size == 0 ? 0 : tile.size + 2 * kAround;
  }
  const bool big = head(format, levels, none, Layout(false)).size() + bytes > format.most_small;
  const Layout layout(big);
  const std::uint64_t begin = head(format, levels, none, layout).size();
  const std::string first = head(format, levels, offsets_of(levels, begin), layout);
  CogWriter file(path);
  file.append(std::as_bytes(std::span(first)));
  std::vector<std::byte> tile;
  for (std::size_t i = levels.size(); i-- > 0;)
    for (const TilePlace& place : levels[i].tiles) {
      if (proceed && !proceed()) return false;
      if (place.size == 0) continue;
      tiles.read(place, tile);
      file.append(leader_of(place.size));
      file.append(tile);
      file.append(std::span(tile).last(kAround));
    }
  file.flush();
  return true;
}

}  // namespace talus::io
