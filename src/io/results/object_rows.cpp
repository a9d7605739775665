#include "object_rows.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "io/gdal/dataset.hpp"
#include "talus/base/text.hpp"
#include "talus/products/hazard.hpp"
#include "talus/terrain/no_height.hpp"

namespace talus::io {
namespace {

bool is_upper_bound(const std::string& column) {
  return column.ends_with("_upper");
}

/// The value of an attribute as text; that of a list in JSON; empty if there is none.
std::string attribute_text(const OGRFeature& feature, int field) {
  if (feature.IsFieldSetAndNotNull(field) == 0) return "";
  const std::unique_ptr<char, void (*)(void*)> list(feature.GetFieldAsSerializedJSon(field), VSIFree);
  return list ? list.get() : feature.GetFieldAsString(field);
}

/// The type of the column of an attribute. GeoPackages have no lists: these become text.
OGRFieldType column_type(OGRFieldType type) {
  const bool is_list =
      type == OFTStringList || type == OFTRealList || type == OFTIntegerList || type == OFTInteger64List;
  return is_list ? OFTString : type;
}

void copy_attribute(const OGRFeature& from, int field, OGRFeature& to, int column) {
  if (to.GetFieldDefnRef(column)->GetType() == OFTString)
    to.SetField(column, attribute_text(from, field).c_str());
  else
    to.SetField(column, from.GetRawFieldRef(field));
}

std::string head_of_table(const ObjectRow& object, const std::vector<int>& attributes) {
  std::string text = "object";
  for (const int i : attributes) text += ',' + csv_field(std::string(object.from.GetFieldDefnRef(i)->GetNameRef()));
  for (const auto& [name, value] : object.figures) text += ',' + name;
  if (object.with_rotation) text += std::string(",") + kEnergiesColumn;
  return text + ",sources\n";
}

/// Point i of a curve, with the bounds of objects.csv where that has it: at all hits, and at a threshold.
Bounded curve_point(const HazardCurve& curve, const EnergyBins& bins, std::size_t i) {
  if (i == 0) return curve.passage();
  const auto threshold = bins.threshold_at(bins.edge(curve.first() + static_cast<int>(i)));
  return threshold ? curve.exceedance(*threshold) : curve.at(i);
}

/// The number of the class of hazard by a curve, with those by the bounds.
Bounded class_by(const HazardCurve& curve, const HazardMatrix& matrix) {
  std::vector<Bounded> frequencies{curve.passage()};
  for (const double energy : matrix.energies) frequencies.push_back(curve.exceedance_of(energy));
  const BoundedClass found = class_of(matrix, frequencies);
  return {static_cast<double>(found.value), static_cast<double>(found.low), static_cast<double>(found.high)};
}

}  // namespace

Figures figures_of(const HazardRules& rules, const ObjectHits& hits, double without_height,
                   const HazardMatrix& matrix) {
  const HazardCurve curve(rules, hits.largest), entry(rules, hits.entry);
  const std::vector<double>& thresholds = rules.bins.thresholds();
  Figures figures{{"trajectories", static_cast<double>(hits.trajectories)}};
  const auto add = [&figures](const std::string& name, const Bounded& b) {
    figures.emplace_back(name, b.value);
    figures.emplace_back(name + "_lower", b.low);
    figures.emplace_back(name + "_upper", b.high);
  };
  add("frequency", curve.passage());
  figures.emplace_back("return_period", return_period(curve.passage()).value);
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    add("frequency_" + text_of(thresholds[i]), curve.exceedance(i));
    figures.emplace_back("return_period_" + text_of(thresholds[i]), return_period(curve.exceedance(i)).value);
    add("entry_" + text_of(thresholds[i]), entry.exceedance(i));
  }
  for (const double t : matrix.years) add("energy_T" + text_of(t), curve.energy_once_in(t));
  add("hazard_class", class_by(curve, matrix));
  add("entry_class", class_by(entry, matrix));
  for (auto& [name, value] : figures)
    if (is_all_without_height(without_height) || (is_partly_without_height(without_height) && is_upper_bound(name)))
      value = kNotGiven;
  figures.emplace_back("share_without_height", without_height);
  return figures;
}

std::vector<int> copied_attributes(OGRFeature& model, const Figures& figures, bool with_rotation) {
  std::vector<std::string> own{"object", "sources", "fid", "geom"};
  if (with_rotation) own.emplace_back(kEnergiesColumn);
  for (const auto& [name, value] : figures) own.push_back(name);
  std::vector<int> copied;
  for (int i = 0; i < model.GetFieldCount(); ++i) {
    const char* name = model.GetFieldDefnRef(i)->GetNameRef();
    if (std::ranges::none_of(own, [&](const std::string& one) { return EQUAL(one.c_str(), name); }))
      copied.push_back(i);
  }
  return copied;
}

ObjectsWriter::ObjectsWriter(const std::filesystem::path& file, const LoadedScenario& loaded, OGRFeature& model,
                             const Figures& figures)
    : file_(file, loaded.geo), attributes_(copied_attributes(model, figures, loaded.scenario.output.count_rotation)) {
  std::vector<GeoPackage::Column> columns{{"object", OFTString}};
  for (const int i : attributes_)
    columns.push_back({model.GetFieldDefnRef(i)->GetNameRef(), column_type(model.GetFieldDefnRef(i)->GetType())});
  for (const auto& [name, value] : figures) columns.push_back({name.c_str(), OFTReal});
  if (loaded.scenario.output.count_rotation) columns.push_back({kEnergiesColumn, OFTString});
  columns.push_back({"sources", OFTString});
  layer_ = file_.add_layer("objects", wkbUnknown, columns);
}

void ObjectsWriter::write(const ObjectRow& object, const OGRGeometry& geometry) {
  const GdalMessages messages;
  const Feature row(OGRFeature::CreateFeature(layer_->GetLayerDefn()));
  row->SetField(0, object.name.c_str());
  int next = 1;
  for (const int i : attributes_) {
    if (object.from.IsFieldSetAndNotNull(i) != 0) copy_attribute(object.from, i, *row, next);
    ++next;
  }
  for (const auto& [name, value] : object.figures) {
    if (std::isfinite(value)) row->SetField(next, value);
    ++next;
  }
  if (object.with_rotation) row->SetField(next++, kEnergiesWithRotation);
  row->SetField(next, object.sources.c_str());
  row->SetGeometry(&geometry);
  file_.append(layer_, *row);
}

void ObjectsWriter::finish(StyledLayer style) {
  file_.set_style("objects", style_of(style));
  file_.finish();
}

void ObjectsTable::add(const ObjectRow& object) {
  const std::vector<int> attributes = copied_attributes(object.from, object.figures, object.with_rotation);
  if (text_.empty()) text_ = head_of_table(object, attributes);
  text_ += csv_field(object.name);
  for (const int i : attributes) text_ += ',' + csv_field(attribute_text(object.from, i));
  for (const auto& [name, value] : object.figures) text_ += ',' + csv_field(value);
  if (object.with_rotation) text_ += std::string(",") + kEnergiesWithRotation;
  text_ += ',' + csv_field(object.sources) + '\n';
}

std::string curve_rows(const std::string& object, const HazardCurve& curve, const EnergyBins& bins, bool bounded) {
  std::string rows;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const int bin = curve.first() + static_cast<int>(i);
    const double energy = bins.edge(bin);
    // Each energy has one row: two bins begin with it where a threshold is an edge. The first row is of all hits.
    if (i > 0 && (energy == bins.edge(curve.first()) || (i + 1 < curve.size() && energy == bins.edge(bin + 1))))
      continue;
    const Bounded f = curve_point(curve, bins, i);
    rows += object + ',' + csv_field(energy);
    for (const double value : {f.value, f.low, bounded ? f.high : kNotGiven, 1.0 / f.value})
      rows += ',' + csv_field(value);
    rows += '\n';
  }
  return rows;
}

}  // namespace talus::io
