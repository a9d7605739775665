#pragma once
#include <memory>
#include <string>
#include <vector>

#include "bulk_layer.hpp"
#include "layer_file.hpp"

namespace talus::io {

inline constexpr char kStylesTable[] = "layer_styles";  ///< where QGIS keeps the styles of layers

/// A GeoPackage that is being written, in one transaction. The dates that the format asks for are those of 1970. Rows
/// of bulk layers are inserted by `BulkLayer`.
class GeoPackage final : public LayerFile {
 public:
  GeoPackage(const std::filesystem::path& file, const GeoReference& geo);

  /// A new layer, which gets its spatial index from `finish`. For a few rows, of fields of any type.
  OGRLayer* add_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns);

  OGRLayer* add_bulk_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns) override;
  void append(OGRLayer* layer, OGRFeature& feature) override;
  void set_style(const std::string& layer, const std::string& style) override { styles_.emplace_back(layer, style); }
  void finish() override;

 private:
  OGRLayer* create_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns);
  std::vector<std::string> execute(const std::string& sql);
  void write_styles();
  void create_index(const std::string& layer);
  template <class Work>
  void with_name(Work work) const;

  OGRSpatialReference system_;
  std::vector<std::string> layers_;                          // still without an index
  std::vector<std::pair<std::string, std::string>> styles_;  // by layer
  Dataset dataset_;
  std::vector<std::unique_ptr<BulkLayer>> bulk_;  // closed before the file
};

}  // namespace talus::io
