#include "talus/io/gdal/zones.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "idle_features.hpp"
#include "layer.hpp"
#include "off_map.hpp"
#include "pixels.hpp"
#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
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
    if (found == names_.end() && std::ranges::count(request_.presets, zone) > 0 && names_.size() < 255) {
      names_.push_back(zone);
      seen_.push_back(true);
      return static_cast<std::uint8_t>(names_.size());
    }
    if (found == names_.end())
      throw InputError(where + ": zone '" + zone + "' is not described, must be one of [" + request_.table +
                       "]: " + (names_.empty() ? "none is there" : joined(names_)) + ": " + way_out(zone));
    const auto index = static_cast<std::size_t>(found - names_.begin());
    seen_[index] = true;
    return static_cast<std::uint8_t>(index + 1);
  }

  /// The presets that were named, in the order of their first place.
  std::vector<std::string> named_presets() const { return {names_.begin() + std::ssize(request_.names), names_.end()}; }

  void warn_unseen(std::vector<std::string>& warnings) const {
    for (std::size_t i = 0; i < seen_.size(); ++i)
      if (!seen_[i])
        warnings.push_back(request_.path + ": no zone '" + names_[i] + "' on the map: " + described(i) +
                           " is not used");
  }

 private:
  /// What to do about a zone that is not described.
  std::string way_out(const std::string& zone) const {
    if (request_.table == "ground.zones")
      return "call the zone by a preset (talus presets), also in another field (--zone-field), or add [ground.zones." +
             quoted(zone) + "] with a preset to a scenario";
    if (zone.starts_with('-'))
      return "codes are 0 and above: make these cells nodata (the default ground), or give them such a code";
    return "add " + quoted(zone) + " = \"NAME\" there";
  }
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
  const int field = layer.field(name, "name one of them (--zone-field)");
  out.field = name;
  if (field < 0) {
    throw InputError(request.path + ": has no field '" + name + "'" + known_names(name, layer.field_names()) +
                     ": say which holds the zone by --zone-field, or field in [ground]");
  }
  FieldUse use{name, layer.field_names()[static_cast<std::size_t>(field)], {}, field, true};
  std::size_t features = 0;
  IdleFeatures idle(request.path, "zones", terrain);
  for_each_feature(layer, [&](const Feature& feature) {
    ++features;
    const std::string zone = layer.code(*feature, field);
    const std::string called = std::to_string(feature->GetFID()) + (zone.empty() ? "" : " (" + zone + ")");
    if (!zone.empty()) ++use.count;
    const auto value = [&] {
      return zone.empty() ? std::uint8_t{0} : index.at(zone, layer.label(*feature) + ": field " + name);
    };
    idle.mark(called, layer.polygons(*feature), value, out.zones);
  });
  if (idle.all_off(features)) throw InputError(off_dem_text(request.path, idle.box(), layer, terrain));
  if (features == 0) out.warnings.push_back(request.path + ": has no features: the default ground is everywhere");
  idle.warn(out.zones, out.warnings);
  if (use.count < features)
    out.warnings.push_back(request.path + ": " + std::to_string(features - use.count) + " of " +
                           std::to_string(features) + " features have no " + name +
                           ": the default ground is there; give them a zone or preset, or 'default' if it is meant");
  out.notes.push_back(fields_note(request.path, {use}, features, layer.field_names()));
  index.warn_unseen(out.warnings);
  out.presets = index.named_presets();
  layer.tell(out);
}

/// Throws InputError if a raster gives no cell of the DEM a zone. Warns if it leaves out more than a few.
/// @param cells  of the DEM that have a height @param given  those of them with a zone
void tell_cover(GDALDataset& dataset, const std::string& wkt, const std::string& path, const Terrain& terrain,
                std::uint64_t cells, std::uint64_t given, std::vector<std::string>& warnings) {
  constexpr double kNoticed = 0.01;
  if (cells == 0) return;  // the sources say so
  if (given == 0) {
    std::array<double, 6> g{};
    dataset.GetGeoTransform(g.data());
    OGREnvelope box;
    for (const int x : {0, dataset.GetRasterXSize()})
      for (const int y : {0, dataset.GetRasterYSize()})
        box.Merge(g[0] + x * g[1] + y * g[2], g[3] + x * g[4] + y * g[5]);
    throw InputError(path + ": gives no cell of the DEM a zone: it reaches over " +
                     extent_text({box.MinX, box.MinY, box.MaxX, box.MaxY}) + " in " + crs_name(wkt) +
                     ", the DEM over " + extent_text(terrain.extent()) + " in " + crs_name(terrain.geo.crs_wkt) +
                     ": is its coordinate system the right one, or is it nodata there?");
  }
  const double share = static_cast<double>(cells - given) / static_cast<double>(cells);
  if (share > kNoticed)
    warnings.push_back(path + ": gives no zone to " + percent(share, 2) +
                       " of the cells of the DEM (off the raster, or nodata): they get the default ground");
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
    out.warnings.push_back(dem_system_note(request.path, wkt));
  }
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if (band.GetScale() != 1.0 || band.GetOffset() != 0.0)
    throw InputError(request.path + ": has a scale or an offset (" + text_of(band.GetScale()) + ", " +
                     text_of(band.GetOffset()) + "), codes of zones must be plain numbers: write them with " +
                     "gdal_translate -unscale " + shell_word(request.path) + " zones.tif");
  Transformer transformer({"ground", request.path}, terrain.geo.crs_wkt, wkt, terrain.map());
  const PixelFinder pixel(dataset, request.path);
  PixelReader reader(dataset, request.path);
  ZoneIndex index(request, true);
  const Grid& grid = terrain.heights.grid;
  double last = kNotGiven;
  std::uint8_t zone = 0;
  std::uint64_t cells = 0, given = 0;
  in_squares(terrain.heights, [&](int column, int row) {
    if (std::isnan(terrain.heights.at(column, row))) return;  // no block will ever be there
    ++cells;
    double x = grid.west + grid.centre_x(column), y = grid.south + grid.centre_y(row);
    transformer.apply(x, y, request.path);
    const double code = reader.at(pixel.column(x, y), pixel.row(x, y));
    if (std::isnan(code)) return;
    ++given;
    if (code != last) {
      if (code != std::floor(code) || std::abs(code) > 1e15)
        throw InputError(request.path + ": holds " + text_of(code) + ", must be whole numbers that stand for zones");
      zone = index.at(std::to_string(static_cast<std::int64_t>(code)), request.path);
      last = code;
    }
    out.zones.at(column, row) = zone;
  });
  tell_cover(dataset, wkt, request.path, terrain, cells, given, out.warnings);
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
