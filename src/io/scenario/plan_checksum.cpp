#include "talus/io/scenario/plan_checksum.hpp"

#include <algorithm>
#include <filesystem>

#include "io/files/checksum.hpp"
#include "io/gdal/input_name.hpp"
#include "scenario_text.hpp"
#include "talus/io/gdal/layer_name.hpp"

namespace talus::io {
namespace {

/// Removes the folder: machines may have the same files in other folders. Name and content count.
void strip_folder(NamedFile& file) {
  const std::string name = file_of_layer(file.path);
  const PartName part = part_name(name).value_or(PartName{"", name, ""});
  const std::filesystem::path path(part.file);
  if (path.is_absolute()) file.path = same_layer_in(part.before + path.filename().string() + part.after, file.path);
}

/// Whether the sources have a field `height`, which earlier builds read as the height of release, or
/// `release_height`, which they did not read: such runs must not go on, or be repeated, as if they were the same.
bool fields_changed_meaning(const LoadedScenario& loaded) {
  const auto read = [](const Setting& s) { return s.key == "sources.attributes.release_height"; };
  return loaded.unread_height || std::ranges::any_of(loaded.settings, read);
}

}  // namespace

std::string plan_checksum(const LoadedScenario& loaded, std::uint32_t rounds) {
  ScenarioSpec spec = *loaded.spec;
  spec.values.trajectories /= rounds;
  spec.vrt_folders.clear();
  spec.fitted_on = {};  // changes no result, and the plans of earlier versions keep their checksum
  for (NamedFile* file : {&spec.dem, &spec.sources, &spec.ground, &spec.screens, &spec.barriers}) strip_folder(*file);
  for (auto& [name, effect] : spec.effects) {
    strip_folder(effect.file);
    for (auto& [key, map] : effect.maps) strip_folder(map);
  }
  Sha256 sum;
  sum.add(toml_of(spec));
  for (const InputFile& input : loaded.inputs)
    if (input.role != "scenario" && input.role != kFittedModel) sum.add(input.role + input.content + "\n");
  if (fields_changed_meaning(loaded)) sum.add("release_height\n");
  return sum.digits();
}

}  // namespace talus::io
