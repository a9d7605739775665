#include "frequency_keys.hpp"

#include <cmath>

namespace talus::io {
namespace {

using Kind = TomlValue::Kind;

void read_law(ScenarioSpec& spec, TableReader& table, const TomlValue& value, const std::string& origin) {
  if (value.kind != Kind::Table) {
    table.fault("power_law", value, "must be a table like { A = 0.01, b = 0.6 }, of N(>= V) = A V^-b");
    return;
  }
  TableReader law(&value, "frequency.power_law", table.file(), table.faults());
  const auto scale = law.number("A", bounds_of("frequency.power_law.A")),
             exponent = law.number("b", bounds_of("frequency.power_law.b"));
  for (const char* key : {"A", "b"})
    if (value.find(key) == nullptr)
      table.fault("power_law", value, std::string("has no ") + key + ", must be { A, b } of N(>= V) = A V^-b");
  law.finish();
  if (!scale || !exponent) return;
  spec.values.frequency.scale = *scale;
  spec.values.frequency.exponent = *exponent;
  spec.origins["frequency.power_law"] = origin;
}

}  // namespace

void read_frequency(ScenarioSpec& spec, TableReader table, const std::string& origin) {
  FrequencyRules& rules = spec.values.frequency;
  if (const TomlValue* value = table.find("by_true_area")) {
    if (value->kind == Kind::Boolean)
      rules.by_true_area = value->boolean;
    else
      table.fault("by_true_area", *value, "must be true or false");
    spec.origins["frequency.by_true_area"] = origin;
  }
  if (const auto value = table.number("total", bounds_of("frequency.total"))) {
    rules.total = *value;
    spec.origins["frequency.total"] = origin;
  }
  if (const auto value = table.number("per_area", bounds_of("frequency.per_area"))) {
    rules.per_area = *value;
    spec.origins["frequency.per_area"] = origin;
  }
  if (const TomlValue* value = table.find("power_law")) read_law(spec, table, *value, origin);
  table.finish();
}

}  // namespace talus::io
