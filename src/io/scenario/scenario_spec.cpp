#include "scenario_spec.hpp"

#include <algorithm>

namespace talus::io {

namespace {

/// The files that a scenario names, with their roles. @tparam Spec  ScenarioSpec, const or not
template <class Spec>
auto named_files(Spec& spec) {
  std::vector<std::pair<std::string, decltype(&spec.dem)>> files{
      {"scenario", &spec.scenario}, {kFittedModel, &spec.include}, {"dem", &spec.dem},
      {"sources", &spec.sources},   {"ground", &spec.ground},      {"screens", &spec.screens},
      {"barriers", &spec.barriers}};
  for (auto& [name, effect] : spec.effects) {
    files.emplace_back("effects." + name, &effect.file);
    for (auto& [key, map] : effect.maps) files.emplace_back("effects." + name + "." + key, &map);
  }
  std::erase_if(files, [](const auto& file) { return file.second->path.empty(); });
  return files;
}

}  // namespace

std::vector<std::pair<std::string, const NamedFile*>> ScenarioSpec::inputs() const {
  return named_files(*this);
}

std::vector<std::pair<std::string, NamedFile*>> ScenarioSpec::inputs() {
  return named_files(*this);
}

}  // namespace talus::io
