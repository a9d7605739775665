#include "talus/io/scenario/plan_checksum.hpp"

#include <filesystem>

#include "io/files/checksum.hpp"
#include "scenario_text.hpp"

namespace talus::io {
namespace {

/// Removes the folder: machines may have the same files in other folders. Name and content count.
void strip_folder(NamedFile& file) {
  const std::filesystem::path path(file.path);
  if (path.is_absolute()) file.path = path.filename().string();
}

}  // namespace

std::string plan_checksum(const LoadedScenario& loaded) {
  ScenarioSpec spec = *loaded.spec;
  for (NamedFile* file : {&spec.dem, &spec.sources, &spec.ground, &spec.screens, &spec.barriers}) strip_folder(*file);
  for (auto& [name, effect] : spec.effects) {
    strip_folder(effect.file);
    for (auto& [key, map] : effect.maps) strip_folder(map);
  }
  Sha256 sum;
  sum.add(toml_of(spec));
  for (const InputFile& input : loaded.inputs)
    if (input.role != "scenario" && input.role != "include") sum.add(input.role + input.sha256 + "\n");
  return sum.digits();
}

}  // namespace talus::io
