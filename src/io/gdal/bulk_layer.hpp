#pragma once
#include <string>
#include <vector>

#include "dataset.hpp"
#include "packed_index.hpp"
#include "sqlite_rows.hpp"

namespace talus::io {

/// Many rows of a new layer of a GeoPackage, at least twice as fast as by GDAL 3.6: one prepared statement on the
/// connection that GDAL has open, while the triggers of the spatial index are away; `PackedIndex` makes the index.
/// Tables, coordinate system and triggers are GDAL's own, and the rows are as GDAL writes them.
///
/// Geometry: the binary format of GeoPackage 1.3, section 2.1.3; with an envelope where it is no point.
class BulkLayer {
 public:
  /// @param file   a GeoPackage within a transaction
  /// @param layer  empty, with all its fields (OFTInteger64, OFTReal, OFTString) and an empty spatial index
  /// All throw std::runtime_error with the message of SQLite.
  BulkLayer(GDALDataset& file, OGRLayer& layer);

  bool is(const OGRLayer* layer) const { return layer == layer_; }
  /// The next row, which has a geometry; fids count from 1.
  void append(OGRFeature& feature);
  /// Writes the index and the extent, and sets the triggers again.
  void finish();

 private:
  void add_geometry(const OGRGeometry* geometry);
  void execute(const std::string& sql) const;

  sqlite3* database_;
  OGRLayer* layer_;
  std::string name_;
  std::vector<OGRFieldType> types_;    // of the fields
  std::vector<std::string> triggers_;  // to be set again
  int system_ = 0;                     // srs_id
  std::int64_t id_ = 0;                // of the last row
  OGREnvelope extent_;
  std::vector<unsigned char> bytes_;  // of a geometry
  SqliteRows rows_;
  PackedIndex index_;
};

}  // namespace talus::io
