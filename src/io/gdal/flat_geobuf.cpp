#include "flat_geobuf.hpp"

#include "talus/base/error.hpp"

namespace talus::io {

FlatGeobuf::FlatGeobuf(const std::filesystem::path& file, const GeoReference& geo)
    : LayerFile(file), system_(system_of(geo)) {
  GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("FlatGeobuf");
  if (driver == nullptr) fail("this GDAL has no driver FlatGeobuf");
  dataset_.reset(driver->Create(path().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  require(dataset_ != nullptr, messages);
}

OGRLayer* FlatGeobuf::add_bulk_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns) {
  GdalMessages messages;
  CPLStringList options;
  options.SetNameValue("TEMPORARY_DIR", path().parent_path().c_str());
  OGRLayer* layer = dataset_->CreateLayer(name, system_.IsEmpty() ? nullptr : &system_, type, options.List());
  require(layer != nullptr, messages);
  for (const Column& column : columns) {
    OGRFieldDefn field(column.name, column.type);
    require(layer->CreateField(&field) == OGRERR_NONE, messages);
  }
  return layer;
}

void FlatGeobuf::append(OGRLayer* layer, OGRFeature& feature) {
  feature.SetFID(OGRNullFID);
  if (layer->CreateFeature(&feature) != OGRERR_NONE) fail(CPLGetLastErrorMsg());
  ++rows_;
}

void FlatGeobuf::finish() {
  GdalMessages messages;
  dataset_.reset();
  require(true, messages);
  require(rows_ == 0 || has_last_row(), messages);
}

/// GDAL does not say whether the last bytes have reached the disk.
bool FlatGeobuf::has_last_row() const {
  try {
    return Feature(open_dataset(path().string(), GDAL_OF_VECTOR)->GetLayer(0)->GetFeature(rows_ - 1)) != nullptr;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace talus::io
