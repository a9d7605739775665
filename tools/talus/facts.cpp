#include "facts.hpp"

#include <algorithm>
#include <map>

#include "talus/base/text.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace {

/// Options live as long as the description of the command line, of which a program makes one.
std::map<const CLI::Option*, Facts>& attached() {
  static std::map<const CLI::Option*, Facts> facts;
  return facts;
}

Facts of_type(std::string type, std::vector<std::string> holds, bool written) {
  Facts facts;
  facts.type = std::move(type);
  facts.holds = std::move(holds);
  facts.written = written;
  return facts;
}

}  // namespace

CLI::Option* with(CLI::Option* option, Facts facts) {
  attached()[option] = std::move(facts);
  return option;
}

const Facts& facts_of(const CLI::Option& option) {
  static const Facts none;
  const auto found = attached().find(&option);
  return found == attached().end() ? none : found->second;
}

Facts file_of(std::vector<std::string> holds) {
  return of_type("file", std::move(holds), false);
}

Facts new_file_of(std::vector<std::string> holds) {
  return of_type("file", std::move(holds), true);
}

Facts folder_of_results() {
  return of_type("folder", {}, false);
}

Facts new_folder() {
  return of_type("folder", {}, true);
}

Facts number_of(const talus::Bounds& bounds, std::string standard) {
  Facts facts;
  if (bounds.unit != "1") facts.unit = bounds.unit;
  facts.low = bounds.min;
  facts.high = bounds.max;
  facts.above_low = bounds.ends != talus::Bounds::Closed;
  facts.below_high = bounds.ends == talus::Bounds::Between;
  facts.standard = std::move(standard);
  return facts;
}

Facts default_of(std::string value) {
  Facts facts;
  facts.standard = std::move(value);
  return facts;
}

Facts default_of(double value) {
  return default_of(talus::text_of(value));
}

Facts with_unit(std::string unit, double value) {
  Facts facts = default_of(value);
  facts.unit = std::move(unit);
  return facts;
}

Facts scalar_of(std::string_view key) {
  const auto fields = talus::scenario_fields();
  const auto field = std::ranges::find_if(fields, [key](const auto& f) { return f.key == key; });
  const talus::Scenario scenario;
  return number_of(*field, talus::text_of(field->get(scenario)));
}

Facts surface_choice() {
  Facts facts;
  facts.choices = {"creased", "bilinear"};
  facts.standard = facts.choices.front();
  return facts;
}

Facts lane_choice() {
  Facts facts;
  for (const int lanes : talus::kLaneChoices) facts.choices.push_back(std::to_string(lanes));
  return facts;
}

Facts vectors_choice() {
  Facts facts;
  for (const talus::VectorFormat format : talus::kVectorFormats) facts.choices.emplace_back(name_of(format));
  facts.standard = facts.choices.front();
  return facts;
}

Facts preset_choice(std::string_view standard) {
  Facts facts;
  for (const talus::Preset& preset : talus::presets()) facts.choices.emplace_back(preset.name);
  facts.standard = standard;
  return facts;
}
