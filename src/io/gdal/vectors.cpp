#include "talus/io/gdal/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "layer.hpp"
#include "narrow_polygons.hpp"
#include "off_map.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/layer_name.hpp"

namespace talus::io {

namespace {

// In the warnings about sources of which a part, or all, gives no blocks; the first also in narrow_polygons.cpp.
constexpr const char *kReleaseNothing = "release nothing", *kFromTheRest = "blocks start from the rest alone";

std::string file_name(const std::string& path) {
  return same_layer_in(std::filesystem::path(file_of_layer(path)).filename().string(), path);
}

/// The key of the parameter table with the bounds of a field.
std::string_view key_of(const std::string& name) {
  if (name == "frequency") return "sources.frequency";
  if (name == "release_height") return "sources.release_height";
  return name.starts_with("diameter") ? "blocks.diameter" : "sources.velocity";
}

/// Index of the field that holds a quantity.
int field_of(const Layer& layer, const std::string& name, const std::string& field) {
  return layer.field(field, "say which is " + name + " with --field " + name +
                                "=COLUMN or in [sources.fields], or rename all but one");
}

/// The fields of a layer that are read: those that the map names, else those of the names themselves; none where the
/// map names none.
std::vector<FieldUse> columns_of(const Layer& layer, const std::string& path, const FieldMap& map) {
  std::vector<std::pair<std::string, int>> mapped;
  for (const auto& [name, given] : map) {
    const int index = given.field.empty() ? -1 : field_of(layer, name, given.field);
    if (index < 0 && !given.field.empty())
      throw InputError(given.where + ": " + path + " has no field '" + given.field + "'" +
                       known_names(given.field, layer.field_names()) +
                       (layer.names_are_utf8()
                            ? ""
                            : "; some names of its fields are not UTF-8: of a Shapefile, write the encoding, such "
                              "as ISO-8859-1, into a file of the same name that ends in .cpg"));
    mapped.emplace_back(name, index);
  }
  const auto taken = [&](int index) {  // by another name
    return std::ranges::any_of(mapped, [index](const auto& entry) { return entry.second == index; });
  };
  std::vector<FieldUse> columns;
  for (const std::string& name : source_field_names()) {
    const auto entry = std::ranges::find(mapped, name, &std::pair<std::string, int>::first);
    const int index = entry != mapped.end() ? entry->second : field_of(layer, name, name);
    if (index < 0 || (entry == mapped.end() && taken(index))) continue;
    FieldUse use{name, layer.field_names()[static_cast<std::size_t>(index)], {}, index};
    use.is_text = name == "name";
    use.zero_if_empty = key_of(name) == "sources.velocity" && !use.is_text;
    const std::string unit(use.is_text ? "1" : bounds_of(key_of(name)).unit);
    if (unit != "1") use.unit = unit;
    use.from_text = !use.is_text && layer.holds_text(index);
    columns.push_back(std::move(use));
  }
  return columns;
}

/// "diameter", or "Durchmesser (diameter)", for messages.
std::string shown(const FieldUse& use) {
  return EQUAL(use.field.c_str(), use.name.c_str()) ? use.name : use.field + " (" + use.name + ")";
}

// Reads the fields of a feature and records which were read.
class AttributeReader {
 public:
  AttributeReader(Layer& layer, const std::string& path, const Range& release_height, const FieldMap& map)
      : layer_(layer), path_(path), release_height_(release_height), columns_(columns_of(layer, path, map)) {}

  /// A feature without a name has its number (FID) for one. Faults are added to those of the layer.
  SourceFeature read(const OGRFeature& feature) {
    SourceFeature f;
    ++features_;
    f.name = text(feature, "name");
    f.id = feature.GetFID();
    if (f.name.empty()) f.name = std::to_string(f.id);
    f.frequency = get(feature, "frequency").value_or(kNotGiven);
    f.diameter = diameter(feature);
    f.release_height = release_height_;
    if (const auto height = get(feature, "release_height")) f.release_height = {*height, *height};
    for (const auto& [field, axis] : {std::pair{"vx", 0}, {"vy", 1}, {"vz", 2}})
      f.velocity[axis] = get(feature, field).value_or(0.0);
    if (!(f.velocity.norm() <= 200.0))
      throw InputError(layer_.label(feature) + ": fields vx, vy, vz give a speed of " + text_of(f.velocity.norm()) +
                       " m/s, must be at most 200 m/s");
    return f;
  }

  std::vector<Setting> record() const {
    std::vector<Setting> settings;
    for (const FieldUse& c : columns_) {
      if (c.count == 0 || c.is_text) continue;
      settings.push_back({"sources.attributes." + c.name, c.range() + " (" + share_text(c) + ")", c.unit,
                          "attribute " + c.field + " of " + file_name(path_)});
    }
    return settings;
  }

  std::string read_note() const { return fields_note(path_, columns_, features_, layer_.field_names()); }

  /// A line for each field that looks as if it were meant.
  std::vector<std::string> unread_notes() const {
    std::vector<std::string> notes;
    for (const std::string& field : layer_.field_names()) {
      if (is_read(field)) continue;
      const auto meant =
          std::ranges::find_if(columns_, [&](const FieldUse& c) { return EQUAL(c.name.c_str(), field.c_str()); });
      if (meant != columns_.end())
        notes.push_back(path_ + ": field " + field + " is not read: " + meant->field + " is read as " + meant->name);
      if (is_height(field))
        notes.push_back(path_ + ": field " + field +
                        " is not read (it is mostly the height of a cliff): if it is the height of release above the "
                        "ground, give --field " +
                        shell_word("release_height=" + field) + ", or release_height = \"" + field +
                        "\" in [sources.fields]");
    }
    return notes;
  }

  bool has_unread_height() const {
    return std::ranges::any_of(layer_.field_names(), [&](const std::string& f) { return is_height(f) && !is_read(f); });
  }

 private:
  static bool is_height(const std::string& field) { return EQUAL(field.c_str(), "height"); }
  bool is_read(const std::string& field) const {
    return std::ranges::find(columns_, field, &FieldUse::field) != columns_.end();
  }
  FieldUse* column(const char* name) {
    const auto found = std::ranges::find(columns_, name, &FieldUse::name);
    return found == columns_.end() ? nullptr : &*found;
  }

  std::string share_text(const FieldUse& c) const {
    return std::to_string(c.count) + " of " + std::to_string(features_) + " features";
  }

  std::string text(const OGRFeature& feature, const char* name) {
    FieldUse* const c = column(name);
    if (c == nullptr) return {};
    std::string text = layer_.text(feature, c->index);
    if (!text.empty()) ++c->count;
    return text;
  }

  /// The value of a field; nothing where there is none, or a faulty one.
  std::optional<double> get(const OGRFeature& feature, const char* name) {
    FieldUse* const c = column(name);
    std::optional<double> value;
    if (c == nullptr) return value;
    layer_.faults().attempt([&] { value = layer_.number(feature, c->index, shown(*c), bounds_of(key_of(c->name))); });
    if (value) c->add(*value);
    return value;
  }

  Range diameter(const OGRFeature& feature) {
    const std::size_t faults = layer_.faults().count();
    const auto one = get(feature, "diameter"), low = get(feature, "diameter_min"), high = get(feature, "diameter_max");
    if (layer_.faults().count() > faults) return {kNotGiven, kNotGiven};
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

  Layer& layer_;
  std::string path_;
  Range release_height_;
  std::vector<FieldUse> columns_;
  std::size_t features_ = 0;
};

/// Whether a geometry has heights of its own. Those that are 0 or no number are none: KML writes 0 for a height that is
/// not known.
bool has_heights(const OGRGeometry* geometry) {
  if (geometry == nullptr || geometry->Is3D() == 0 || geometry->IsEmpty()) return false;
  OGREnvelope3D box;
  geometry->getEnvelope(&box);
  return std::isfinite(box.MinZ) && std::isfinite(box.MaxZ) && (box.MinZ != 0.0 || box.MaxZ != 0.0);
}

/// Whether a straight line has a length in a cell with its edges, not a touch alone.
bool runs_through(const OGRLineString& segment, const Grid& grid, const Cell& cell) {
  constexpr double kTouch = 1e-9;  // cells
  const double u[] = {segment.getX(0) / grid.cell_x - cell.column, segment.getX(1) / grid.cell_x - cell.column};
  const double v[] = {segment.getY(0) / grid.cell_y - cell.row, segment.getY(1) / grid.cell_y - cell.row};
  double from = 0.0, to = 1.0;  // share of the segment that lies in the cell
  for (const double* w : {u, v}) {
    const double way = w[1] - w[0];
    if (way == 0.0 && (w[0] < 0.0 || w[0] > 1.0)) return false;
    if (way == 0.0) continue;
    from = std::max(from, std::min(-w[0] / way, (1.0 - w[0]) / way));
    to = std::min(to, std::max(-w[0] / way, (1.0 - w[0]) / way));
  }
  return (to - from) * std::hypot(u[1] - u[0], v[1] - v[0]) > kTouch;
}

/// Appends the cells that a line crosses, some of them twice. GDAL also gives cells that it touches in a corner, or
/// with a vertex on their edge.
void append_cells(const OGRLineString& line, const Grid& grid, std::vector<Cell>& cells) {
  const std::size_t before = cells.size();
  for (int i = 1; i < line.getNumPoints(); ++i) {
    OGRLineString segment;
    for (const int end : {i - 1, i}) segment.addPoint(line.getX(end), line.getY(end));
    for_each_cell(segment, grid, CellRule::Touched, [&](int column, int row) {
      const Cell cell{column, row};
      if (runs_through(segment, grid, cell)) cells.push_back(cell);
    });
  }
  const Cell start{grid.column_of(line.getX(0)), grid.row_of(line.getY(0))};
  if (cells.size() == before && grid.contains(start.column, start.row)) cells.push_back(start);  // without length
}

// The cells of the polygons and lines of a feature, each once, row by row from the north-west. Counts those of its
// polygons.
std::vector<Cell> cells_of(const Parts& parts, const Grid& grid, PolygonCells& of_polygons) {
  std::vector<Cell> cells;
  const auto add = [&](int column, int row) { cells.push_back({column, row}); };
  for (const OGRPolygon& polygon : parts.polygons) {
    const std::size_t before = cells.size();
    const CellMask inside = mask_of(polygon, grid, CellRule::Once), at_all = mask_of(polygon, grid, CellRule::Touched);
    for_each_cell(inside, add);
    if (cells.size() == before)
      for_each_cell(at_all, add);
    else
      of_polygons.add(inside, at_all);
  }
  for (const OGRLineString& line : parts.lines) append_cells(line, grid, cells);
  if (parts.polygons.size() == 1 && parts.lines.empty()) return cells;
  std::sort(cells.begin(), cells.end(), from_north_west);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  of_polygons.keep_far_from(cells);
  return cells;
}

/// A feature of which a part releases nothing.
struct Lack {
  std::string name;      // "polygon 4 (cliff A)"
  double outside, hole;  // shares off the DEM, and where it has no heights
  double frequency;      // of the whole feature [1/year]; NaN: not given
};

/// "83 % of polygon 4 (cliff A) lies outside the DEM"; with a frequency "..., and its 0.5 events per year all fall on
/// the 17 % that are left".
std::string lack_text(const Lack& lack) {
  const double share = lack.outside + lack.hole;
  const char* where = lack.hole == 0.0      ? "outside the DEM"
                      : lack.outside == 0.0 ? "where the DEM has no heights"
                                            : "outside the DEM or where it has no heights";
  const std::string events = lack.frequency > 0.0 ? ", and its " + with_digits(lack.frequency, 3) + kAllOnTheRest +
                                                        percent(1.0 - share, 2) + " that are left"
                                                  : "";
  return percent(share, 2) + " of " + lack.name + " lies " + where + events;
}

/// Features that release nothing.
struct LostSources {
  std::vector<std::string> names;  // "4 (cliff A)"
  double frequency = 0.0;          // of all that have one [1/year]

  void add(const std::string& name, const SourceFeature& feature) {
    names.push_back(name);
    if (feature.frequency > 0.0) frequency += feature.frequency;
  }
};

/// "FID 3, 4 (cliff A)"; with a frequency "..., and their 0.8 events per year are lost".
std::string lost_text(const LostSources& lost) {
  const std::string text = "FID " + listed(lost.names);
  if (!(lost.frequency > 0.0)) return text;
  return text + ", and " + (lost.names.size() == 1 ? "its " : "their ") + with_digits(lost.frequency, 3) + kEventsLost;
}

/// A source of which lengths release nothing, as they are narrower than a cell.
struct NarrowSource {
  std::string name;  // "polygon 4 (crest)"
  PolygonCells cells;
  std::uint64_t released;  // cells of the feature that release
  double frequency;        // as in Lack
};

/// "polygon 4 (crest): of the 101 cells that it touches, 39 release nothing, nor does a neighbour of them"; with a
/// frequency "..., and its 5 events per year all fall on the 60 that release".
std::string narrow_text(const NarrowSource& source) {
  const std::string events = source.frequency > 0.0 ? ", and its " + with_digits(source.frequency, 3) + kAllOnTheRest +
                                                          std::to_string(source.released) + " that release"
                                                    : "";
  return source.name + ": " + left_out_text(source.cells) + events;
}

/// The first five, and how many more there are: "...; ... and parts of 3 more features".
template <class Source, class Text>
std::string first_five(const std::vector<Source>& sources, Text text_of_one) {
  constexpr std::size_t kShown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(sources.size(), kShown); ++i)
    text += (i > 0 ? "; " : "") + text_of_one(sources[i]);
  if (sources.size() > kShown) text += "; and parts of " + std::to_string(sources.size() - kShown) + " more features";
  return text;
}

/// The largest shares first: "83 % of polygon 4 (cliff A) lies outside the DEM; ... and 3 more features".
std::string lacks_text(std::vector<Lack> lacks) {
  std::ranges::stable_sort(lacks, std::ranges::greater{}, [](const Lack& l) { return l.outside + l.hole; });
  return first_five(lacks, lack_text) + ": " + kFromTheRest;
}

// Places features on the terrain and counts those that are not on it.
class Placer {
 public:
  Placer(const Terrain& terrain, SourceLayer& out) : heights_(terrain.heights), out_(out) {}

  void place(const Parts& parts, std::int64_t id) {
    const std::string number = std::to_string(id);
    const std::string name = number + (source().name == number ? "" : " (" + source().name + ")");
    if (parts.empty()) {
      without_geometry_.add(name, source());
      return;
    }
    SourceFeature& drawn = out_.features.back();
    drawn.has_area = !parts.polygons.empty() && parts.lines.empty() && parts.points.empty();
    drawn.drawn_area = 0.0;
    for (const OGRPolygon& polygon : parts.polygons) drawn.drawn_area += polygon.get_Area();
    box_.Merge(parts.envelope());
    const Grid& grid = heights_.grid;
    std::uint64_t on_map = 0;
    const std::uint64_t missing = without_terrain_;
    PolygonCells of_polygons;
    for (const Cell& cell : cells_of(parts, grid, of_polygons)) {
      add(cell, {feature(), grid.centre_x(cell.column), grid.centre_y(cell.row), false});
      ++on_map;
    }
    for (const Eigen::Vector2d& point : parts.points) {
      const Cell cell{grid.column_of(point.x()), grid.row_of(point.y())};
      if (!grid.contains(cell.column, cell.row)) continue;
      add(cell, {feature(), point.x(), point.y(), true});
      ++on_map;
    }
    record(parts, name, on_map, without_terrain_ - missing);
    const std::uint64_t released = on_map - (without_terrain_ - missing);
    if (of_polygons.is_narrow() && released > 0)
      narrow_.push_back({kind_of(parts) + (" " + name), of_polygons, released, source().frequency});
  }

  void finish(const std::string& path, const Layer& layer, const Terrain& terrain) {
    if (out_.features.empty())
      throw InputError(path + ": has no features, must have polygons, lines or points where blocks are released");
    if (without_geometry_.names.size() == out_.features.size())
      throw InputError(path + ": none of its features has a geometry");
    if (out_.cells.empty() && without_terrain_ > 0)
      throw InputError(path + ": the DEM has no heights in any of its " + std::to_string(without_terrain_) +
                       " cells, must have in one at least");
    if (out_.cells.empty()) throw InputError(off_dem_text(path, box_, layer, terrain));
    for (const auto& [lost, what] :
         {std::pair{&without_geometry_, "without geometry (or with one that cannot be read)"},
          {&off_map_, "wholly off the DEM"},
          {&without_height_, "where the DEM has no heights"}})
      if (!lost->names.empty())
        out_.warnings.push_back(path + ": features " + what + ", which " + kReleaseNothing + ": " + lost_text(*lost));
    if (!lacks_.empty()) out_.warnings.push_back(path + ": " + lacks_text(lacks_));
    if (!narrow_.empty())
      out_.warnings.push_back(
          path + ": where a polygon is narrower than a cell of the DEM, lengths of it release nothing: " +
          first_five(narrow_, narrow_text) + ": draw a crest as a line, widen the polygon, or take a finer DEM");
    if (at_edge_ + without_terrain_ > 0) out_.warnings.push_back(path + ": " + gaps_text());
  }

 private:
  /// What gaps and the edge of the DEM do to the sources.
  std::string gaps_text() const {
    std::string text;
    if (without_terrain_ > 0)
      text =
          std::to_string(without_terrain_) + " source cells or points have no height in the DEM and " + kReleaseNothing;
    if (at_edge_ > 0)
      text += (text.empty() ? "" : "; ") + std::to_string(at_edge_) +
              " source cells or points lie at the edge of the DEM or beside missing heights: blocks that start where "
              "there is no terrain count as left at once";
    return text;
  }
  const SourceFeature& source() const { return out_.features.back(); }

  /// Records which share of a feature releases nothing.
  /// @param on_map   its cells and points on the DEM
  /// @param missing  those without a height
  void record(const Parts& parts, const std::string& name, std::uint64_t on_map, std::uint64_t missing) {
    constexpr double kNoticed = 0.01;
    if (on_map == 0) return off_map_.add(name, source());
    if (missing == on_map) return without_height_.add(name, source());
    const double outside = share_outside(parts, heights_.grid);
    const double hole = (1.0 - outside) * static_cast<double>(missing) / static_cast<double>(on_map);
    out_.features.back().drawn_area *= std::max(0.0, 1.0 - outside - hole);
    if (outside + hole >= kNoticed)
      lacks_.push_back({kind_of(parts) + (" " + name), outside, hole, source().frequency});
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
  LostSources without_geometry_, off_map_, without_height_;
  std::vector<Lack> lacks_;
  std::vector<NarrowSource> narrow_;
  std::uint64_t without_terrain_ = 0, at_edge_ = 0;
};

}  // namespace

bool is_of_cut_sources(const std::string& warning) {
  return warning.find(kReleaseNothing) != std::string::npos || warning.find(kFromTheRest) != std::string::npos;
}

const std::vector<std::string>& source_field_names() {
  static const std::vector<std::string> names{
      "name", "frequency", "diameter", "diameter_min", "diameter_max", "release_height", "vx", "vy", "vz"};
  return names;
}

SourceLayer read_sources(const std::string& path, const Terrain& terrain, const Range& release_height,
                         const FieldMap& fields) {
  Layer layer("sources", path, terrain);
  AttributeReader attributes(layer, path, release_height, fields);
  SourceLayer out;
  Placer placer(terrain, out);
  std::size_t with_heights = 0;
  for_each_feature(layer, [&](const Feature& feature) {
    with_heights += has_heights(feature->GetGeometryRef()) ? 1 : 0;
    out.features.push_back(attributes.read(*feature));
    placer.place(layer.parts(*feature), feature->GetFID());
  });
  placer.finish(path, layer, terrain);
  out.fields = layer.field_names();
  out.attributes = attributes.record();
  out.read_note = attributes.read_note();
  out.unread_notes = attributes.unread_notes();
  if (with_heights > 0)
    out.unread_notes.push_back(path + ": the height (Z) of " + std::to_string(with_heights) + " of " +
                               std::to_string(out.features.size()) +
                               " features is not read: blocks start above the DEM, by the release height");
  out.unread_height = attributes.has_unread_height();
  layer.tell(out);
  return out;
}

}  // namespace talus::io
