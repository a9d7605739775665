#include "barrier_keys.hpp"

#include <cmath>
#include <set>

#include "scenario_text.hpp"
#include "talus/base/text.hpp"
#include "talus/products/barrier_design.hpp"
#include "talus/simulate/scenario/parameter_table.hpp"

namespace talus::io {
namespace {

using Kind = TomlValue::Kind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Bounds kPlaceOnMap{"from", "m", "coordinate in the system of the DEM", -1e8, 1e8};
constexpr Bounds kBias{"speed", "1", "share of the value that an instrument reads too high", -0.9, 10.0};

std::optional<Eigen::Vector2d> place(TableReader& table, const std::string& key) {
  const auto values = table.numbers(key, kPlaceOnMap);
  if (values && values->size() == 2) return Eigen::Vector2d((*values)[0], (*values)[1]);
  const TomlValue* value = table.value()->find(key);
  if (values) table.fault(key, *value, "must be [x, y]");
  if (value == nullptr)
    table.faults().push_back(table.file() + ":" + std::to_string(table.value()->line) + ": a barrier has no " + key +
                             ", must have height, from and to");
  return std::nullopt;
}

std::optional<BarrierLine> read_line(TableReader table) {
  BarrierLine line;
  line.id = table.text("id").value_or("");
  const auto height = table.number("height", bounds_of("barriers.height"));
  if (table.value()->find("height") == nullptr)
    table.faults().push_back(table.file() + ":" + std::to_string(table.value()->line) +
                             ": a barrier has no height, must have height, from and to");
  line.capacity = 1e3 * table.number("capacity", bounds_of("barriers.capacity")).value_or(kInfinity);
  const auto from = place(table, "from"), to = place(table, "to");
  table.finish();
  if (!height || !from || !to) return std::nullopt;
  line.height = *height, line.from = *from, line.to = *to;
  if (line.from != line.to) return line;
  table.fault("to", *table.value()->find("to"), "must not be the place of from: a barrier has a length");
  return std::nullopt;
}

/// The tables of a list; null, with a fault, if it is not a list of tables.
const std::vector<TomlValue>* tables_of(TableReader& table, const std::string& key) {
  const TomlValue* value = table.find(key);
  if (value == nullptr) return nullptr;
  bool tables = value->kind == Kind::List;
  for (const TomlValue& item : value->items) tables = tables && item.kind == Kind::Table;
  if (tables) return &value->items;
  table.fault(key, *value, "must be a list of tables, [[" + table.full(key) + "]]");
  return nullptr;
}

std::string place_text(const Eigen::Vector2d& place) {
  return "[" + text_of(place.x()) + ", " + text_of(place.y()) + "]";
}

}  // namespace

void read_barrier_lines(ScenarioSpec& spec, TableReader& barriers, const std::string& origin) {
  const std::vector<TomlValue>* tables = tables_of(barriers, "line");
  if (tables == nullptr) return;
  spec.barrier_lines.clear();  // replaces those of an included file
  for (const TomlValue& item : *tables)
    if (auto line = read_line({&item, barriers.full("line"), barriers.file(), barriers.faults()})) {
      if (line->id.empty()) line->id = "line " + std::to_string(spec.barrier_lines.size() + 1);
      line->says_capacity = item.find("capacity") != nullptr;
      spec.barrier_lines.push_back(std::move(*line));
    }
  spec.origins["barriers.line"] = origin;
}

void read_instrument_bias(ScenarioSpec& spec, TableReader& top) {
  const std::vector<TomlValue>* tables = tables_of(top, "instrument_bias");
  if (tables == nullptr) return;
  for (const TomlValue& item : *tables) {
    TableReader table(&item, "instrument_bias", top.file(), top.faults());
    InstrumentBias bias;
    bias.where = top.file() + ":" + std::to_string(item.line) + ": [[instrument_bias]]";
    const std::size_t faults_before = top.faults().size();
    bias.screen = table.text("screen").value_or("");
    bias.speed = table.number("speed", kBias).value_or(0.0);
    bias.jump = table.number("jump", kBias).value_or(0.0);
    bias.spin = table.number("spin", kBias).value_or(0.0);
    table.finish();
    if (bias.speed == 0.0 && bias.jump == 0.0 && bias.spin == 0.0 && top.faults().size() == faults_before)
      top.faults().push_back(bias.where + " does nothing, must give speed, jump or spin, other than 0");
    if (std::ranges::count(spec.instrument_bias, bias.screen, &InstrumentBias::screen) > 0)
      top.faults().push_back(bias.where + (bias.screen.empty() ? " without a screen" : " of screen " + bias.screen) +
                             " is given twice, must be one of each screen and one without");
    spec.instrument_bias.push_back(std::move(bias));
  }
}

void warn_of_unlikely_barriers(std::span<const Barrier> barriers, std::vector<std::string>& warnings) {
  std::vector<std::string> names, idle;
  for (const Barrier& b : barriers)
    if (b.height == 0.0 || b.capacity == 0.0) idle.push_back(b.id);
  if (!idle.empty())
    warnings.push_back("barriers: " + listed(idle) +
                       ": of height or capacity 0, which hold no block: was the number not filled in?");
  for (const Barrier& b : barriers)
    if (b.height > 0.0 && std::isfinite(b.capacity) && (b.capacity > kLargestNetCapacity || b.height > kHighestNet))
      names.push_back(b.id + " (" + text_of(1e-3 * b.capacity) + " kJ, " + text_of(b.height) + " m)");
  if (!names.empty())
    warnings.push_back("barriers: " + listed(names) + ": above " + text_of(1e-3 * kLargestNetCapacity) + " kJ or " +
                       text_of(kHighestNet) +
                       " m, more than any net: is the capacity in J, or is it a dam? Give kJ and m, and a dam the "
                       "capacity inf");
}

void warn_of_unsaid_capacities(const std::vector<BarrierLine>& lines, std::vector<std::string>& warnings) {
  std::vector<std::string> unbreakable;
  for (const BarrierLine& line : lines)
    if (!line.says_capacity) unbreakable.push_back(line.id);
  if (!unbreakable.empty())
    warnings.push_back("barriers.line: no capacity is given of " + listed(unbreakable) +
                       ", so that nothing breaks through (unsafe for a net): give capacity in kJ, or capacity = inf "
                       "for a dam");
}

void warn_of_equal_ids(std::span<const Barrier> barriers, std::vector<std::string>& warnings) {
  std::set<std::string> seen, twice;
  for (const Barrier& barrier : barriers)
    if (!seen.insert(barrier.id).second) twice.insert(barrier.id);
  if (!twice.empty())
    warnings.push_back(
        "barriers: several have the same id, so that barriers.csv, run.json and the summary do not tell "
        "them apart: " +
        listed(std::vector<std::string>(twice.begin(), twice.end())) +
        "; give each an id of its own, in the layer and in [[barriers.line]]");
}

std::string barrier_lines_text(const std::vector<BarrierLine>& lines) {
  std::vector<std::string> words;
  for (const BarrierLine& line : lines)
    words.push_back("{ id = " + toml_text(line.id) + ", height = " + text_of(line.height) +
                    ", capacity = " + text_of(1e-3 * line.capacity) + ", from = " + place_text(line.from) +
                    ", to = " + place_text(line.to) + " }");
  return "[" + joined(words) + "]";
}

Barrier barrier_of(const BarrierLine& line, const Grid& grid) {
  const Eigen::Vector2d corner(grid.west, grid.south);
  return {line.id, {{line.from - corner, line.to - corner}}, line.height, line.capacity};
}

BarrierLine line_of(const Barrier& barrier, const Grid& grid) {
  const Eigen::Vector2d corner(grid.west, grid.south);
  const std::vector<Eigen::Vector2d>& line = barrier.lines.front();
  return {barrier.id, barrier.height, barrier.capacity, line.front() + corner, line.back() + corner};
}

}  // namespace talus::io
