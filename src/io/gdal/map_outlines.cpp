#include "map_outlines.hpp"

#include "dataset.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
namespace {

void add_line(const OGRSimpleCurve& line, bool closed, const std::string& name, Outlines& out) {
  Outline outline{name, {}, closed};
  for (int i = 0; i < line.getNumPoints(); ++i)
    if (is_place(line.getX(i), line.getY(i))) outline.places.emplace_back(line.getX(i), line.getY(i));
  if (!outline.places.empty()) out.list.push_back(std::move(outline));
}

void add(const OGRGeometry& geometry, const std::string& name, int depth, Outlines& out) {
  constexpr int kDeepest = 8;
  if (depth > kDeepest) return;
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbPoint: {
      const OGRPoint& point = *geometry.toPoint();
      if (is_place(point.getX(), point.getY())) out.list.push_back({name, {{point.getX(), point.getY()}}, false});
      return;
    }
    case wkbLineString:
      return add_line(*geometry.toLineString(), false, name, out);
    case wkbPolygon:
      for (const OGRLinearRing* ring : *geometry.toPolygon()) add_line(*ring, true, name, out);
      return;
    case wkbMultiPoint:
    case wkbMultiLineString:
    case wkbMultiPolygon:
    case wkbGeometryCollection:
      for (const OGRGeometry* part : *geometry.toGeometryCollection()) add(*part, name, depth + 1, out);
      return;
    default:
      return;
  }
}

}  // namespace

Outlines read_outlines(const std::string& path, const char* layer_name, std::initializer_list<const char*> fields,
                       std::size_t most) {
  const Dataset dataset = open_dataset(path, GDAL_OF_VECTOR);
  const GdalMessages messages;
  OGRLayer* const layer = dataset->GetLayerByName(layer_name);
  if (layer == nullptr) throw InputError(path + ": has no layer " + layer_name + ", must be as talus has written it");
  int index = -1;
  for (const char* const field : fields)
    if (index < 0) index = layer->GetLayerDefn()->GetFieldIndex(field);
  Outlines out;
  std::size_t places = 0;
  for (;;) {
    const Feature feature(layer->GetNextFeature());
    if (!feature) return out;
    const std::string name = index >= 0 && feature->IsFieldSetAndNotNull(index) != 0
                                 ? feature->GetFieldAsString(index)
                                 : std::to_string(feature->GetFID());
    const std::size_t before = out.list.size();
    if (const OGRGeometry* geometry = feature->GetGeometryRef()) add(*geometry, name, 0, out);
    for (std::size_t i = before; i < out.list.size(); ++i) places += out.list[i].places.size();
    if (places <= most) continue;
    out.list.resize(before);
    out.cut = true;
    return out;
  }
}

}  // namespace talus::io
