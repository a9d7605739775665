#include "fuzz.hpp"
#include "talus/io/results/objects_file.hpp"
#include "talus/io/results/weighting_file.hpp"

/// The first byte says what the rest is: sources, screens, zones or barriers of a scenario or objects at risk, as CSV
/// or GeoJSON (the second byte), or another weighting of a run.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talus;
  fuzz::Bytes bytes(data, size);
  const std::size_t which = bytes.index(6);
  const std::string table = which == 5 ? "weighting.toml" : bytes.yes() ? "table.csv" : "table.geojson";
  const std::string file = (fuzz::site() / table).string();
  fuzz::write(file, bytes.rest());
  std::string scenario = "dem = \"dem.tif\"\n[blocks]\ndiameter = 1\n[sources]\nfile = \"" +
                         (which == 0 ? table : "cliffs.geojson") + "\"\n";
  if (which == 1) scenario += "[screens]\nfile = \"" + table + "\"\n";
  if (which == 2) scenario += "[ground]\nfile = \"" + table + "\"\nfield = \"zone\"\ndefault = \"upper-talus-3d\"\n";
  if (which == 3) scenario += "[barriers]\nfile = \"" + table + "\"\n";
  fuzz::write(fuzz::site() / "tables.toml", scenario);
  fuzz::refused_or_read([&] {
    io::RunFlags flags;
    flags.scenario = fuzz::site() / "tables.toml";
    io::LoadedScenario loaded = io::load_scenario(flags);
    if (which == 4) io::ObjectLayer(file, loaded, {.line_width = 4.0});
    if (which == 5) io::apply_weighting(file, loaded.scenario);
  });
  return 0;
}
