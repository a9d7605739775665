#include "scenario_spec.hpp"

#include <algorithm>

namespace talus::io {

std::vector<std::pair<std::string, const NamedFile*>> ScenarioSpec::inputs() const {
  std::vector<std::pair<std::string, const NamedFile*>> files{
      {"scenario", &scenario}, {"include", &include}, {"dem", &dem},          {"sources", &sources},
      {"ground", &ground},     {"screens", &screens}, {"barriers", &barriers}};
  for (const auto& [name, effect] : effects) {
    files.emplace_back("effects." + name, &effect.file);
    for (const auto& [key, map] : effect.maps) files.emplace_back("effects." + name + "." + key, &map);
  }
  std::erase_if(files, [](const auto& file) { return file.second->path.empty(); });
  return files;
}

}  // namespace talus::io
