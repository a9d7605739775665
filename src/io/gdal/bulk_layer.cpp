#include "bulk_layer.hpp"

#include <sqlite3.h>

#include <bit>
#include <cstring>
#include <stdexcept>

#include "talus/base/text.hpp"

namespace talus::io {
namespace {

/// GDAL's connection to the file.
sqlite3* connection_of(GDALDataset& file) {
  void* const handle = file.GetInternalHandle("SQLITE_HANDLE");
  if (handle == nullptr) throw std::runtime_error("this GDAL does not give its connection to SQLite");
  return static_cast<sqlite3*>(handle);
}

/// The first column of all rows of a query.
std::vector<std::string> texts_of(sqlite3* database, const std::string& sql) {
  std::vector<std::string> texts;
  const auto keep = [](void* list, int, char** values, char**) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(values[0]);
    return 0;
  };
  if (sqlite3_exec(database, sql.c_str(), keep, &texts, nullptr) != SQLITE_OK)
    throw std::runtime_error(sqlite3_errmsg(database));
  return texts;
}

std::vector<const OGRFieldDefn*> fields_of(OGRLayer& layer) {
  std::vector<const OGRFieldDefn*> fields;
  for (int i = 0; i < layer.GetLayerDefn()->GetFieldCount(); ++i)
    fields.push_back(layer.GetLayerDefn()->GetFieldDefn(i));
  return fields;
}

/// "INSERT INTO "stops" ("geom", "source")".
std::string into(OGRLayer& layer) {
  std::string sql = std::string("INSERT INTO \"") + layer.GetName() + "\" (\"geom\"";
  for (const OGRFieldDefn* field : fields_of(layer)) sql += std::string(", \"") + field->GetNameRef() + "\"";
  return sql + ")";
}

}  // namespace

BulkLayer::BulkLayer(GDALDataset& file, OGRLayer& layer)
    : database_(connection_of(file)),
      layer_(&layer),
      name_(layer.GetName()),
      rows_(database_, into(layer), 1 + layer.GetLayerDefn()->GetFieldCount()),
      index_(database_, "rtree_" + name_ + "_geom") {
  for (const OGRFieldDefn* field : fields_of(layer)) types_.push_back(field->GetType());
  system_ = std::stoi(
      texts_of(database_, "SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = '" + name_ + "'").at(0));
  // The triggers would insert the boxes one by one.
  const std::string of_layer =
      " FROM sqlite_master WHERE type = 'trigger' AND tbl_name = '" + name_ + "' ORDER BY name";
  triggers_ = texts_of(database_, "SELECT sql" + of_layer);
  for (const std::string& trigger : texts_of(database_, "SELECT name" + of_layer))
    execute("DROP TRIGGER \"" + trigger + "\"");
}

void BulkLayer::append(OGRFeature& feature) {
  ++id_;
  add_geometry(feature.GetGeometryRef());
  for (std::size_t i = 0; i < types_.size(); ++i) {
    const OGRField& field = *feature.GetRawFieldRef(static_cast<int>(i));
    if (OGR_RawField_IsUnset(&field) != 0 || OGR_RawField_IsNull(&field) != 0)
      rows_.add_null();
    else if (types_[i] == OFTInteger64)
      rows_.add(std::int64_t{field.Integer64});
    else if (types_[i] == OFTReal)
      rows_.add(field.Real);
    else
      rows_.add(field.String);
  }
  rows_.insert();
}

void BulkLayer::add_geometry(const OGRGeometry* geometry) {
  OGREnvelope3D box;
  geometry->getEnvelope(&box);
  constexpr std::size_t kHead = 8;
  const bool point = wkbFlatten(geometry->getGeometryType()) == wkbPoint, solid = geometry->Is3D() != 0;
  const std::size_t numbers = point ? 0 : solid ? 6 : 4, head = kHead + numbers * sizeof(double);
  bytes_.resize(head + geometry->WkbSize());
  constexpr int kByteOrder = std::endian::native == std::endian::little ? 1 : 0, kPlane = 2, kSolid = 4;
  const auto flags = static_cast<unsigned char>(kByteOrder | (point ? 0 : solid ? kSolid : kPlane));
  const std::array<unsigned char, 4> start{'G', 'P', 0, flags};
  std::memcpy(bytes_.data(), start.data(), start.size());
  std::memcpy(bytes_.data() + start.size(), &system_, sizeof(system_));
  const std::array<double, 6> envelope{box.MinX, box.MaxX, box.MinY, box.MaxY, box.MinZ, box.MaxZ};
  std::memcpy(bytes_.data() + kHead, envelope.data(), numbers * sizeof(double));
  if (geometry->exportToWkb(wkbNDR, bytes_.data() + head, wkbVariantIso) != OGRERR_NONE)
    throw std::runtime_error("a geometry has no well-known binary form");
  rows_.add_bytes(bytes_.data(), bytes_.size());
  index_.add(id_, {box.MinX, box.MaxX, box.MinY, box.MaxY});
  extent_.Merge(box);
}

void BulkLayer::finish() {
  index_.finish();
  for (const std::string& trigger : triggers_) execute(trigger);
  if (id_ == 0) return;
  execute("UPDATE gpkg_contents SET min_x = " + text_of(extent_.MinX) + ", min_y = " + text_of(extent_.MinY) +
          ", max_x = " + text_of(extent_.MaxX) + ", max_y = " + text_of(extent_.MaxY) + " WHERE table_name = '" +
          name_ + "'");
}

void BulkLayer::execute(const std::string& sql) const {
  texts_of(database_, sql);
}

}  // namespace talus::io
