#include "layer_file.hpp"

#include <stdexcept>

#include "cause_of_failure.hpp"
#include "flat_geobuf.hpp"
#include "geopackage.hpp"
#include "talus/base/hidden_name.hpp"

namespace talus::io {

void LayerFile::fail(const std::string& cause) const {
  const std::string written = file_.filename().string(), name = final_name(written);
  std::string text = name + ": cannot be written: " + cause_of_failure(file_.parent_path(), cause);
  for (std::size_t at = 0; (at = text.find(written, at)) != std::string::npos; at += name.size())
    text.replace(at, written.size(), name);  // GDAL names the hidden file
  throw std::runtime_error(text);
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
