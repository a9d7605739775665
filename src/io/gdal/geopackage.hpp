#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bulk_layer.hpp"
#include "dataset.hpp"
#include "talus/io/origin/origin.hpp"

namespace talus::io {

/// A GeoPackage that is being written, in one transaction. Its rows and all its bytes are the same for the same input:
/// the dates that the format asks for are those of 1970.
class GeoPackage {
 public:
  struct Column {
    const char* name;
    OGRFieldType type;
  };

  GeoPackage(std::filesystem::path file, const GeoReference& geo);

  /// A new layer, which gets its spatial index from `finish`. For a few rows, of fields of any type.
  OGRLayer* add_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns);

  /// A new layer of which there may be millions of rows: `BulkLayer` inserts them and packs the spatial index. All its
  /// features must go through `append`. Fields are of the types OFTInteger64, OFTReal and OFTString.
  OGRLayer* add_bulk_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns);

  /// Appends a row, which gets the next number as its fid. The feature may be used again.
  void append(OGRLayer* layer, OGRFeature& feature);

  /// Sets the style that QGIS gives a layer when it opens the file.
  void set_style(const std::string& layer, const std::string& style) { styles_.emplace_back(layer, style); }

  /// Writes the styles, builds the spatial indices and closes the file.
  void finish();

 private:
  OGRLayer* create_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns);
  std::vector<std::string> execute(const std::string& sql);
  void write_styles();
  void create_index(const std::string& layer);
  void finish_bulk();
  [[noreturn]] void fail(const std::string& cause) const;
  void require(bool good, GdalMessages& messages) const;

  std::filesystem::path file_;
  OGRSpatialReference system_;
  std::vector<std::string> layers_;                          // still without an index
  std::vector<std::pair<std::string, std::string>> styles_;  // by layer
  Dataset dataset_;
  std::vector<std::unique_ptr<BulkLayer>> bulk_;  // closed before the file
};

}  // namespace talus::io
