#include "help.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "facts.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"
#include "talus/io/results/qgis_project.hpp"
#include "talus/physics/effects/registry.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace {

using Json = nlohmann::ordered_json;

/// What a text says after `begin` up to `end`; empty if it does not.
std::string between_marks(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) return {};
  const std::size_t to = text.find(end, from + begin.size());
  return to == std::string::npos ? "" : text.substr(from + begin.size(), to - from - begin.size());
}

/// The values that an option's check allows: "{fit,holdout,all}" of CLI::IsMember.
std::vector<std::string> choices_of(const CLI::Option& option) {
  std::vector<std::string> choices = facts_of(option).choices;
  if (!choices.empty()) return choices;
  std::string text = between_marks(option.get_type_name(), ":{", "}");
  while (!text.empty()) {
    const std::size_t comma = text.find(',');
    choices.push_back(text.substr(0, comma));
    text = comma == std::string::npos ? "" : text.substr(comma + 1);
  }
  return choices;
}

bool is_flag(const CLI::Option& option) {
  return option.get_items_expected_max() == 0;
}

bool takes_many(const CLI::Option& option) {
  return option.get_items_expected_max() > 1;
}

/// The type of one value: flag, file, folder, choice, integer, number or text.
std::string type_of(const CLI::Option& option) {
  if (is_flag(option)) return "flag";
  if (const Facts& facts = facts_of(option); !facts.type.empty()) return facts.type;
  if (!choices_of(option).empty()) return "choice";
  const std::string name = option.get_type_name();
  if (name.starts_with("INT") || name.starts_with("UINT")) return "integer";
  return name.starts_with("FLOAT") ? "number" : "text";
}

/// A whole number without a decimal point.
Json json_of_number(double value) {
  if (value == std::floor(value) && std::abs(value) < 9.1e15) return static_cast<std::int64_t>(value);
  return value;
}

/// Lower and upper bound: those of the facts, else those of the option's check, "INT in [1 - 10000]".
Json bounds_of(const CLI::Option& option) {
  const Facts& facts = facts_of(option);
  double low = facts.low, high = facts.high;
  const std::string range = between_marks(option.get_type_name(), " in [", "]");
  if (std::isnan(low) && !range.empty() && std::sscanf(range.c_str(), "%lf - %lf", &low, &high) != 2)
    low = high = talus::kNotGiven;
  Json json = Json::object();
  if (std::isfinite(low)) json["low"] = json_of_number(low);
  if (std::isfinite(low) && facts.above_low) json["low_excluded"] = true;
  if (std::isfinite(high)) json["high"] = json_of_number(high);
  if (std::isfinite(high) && facts.below_high) json["high_excluded"] = true;
  return json;
}

/// The default, as a number where the option takes one; null where there is none.
Json default_of(const CLI::Option& option, const std::string& type) {
  const Facts& facts = facts_of(option);
  const std::string text = facts.standard.empty() ? option.get_default_str() : facts.standard;
  if (type == "flag") return false;
  if (text.empty() || text == "[]") return nullptr;
  if (!takes_many(option) && (type == "number" || type == "integer")) return json_of_number(talus::number_in(text));
  return text;
}

Json json_of(const CLI::Option& option) {
  Json json;
  const bool named = option.nonpositional();
  json["name"] = named && !option.get_lnames().empty() ? option.get_lnames().front() : option.get_name(true);
  json["flags"] = Json::array();
  for (const std::string& name : option.get_snames()) json["flags"].push_back("-" + name);
  for (const std::string& name : option.get_lnames()) json["flags"].push_back("--" + name);
  json["positional"] = !named;
  const std::string type = type_of(option);
  const bool list = option.get_delimiter() != '\0';
  json["type"] = list ? "list" : type;
  if (list) json["of"] = type, json["delimiter"] = std::string(1, option.get_delimiter());
  const Facts& facts = facts_of(option);
  if (type == "file") json["holds"] = facts.holds;
  if (type == "file" || type == "folder") json["written"] = facts.written;
  if (const auto choices = choices_of(option); !choices.empty()) json["choices"] = choices;
  json["unit"] = facts.unit.empty() ? Json() : Json(facts.unit);
  json["bounds"] = bounds_of(option);
  json["default"] = default_of(option, type);
  json["required"] = option.get_required();
  json["repeatable"] = !list && takes_many(option);
  json["text"] = option.get_description();
  return json;
}

Json json_of(const CLI::App& command) {
  Json json{{"name", command.get_name()}, {"text", command.get_description()}, {"parameters", Json::array()}};
  for (const CLI::Option* option : command.get_options())
    if (option != command.get_help_ptr()) json["parameters"].push_back(json_of(*option));
  return json;
}

Json json_of(const talus::Bounds& bounds, const std::string& prefix) {
  Json json{{"name", prefix + std::string(bounds.key)}, {"type", bounds.whole ? "integer" : "number"}};
  json["unit"] = bounds.unit == "1" ? Json() : Json(bounds.unit);
  Json& range = json["bounds"];
  range["low"] = json_of_number(bounds.min);
  if (bounds.ends != talus::Bounds::Closed) range["low_excluded"] = true;
  if (std::isfinite(bounds.max)) range["high"] = json_of_number(bounds.max);
  if (bounds.ends == talus::Bounds::Between) range["high_excluded"] = true;
  json["default"] = nullptr;
  json["text"] = bounds.meaning;
  return json;
}

/// The numbers of a scenario file, as the tables of its readers have them.
Json scenario_json() {
  const talus::Scenario scenario;
  Json json = Json::array();
  for (const auto& field : talus::scenario_fields()) {
    json.push_back(json_of(field, ""));
    json.back()["default"] = json_of_number(field.get(scenario));
  }
  for (const talus::Bounds& bounds : talus::list_bounds()) json.push_back(json_of(bounds, ""));
  for (const auto& field : talus::ground_fields()) json.push_back(json_of(field, "ground."));
  for (const talus::EffectEntry& effect : talus::effect_entries())
    for (const talus::EffectField& field : effect.fields()) json.push_back(json_of(field, "effects."));
  return json;
}

/// The layers of results, from the top downwards, as talus.qgs has them.
Json results_json() {
  Json json = Json::array();
  for (const talus::io::ProjectLayer& layer : talus::io::project_layers())
    json.push_back({{"file", layer.file},
                    {"title", layer.title},
                    {"shown", layer.shown},
                    {"counts_energy", layer.counts_energy},
                    {"thresholds", layer.thresholds},
                    {"style", layer.style}});
  return json;
}

struct HelpOptions {
  std::string command;
  std::string program;  // the help of the program
  bool json = false;
};

/// The help that is asked for. Throws InputError if there is no such command.
std::string help_text(const CLI::App& app, const HelpOptions& options) {
  if (options.json) return help_json(app);
  if (options.command.empty()) return options.program;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (command->get_name() == options.command) return command->help(app.get_name());
    names.push_back(command->get_name());
  }
  throw talus::InputError("unknown command '" + options.command + "'" + talus::known_names(options.command, names) +
                          "; see talus --help");
}

}  // namespace

std::string help_json(const CLI::App& app) {
  Json json{{"program", app.get_name()}, {"version", talus::version()}, {"text", app.get_description()},
            {"commands", Json::array()}, {"scenario", scenario_json()}, {"results", results_json()}};
  for (const CLI::App* command : app.get_subcommands(nullptr)) json["commands"].push_back(json_of(*command));
  return json.dump(1) + "\n";
}

void add_help(CLI::App& app, Action& action) {
  const auto options = std::make_shared<HelpOptions>();
  CLI::App* command = app.add_subcommand("help", "Print this help, or that of a command");
  command->add_option("command", options->command, "name of a command");
  command->add_flag("--json", options->json,
                    "everything that can be given to every command, and the layers of results, for other programs");
  command->footer("Examples:\n  talus help\n  talus help run\n  talus help --json");
  options->program = app.help();  // here: once a command is read, this is the help of the command
  command->callback([&app, &action, options] {
    action = [text = help_text(app, *options)] {
      print_text(text);
      return 0;
    };
  });
}
