#pragma once
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace talus::io {

/// Registers the drivers of GDAL that Talus uses once, bounds its block cache to 32 MB (unless the environment sets
/// GDAL_CACHEMAX), and keeps its messages off the screen. Every function of `io` that uses GDAL calls it first.
void start_gdal();

/// Collects the messages of GDAL in this thread while the object lives, and those of GDAL's own threads.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  /// Returns all messages in one line, joined by "; ", and clears them; `otherwise` if there was none.
  std::string take(const std::string& otherwise = "GDAL gives no reason");

  /// Whether an error (not a mere warning) is among them.
  bool failed() const;

 private:
  std::vector<std::string> errors_, warnings_;
};

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

struct CloseVsiFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using VsiFile = std::unique_ptr<VSILFILE, CloseVsiFile>;

struct DropFeature {
  void operator()(OGRFeature* feature) const { OGRFeature::DestroyFeature(feature); }
};
using Feature = std::unique_ptr<OGRFeature, DropFeature>;

/// Opens an input for reading, the only place that does. `kinds`: GDAL_OF_RASTER, GDAL_OF_VECTOR or both.
/// Throws InputError if the input is not allowed (docs/security.md), if GDAL cannot open it, or would lose rows or
/// fields without a message (`check_vector_file`).
Dataset open_dataset(const std::string& path, unsigned kinds);

/// The files that GDAL reads with a raster, as it lists them itself: header (.hdr), world file, mask (.msk), .prj. None
/// if the input is no raster, is a VRT (`files_of_vrt`), or is not allowed. Reads no pixels.
std::vector<std::string> files_of_raster(const std::string& path);

/// A dataset in memory, of zeros. Throws std::runtime_error if there is no memory for it.
Dataset memory_dataset(int columns, int rows, GDALDataType type);

/// A dataset in memory over the bytes of the caller (rows x columns), which must outlive it. Throws as the other one.
Dataset memory_dataset(int columns, int rows, std::uint8_t* bytes);

/// Coordinates on a map of the earth are below this [m]; with the number of a zone before them they have up to 8
/// digits.
inline constexpr double kFarthestPlace = 1e9;

/// Whether these can be coordinates on a map of the earth: numbers, and not too large.
bool is_place(double x, double y);

/// The command that corrects the metadata of a raster: "gdal_edit.py -a_nodata 0 dem.tif"; for formats that cannot be
/// edited, gdal_translate to a copy.
std::string edit_command(const std::string& path, const std::string& option);

/// Coordinate system as WKT; empty if there is none.
std::string wkt_of(const OGRSpatialReference* system);

/// A projected system with three axes (ellipsoidal heights) without the third; any other as it is. Layers in a
/// GeoPackage or FlatGeobuf cannot have such a system.
std::string without_heights(const std::string& wkt);

}  // namespace talus::io
