#include "local_gdal.hpp"

#include <cpl_http.h>
#include <cpl_vsi.h>
#include <cpl_vsi_virtual.h>
#include <gdal_priv.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "talus/io/gdal/input_access.hpp"

namespace talus::io {

namespace {

/// Drivers of local files. None of them connects, or runs what a file says. "MEM" and "Memory" are ours alone.
constexpr std::array<std::string_view, 41> kDrivers{
    "GTiff",        "COG",        "VRT",         "AAIGrid",    "GRASSASCIIGrid", "SRTMHGT",
    "HFA",          "ENVI",       "EHdr",        "AIG",        "netCDF",         "XYZ",
    "SAGA",         "GSAG",       "GSBG",        "GS7BG",      "USGSDEM",        "DTED",
    "NWT_GRD",      "PCRaster",   "BT",          "RRASTER",    "ZMap",           "RST",
    "PNG",          "JPEG",       "JP2OpenJPEG", "BMP",        "GPKG",           "ESRI Shapefile",
    "GeoJSON",      "GeoJSONSeq", "CSV",         "FlatGeobuf", "LIBKML",         "DXF",
    "MapInfo File", "GPX",        "OpenFileGDB", "MEM",        "Memory"};

/// GDAL's virtual files that lie in memory or in local files.
constexpr std::array<std::string_view, 8> kLocalFiles{"/vsimem/",     "/vsizip/",    "/vsitar/",   "/vsigzip/",
                                                      "/vsisubfile/", "/vsisparse/", "/vsicached", "/vsicrypt/"};

template <std::size_t N>
bool holds(const std::array<std::string_view, N>& list, std::string_view name) {
  return std::ranges::count(list, name) > 0;
}

void drop_other_drivers() {
  GDALDriverManager& manager = *GetGDALDriverManager();
  for (int i = manager.GetDriverCount() - 1; i >= 0; --i) {
    GDALDriver* const driver = manager.GetDriver(i);
    if (holds(kDrivers, driver->GetDescription())) continue;
    manager.DeregisterDriver(driver);
    GDALDestroyDriver(driver);
  }
  for (const char* ours :
       {"MEM", "Memory"})  // made by `Create`; to open one by a name is to read any address of memory
    if (GDALDriver* const driver = manager.GetDriverByName(ours)) driver->pfnOpen = nullptr;
}

/// In the place of a file system of GDAL: holds no file. The earlier one is kept until the program ends: GDAL itself
/// may hold it under other names.
void close_file_system(const char* start) {
  static auto& replaced = *new std::vector<const VSIFilesystemHandler*>;  // never removed: not even at the end
  replaced.push_back(VSIFileManager::GetHandler(start));
  VSIFilesystemPluginCallbacksStruct* const none = VSIAllocFilesystemPluginCallbacksStruct();
  none->open = [](void*, const char*, const char*) -> void* { return nullptr; };
  none->stat = [](void*, const char*, VSIStatBufL*, int) { return -1; };
  none->read = [](void*, void*, size_t, size_t) { return size_t{0}; };
  none->tell = [](void*) { return vsi_l_offset{0}; };
  none->seek = [](void*, vsi_l_offset, int) { return -1; };
  none->eof = [](void*) { return 1; };
  none->close = [](void*) { return 0; };
  VSIInstallPluginHandler(start, none);
  VSIFreeFilesystemPluginCallbacksStruct(none);
}

void close_other_file_systems() {
  char** const starts = VSIGetFileSystemsPrefixes();
  for (char** start = starts; start != nullptr && *start != nullptr; ++start)
    if (!holds(kLocalFiles, *start)) close_file_system(*start);
  CSLDestroy(starts);
  for (const char* start : {"/vsicurl?", "/vsistdin?"}) close_file_system(start);  // not in the list: no / at the end
}

/// Answers all that GDAL would fetch: systems of coordinates given by an address, schemas, tiles.
CPLHTTPResult* fetch_nothing(const char* url, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*,
                             void*) {
  auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup((std::string(url) + ": the network is not allowed (--allow-network)").c_str());
  return result;
}

}  // namespace

void register_drivers() {
  CPLSetConfigOption("GDAL_VRT_ENABLE_PYTHON", "NO");  // stronger than the environment
  CPLSetConfigOption("GDAL_VRT_TRUSTED_MODULES", "");
  CPLSetConfigOption("OGR_SQLITE_LOAD_EXTENSIONS", "");  // a GeoPackage may load no library
  CPLSetConfigOption("OGR_SQLITE_LIST_VIRTUAL_OGR", "NO");
  GDALAllRegister();
  drop_other_drivers();
  if (network_is_allowed()) return;
  close_other_file_systems();
  CPLHTTPSetFetchCallback(fetch_nothing, nullptr);
  OSRSetPROJEnableNetwork(0);
}

}  // namespace talus::io
