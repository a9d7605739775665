#include "layer.hpp"

#include <gdal_alg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "csv_table.hpp"
#include "input_name.hpp"
#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/io/gdal/layer_name.hpp"
#include "talus/io/gdal/source_cells.hpp"

namespace talus::io {
namespace {

/// What a text must be in the place of a number. A comma is not taken as a decimal point: "1,200" may be 1200.
/// @param in_layer  the text is in a text field of a layer, else in a CSV
/// @param may_lack  as of `Layer::number`
std::string no_number_text(const std::string& text, const std::string& unit, bool in_layer, bool may_lack = true) {
  const std::string wanted =
      "must be a number" + unit + ", with a point for decimals" +
      (may_lack ? std::string(", or ") + (in_layer ? "NULL" : "empty") + " where it is not known" : std::string());
  if (!in_layer) return wanted;
  std::string number = "the field";
  if (text.find_first_not_of("0123456789.,- ") != std::string::npos)  // a unit
    number = "regexp_replace(" + number + ", '[^0-9.,]', '')";
  if (text.find(',') != std::string::npos) number = "replace(" + number + ", ',', '.')";
  return wanted + ": in QGIS make a number field of it with the field calculator, to_real(" + number + ")";
}

}  // namespace

std::string FieldUse::text(std::size_t features) const {
  const std::string counted = zero_if_empty ? ", counted as 0" : "";
  std::string word = name;
  if (count > 0 && !is_text) word += " " + range() + (unit.empty() ? "" : " " + unit);
  if (!EQUAL(field.c_str(), name.c_str())) word += " from " + field;
  word +=
      " (" + (count == 0 ? "empty" + counted : std::to_string(count) + " of " + std::to_string(features) + " features");
  if (count > 0 && count < features) word += ", " + std::to_string(features - count) + " empty" + counted;
  return word + (from_text && count > 0 ? "; text, read as numbers)" : ")");
}

std::string FieldUse::range() const {
  return low == high ? text_of(low) : text_of(low) + " to " + text_of(high);
}

void FieldUse::add(double value) {
  low = count == 0 ? value : std::min(low, value);
  high = count == 0 ? value : std::max(high, value);
  ++count;
}

OGREnvelope Parts::envelope() const {
  OGREnvelope all, one;
  for (const OGRPolygon& polygon : polygons) polygon.getEnvelope(&one), all.Merge(one);
  for (const OGRLineString& line : lines) line.getEnvelope(&one), all.Merge(one);
  for (const Eigen::Vector2d& point : points) all.Merge(point.x(), point.y());
  return all;
}

Layer::Layer(std::string role, const std::string& path, const Terrain& terrain)
    : path_(path), terrain_(terrain), dataset_(open_dataset(path, GDAL_OF_VECTOR)) {
  choose_layer();
  faults_ = is_csv() ? FaultList(path, "row", " below the header") : FaultList(path, "feature", "");
  if (is_csv()) {
    odd_ = odd_cells(name_for_gdal(file_of_layer(path)));
    for (const char* place : {"x", "y"})
      if (fields().GetFieldIndex(place) < 0) refuse_odd(odd_.places, place, "");  // a coordinate, no field
  }
  const OGRSpatialReference* system = layer_->GetSpatialRef();
  crs_wkt_ = wkt_of(system);
  if (crs_wkt_.empty()) {
    crs_wkt_ = terrain.geo.crs_wkt;
    if (!is_csv()) warnings_.push_back(dem_system_note(path, crs_wkt_));
  } else {
    const std::vector<int>& order = system->GetDataAxisToSRSAxisMapping();
    north_first_ = !order.empty() && order[0] == 1 &&
                   (system->EPSGTreatsAsLatLong() != 0 || system->EPSGTreatsAsNorthingEasting() != 0);
  }
  transformer_.emplace(LayerName{std::move(role), path}, crs_wkt_, terrain.geo.crs_wkt, terrain.map());
}

bool Layer::is_csv() const {
  return EQUAL(dataset_->GetDriverName(), "CSV");
}

std::vector<OGRLayer*> Layer::layers_with_geometry() const {
  std::vector<OGRLayer*> layers;
  for (int i = 0; i < dataset_->GetLayerCount(); ++i)
    if (OGRLayer* layer = dataset_->GetLayer(i); layer->GetGeomType() != wkbNone) layers.push_back(layer);
  return layers;
}

void Layer::refuse_without_geometry() {
  if (is_csv() && dataset_->GetLayerCount() > 0) {
    layer_ = dataset_->GetLayer(0);
    throw InputError(path_ + ": does not say where its features lie: must have the columns x and y, or wkt; has " +
                     joined(field_names()));
  }
  throw InputError(path_ + ": has no layer with geometry, must have polygons, lines or points");
}

void Layer::choose_layer() {
  const std::vector<OGRLayer*> layers = layers_with_geometry();
  if (layers.empty()) refuse_without_geometry();
  std::vector<std::string> names;
  for (OGRLayer* layer : layers) names.emplace_back(layer->GetName());
  const NamedLayer wanted = named_layer(path_);
  if (wanted.unread.starts_with("|layer"))
    throw InputError(path_ + ": '" + wanted.unread + "' is not read: a file is followed by one layer, such as " +
                     shell_word("|layername=" + names.front()) + " or |layerid=0 (a whole number from 0)");
  if (!wanted.unread.empty())
    throw InputError(path_ + ": '" + wanted.unread +
                     "' is not read (a filter or a kind of geometry): export the features to a file of their own");
  const std::string given = wanted.number >= 0 && wanted.number < dataset_->GetLayerCount()
                                ? dataset_->GetLayer(wanted.number)->GetName()
                                : wanted.layer;
  const bool asked = !wanted.layer.empty() || wanted.number >= 0;
  if (!asked && names.size() > 1 && names != kSourceLayers)
    throw InputError(
        wanted.file + ": has the layers " + joined(names) + ", must be told which, such as " +
        shell_word(std::filesystem::path(wanted.file).filename().string() + "|layername=" + names.front()));
  const auto found = asked ? std::ranges::find(names, given) : names.begin();
  if (found == names.end()) throw InputError(path_ + ": has no such layer with geometry" + known_names(given, names));
  layer_ = layers[static_cast<std::size_t>(found - names.begin())];
  layer_->ResetReading();
  if (!asked && names.size() > 1)
    warnings_.push_back(path_ + ": its layer " + *found + " is read, " + names.back() + " is not");
}

Feature Layer::next() {
  GdalMessages messages;
  CPLErrorReset();
  Feature feature(layer_->GetNextFeature());
  if (!feature && CPLGetLastErrorType() == CE_Failure)
    throw InputError(path_ + ": its features cannot be read: " + messages.take(CPLGetLastErrorMsg()));
  return feature;
}

int Layer::field(const std::string& name, const std::string& way_out) const {
  std::vector<std::string> same;
  int found = -1;
  for (int i = 0; i < fields().GetFieldCount(); ++i) {
    const char* const other = fields().GetFieldDefn(i)->GetNameRef();
    if (name == other) return i;
    if (!EQUAL(other, name.c_str())) continue;
    same.emplace_back(other);
    found = i;
  }
  if (same.size() > 1)
    throw InputError(path_ + ": has the fields " + joined(same) +
                     ", which differ only in the case of their letters, and none is spelt " + name + ": " + way_out);
  return found >= 0 ? found : cut_field(name);
}

int Layer::cut_field(const std::string& name) const {
  // A Shapefile cuts names to ten characters: GDAL and QGIS write the pair diameter_min, diameter_max as
  // diameter_m, diameter_1. A layer that was made of one keeps them.
  if (EQUAL(name.c_str(), "release_height")) return fields().GetFieldIndex("release_he");
  const int low = fields().GetFieldIndex("diameter_m"), high = fields().GetFieldIndex("diameter_1");
  if (low < 0 || high < 0) return -1;
  return EQUAL(name.c_str(), "diameter_min") ? low : EQUAL(name.c_str(), "diameter_max") ? high : -1;
}

std::vector<std::string> Layer::field_names() const {
  std::vector<std::string> names(fields().GetFieldCount());
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = fields().GetFieldDefn(static_cast<int>(i))->GetNameRef();
  return names;
}

bool Layer::names_are_utf8() const {
  return std::ranges::all_of(field_names(), is_utf8);
}

std::string Layer::label(const OGRFeature& feature) const {
  return faults_.label(feature.GetFID());
}

std::optional<double> Layer::number(const OGRFeature& feature, int index, const std::string& name, const Bounds& bounds,
                                    bool may_lack) const {
  if (index < 0 || feature.IsFieldSetAndNotNull(index) == 0) return std::nullopt;
  const OGRFieldType type = fields().GetFieldDefn(index)->GetType();
  const std::string unit = bounds.unit == "1" ? "" : " in " + std::string(bounds.unit);
  if (is_csv()) refuse_odd(odd_.commas, fields().GetFieldDefn(index)->GetNameRef(), unit);
  if (type == OFTString && *feature.GetFieldAsString(index) == '\0') return std::nullopt;
  const std::string where = label(feature) + ": field " + name + " = ";
  double value = feature.GetFieldAsDouble(index);
  if (type == OFTString) {
    const std::string text = feature.GetFieldAsString(index);
    const auto number = number_of_cell(text);
    if (!number && text.find_first_not_of(' ') == std::string::npos) return std::nullopt;
    if (!number) throw InputError(where + "'" + text + "': " + no_number_text(text, unit, !is_csv(), may_lack));
    value = *number;
  } else if (fields().GetFieldDefn(index)->GetSubType() == OFSTBoolean) {
    throw InputError(where + (value == 0.0 ? "no" : "yes") + " is of the type Boolean, must be a number field" + unit);
  } else if (type != OFTInteger && type != OFTInteger64 && type != OFTReal) {
    throw InputError(where + "'" + feature.GetFieldAsString(index) + "' is of the type " +
                     OGRFieldDefn::GetFieldTypeName(type) + ", must be a number field" + unit);
  }
  if (std::isnan(value)) return std::nullopt;
  if (const auto fault = fault_of(bounds, value))
    throw InputError(where + text_of(value) + ": " + *fault + (may_lack ? ", or NULL where it is not known" : ""));
  return value;
}

void Layer::refuse_odd(const std::map<std::string, CsvCell>& cells, const std::string& name,
                       const std::string& unit) const {
  const std::string column = lowercase(name);
  const auto found = cells.find(column);
  if (found == cells.end()) return;
  throw InputError(path_ + ":" + std::to_string(found->second.line) + ": " + column + " = '" + found->second.text +
                   "': " + no_number_text(found->second.text, unit, false));
}

bool Layer::holds_text(int field) const {
  return !is_csv() && fields().GetFieldDefn(field)->GetType() == OFTString;
}

std::string Layer::text(const OGRFeature& feature, int index) const {
  if (index < 0 || feature.IsFieldSetAndNotNull(index) == 0) return {};
  std::string text = trimmed(feature.GetFieldAsString(index));
  if (!is_utf8(text))
    throw InputError(label(feature) + ": field " + fields().GetFieldDefn(index)->GetNameRef() + " = '" + text + "' " +
                     kEncodingFault);
  return text;
}

std::string Layer::code(const OGRFeature& feature, int index) const {
  if (feature.IsFieldSetAndNotNull(index) == 0) return {};
  const OGRFieldType type = fields().GetFieldDefn(index)->GetType();
  if (type == OFTString || type == OFTInteger || type == OFTInteger64) return text(feature, index);
  throw InputError(label(feature) + ": field " + fields().GetFieldDefn(index)->GetNameRef() + " = " +
                   feature.GetFieldAsString(index) + " is of the type " + OGRFieldDefn::GetFieldTypeName(type) +
                   ", must be text or a whole number");
}

std::vector<std::string> Layer::warnings() const {
  std::vector<std::string> all = warnings_;
  if (mended_ > 5) all.push_back(path_ + ": " + std::to_string(mended_ - 5) + " more invalid polygons were mended");
  const Grid& grid = terrain_.heights.grid;
  for (std::string& line : transformer_->warnings(std::min(grid.cell_x, grid.cell_y))) all.push_back(std::move(line));
  return all;
}

Parts Layer::parts(const OGRFeature& feature) {
  Parts parts;
  const OGRGeometry* stored = feature.GetGeometryRef();
  if (stored == nullptr || stored->IsEmpty()) return parts;
  GdalMessages messages;
  const std::unique_ptr<OGRGeometry> geometry(stored->getLinearGeometry());
  if (!geometry) throw InputError(label(feature) + ": its geometry cannot be read: " + messages.take());
  geometry->flattenTo2D();
  geometry->closeRings();
  collect(*geometry, parts, label(feature));
  return parts;
}

Parts Layer::polygons(const OGRFeature& feature, const std::string& purpose) {
  Parts found = parts(feature);
  if (!found.lines.empty() || !found.points.empty())
    throw InputError(label(feature) + ": is no polygon, must be one" + purpose);
  return found;
}

void Layer::collect(OGRGeometry& geometry, Parts& parts, const std::string& where) {
  if (geometry.IsEmpty()) return;
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbPolygon || type == wkbTriangle) {
    OGRPolygon polygon(*geometry.toPolygon());
    for (OGRLinearRing* ring : polygon) move(*ring, where);
    add_valid(polygon, parts, where);
  } else if (type == wkbLineString) {
    OGRLineString line(*geometry.toLineString());
    move(line, where);
    parts.lines.push_back(std::move(line));
  } else if (type == wkbPoint) {
    OGRLineString one;
    one.addPoint(geometry.toPoint());
    move(one, where);
    parts.points.emplace_back(one.getX(0), one.getY(0));
  } else if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection) != 0) {
    for (OGRGeometry* part : *geometry.toGeometryCollection()) collect(*part, parts, where);
  } else if (type == wkbPolyhedralSurface || type == wkbTIN) {
    for (OGRPolygon* part : *geometry.toPolyhedralSurface()) collect(*part, parts, where);
  } else {
    throw InputError(where + ": geometry of the type " + OGRGeometryTypeToName(type) +
                     ", must be polygons, lines or points");
  }
}

void Layer::move(OGRSimpleCurve& line, const std::string& where) {
  if (north_first_) line.swapXY();
  const Grid& grid = terrain_.heights.grid;
  for (int i = 0; i < line.getNumPoints(); ++i) {
    double x = line.getX(i), y = line.getY(i);
    if (!std::isfinite(x) || !std::isfinite(y)) throw InputError(where + ": a coordinate is not a number");
    transformer_->apply(x, y, where);
    if (!is_place(x, y))
      throw InputError(where + ": its place (" + text_of(x) + ", " + text_of(y) +
                       ") is none on the earth, must be within " + text_of(kFarthestPlace) +
                       " m of the origin of the map: mend the coordinates of the feature");
    line.setPoint(i, x - grid.west, y - grid.south);
  }
}

std::string Layer::fault_on_map(const OGRPolygon& polygon) const {
  OGRPolygon on_map(polygon);
  const Grid& grid = terrain_.heights.grid;
  for (OGRLinearRing* ring : on_map)
    for (int i = 0; i < ring->getNumPoints(); ++i)
      ring->setPoint(i, ring->getX(i) + grid.west, ring->getY(i) + grid.south);
  GdalMessages messages;
  on_map.IsValid();  // says where
  return messages.take("invalid");
}

void Layer::add_valid(const OGRPolygon& polygon, Parts& parts, const std::string& where) {
  GdalMessages messages;
  if (!OGRGeometryFactory::haveGEOS() || polygon.IsValid() != 0) {
    parts.polygons.push_back(polygon);
    return;
  }
  const std::string reason = fault_on_map(polygon);
  CPLStringList method;  // the default, by lines, fills a hole that shares an edge with the outer ring
  method.SetNameValue("METHOD", "STRUCTURE");
  const std::unique_ptr<OGRGeometry> mended(polygon.MakeValid(method.List()));
  const std::size_t before = parts.polygons.size();
  double area = 0.0;
  const auto keep = [&](const auto& self, const OGRGeometry& geometry) -> void {
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (type == wkbPolygon && !geometry.IsEmpty()) {
      parts.polygons.push_back(*geometry.toPolygon());
      area += geometry.toPolygon()->get_Area();
    }
    if (OGR_GT_IsSubClassOf(type, wkbGeometryCollection) != 0)
      for (const OGRGeometry* part : *geometry.toGeometryCollection()) self(self, *part);
  };
  if (mended) keep(keep, *mended);
  if (parts.polygons.size() == before)
    throw InputError(where + ": polygon is invalid (" + reason +
                     ") and no area is left when it is mended: draw it anew, or delete it");
  if (++mended_ <= 5)
    warnings_.push_back(where + ": polygon was invalid (" + reason + ") and was mended: " + readable(area) +
                        " m2 are left, without its inner rings; is that what was drawn?");
}

CellMask mask_of(const OGRGeometry& geometry, const Grid& grid, CellRule rule) {
  OGREnvelope box;
  geometry.getEnvelope(&box);
  const auto clamped = [](double value, int low, int high) {
    return static_cast<int>(std::clamp(std::floor(value), double(low), double(high)));
  };
  const int west = clamped(box.MinX / grid.cell_x - 1.0, 0, grid.columns),
            east = clamped(box.MaxX / grid.cell_x + 2.0, 0, grid.columns);
  const int south = clamped(box.MinY / grid.cell_y - 1.0, 0, grid.rows),
            north = clamped(box.MaxY / grid.cell_y + 2.0, 0, grid.rows);
  CellMask mask{west, north - 1, east - west, north - south, {}};
  if (mask.columns <= 0 || mask.rows <= 0) return {};
  mask.marks.resize(static_cast<std::size_t>(mask.columns) * static_cast<std::size_t>(mask.rows));
  const Dataset window = memory_dataset(mask.columns, mask.rows, mask.marks.data());
  // GDAL counts cells whose centres lie on an edge to the west or east once, to the south and north twice: a little to
  // the north none lies on one.
  const double off_edges = rule == CellRule::Once ? 1e-6 * grid.cell_y : 0.0;
  std::array<double, 6> place{west * grid.cell_x, grid.cell_x, 0.0, north * grid.cell_y + off_edges, 0.0, -grid.cell_y};
  window->SetGeoTransform(place.data());
  GdalMessages messages;
  int band = 1;
  double burn = 1.0;
  auto handle = OGRGeometry::ToHandle(const_cast<OGRGeometry*>(&geometry));
  const char* const options[] = {"ALL_TOUCHED=TRUE", nullptr};
  if (GDALRasterizeGeometries(window.get(), 1, &band, 1, &handle, nullptr, nullptr, &burn,
                              rule == CellRule::Touched ? const_cast<char**>(options) : nullptr, nullptr,
                              nullptr) != CE_None)
    throw std::runtime_error("rasterizing failed: " + messages.take());
  window->FlushCache(false);
  return mask;
}

std::string fields_note(const std::string& path, const std::vector<FieldUse>& fields, std::size_t features,
                        const std::vector<std::string>& there) {
  if (fields.empty()) return path + ": no field is read" + (there.empty() ? "" : "; there are " + joined(there));
  std::vector<std::string> words, others;
  for (const FieldUse& use : fields) words.push_back(use.text(features));
  for (const std::string& field : there)
    if (std::ranges::find(fields, field, &FieldUse::field) == fields.end()) others.push_back(field);
  return path + ": fields read: " + joined(words) + (others.empty() ? "" : "; others: " + joined(others));
}

}  // namespace talus::io
