#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/gdal/map_outlines.hpp"
#include "io/gdal/map_raster.hpp"
#include "map_style.hpp"
#include "named_files.hpp"
#include "report_facts.hpp"

namespace talus::io {

/// Longest side of a map on a page [pixels].
inline constexpr int kLongestMap = 800;

/// A raster as a page shows it: one band, in the look of the style beside it.
struct ReportMap {
  std::string name;   ///< of the file, "energy"
  std::string title;  ///< "Energy, P95"
  std::string unit;   ///< of the file, "kJ"
  MapStyle style;
  std::string picture;        ///< `data:` address
  std::string values;         ///< `packed_values`
  double largest = 0.0;       ///< of all pixels
  bool in_print = false;      ///< has a figure of its own
  bool smallest = false;      ///< a pixel holds the smallest value of its cells, else the largest
  bool classes_only = false;  ///< the values are classes with names
  std::string file = {};      ///< with the band where it is not the first
};

/// The part of the terrain that all maps of a page show.
struct MapSheet {
  MapWindow window;
  double west = 0.0, north = 0.0, pixel_x = 0.0, pixel_y = 0.0;  ///< [m]
  std::string relief;                                            ///< `data:` address; empty if there is none
  std::string relief_note;                                       ///< why there is none
  std::string copyright;                                         ///< as the file of the DEM states it
  std::vector<ReportMap> maps;
  std::vector<std::uint8_t> sources;    ///< pixels from which blocks are released; empty if not known
  std::vector<std::uint8_t> cut_short;  ///< pixels from which paths leave the map; empty if not known, or if none do
  MapClass cut;                         ///< their look
  std::optional<double> undecided;      ///< share of the pixels with a class where it is not decided
  Outlines objects;
  std::vector<std::string> notes;  ///< what is left out, and why
};

/// The maps of the rasters that a record names.
MapSheet read_sheet(const std::filesystem::path& folder, const RunFacts& run, const NamedFiles& named);

}  // namespace talus::io
