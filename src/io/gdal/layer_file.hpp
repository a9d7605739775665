#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dataset.hpp"
#include "talus/io/origin/origin.hpp"

namespace talus::io {

/// A file of layers that is being written. Its bytes are the same for the same input. All functions throw
/// std::runtime_error, one line with the file and the cause.
class LayerFile {
 public:
  struct Column {
    const char* name;
    OGRFieldType type;
  };

  explicit LayerFile(std::filesystem::path file) : file_(std::move(file)) {}
  virtual ~LayerFile() = default;
  LayerFile(const LayerFile&) = delete;
  LayerFile& operator=(const LayerFile&) = delete;

  /// A new layer with a spatial index, of which there may be millions of rows. All its features must go through
  /// `append` and have a geometry. Fields are of the types OFTInteger64, OFTReal and OFTString.
  virtual OGRLayer* add_bulk_layer(const char* name, OGRwkbGeometryType type, const std::vector<Column>& columns) = 0;

  /// Appends a row, which gets the next number as its fid. The feature may be used again.
  virtual void append(OGRLayer* layer, OGRFeature& feature) = 0;

  /// Sets the style that QGIS gives a layer when it opens the file. A format without room for it leaves it out.
  virtual void set_style(const std::string& layer, const std::string& style) = 0;

  /// Writes what is left and closes the file; without it the file is worthless.
  virtual void finish() = 0;

 protected:
  [[noreturn]] void fail(const std::string& cause) const;
  void require(bool good, GdalMessages& messages) const;
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
};

/// A new file in the format of its ending: ".gpkg" or ".fgb".
std::unique_ptr<LayerFile> new_layer_file(const std::filesystem::path& file, const GeoReference& geo);

/// The coordinate system, east or longitude first; empty if there is none.
OGRSpatialReference system_of(const GeoReference& geo);

}  // namespace talus::io
