#pragma once
#include <string>
#include <vector>

#include "scenario_spec.hpp"

namespace talus::io {

/// A key or text as TOML writes it.
std::string toml_key(const std::string& name);
std::string toml_text(const std::string& text);

/// The text of a scenario file that reads back as exactly this, with every setting written out and absolute paths.
std::string toml_of(const ScenarioSpec& spec);

/// Every setting with its value and origin, in the order of toml_of.
std::vector<Setting> settings_of(const ScenarioSpec& spec);

}  // namespace talus::io
