#include "layer_file.hpp"

#include <stdexcept>

#include "cause_of_failure.hpp"
#include "flat_geobuf.hpp"
#include "geopackage.hpp"

namespace talus::io {

void LayerFile::fail(const std::string& cause) const {
  throw std::runtime_error(file_.filename().string() +
                           ": cannot be written: " + cause_of_failure(file_.parent_path(), cause));
}

void LayerFile::require(bool good, GdalMessages& messages) const {
  if (!good || messages.failed()) fail(messages.take());
}

std::unique_ptr<LayerFile> new_layer_file(const std::filesystem::path& file, const GeoReference& geo) {
  if (file.extension() == ".fgb") return std::make_unique<FlatGeobuf>(file, geo);
  return std::make_unique<GeoPackage>(file, geo);
}

OGRSpatialReference system_of(const GeoReference& geo) {
  OGRSpatialReference system;
  if (!geo.crs_wkt.empty()) system.importFromWkt(geo.crs_wkt.c_str());
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

}  // namespace talus::io
