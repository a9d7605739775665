#pragma once
#include "files.hpp"
#include "talus/io/scenario/loaded_scenario.hpp"

namespace talus::io::test {

// A folder with dem.tif, sources.gpkg (a point without a diameter) and a scenario of the given text.
class ScenarioFile : public Files {
 protected:
  ScenarioFile() {
    RasterFile{}.write(path("dem.tif"));
    write_vector(path("sources.gpkg"), "EPSG:32632", {}, {{"POINT(55 45)"}});
  }

  static constexpr const char* kFiles = "dem = \"dem.tif\"\n[sources]\nfile = \"sources.gpkg\"\n";

  LoadedScenario load(const std::string& text, RunFlags flags = {}) {
    flags.scenario = write_text("scenario.toml", text);
    return load_scenario(flags);
  }
  // The rest of a scenario after kFiles, which has a diameter.
  LoadedScenario with(const std::string& rest) {
    return load(std::string(kFiles) + "[blocks]\ndiameter = 1.2\n" + rest);
  }
  void refused(const std::string& text, const std::vector<std::string>& parts) {
    expect_input_error([&] { load(text); }, parts);
  }
  static std::string origin(const LoadedScenario& loaded, const std::string& key) {
    for (const Setting& s : loaded.settings)
      if (s.key == key) return s.source;
    return "no such setting";
  }
};

}  // namespace talus::io::test
