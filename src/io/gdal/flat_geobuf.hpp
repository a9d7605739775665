#pragma once
#include "layer_file.hpp"

namespace talus::io {

/// A FlatGeobuf file of one layer, which is being written by GDAL. GDAL appends the rows to a file beside it, and
/// copies them from there when the file is finished: in the order of its spatial index, which takes 160 bytes of memory
/// a row (docs/performance.md).
class FlatGeobuf final : public LayerFile {
 public:
  FlatGeobuf(const std::filesystem::path& file, const GeoReference& geo);

  OGRLayer* add_bulk_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns) override;
  void append(OGRLayer* layer, OGRFeature& feature) override;
  void set_style(const std::string&, const std::string&) override {}
  void finish() override;

 private:
  bool has_last_row() const;

  OGRSpatialReference system_;
  GIntBig rows_ = 0;
  Dataset dataset_;
};

}  // namespace talus::io
