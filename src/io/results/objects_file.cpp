#include "talus/io/results/objects_file.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "io/gdal/layer.hpp"
#include "io/gdal/off_map.hpp"
#include "io/gdal/typed_cells.hpp"
#include "object_rows.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/results/vector_style.hpp"
#include "talus/terrain/no_height.hpp"

namespace talus::io {
namespace {

HazardObject::Ring ring_of(const OGRSimpleCurve& curve) {
  HazardObject::Ring ring;
  for (int i = 0; i < curve.getNumPoints(); ++i) ring.emplace_back(curve.getX(i), curve.getY(i));
  return ring;
}

constexpr Bounds kWidth{"width", "m", "of a line", 0.0, 1000.0};

/// @param line_width  of lines without a field `width` [m]
HazardObject object_of(const Parts& parts, double line_width) {
  HazardObject object;
  object.line_width = line_width;
  for (const OGRPolygon& polygon : parts.polygons) {
    auto& rings = object.polygons.emplace_back();
    for (const OGRLinearRing* ring : polygon) rings.push_back(ring_of(*ring));
  }
  for (const OGRLineString& line : parts.lines) object.lines.push_back(ring_of(line));
  return object;
}

/// Share of an object where the terrain has no height, so that blocks do not get there: of the area of its polygons and
/// of the length of its lines, the larger one; of what has neither, of its places.
double object_without_height(const HazardObject& object, const Raster<float>& heights) {
  WithoutHeight area, length, places;
  for (const auto& rings : object.polygons) add_polygon(area, heights, rings);
  for (const HazardObject::Ring& line : object.lines) {
    add_line(length, heights, line);
    for (const Eigen::Vector2d& place : line) places.whole += 1.0, places.without += has_height(heights, place) ? 0 : 1;
  }
  return area.whole + length.whole > 0.0 ? std::max(area.share(), length.share()) : places.share();
}

/// The geometry of an object in map coordinates: a multipolygon or a multiline; a collection if it has both.
std::unique_ptr<OGRGeometry> geometry_of(const Parts& parts, double west, double south) {
  std::unique_ptr<OGRGeometryCollection> all;
  if (parts.lines.empty())
    all = std::make_unique<OGRMultiPolygon>();
  else if (parts.polygons.empty())
    all = std::make_unique<OGRMultiLineString>();
  else
    all = std::make_unique<OGRGeometryCollection>();
  const auto moved = [&](OGRSimpleCurve& curve) {
    for (int i = 0; i < curve.getNumPoints(); ++i) curve.setPoint(i, curve.getX(i) + west, curve.getY(i) + south);
  };
  for (OGRPolygon polygon : parts.polygons) {
    for (OGRLinearRing* ring : polygon) moved(*ring);
    all->addGeometry(&polygon);
  }
  for (OGRLineString line : parts.lines) {
    moved(line);
    all->addGeometry(&line);
  }
  return all;
}

/// Throws InputError if the layer has fields that differ only in their case: a GeoPackage cannot hold copies of both.
void refuse_same_fields(const Layer& layer, const std::string& path) {
  const std::vector<std::string> names = layer.field_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (EQUAL(names[i].c_str(), names[k].c_str()))
        throw InputError(path + ": has the fields " + names[k] + ", " + names[i] +
                         ", which differ only in the case of their letters, so that objects.gpkg cannot hold both: "
                         "rename one or leave it out");
}

/// The first of some fields (-1: not there) that holds a text, else the number of the feature. All texts must be UTF-8:
/// they are copied.
std::string object_name(const Layer& layer, const OGRFeature& feature, const std::vector<int>& of_name) {
  for (int field = 0; field < feature.GetFieldCount(); ++field) layer.text(feature, field);
  for (const int field : of_name)
    if (std::string name = layer.text(feature, field); !name.empty()) return name;
  return std::to_string(feature.GetFID());
}

}  // namespace

struct ObjectLayer::State {
  std::string file;
  std::vector<Feature> features;  // with their attributes
  std::vector<std::string> names;
  std::vector<Parts> parts;
  std::vector<HazardObject> objects;
  std::vector<double> without_height;  // share of each where the terrain has no height
  std::vector<std::string> warnings;
  double line_width = 0.0;
  std::string width_field = "width";
  std::vector<std::string> fields;  // of the layer
  bool named = false;               // a field may hold the names
  std::size_t lines_of_their_width = 0, lines_of_given_width = 0, lines_of_width_0 = 0, polygons_with_width = 0;
  std::vector<std::string> without_geometry;  // features that are left out

  bool known(std::size_t i) const { return !is_all_without_height(without_height[i]); }
  bool is_partial(std::size_t i) const { return is_partly_without_height(without_height[i]); }
  /// "95 %": how much of an object has no height.
  std::string lack(std::size_t i) const { return percent(without_height[i], 2); }
  void warn_of_places(const std::string& path, const std::vector<bool>& off_map);
  void warn_of_names(const std::string& path);
  void warn_of_widths(const std::string& path);

  /// Features whose blocks reach an object, the largest share first: index and share.
  static std::vector<std::pair<std::size_t, double>> sources_of(const ObjectHits& hits) {
    std::int64_t sum = 0;
    for (const auto& [feature, weight] : hits.by_feature) sum += weight;
    std::vector<std::pair<std::size_t, double>> list;
    for (const auto& [feature, weight] : hits.by_feature)
      if (weight > 0) list.emplace_back(feature, static_cast<double>(weight) / static_cast<double>(sum));
    std::ranges::stable_sort(list, std::ranges::greater{}, &std::pair<std::size_t, double>::second);
    return list;
  }
};

/// Throws InputError if blocks get to no object at all.
void ObjectLayer::State::warn_of_places(const std::string& path, const std::vector<bool>& off_map) {
  constexpr std::size_t kShown = 8;
  std::vector<std::string> off, gaps;
  std::vector<std::size_t> partial;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_partial(i)) partial.push_back(i);
    if (!known(i)) (off_map[i] ? off : gaps).push_back(names[i]);
  }
  if (off.size() + gaps.size() == names.size())
    throw InputError(path +
                     ": none of its objects lies where the DEM has a height (it has none in its gaps and in its "
                     "outer half cell), so that no block gets to them: fill the gaps of the DEM, or take a larger one");
  if (!off.empty()) warnings.push_back(path + ": objects wholly off the DEM, which have no results: " + listed(off));
  if (!gaps.empty())
    warnings.push_back(
        path + ": objects wholly in gaps of the DEM or in its outer half cell, which have no results: " + listed(gaps));
  if (partial.empty()) return;
  std::ranges::stable_sort(partial, std::ranges::greater{}, [this](std::size_t i) { return without_height[i]; });
  std::string text;
  for (std::size_t i = 0; i < std::min(partial.size(), kShown); ++i)
    text += (i > 0 ? ", " : "") + lack(partial[i]) + " of object " + names[partial[i]];
  if (partial.size() > kShown) text += " and parts of " + std::to_string(partial.size() - kShown) + " more";
  warnings.push_back(path + ": where the DEM has no height (off it, in its outer half cell or in a gap) lie " + text +
                     ": blocks do not get there, so that the frequencies are lower bounds (unsafe)");
}

/// Objects of one name cannot be told apart in the tables.
void ObjectLayer::State::warn_of_names(const std::string& path) {
  std::set<std::string> seen, twice;
  for (const std::string& name : names)
    if (!seen.insert(name).second) twice.insert(name);
  if (!twice.empty())
    warnings.push_back(
        path +
        ": several objects have the same name (of --name-field, else name, id, object or the number "
        "of the feature), so that their rows in objects_curves.csv and objects_sources.csv cannot be told "
        "apart: " +
        listed(std::vector<std::string>(twice.begin(), twice.end())));
}

/// A road of no width is hit less often than it is.
void ObjectLayer::State::warn_of_widths(const std::string& path) {
  if (polygons_with_width > 0)
    warnings.push_back(path + ": the field " + width_field + " of " + std::to_string(polygons_with_width) +
                       " polygons is not used: it is for lines; a polygon is what it covers");
  if (lines_of_width_0 > 0)
    warnings.push_back(path + ": " + width_field + " = 0 of " + std::to_string(lines_of_width_0) +
                       (lines_of_width_0 == 1 ? " line" : " lines") +
                       ": a road of some width is hit more often (unsafe); give its width in metres, or NULL for that "
                       "of --width");
  if (lines_of_given_width == 0 || line_width > 0.0) return;
  warnings.push_back(path + ": " + std::to_string(lines_of_given_width) +
                     (lines_of_given_width == 1 ? " line has no width and counts" : " lines have no width and count") +
                     " as 0 m wide: a road of some width is hit more often (unsafe); give --width, "
                     "or the field of its width (--width-field; the layer has " +
                     (fields.empty() ? "no fields" : "the fields " + joined(fields)) + ")");
}

namespace {

/// Index of a field that is asked for. Throws InputError if it is not there.
int asked_field(const Layer& layer, const std::string& path, const std::string& flag, const std::string& field) {
  const int index = layer.field(field);
  if (index < 0)
    throw InputError("flag --" + flag + ": " + path + " has no field '" + field + "'" +
                     known_names(field, layer.field_names()));
  return index;
}

/// Indices of the fields that may hold the name of an object, the first one counts.
std::vector<int> fields_of_name(const Layer& layer, const std::string& path, const std::string& asked) {
  if (!asked.empty()) return {asked_field(layer, path, "name-field", asked)};
  return {layer.field("name"), layer.field("id"), layer.field("object")};
}

}  // namespace

ObjectLayer::ObjectLayer(const std::string& path, const LoadedScenario& loaded, const ObjectFields& fields)
    : state_(std::make_unique<State>()) {
  Terrain terrain;
  terrain.geo = loaded.geo;
  terrain.heights.grid = loaded.scenario.surface.grid();
  const Grid& grid = terrain.heights.grid;
  Layer layer("objects", path, terrain);
  refuse_same_fields(layer, path);
  state_->line_width = fields.line_width;
  state_->fields = layer.field_names();
  if (!fields.width.empty()) state_->width_field = fields.width;
  const int width_field =
      fields.width.empty() ? layer.field(state_->width_field) : asked_field(layer, path, "width-field", fields.width);
  const std::vector<int> name_fields = fields_of_name(layer, path, fields.name);
  state_->named = std::ranges::any_of(name_fields, [](int field) { return field >= 0; });
  std::vector<bool> off_map;
  OGREnvelope all;
  for_each_feature(layer, [&](Feature& feature) {
    Parts parts = layer.parts(*feature);
    if (parts.empty()) {
      state_->without_geometry.push_back(std::to_string(feature->GetFID()));
      return;
    }
    if (!parts.points.empty())
      throw InputError(layer.label(*feature) +
                       ": is a point, must be a polygon or a line that blocks may hit; make areas of points first, as "
                       "wide as the houses (Buffer, in QGIS)");
    const OGREnvelope box = parts.envelope();
    state_->names.push_back(object_name(layer, *feature, name_fields));
    off_map.push_back(wholly_off(box, grid));
    all.Merge(box);
    std::optional<double> width;
    if (!parts.lines.empty()) {
      width = layer.number(*feature, width_field, state_->width_field, kWidth);
      if (width.value_or(0.0) > kWidestObject)
        state_->warnings.push_back(layer.label(*feature) + ": " + state_->width_field + " = " + text_of(*width) +
                                   " m, wider than any road: must be in metres");
      if (width == 0.0) ++state_->lines_of_width_0;
      (width ? state_->lines_of_their_width : state_->lines_of_given_width) += 1;
    } else if (!layer.text(*feature, width_field).empty()) {
      ++state_->polygons_with_width;
    }
    state_->objects.push_back(object_of(parts, width.value_or(fields.line_width)));
    state_->without_height.push_back(object_without_height(state_->objects.back(), loaded.scenario.surface.heights()));
    state_->parts.push_back(std::move(parts));
    state_->features.push_back(std::move(feature));
  });
  if (state_->objects.empty())
    throw InputError(path + (state_->without_geometry.empty() ? ": has no features" : ": no feature has a geometry") +
                     ", must have polygons or lines");
  if (std::ranges::count(off_map, false) == 0) throw InputError(off_dem_text(path, all, layer, terrain));
  if (layer.is_csv()) state_->features = with_numbers(state_->features);
  state_->warn_of_places(path, off_map);
  state_->warn_of_names(path);
  state_->warn_of_widths(path);
  if (!state_->without_geometry.empty())
    state_->warnings.push_back(path + ": objects without geometry, which have no results: features " +
                               listed(state_->without_geometry));
  state_->file = path;
  for (std::string& line : layer.warnings()) state_->warnings.push_back(std::move(line));
}

ObjectLayer::~ObjectLayer() = default;

const std::vector<HazardObject>& ObjectLayer::objects() const {
  return state_->objects;
}
const std::vector<std::string>& ObjectLayer::warnings() const {
  return state_->warnings;
}

std::string ObjectLayer::lines_text() const {
  const State& s = *state_;
  std::string text;
  if (s.lines_of_their_width > 0)
    text = std::to_string(s.lines_of_their_width) + " as wide as their field " + s.width_field + " says";
  if (s.lines_of_given_width > 0)
    text += (text.empty() ? "" : "; ") + std::to_string(s.lines_of_given_width) + " without a field " + s.width_field +
            ", taken as " + text_of(s.line_width) + " m wide" + (s.line_width > 0.0 ? " (--width)" : "");
  return text.empty() ? text : "lines: " + text;
}

std::string ObjectLayer::names_text() const {
  if (state_->named || state_->fields.empty()) return {};
  return "objects are called by the numbers of their features, as there is no field name, id or object: --name-field "
         "takes another one (" +
         joined(state_->fields) + ")";
}

namespace {

/// How often an object is hit that nothing hits per year.
std::string never_hit_text(const ObjectHits& hits) {
  if (hits.trajectories == 0) return "hit by no block of this run";
  return "hit by " + std::to_string(hits.trajectories) + (hits.trajectories == 1 ? " block" : " blocks, all") +
         " of sources or block classes with a frequency of 0";
}

}  // namespace

std::string ObjectLayer::not_copied_text(const HazardRules& rules, const HazardMatrix& matrix) const {
  OGRFeature& model = *state_->features.front();
  const std::vector<int> copied = copied_attributes(model, figures_of(rules, {}, 0.0, matrix), rules.with_rotation);
  std::vector<std::string> left_out;
  for (int i = 0; i < model.GetFieldCount(); ++i) {
    const std::string name = model.GetFieldDefnRef(i)->GetNameRef();
    if (std::ranges::count(copied, i) == 0) left_out.push_back(name);
  }
  if (left_out.empty()) return {};
  return state_->file + ": fields named as columns of the results are not copied into objects.gpkg and objects.csv: " +
         listed(left_out) + "; rename them to keep them";
}

std::vector<std::string> ObjectLayer::hits_text(const HazardRules& rules, const std::vector<ObjectHits>& hits,
                                                std::size_t most) const {
  std::vector<std::pair<Bounded, std::size_t>> order;
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (state_->known(i)) order.emplace_back(HazardCurve(rules, hits[i].largest).passage(), i);
  std::ranges::stable_sort(order, std::ranges::greater{}, [](const auto& one) { return one.first.value; });
  std::vector<std::string> lines;
  for (const auto& [f, i] : order) {
    if (lines.size() == most) {
      lines.push_back("and " + std::to_string(order.size() - most) + " more, hit less often: objects.csv");
      break;
    }
    const std::string name = printable(state_->names[i]) + ": ",
                      lack = state_->is_partial(i)
                                 ? "; the " + state_->lack(i) + " of it where the DEM has no height is not assessed"
                                 : "";
    if (f.value > 0.0)
      lines.push_back(name + "hit " + with_digits(f.value, 3) + " times per year, once in " + readable(1.0 / f.value) +
                      " years (95 %: " + with_digits(f.low, 3) +
                      (lack.empty() ? " to " + with_digits(f.high, 3) : " or more") + " per year)" + lack);
    else
      lines.push_back(name + never_hit_text(hits[i]) +
                      (lack.empty() ? "; at most " + with_digits(f.high, 3) + " times per year (95 %)" : lack));
  }
  return lines;
}

/// Names of the source features; with their numbers, "A (FID 3)", where two have the same.
static std::vector<std::string> distinct_names(const std::vector<SourceFeature>& features) {
  std::map<std::string, std::size_t> held;
  for (const SourceFeature& f : features) ++held[f.name];
  std::vector<std::string> names;
  for (const SourceFeature& f : features)
    names.push_back(f.name + (held[f.name] > 1 ? " (FID " + std::to_string(f.id) + ")" : ""));
  return names;
}

void ObjectLayer::write(const std::filesystem::path& folder, const LoadedScenario& loaded, const HazardRules& rules,
                        const std::vector<ObjectHits>& hits, const HazardMatrix& matrix) const {
  const Grid& grid = loaded.scenario.surface.grid();
  std::unique_ptr<ObjectsWriter> writer;
  ObjectsTable table;
  const std::vector<std::string> names = distinct_names(loaded.scenario.features);
  std::string curves = std::string("object,") + (rules.with_rotation ? "total_energy_kj" : "energy_kj") +
                       ",frequency,lower,upper,return_period\n",
              from = "object,feature,frequency,share\n";
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const HazardCurve curve(rules, hits[i].largest);
    const Figures figures = figures_of(rules, hits[i], state_->without_height[i], matrix);
    const std::string object = csv_field(state_->names[i]);
    std::string sources;
    for (const auto& [feature, share] : State::sources_of(state_->known(i) ? hits[i] : ObjectHits{})) {
      const std::string& name = names[feature];
      sources += (sources.empty() ? "" : "; ") + name + ' ' + percent(share);
      from += object + ',' + csv_field(name) + ',' +
              csv_field(static_cast<double>(hits[i].by_feature.at(static_cast<std::uint32_t>(feature))) *
                        rules.scale.unit) +
              ',' + csv_field(share) + '\n';
    }
    if (!writer)
      writer = std::make_unique<ObjectsWriter>(folder / "objects.gpkg", loaded, *state_->features[i], figures);
    const ObjectRow row{state_->names[i], *state_->features[i], figures, sources, rules.with_rotation};
    writer->write(row, *geometry_of(state_->parts[i], grid.west, grid.south));
    table.add(row);
    if (state_->known(i)) curves += curve_rows(object, curve, rules.bins, !state_->is_partial(i));
  }
  const bool lines = std::ranges::all_of(state_->parts, [](const Parts& parts) { return parts.polygons.empty(); });
  writer->finish(lines ? StyledLayer::LineObjects : StyledLayer::AreaObjects);
  write_text(folder / "objects.csv", table.text());
  write_text(folder / "objects_curves.csv", curves);
  write_text(folder / "objects_sources.csv", from);
}

}  // namespace talus::io
