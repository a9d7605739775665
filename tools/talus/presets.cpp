#include "talus/simulate/scenario/presets.hpp"

#include <cstdio>

#include "commands.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace {

/// One column per parameter of a ground, as `fields` names it; then the source of the set.
int print_presets() {
  std::printf("%-18s", "preset");
  for (const auto& field : talus::ground_fields())
    std::printf("%*s", static_cast<int>(field.key.size()) + 2, field.key.data());
  std::printf("  source\n");
  for (const talus::Preset& preset : talus::presets()) {
    std::printf("%-18s", std::string(preset.name).c_str());
    for (const auto& field : talus::ground_fields()) {
      std::printf("%*.6g", static_cast<int>(field.key.size()) + 2, field.get(preset.ground));
    }
    std::printf("  %s: %s\n", std::string(preset.source).c_str(), std::string(preset.where).c_str());
  }
  std::printf(
      "\nTables of Mitchell and Hungr's paper on PIERRE 2. Units: En50, Et50 m3/s2, phi degrees; the others have "
      "none.\n"
      "Where no preset is named, %s holds.\n",
      std::string(talus::kDefaultPreset).c_str());
  return 0;
}

}  // namespace

void add_presets(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("presets", "Print the parameter sets of the paper");
  command->footer("Example:\n  talus presets");
  command->callback([&action] { action = print_presets; });
}
