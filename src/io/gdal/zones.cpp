#include "talus/io/gdal/zones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "layer.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

namespace {

// Gives each zone of the file its index, and records which zones were seen.
class ZoneIndex {
 public:
  ZoneIndex(const ZoneRequest& request, bool raster)
      : request_(request), names_(request.names), seen_(request.names.size(), false) {
    for (std::size_t i = 0; raster && i < request.codes.size(); ++i)
      if (!request.codes[i].empty()) names_[i] = request.codes[i];
    for (std::size_t i = 0; i < names_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k)
        if (names_[i] == names_[k]) refuse_both(names_[i], described(k), described(i));
      if (names_[i] == request.default_code) refuse_both(names_[i], "[" + request.table + ".default]", described(i));
    }
  }

  std::uint8_t at(const std::string& zone, const std::string& where) {
    const auto found = std::find(names_.begin(), names_.end(), zone);
    if (found == names_.end() && (zone == "default" || zone == request_.default_code)) return 0;
    if (found == names_.end())
      throw InputError(where + ": zone '" + zone + "' is not described, must be one of [" + request_.table +
                       "]: " + (names_.empty() ? "none is there" : joined(names_)) + ": " +
                       (request_.table == "ground.zones" ? "add [ground.zones." + quoted(zone) + "] with a preset"
                                                         : "add " + quoted(zone) + " = \"NAME\" there"));
    const auto index = static_cast<std::size_t>(found - names_.begin());
    seen_[index] = true;
    return static_cast<std::uint8_t>(index + 1);
  }

  void warn_unseen(std::vector<std::string>& warnings) const {
    for (std::size_t i = 0; i < seen_.size(); ++i)
      if (!seen_[i])
        warnings.push_back(request_.path + ": no zone '" + names_[i] + "' on the map: " + described(i) +
                           " is not used");
  }

 private:
  [[noreturn]] void refuse_both(const std::string& code, const std::string& one, const std::string& other) const {
    throw InputError(request_.path + ": '" + code + "' stands for both " + one + " and " + other +
                     ": give each a code of its own");
  }
  std::string described(std::size_t i) const {
    const bool by_code = request_.table != "ground.zones";  // else by name
    return "[" + request_.table + "." + quoted(by_code ? names_[i] : request_.names[i]) + "]";
  }
  static std::string quoted(const std::string& name) {
    const bool bare = std::all_of(name.begin(), name.end(),
                                  [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
    return bare ? name : "\"" + name + "\"";
  }

  const ZoneRequest& request_;
  std::vector<std::string> names_;  // as the file has them
  std::vector<bool> seen_;
};

void read_polygons(const ZoneRequest& request, const Terrain& terrain, ZoneLayer& out) {
  Layer layer("ground", request.path, terrain);
  ZoneIndex index(request, false);
  const std::string name = request.field.empty() ? "zone" : request.field;
  const int field = layer.field(name.c_str());
  out.field = name;
  if (field < 0) {
    throw InputError(request.path + ": has no field '" + name + "'" + known_names(name, layer.field_names()) +
                     ": say which holds the zone by field in [ground]");
  }
  const Grid& grid = terrain.heights.grid;
  while (const Feature feature = layer.next()) {
    const Parts parts = layer.parts(*feature);
    if (!parts.lines.empty() || !parts.points.empty())
      throw InputError(layer.label(*feature) + ": is no polygon, must be one");
    if (parts.empty()) continue;
    const OGREnvelope box = parts.envelope();
    if (box.MaxX <= 0.0 || box.MinX >= grid.width() || box.MaxY <= 0.0 || box.MinY >= grid.height()) continue;
    const std::string zone = layer.code(*feature, field);
    const std::uint8_t value =
        zone.empty() ? std::uint8_t{0} : index.at(zone, layer.label(*feature) + ": field " + name);
    for (const OGRPolygon& polygon : parts.polygons)
      for_each_cell(polygon, grid, false, [&](int column, int row) { out.zones.at(column, row) = value; });
  }
  index.warn_unseen(out.warnings);
  out.reprojections = layer.reprojections();
  for (std::string& line : layer.warnings()) out.warnings.push_back(std::move(line));
}

// The pixel of a raster that holds a place.
class PixelFinder {
 public:
  PixelFinder(GDALDataset& dataset, const std::string& path) {
    std::array<double, 6> place{};
    if (dataset.GetGeoTransform(place.data()) != CE_None || GDALInvGeoTransform(place.data(), inverse_.data()) == 0)
      throw InputError(path + ": does not say where it lies (no geotransform): georeference it with " +
                       edit_command(path, "-a_ullr WEST NORTH EAST SOUTH"));
  }
  double column(double x, double y) const { return std::floor(inverse_[0] + inverse_[1] * x + inverse_[2] * y); }
  double row(double x, double y) const { return std::floor(inverse_[3] + inverse_[4] * x + inverse_[5] * y); }

 private:
  std::array<double, 6> inverse_{};
};

// Reads single pixels through a cache of the last tiles of the file.
class PixelReader {
 public:
  PixelReader(GDALDataset& dataset, std::string path)
      : band_(*dataset.GetRasterBand(1)),
        path_(std::move(path)),
        masked_((band_.GetMaskFlags() & GMF_ALL_VALID) == 0) {}

  // The value of the pixel; NaN if there is none.
  double at(double column, double row) {
    if (!(column >= 0.0 && row >= 0.0 && column < band_.GetXSize() && row < band_.GetYSize()))
      return std::numeric_limits<double>::quiet_NaN();
    const int x = static_cast<int>(column), y = static_cast<int>(row);
    const std::pair<int, int> key{y / kSide, x / kSide};
    if (tile_ == nullptr || key != key_) {
      if (tiles_.size() > kTiles && !tiles_.contains(key)) tiles_.clear();
      const auto [found, fresh] = tiles_.try_emplace(key);
      if (fresh) read(key.second * kSide, key.first * kSide, found->second);
      key_ = key;
      tile_ = found->second.data();
    }
    return tile_[static_cast<std::size_t>(y % kSide) * kSide + static_cast<std::size_t>(x % kSide)];
  }

 private:
  static constexpr int kSide = 256;
  static constexpr std::size_t kTiles = 64;  // 32 MB

  void read(int x, int y, std::vector<double>& values) {
    values.resize(std::size_t{kSide} * kSide);
    const int columns = std::min(kSide, band_.GetXSize() - x), rows = std::min(kSide, band_.GetYSize() - y);
    const GSpacing line = kSide * sizeof(double);
    if (band_.RasterIO(GF_Read, x, y, columns, rows, values.data(), columns, rows, GDT_Float64, 0, line, nullptr) !=
            CE_None ||
        (masked_ && band_.GetMaskBand()->RasterIO(GF_Read, x, y, columns, rows, mask_.data(), columns, rows, GDT_Byte,
                                                  0, kSide, nullptr) != CE_None))
      throw InputError(path_ + ": cannot be read: " + messages_.take());
    if (!masked_) return;
    for (std::size_t k = 0; k < values.size(); ++k)
      if (mask_[k] == 0) values[k] = std::numeric_limits<double>::quiet_NaN();
  }

  GDALRasterBand& band_;
  std::string path_;
  bool masked_;
  std::map<std::pair<int, int>, std::vector<double>> tiles_;  // by row and column of tiles
  std::pair<int, int> key_{-1, -1};
  const double* tile_ = nullptr;
  std::vector<std::uint8_t> mask_ = std::vector<std::uint8_t>(std::size_t{kSide} * kSide);
  GdalMessages messages_;
};

// Visits the cells in squares, so that a zone raster in any direction is read part by part.
template <class Visit>
void in_squares(const Grid& grid, Visit visit) {
  constexpr int kSide = 256;
  for (int top = grid.rows; top > 0; top -= kSide)
    for (int left = 0; left < grid.columns; left += kSide)
      for (int row = top - 1; row >= std::max(0, top - kSide); --row)
        for (int column = left; column < std::min(grid.columns, left + kSide); ++column) visit(column, row);
}

void read_codes(GDALDataset& dataset, const ZoneRequest& request, const Terrain& terrain, ZoneLayer& out) {
  if (!request.field.empty())
    throw InputError(request.path + ": is a raster: field = '" + request.field +
                     "' in [ground] is for polygons only, must be left out");
  if (dataset.GetRasterCount() > 1)
    out.warnings.push_back(request.path + ": has " + std::to_string(dataset.GetRasterCount()) +
                           " bands: the first is taken as zones");
  std::string wkt = wkt_of(dataset.GetSpatialRef());
  if (wkt.empty()) {
    wkt = terrain.geo.crs_wkt;
    out.warnings.push_back(request.path + ": says no coordinate system: taken as the one of the DEM, " + crs_name(wkt));
  }
  Transformer transformer({"ground", request.path}, terrain.geo.crs_wkt, wkt, terrain.map());
  const PixelFinder pixel(dataset, request.path);
  PixelReader reader(dataset, request.path);
  ZoneIndex index(request, true);
  const Grid& grid = terrain.heights.grid;
  double last = std::numeric_limits<double>::quiet_NaN();
  std::uint8_t zone = 0;
  in_squares(grid, [&](int column, int row) {
    if (std::isnan(terrain.heights.at(column, row))) return;  // no block will ever be there
    double x = grid.west + grid.centre_x(column), y = grid.south + grid.centre_y(row);
    transformer.apply(x, y, request.path);
    const double code = reader.at(pixel.column(x, y), pixel.row(x, y));
    if (std::isnan(code)) return;
    if (code != last) {
      if (code != std::floor(code) || std::abs(code) > 1e15)
        throw InputError(request.path + ": holds " + text_of(code) + ", must be whole numbers that stand for zones");
      zone = index.at(std::to_string(static_cast<std::int64_t>(code)), request.path);
      last = code;
    }
    out.zones.at(column, row) = zone;
  });
  index.warn_unseen(out.warnings);
  out.reprojections = transformer.used();
  for (std::string& line : transformer.warnings(std::min(grid.cell_x, grid.cell_y)))
    out.warnings.push_back(std::move(line));
}

}  // namespace

ZoneLayer read_zones(const ZoneRequest& request, const Terrain& terrain) {
  ZoneLayer out;
  out.zones = Raster<std::uint8_t>(terrain.heights.grid, 0, terrain.heights.values.memory());
  const Dataset dataset = open_dataset(request.path, GDAL_OF_RASTER | GDAL_OF_VECTOR);
  GdalMessages messages;
  const bool polygons = dataset->GetLayerCount() > 0 && (dataset->GetRasterCount() == 0 || !request.field.empty());
  if (polygons)
    read_polygons(request, terrain, out);
  else if (dataset->GetRasterCount() > 0)
    read_codes(*dataset, request, terrain, out);
  else
    throw InputError(request.path + ": has neither polygons nor a raster, must have one");
  return out;
}

}  // namespace talus::io
