#include "geopackage.hpp"

#include <algorithm>
#include <stdexcept>

namespace talus::io {
namespace {

/// Sets an option of GDAL while the object lives, and restores the earlier value.
class Configured {
 public:
  Configured(const char* key, const char* value) : key_(key) {
    const char* old = CPLGetThreadLocalConfigOption(key, nullptr);
    had_ = old != nullptr;
    if (had_) old_ = old;
    CPLSetThreadLocalConfigOption(key, value);
  }
  ~Configured() { CPLSetThreadLocalConfigOption(key_, had_ ? old_.c_str() : nullptr); }
  Configured(const Configured&) = delete;
  Configured& operator=(const Configured&) = delete;

 private:
  const char* key_;
  std::string old_;
  bool had_ = false;
};

/// A text in a command of SQL.
std::string in_sql(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + '\'';
}

constexpr const char* kDate = "1970-01-01T00:00:00.000Z";

}  // namespace

GeoPackage::GeoPackage(const std::filesystem::path& file, const GeoReference& geo)
    : LayerFile(file), system_(system_of(geo)) {
  GdalMessages messages;
  // The file has its final name only when it is complete: nothing has to survive a crash, no journal is needed.
  const Configured date("OGR_CURRENT_DATE", kDate), journal("OGR_SQLITE_JOURNAL", "OFF"),
      synchronous("OGR_SQLITE_SYNCHRONOUS", "OFF");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  if (driver == nullptr) fail("this GDAL has no driver GPKG");
  const char* const options[] = {"ADD_GPKG_OGR_CONTENTS=NO", nullptr};
  dataset_.reset(driver->Create(path().c_str(), 0, 0, 0, GDT_Unknown, options));
  require(dataset_ != nullptr, messages);
  require(dataset_->StartTransaction() == OGRERR_NONE, messages);
}

OGRLayer* GeoPackage::create_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns) {
  GdalMessages messages;
  const Configured date("OGR_CURRENT_DATE", kDate);
  CPLStringList options;
  options.SetNameValue("SPATIAL_INDEX", "NO");
  OGRLayer* layer = dataset_->CreateLayer(name, system_.IsEmpty() ? nullptr : &system_, type, options.List());
  require(layer != nullptr, messages);
  for (const Column& column : columns) {
    OGRFieldDefn field(column.name, column.type);
    require(layer->CreateField(&field) == OGRERR_NONE, messages);
  }
  return layer;
}

OGRLayer* GeoPackage::add_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns) {
  layers_.emplace_back(name);
  return create_layer(name, type, columns);
}

/// Adds the name of the file to the errors of bulk layers.
template <class Work>
void GeoPackage::with_name(Work work) const {
  try {
    work();
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
}

OGRLayer* GeoPackage::add_bulk_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns) {
  const Configured date("OGR_CURRENT_DATE", kDate);  // the lines below write the dates of earlier layers
  OGRLayer* layer = create_layer(name, type, columns);
  create_index(name);
  with_name([&] { bulk_.push_back(std::make_unique<BulkLayer>(*dataset_, *layer)); });
  return layer;
}

void GeoPackage::append(OGRLayer* layer, OGRFeature& feature) {
  const auto bulk = std::ranges::find_if(bulk_, [&](const auto& one) { return one->is(layer); });
  if (bulk == bulk_.end()) {
    feature.SetFID(OGRNullFID);
    if (layer->CreateFeature(&feature) != OGRERR_NONE) fail(CPLGetLastErrorMsg());
    return;
  }
  with_name([&] { (*bulk)->append(feature); });
}

void GeoPackage::finish() {
  GdalMessages messages;
  const Configured date("OGR_CURRENT_DATE", kDate);
  with_name([&] {
    for (const auto& bulk : bulk_) bulk->finish();
  });
  bulk_.clear();
  for (const std::string& layer : layers_) create_index(layer);
  write_styles();
  require(dataset_->CommitTransaction() == OGRERR_NONE, messages);
  dataset_.reset();
  require(true, messages);
}

std::vector<std::string> GeoPackage::execute(const std::string& sql) {
  GdalMessages messages;
  std::vector<std::string> rows;
  if (OGRLayer* result = dataset_->ExecuteSQL(sql.c_str(), nullptr, nullptr)) {
    while (const Feature row{result->GetNextFeature()}) rows.emplace_back(row->GetFieldAsString(0));
    dataset_->ReleaseResultSet(result);
  }
  require(true, messages);
  return rows;
}

/// The table `layer_styles`, as QGIS makes it.
void GeoPackage::write_styles() {
  if (styles_.empty()) return;
  execute(
      "CREATE TABLE layer_styles (id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, f_table_catalog TEXT(256), "
      "f_table_schema TEXT(256), f_table_name TEXT(256), f_geometry_column TEXT(256), styleName TEXT(30), styleQML "
      "TEXT, styleSLD TEXT, useAsDefault BOOLEAN, description TEXT, owner TEXT(30), ui TEXT(30), update_time "
      "DATETIME)");
  const std::string date = std::string("'") + kDate + "'";
  execute(
      "INSERT INTO gpkg_contents (table_name, data_type, identifier, description, last_change) VALUES "
      "('layer_styles', 'attributes', 'layer_styles', '', " +
      date + ")");
  for (const auto& [layer, style] : styles_)
    execute(
        "INSERT INTO layer_styles (f_table_catalog, f_table_schema, f_table_name, f_geometry_column, styleName, "
        "styleQML, styleSLD, useAsDefault, description, owner, ui, update_time) VALUES ('', '', " +
        in_sql(layer) + ", 'geom', 'talus', " + in_sql(style) + ", '', 1, '', '', NULL, " + date + ")");
}

void GeoPackage::create_index(const std::string& layer) {
  if (execute("SELECT CreateSpatialIndex('" + layer + "', 'geom')") != std::vector<std::string>{"1"})
    fail("the spatial index of " + layer + " cannot be made");
}

}  // namespace talus::io
