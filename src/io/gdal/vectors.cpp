#include "talus/io/gdal/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "layer.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {

namespace {

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

// Reads the fields of a feature and records which were read.
class AttributeReader {
 public:
  AttributeReader(const Layer& layer, const Range& release_height) : layer_(layer), release_height_(release_height) {}

  SourceFeature read(const OGRFeature& feature) {
    SourceFeature f;
    ++features_;
    const int name = layer_.field("name");
    if (name >= 0 && feature.IsFieldSetAndNotNull(name) != 0) f.name = feature.GetFieldAsString(name);
    f.frequency = get(feature, "frequency", "sources.frequency").value_or(kNotGiven);
    f.diameter = diameter(feature);
    f.release_height = release_height_;
    if (const auto height = get(feature, "height", "sources.release_height")) f.release_height = {*height, *height};
    for (const auto& [field, axis] : {std::pair{"vx", 0}, {"vy", 1}, {"vz", 2}})
      f.velocity[axis] = get(feature, field, "sources.velocity").value_or(0.0);
    if (!(f.velocity.norm() <= 200.0))
      throw InputError(layer_.label(feature) + ": fields vx, vy, vz give a speed of " + text_of(f.velocity.norm()) +
                       " m/s, must be at most 200 m/s");
    return f;
  }

  std::vector<Setting> record(const std::string& path) const {
    std::vector<Setting> settings;
    for (const Seen& s : seen_)
      settings.push_back({"sources.attributes." + s.field,
                          (s.low == s.high ? text_of(s.low) : text_of(s.low) + " to " + text_of(s.high)) + " (" +
                              std::to_string(s.count) + " of " + std::to_string(features_) + " features)",
                          s.unit == "1" ? "" : s.unit, "attribute " + s.field + " of " + file_name(path)});
    return settings;
  }

 private:
  struct Seen {
    std::string field, unit;
    std::size_t count;
    double low, high;
  };

  std::optional<double> get(const OGRFeature& feature, const char* field, std::string_view key) {
    const Bounds& bounds = bounds_of(key);
    const auto value = layer_.number(feature, field, bounds);
    if (!value) return value;
    auto seen = std::find_if(seen_.begin(), seen_.end(), [&](const Seen& s) { return s.field == field; });
    if (seen == seen_.end()) seen = seen_.insert(seen_.end(), {field, std::string(bounds.unit), 0, *value, *value});
    ++seen->count;
    seen->low = std::min(seen->low, *value);
    seen->high = std::max(seen->high, *value);
    return value;
  }

  Range diameter(const OGRFeature& feature) {
    const auto one = get(feature, "diameter", "blocks.diameter");
    const auto low = get(feature, "diameter_min", "blocks.diameter"),
               high = get(feature, "diameter_max", "blocks.diameter");
    const std::string where = layer_.label(feature) + ": ";
    if (one && (low || high))
      throw InputError(where + "has diameter = " + text_of(*one) +
                       " and diameter_min or diameter_max, must be either: set the others to NULL");
    if (low.has_value() != high.has_value())
      throw InputError(where +
                       (low ? "diameter_min = " + text_of(*low) + " without diameter_max"
                            : "diameter_max = " + text_of(*high) + " without diameter_min") +
                       ", must be both");
    if (low && *low > *high)
      throw InputError(where + "diameter_min = " + text_of(*low) + " is larger than diameter_max = " + text_of(*high) +
                       ", must not be");
    if (one) return {*one, *one};
    return low ? Range{*low, *high} : Range{kNotGiven, kNotGiven};
  }

  const Layer& layer_;
  Range release_height_;
  std::size_t features_ = 0;
  std::vector<Seen> seen_;
};

struct Cell {
  int column, row;
  bool operator==(const Cell&) const = default;
};

// The cells of the polygons and lines of a feature, each once, row by row from the north-west.
std::vector<Cell> cells_of(const Parts& parts, const Grid& grid) {
  std::vector<Cell> cells;
  const auto add = [&](int column, int row) { cells.push_back({column, row}); };
  for (const OGRPolygon& polygon : parts.polygons) {
    const std::size_t before = cells.size();
    for_each_cell(polygon, grid, false, add);
    if (cells.size() == before) for_each_cell(polygon, grid, true, add);
  }
  for (const OGRLineString& line : parts.lines) {
    for_each_cell(line, grid, true, add);
    const int column = grid.column_of(line.getX(0)), row = grid.row_of(line.getY(0));
    if (grid.contains(column, row)) add(column, row);  // also of a line without length
  }
  if (parts.polygons.size() + parts.lines.size() == 1 && parts.lines.empty()) return cells;
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.row != b.row ? a.row > b.row : a.column < b.column; });
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

// Places features on the terrain and counts those that are not on it.
class Placer {
 public:
  Placer(const Terrain& terrain, SourceLayer& out) : heights_(terrain.heights), out_(out) {}

  void place(const Parts& parts, std::int64_t id) {
    if (parts.empty()) {
      without_geometry_.push_back(id);
      return;
    }
    box_.Merge(parts.envelope());
    const Grid& grid = heights_.grid;
    bool on_map = false;
    for (const Cell& cell : cells_of(parts, grid)) {
      add(cell, {feature(), grid.centre_x(cell.column), grid.centre_y(cell.row), false});
      on_map = true;
    }
    for (const Eigen::Vector2d& point : parts.points) {
      const Cell cell{grid.column_of(point.x()), grid.row_of(point.y())};
      if (!grid.contains(cell.column, cell.row)) continue;
      add(cell, {feature(), point.x(), point.y(), true});
      on_map = true;
    }
    if (!on_map) off_map_.push_back(id);
  }

  void finish(const std::string& path, const Layer& layer, const Terrain& terrain) {
    if (out_.features.empty())
      throw InputError(path + ": has no features, must have polygons, lines or points where blocks are released");
    if (without_geometry_.size() == out_.features.size())
      throw InputError(path + ": none of its features has a geometry");
    const Grid& grid = heights_.grid;
    if (out_.cells.empty() && without_terrain_ > 0)
      throw InputError(path + ": the DEM has no heights in any of its " + std::to_string(without_terrain_) +
                       " cells, must have in one at least");
    if (out_.cells.empty())
      throw InputError(
          path + ": lies wholly off the DEM: its features reach over " +
          extent_text({box_.MinX + grid.west, box_.MinY + grid.south, box_.MaxX + grid.west, box_.MaxY + grid.south}) +
          (layer.reprojections().empty() ? "" : " (brought from " + crs_name(layer.crs_wkt()) + ")") +
          ", the DEM over " + extent_text(terrain.extent()) + " in " + crs_name(terrain.geo.crs_wkt) +
          ": is the coordinate system of the layer the right one?");
    if (!without_geometry_.empty())
      out_.warnings.push_back(path + ": features without geometry: FID " + list_of(without_geometry_));
    if (!off_map_.empty())
      out_.warnings.push_back(path + ": features wholly off the DEM, which release nothing: FID " + list_of(off_map_));
    if (at_edge_ + without_terrain_ > 0) out_.warnings.push_back(path + ": " + gaps_text());
  }

 private:
  /// What gaps and the edge of the DEM do to the sources.
  std::string gaps_text() const {
    std::string text;
    if (without_terrain_ > 0)
      text = std::to_string(without_terrain_) + " source cells or points have no height in the DEM and release nothing";
    if (at_edge_ > 0)
      text += (text.empty() ? "" : "; ") + std::to_string(at_edge_) +
              " source cells or points lie at the edge of the DEM or beside missing heights: blocks that start where "
              "there is no terrain count as left at once";
    return text;
  }
  std::uint32_t feature() const { return static_cast<std::uint32_t>(out_.features.size() - 1); }
  void add(const Cell& cell, const SourceCell& source) {
    if (std::isnan(heights_.at(cell.column, cell.row)))
      ++without_terrain_;
    else
      out_.cells.push_back(source);
    at_edge_ += at_edge(cell) ? 1U : 0U;
  }

  /// Whether a cell with a height has a neighbour without one, so that a part of the cell has no surface.
  bool at_edge(const Cell& cell) const {
    if (std::isnan(heights_.at(cell.column, cell.row))) return false;
    for (int row = cell.row - 1; row <= cell.row + 1; ++row)
      for (int column = cell.column - 1; column <= cell.column + 1; ++column)
        if (!heights_.grid.contains(column, row) || std::isnan(heights_.at(column, row))) return true;
    return false;
  }

  const Raster<float>& heights_;
  SourceLayer& out_;
  OGREnvelope box_;
  std::vector<std::int64_t> without_geometry_, off_map_;
  std::uint64_t without_terrain_ = 0, at_edge_ = 0;
};

}  // namespace

SourceLayer read_sources(const std::string& path, const Terrain& terrain, const Range& release_height) {
  Layer layer("sources", path, terrain);
  AttributeReader attributes(layer, release_height);
  SourceLayer out;
  Placer placer(terrain, out);
  while (const Feature feature = layer.next()) {
    out.features.push_back(attributes.read(*feature));
    out.ids.push_back(feature->GetFID());
    placer.place(layer.parts(*feature), feature->GetFID());
  }
  placer.finish(path, layer, terrain);
  out.attributes = attributes.record(path);
  out.reprojections = layer.reprojections();
  for (std::string& line : layer.warnings()) out.warnings.push_back(std::move(line));
  return out;
}

}  // namespace talus::io
