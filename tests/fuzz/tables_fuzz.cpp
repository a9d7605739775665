#include "fuzz.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"

/// The first byte says which table of a scenario the rest is: sources, screens, zones or barriers, as CSV or GeoJSON.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talus;
  fuzz::Bytes bytes(data, size);
  const std::size_t which = bytes.index(4);
  const std::string table = bytes.yes() ? "table.csv" : "table.geojson";
  fuzz::write(fuzz::site() / table, bytes.rest());
  std::string scenario = "dem = \"dem.tif\"\n[blocks]\ndiameter = 1\n[sources]\nfile = \"" +
                         (which == 0 ? table : "cliffs.geojson") + "\"\n";
  if (which == 1) scenario += "[screens]\nfile = \"" + table + "\"\n";
  if (which == 2) scenario += "[ground]\nfile = \"" + table + "\"\nfield = \"zone\"\ndefault = \"upper-talus-3d\"\n";
  if (which == 3) scenario += "[barriers]\nfile = \"" + table + "\"\n";
  fuzz::write(fuzz::site() / "tables.toml", scenario);
  fuzz::refused_or_read([&] {
    io::RunFlags flags;
    flags.scenario = fuzz::site() / "tables.toml";
    io::load_scenario(flags);
  });
  return 0;
}
