#include "dataset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "complete_file.hpp"
#include "input_name.hpp"
#include "local_gdal.hpp"
#include "talus/base/error.hpp"
#include "talus/base/shell.hpp"
#include "talus/io/gdal/layer_name.hpp"
#include "vector_file.hpp"

namespace talus::io {

namespace {

// A pushed handler works for one thread only. Messages of GDAL's own threads go to the global handler.
std::mutex thread_mutex;
std::vector<std::string> thread_errors;

std::string one_line(const char* message) {
  std::string line(message);
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

void collect_of_threads(CPLErr level, CPLErrorNum, const char* message) {
  if (level < CE_Failure) return;
  const std::scoped_lock lock(thread_mutex);
  if (thread_errors.size() < 20) thread_errors.push_back(one_line(message));
}

/// Throws InputError if the metadata in a raster name the file of its overviews, which GDAL would open unchecked. Those
/// of a VRT are checked (`check_vrt`).
void refuse_named_overviews(GDALDataset& raster, const std::string& path) {
  const char* const file = raster.GetMetadataItem("OVERVIEW_FILE", "OVERVIEWS");
  if (file == nullptr || EQUAL(raster.GetDriverName(), "VRT")) return;
  throw InputError(path + ": names '" + file + "' as OVERVIEW_FILE in its metadata, must name no other file: " +
                   "gdal_translate " + shell_word(path) + " copy.tif makes a raster without it");
}

bool ends_with(const std::string& path, const std::string& end) {
  return path.size() >= end.size() && EQUAL(path.c_str() + path.size() - end.size(), end.c_str());
}

/// How to name a file within an archive; empty if the path is none.
std::string archive_hint(const std::string& path) {
  if (path.starts_with("/vsi")) return "";
  const char* reader = ends_with(path, ".zip")                                                            ? "/vsizip/"
                       : ends_with(path, ".tar") || ends_with(path, ".tgz") || ends_with(path, ".tar.gz") ? "/vsitar/"
                                                                                                          : nullptr;
  return reader == nullptr ? "" : "; a file in an archive is named " + std::string(reader) + path + "/FILE";
}

}  // namespace

void start_gdal() {
  static std::once_flag once;
  std::call_once(once, [] {
    if (CPLGetConfigOption("GDAL_CACHEMAX", nullptr) == nullptr) GDALSetCacheMax64(32LL << 20);
    CPLSetErrorHandler(collect_of_threads);
    register_drivers();
  });
}

GdalMessages::GdalMessages() {
  start_gdal();
  {
    const std::scoped_lock lock(thread_mutex);
    thread_errors.clear();
  }
  CPLPushErrorHandlerEx(
      [](CPLErr level, CPLErrorNum, const char* message) {
        auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
        auto& list = level >= CE_Failure ? self->errors_ : self->warnings_;
        if (list.size() < 20) list.push_back(one_line(message));
      },
      this);
}

GdalMessages::~GdalMessages() {
  CPLPopErrorHandler();
}

std::string GdalMessages::take(const std::string& otherwise) {
  {
    const std::scoped_lock lock(thread_mutex);
    errors_.insert(errors_.end(), thread_errors.begin(), thread_errors.end());
    thread_errors.clear();
  }
  const auto& list = errors_.empty() ? warnings_ : errors_;
  std::string line;
  for (const std::string& message : list) line += (line.empty() ? "" : "; ") + message;
  errors_.clear();
  warnings_.clear();
  return line.empty() ? otherwise : line;
}

bool GdalMessages::failed() const {
  const std::scoped_lock lock(thread_mutex);
  return !errors_.empty() || !thread_errors.empty();
}

namespace {

/// The way out where a raster is given for a layer; empty if it is none.
std::string raster_hint(const std::string& file, unsigned kinds) {
  if ((kinds & GDAL_OF_RASTER) != 0) return {};
  if (GDALIdentifyDriverEx(name_for_gdal(file).c_str(), GDAL_OF_RASTER, nullptr, nullptr) == nullptr) return {};
  return "; it is a raster: make polygons of it with gdal_polygonize.py " + shell_word(file) + " polygons.gpkg";
}

}  // namespace

Dataset open_dataset(const std::string& path, unsigned kinds) {
  GdalMessages messages;
  const std::string file = (kinds & GDAL_OF_VECTOR) != 0 ? file_of_layer(path) : path;
  check_input(file);
  if ((kinds & GDAL_OF_VECTOR) != 0) check_vector_file(name_for_gdal(file));
  // A text table does not declare its geometry. Its cells stay text, so that an id 01 does not become 1.
  CPLStringList options;
  if (is_text_table(file)) {
    options.SetNameValue("AUTODETECT_TYPE", "NO");
    options.SetNameValue("KEEP_GEOM_COLUMNS", "NO");
    if (const auto geometry = geometry_column(name_for_gdal(file)))
      options.SetNameValue("GEOM_POSSIBLE_NAMES", geometry->c_str());
    else
      options.SetNameValue("X_POSSIBLE_NAMES", "x").SetNameValue("Y_POSSIBLE_NAMES", "y");
  }
  Dataset dataset(GDALDataset::Open(name_for_gdal(file).c_str(), kinds | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                    nullptr, options.List(), nullptr));
  if (!dataset) {
    const char* kind = (kinds & GDAL_OF_RASTER) == 0   ? "vector layer"
                       : (kinds & GDAL_OF_VECTOR) == 0 ? "raster"
                                                       : "raster or vector layer";
    const char* columns = (kinds & GDAL_OF_VECTOR) != 0 && is_text_table(file)
                              ? " (a CSV must have two columns at least: put another one beside wkt, as id)"
                              : "";
    std::string reason = messages.take();
    if (reason.ends_with('.')) reason.pop_back();
    throw InputError(path + ": cannot be opened as a " + kind + ": " + reason + columns + archive_hint(path) +
                     raster_hint(file, kinds) + "; docs/security.md has the formats that are read");
  }
  if ((kinds & GDAL_OF_RASTER) != 0) refuse_named_overviews(*dataset, path);
  check_complete(*dataset, path, name_for_gdal(file), messages);
  return dataset;
}

std::vector<std::string> files_of_raster(const std::string& path) {
  // Formats of several files. Other formats stay closed here: GDAL reads a whole text file (XYZ) to open it.
  const char* const drivers[] = {"GTiff",   "AAIGrid", "GRASSASCIIGrid", "HFA", "ENVI", "EHdr", "AIG",
                                 "SAGA",    "RST",     "NWT_GRD",        "PNG", "BMP",  "JPEG", "JP2OpenJPEG",
                                 "RRASTER", "BT",      nullptr};
  const GdalMessages quiet;
  std::vector<std::string> files;
  if (!looked_up(path).fault.empty()) return files;
  const Dataset raster(
      GDALDataset::Open(name_for_gdal(path).c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, nullptr, nullptr));
  if (raster) refuse_named_overviews(*raster, path);
  char** const names = raster ? raster->GetFileList() : nullptr;
  for (char** name = names; name != nullptr && *name != nullptr; ++name) files.emplace_back(*name);
  CSLDestroy(names);
  return files;
}

Dataset memory_dataset(int columns, int rows, GDALDataType type) {
  GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  Dataset dataset(driver == nullptr ? nullptr : driver->Create("", columns, rows, 1, type, nullptr));
  if (!dataset) throw std::runtime_error("no memory for a raster: " + messages.take());
  return dataset;
}

Dataset memory_dataset(int columns, int rows, std::uint8_t* bytes) {
  GdalMessages messages;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  Dataset dataset(driver == nullptr ? nullptr : driver->Create("", columns, rows, 0, GDT_Byte, nullptr));
  std::array<char, 32> address{};
  CPLPrintPointer(address.data(), bytes, static_cast<int>(address.size()) - 1);
  const std::string option = std::string("DATAPOINTER=") + address.data();
  const char* const options[] = {option.c_str(), nullptr};
  if (!dataset || dataset->AddBand(GDT_Byte, const_cast<char**>(options)) != CE_None)
    throw std::runtime_error("no memory for a raster: " + messages.take());
  return dataset;
}

bool is_place(double x, double y) {
  return std::abs(x) <= kFarthestPlace && std::abs(y) <= kFarthestPlace;
}

std::string edit_command(const std::string& path, const std::string& option) {
  const std::string file = shell_word(path);
  const bool tiff = ends_with(path, ".tif") || ends_with(path, ".tiff");
  return tiff ? "gdal_edit.py " + option + " " + file : "gdal_translate " + option + " " + file + " mended.tif";
}

std::string wkt_of(const OGRSpatialReference* system) {
  if (system == nullptr || system->IsEmpty()) return {};
  const char* const name = system->GetName();  // what GDAL says where a GeoPackage has none
  if (name != nullptr && (STARTS_WITH_CI(name, "Undefined Cartesian") || STARTS_WITH_CI(name, "Undefined geographic") ||
                          STARTS_WITH_CI(name, "Undefined SRS")))
    return {};
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  std::string wkt;
  if (system->exportToWkt(&text, options) == OGRERR_NONE && text != nullptr) wkt = text;
  CPLFree(text);
  return wkt;
}

std::string without_heights(const std::string& wkt) {
  const GdalMessages quiet;
  OGRSpatialReference system;
  if (system.importFromWkt(wkt.c_str()) != OGRERR_NONE || system.IsCompound() != 0 || system.IsProjected() == 0 ||
      system.GetAxesCount() != 3 || system.DemoteTo2D(nullptr) != OGRERR_NONE)
    return wkt;
  struct Release {
    void operator()(OGRSpatialReference* known) const { known->Release(); }
  };
  const std::unique_ptr<OGRSpatialReference, Release> known(system.FindBestMatch(100));  // with its code
  return wkt_of(known ? known.get() : &system);
}

}  // namespace talus::io
