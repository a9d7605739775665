#include "talus/simulate/scenario/presets.hpp"

#include "commands.hpp"
#include "talus/base/text.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace {

/// The diameters that each set was fitted to.
void print_sizes() {
  print("\n%-18s  diameters fitted [m]\n", "preset");
  for (const talus::Preset& preset : talus::presets()) {
    const talus::FittedSizes& sizes = preset.sizes;
    const std::string range = sizes.known() ? talus::text_of(sizes.smallest) + " to " + talus::text_of(sizes.largest)
                                            : std::string("not known");
    print("%-18s  %-10s  %s\n", std::string(preset.name).c_str(), range.c_str(), std::string(sizes.source).c_str());
  }
}

/// The sets of effects, as a scenario names them, with their numbers.
void print_effect_presets() {
  print("\n");
  for (const talus::EffectPreset& preset : talus::effect_presets()) {
    print("[effects.%s] preset = \"%s\":", std::string(preset.effect).c_str(), std::string(preset.name).c_str());
    for (const talus::EffectField& field : talus::find_effect(preset.effect)->fields())
      print(" %s %s%s", std::string(talus::find_effect(preset.effect)->key_of(field)).c_str(),
            talus::text_of(field.get(preset.numbers)).c_str(), field.unit == "m" ? " m" : "");
    print("; %s\n", std::string(preset.source).c_str());
  }
}

/// One column per parameter of a ground, as `fields` names it; then the source of the set.
int print_presets() {
  print("%-18s", "preset");
  for (const auto& field : talus::ground_fields())
    print("%*s", static_cast<int>(field.key.size()) + 2, field.key.data());
  print("  source\n");
  for (const talus::Preset& preset : talus::presets()) {
    print("%-18s", std::string(preset.name).c_str());
    for (const auto& field : talus::ground_fields()) {
      print("%*.6g", static_cast<int>(field.key.size()) + 2, field.get(preset.ground));
    }
    print("  %s: %s\n", std::string(preset.source).c_str(), std::string(preset.where).c_str());
  }
  print_sizes();
  print_effect_presets();
  print(
      "\nTables of Mitchell and Hungr's paper on PIERRE 2; rockyfor3d-N is a first guess for soil type N of "
      "Rockyfor3D,\nwhich no data support and which damps more than the paper's sets: docs/migration.md.\n"
      "Units: En50, Et50 m3/s2, phi degrees; the others have none.\n"
      "Where no preset is named, %s holds; for talus profile, %s.\n",
      std::string(talus::kDefaultPreset).c_str(), std::string(talus::kDefaultProfilePreset).c_str());
  return 0;
}

}  // namespace

void add_presets(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "presets", "Print the parameter sets, their sources and the block sizes that they were fitted to");
  command->footer("Example:\n  talus presets");
  command->callback([&action] { action = print_presets; });
}
