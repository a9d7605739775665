#include "talus/io/results/write_rasters.hpp"

#include <ogr_spatialref.h>

#include <algorithm>
#include <stdexcept>

#include "io/files/compression.hpp"
#include "io/files/posix_bytes.hpp"
#include "io/gdal/geotiff_tags.hpp"
#include "talus/base/version.hpp"
#include "talus/io/files/output_folder.hpp"
#include "tile_pyramid.hpp"

namespace talus::io {

namespace {

/// Side of the tiles: a small map is not filled up to a large one.
int side_of(const MapTarget& target) {
  return std::max(target.columns, target.rows) > 128 ? 256 : 128;
}

void describe(GDALDataset& file, const Map& map, const MapTarget& target) {
  const GeoReference& geo = target.geo;
  double transform[6] = {geo.west, geo.cell_x, 0.0, geo.north, 0.0, -geo.cell_y};
  file.SetGeoTransform(transform);
  OGRSpatialReference system;
  if (!geo.crs_wkt.empty() && system.importFromWkt(geo.crs_wkt.c_str()) == OGRERR_NONE) {
    system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    file.SetSpatialRef(&system);
  }
  file.SetMetadataItem("AREA_OR_POINT", "Area");
  file.SetMetadataItem("TITLE", map.title.c_str());
  file.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", map.title.c_str());
  file.SetMetadataItem("TIFFTAG_SOFTWARE", ("Talus " + std::string(version())).c_str());
  file.SetMetadataItem("OVERVIEWS", map.farthest_in_overviews   ? "value farthest from 0 of the cells under a pixel"
                                    : map.smallest_in_overviews ? "smallest value of the cells under a pixel"
                                                                : "largest value of the cells under a pixel");
  for (std::size_t b = 0; b < map.bands.size(); ++b) {
    GDALRasterBand* band = file.GetRasterBand(static_cast<int>(b) + 1);
    band->SetDescription(map.bands[b].name.c_str());
    band->SetUnitType(map.bands[b].unit.c_str());
    band->SetNoDataValue(map.kind == Map::Kind::Count ? static_cast<double>(kCountNodata) : kNodata);
  }
}

}  // namespace

class MapFile::Tiles {
 public:
  virtual ~Tiles() = default;
  virtual std::size_t parts() const = 0;
  virtual std::uint64_t place_of(std::size_t i) const = 0;
  virtual void make_part(std::size_t i, TileStore& store) = 0;
  /// False if `proceed` ended it.
  virtual bool write(const std::filesystem::path& file, const TileStore& store) = 0;
};

namespace {

/// Tags of the file, but for its size, its tiles and their compression.
template <class T>
std::vector<TiffTag> tags_of(const Map& map, const MapTarget& target) {
  GdalMessages messages;
  SmallTiff small(static_cast<int>(map.bands.size()), std::is_same_v<T, float> ? GDT_Float32 : GDT_UInt32);
  describe(small.dataset(), map, target);
  std::vector<TiffTag> tags = small.tags();
  if (messages.failed()) throw std::runtime_error("cannot be described: " + messages.take());
  return tags;
}

}  // namespace

template <class T>
class MapFile::TilesOf : public MapFile::Tiles {
 public:
  TilesOf(const Map& map, const MapTarget& target)
      : map_(map), target_(target), pyramid_(map, target, side_of(target)) {}
  std::size_t parts() const override { return pyramid_.parts(); }
  std::uint64_t place_of(std::size_t i) const override { return pyramid_.place_of(i); }
  void make_part(std::size_t i, TileStore& store) override { pyramid_.make_part(i, store); }
  bool write(const std::filesystem::path& file, const TileStore& store) override {
    const CogFormat format{side_of(target_), kDeflate, tags_of<T>(map_, target_)};
    return write_cog(file, format, pyramid_.levels(), store, target_.proceed);
  }

 private:
  const Map& map_;
  const MapTarget& target_;
  TilePyramid<T> pyramid_;
};

MapFile::MapFile(const Map& map, const MapTarget& target) : map_(map), target_(target) {
  if (map.kind == Map::Kind::Count)
    tiles_ = std::make_unique<TilesOf<std::uint32_t>>(map_, target_);
  else
    tiles_ = std::make_unique<TilesOf<float>>(map_, target_);
  missing_ = tiles_->parts();
}

MapFile::~MapFile() = default;

std::size_t MapFile::parts() const {
  return tiles_->parts();
}

std::uint64_t MapFile::place_of(std::size_t i) const {
  return tiles_->place_of(i);
}

bool MapFile::write_part(std::size_t i) {
  if (target_.proceed && !target_.proceed()) return false;
  bool last = false;
  named([&] {
    std::call_once(begun_, [this] { store_ = std::make_unique<TileStore>(target_.folder / (map_.name + ".tif")); });
    tiles_->make_part(i, *store_);
    last = --missing_ == 0;
  });
  return last && finish();
}

bool MapFile::finish() {
  StagedPath staged(StagedPath::Kind::File, target_.folder / (map_.name + ".tif"), ".tif");
  bool whole = false;
  named([&] { whole = tiles_->write(staged.hidden(), *store_); });
  store_.reset();
  tiles_.reset();
  if (!whole) return false;
  const std::error_code error = staged.commit();
  named([&] {
    if (error) throw std::runtime_error("cannot be given its name: " + system_text(error.value()));
  });
  return true;
}

/// Puts the name of the file before the message of an exception.
template <class Work>
void MapFile::named(const Work& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(map_.name + ".tif: " + error.what());
  }
}

}  // namespace talus::io
