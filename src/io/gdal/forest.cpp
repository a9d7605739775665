#include "talus/io/gdal/forest.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "layer.hpp"
#include "pixels.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/physics/effects/tree_species.hpp"
#include "talus/simulate/scenario/stand_figures.hpp"

namespace talus::io {

namespace {

constexpr const char* kRole = "effects.forest-stems";

/// Bounds of a number of the effect: "density" or "diameter".
const Bounds& bounds_of_number(std::string_view key) {
  const EffectEntry& entry = *find_effect("forest-stems");
  return *std::ranges::find_if(entry.fields(), [&](const EffectField& f) { return entry.key_of(f) == key; });
}

/// A raster of a number of the stand, at the centres of the cells of the DEM.
class StandRaster {
 public:
  StandRaster(const std::string& key, const std::string& path, const Terrain& terrain)
      : path_(path),
        bounds_(bounds_of_number(key)),
        terrain_(terrain),
        dataset_(open_dataset(path, GDAL_OF_RASTER)),
        pixel_(*dataset_, path),
        reader_(checked(), path) {
    std::string wkt = wkt_of(dataset_->GetSpatialRef());
    if (wkt.empty()) {
      wkt = terrain.geo.crs_wkt;
      warnings_.push_back(dem_system_note(path, wkt));
    }
    transformer_.emplace(LayerName{std::string(kRole) + "." + key, path}, terrain.geo.crs_wkt, wkt, terrain.map());
    GDALRasterBand& band = *dataset_->GetRasterBand(1);
    int given = 0;
    if (const double scale = band.GetScale(&given); given != 0) scale_ = scale;
    if (const double offset = band.GetOffset(&given); given != 0) offset_ = offset;
  }

  /// The number at the centre of a cell; 0 if the raster has none there. Throws InputError if it is out of bounds.
  double at(int column, int row) {
    const Grid& grid = terrain_.heights.grid;
    double x = grid.west + grid.centre_x(column), y = grid.south + grid.centre_y(row);
    const double east = x, north = y;
    transformer_->apply(x, y, path_);
    const double stored = reader_.at(pixel_.column(x, y), pixel_.row(x, y));
    if (std::isnan(stored)) {
      ++without_;
      return 0.0;
    }
    const double value = stored * scale_ + offset_;
    if (value == 0.0) return 0.0;
    if (const auto fault = fault_of(bounds_, value))
      throw InputError(path_ + ": " + text_of(value) + " at " + with_decimals(east, 1) + ", " +
                       with_decimals(north, 1) + " of the DEM: " + *fault + centimetres_hint(bounds_, value));
    return value;
  }

  std::uint64_t without() const { return without_; }
  void tell(ForestLayer& out) const {
    const auto& used = transformer_->used();
    out.reprojections.insert(out.reprojections.end(), used.begin(), used.end());
    const Grid& grid = terrain_.heights.grid;
    for (const std::string& line : warnings_) out.warnings.push_back(line);
    for (std::string& line : transformer_->warnings(std::min(grid.cell_x, grid.cell_y)))
      out.warnings.push_back(std::move(line));
  }

 private:
  GDALDataset& checked() {
    if (dataset_->GetRasterCount() < 1) throw InputError(path_ + ": has no band, must be a raster of numbers");
    if (dataset_->GetRasterCount() > 1)
      warnings_.push_back(path_ + ": has " + std::to_string(dataset_->GetRasterCount()) +
                          " bands: the first is taken for the forest");
    return *dataset_;
  }

  std::vector<std::string> warnings_;
  std::string path_;
  const Bounds& bounds_;
  const Terrain& terrain_;
  Dataset dataset_;
  PixelFinder pixel_;
  PixelReader reader_;
  std::optional<Transformer> transformer_;
  double scale_ = 1.0, offset_ = 0.0;
  std::uint64_t without_ = 0;
};

/// The rasters of a forest as the map of the effect.
class RasterForest {
 public:
  RasterForest(const ForestRequest& request, const ForestStems& numbers, const Terrain& terrain)
      : request_(request), numbers_(numbers), terrain_(terrain) {
    if (!request.density.empty()) density_.emplace("density", request.density, terrain);
    if (!request.diameter.empty()) diameter_.emplace("diameter", request.diameter, terrain);
  }

  void read(ForestLayer& out) {
    const Grid& grid = terrain_.heights.grid;
    const MemoryPolicy memory = terrain_.heights.values.memory();
    auto map = std::make_shared<ForestMap>();
    map->density = Raster<float>(grid, 0.0F, memory);
    if (diameter_) map->diameter = Raster<float>(grid, static_cast<float>(numbers_.diameter), memory);
    in_squares(terrain_.heights, [&](int column, int row) {
      if (!std::isnan(terrain_.heights.at(column, row))) read_cell(*map, column, row);
    });
    check();
    out.forest.map = std::move(map);
    out.forest.density = highest_;
    tell(out);
  }

 private:
  void read_cell(ForestMap& map, int column, int row) {
    ++cells_;
    const double density = density_ ? density_->at(column, row) : numbers_.density;
    const double diameter = diameter_ ? diameter_->at(column, row) : numbers_.diameter;
    if (!(density > 0.0)) return;
    if (!(diameter > 0.0)) {
      ++thin_;
      return;
    }
    map.density.at(column, row) = static_cast<float>(density);
    if (diameter_) map.diameter.at(column, row) = static_cast<float>(diameter);
    highest_ = std::max(highest_, density);
  }

  const std::string& first_path() const { return density_ ? request_.density : request_.diameter; }

  void check() const {
    if (highest_ > 0.0) return;
    throw InputError(first_path() + ": no cell of the DEM has a forest (" +
                     (density_ ? std::to_string(density_->without()) + " of " + std::to_string(cells_) +
                                     " cells without a density, the others 0 or without a diameter"
                               : "none has a diameter") +
                     "): is its place or its coordinate system wrong? Else leave [effects.forest-stems] out");
  }

  void tell(ForestLayer& out) const {
    for (const auto& [raster, path] :
         {std::pair{&density_, &request_.density}, std::pair{&diameter_, &request_.diameter}}) {
      if (!*raster) continue;
      (*raster)->tell(out);
      if ((*raster)->without() > 0)
        out.warnings.push_back(*path + ": " + std::to_string((*raster)->without()) + " of " + std::to_string(cells_) +
                               " cells of the DEM have no value (nodata, or off the raster): no forest there");
    }
    if (thin_ > 0)
      out.warnings.push_back(request_.diameter + ": " + std::to_string(thin_) +
                             " cells with a density have no diameter, or 0: no forest there");
  }

  const ForestRequest& request_;
  const ForestStems& numbers_;
  const Terrain& terrain_;
  std::optional<StandRaster> density_, diameter_;
  double highest_ = 0.0;                // density [1/ha]
  std::uint64_t cells_ = 0, thin_ = 0;  // of the DEM; of a density without a diameter
};

/// Reads a list of trees.
class TreeReader {
 public:
  TreeReader(const std::string& path, const Terrain& terrain)
      : path_(path),
        terrain_(terrain),
        layer_(kRole, path, terrain),
        diameter_(layer_.field("diameter")),
        species_(layer_.field("species")) {
    if (diameter_ < 0)
      throw InputError(path + ": has no field 'diameter'" + known_names("diameter", layer_.field_names()) +
                       ": must hold the diameter of each stem at breast height, in m");
  }

  void read(ForestLayer& out) {
    for_each_feature(layer_, [this](const Feature& feature) { add(*feature); });
    if (trees_.empty()) refuse();
    auto map = std::make_shared<ForestMap>();
    map->trees = TreeList(trees_);
    out.forest.map = std::move(map);
    const double area = 1e-4 * terrain_.heights.grid.width() * terrain_.heights.grid.height();
    out.forest.density = std::min(static_cast<double>(trees_.size()) / area, bounds_of_number("density").max);
    out.forest.diameter = diameters_.mean();
    tell(out);
  }

 private:
  void add(const OGRFeature& feature) {
    ++features_;
    const Parts parts = layer_.parts(feature);
    if (!parts.polygons.empty() || !parts.lines.empty())
      throw InputError(layer_.label(feature) + ": is no point, must be one: each is a tree");
    if (parts.points.empty()) {
      ++without_place_;
      return;
    }
    std::optional<double> diameter;
    double species = 1.0;
    layer_.faults().attempt([&] { diameter = diameter_of(feature); });
    layer_.faults().attempt([&] { species = species_of(feature); });
    for (const Eigen::Vector2d& place : parts.points) {
      if (!on_terrain(place))
        ++off_;
      else if (!diameter)
        ++without_diameter_;
      else if (!places_.emplace(place.x(), place.y()).second)
        ++twice_;
      else
        trees_.push_back({place, *diameter, species}), diameters_.add(*diameter);
    }
  }

  std::optional<double> diameter_of(const OGRFeature& feature) const {
    constexpr Bounds kAny{"diameter", "m", "of the stem", -1e300, 1e300};
    const Bounds& bounds = bounds_of_number("diameter");
    const auto value = layer_.number(feature, diameter_, "diameter", kAny);
    if (!value) return value;
    if (const auto fault = fault_of(bounds, *value))
      throw InputError(layer_.label(feature) + ": field diameter = " + text_of(*value) + ": " + *fault +
                       centimetres_hint(bounds, *value));
    return value;
  }

  double species_of(const OGRFeature& feature) {
    const std::string name = species_ < 0 ? "" : layer_.code(feature, species_);
    if (name.empty()) {
      if (species_ >= 0) ++without_species_;
      return 1.0;
    }
    if (const auto factor = factor_of_species(name)) return *factor;
    throw InputError(layer_.label(feature) + ": unknown species '" + name + "'" +
                     known_names(name, names_of_species()) + std::string(help_on_species()));
  }

  bool on_terrain(const Eigen::Vector2d& place) const {
    const Grid& grid = terrain_.heights.grid;
    const int column = grid.column_of(place.x()), row = grid.row_of(place.y());
    return grid.contains(column, row) && !std::isnan(terrain_.heights.at(column, row));
  }

  [[noreturn]] void refuse() const {
    if (features_ == 0) throw InputError(path_ + ": has no features, must have points: each is a tree");
    const std::string all = path_ + ": none of its " + std::to_string(features_) + " trees can be used: ";
    throw InputError(all + std::to_string(off_) + " stand off the DEM, " + std::to_string(without_diameter_) +
                     " have no diameter, " + std::to_string(without_place_) + " no place; the DEM reaches over " +
                     extent_text(terrain_.extent()) + " in " + crs_name(terrain_.geo.crs_wkt));
  }

  void tell(ForestLayer& out) const {
    out.note = std::to_string(trees_.size()) + " trees, diameter " + diameters_.text() + " m, " +
               readable(out.forest.density) + " per ha of the DEM" +
               (species_ < 0 ? "; no field species: all as silver fir" : "");
    const auto warn = [&](std::uint64_t count, const std::string& what) {
      if (count > 0) out.warnings.push_back(path_ + ": " + std::to_string(count) + " " + what);
    };
    warn(off_, "trees stand off the DEM or where it has no height: not used");
    warn(without_diameter_, "trees have no diameter: not used");
    warn(without_place_, "features have no geometry: not used");
    warn(without_species_, "features have no species: taken as silver fir");
    warn(twice_, "trees stand at the very place of an earlier one: not used");
    std::vector<std::string> unused;
    for (int i = 0; const std::string& name : layer_.field_names())
      if (const int field = i++; field != diameter_ && field != species_) unused.push_back(name);
    if (!unused.empty()) out.warnings.push_back(path_ + ": fields that are not read: " + joined(unused));
    layer_.tell(out);
  }

  std::string path_;
  const Terrain& terrain_;
  Layer layer_;
  int diameter_, species_;
  std::vector<Tree> trees_;
  std::set<std::pair<double, double>> places_;
  Spread diameters_;
  std::uint64_t features_ = 0, off_ = 0, without_diameter_ = 0, without_place_ = 0, twice_ = 0, without_species_ = 0;
};

}  // namespace

std::string centimetres_hint(const Bounds& bounds, double value) {
  return bounds.unit == "m" && value > bounds.max ? " (are the diameters in centimetres? they must be in metres)" : "";
}

ForestLayer read_forest(const ForestRequest& request, const ForestStems& numbers, const Terrain& terrain) {
  ForestLayer out;
  out.forest = numbers;
  if (!request.trees.empty())
    TreeReader(request.trees, terrain).read(out);
  else
    RasterForest(request, numbers, terrain).read(out);
  return out;
}

}  // namespace talus::io
