#include "talus/io/gdal/crossings_file.hpp"

#include <filesystem>
#include <unordered_map>

#include "csv_table.hpp"
#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"

namespace talus::io {
namespace {

constexpr Bounds kSpeed{"speed_ms", "m/s", "speed of the block", 0.0, 1e4};
constexpr Bounds kEnergy{"energy_kj", "kJ", "translational energy", 0.0, 1e12};
constexpr Bounds kHeight{"jump_height_m", "m", "height above the terrain", 0.0, 1e4};
constexpr Bounds kMass{"mass_kg", "kg", "mass of the block", 0.0, 1e10, Bounds::AboveMin};
constexpr Bounds kPlace{"x", "m", "map coordinate", -1e8, 1e8};

/// Key of the block of a row; empty if the table does not identify it.
std::string block_of(const CsvTable& table, const CsvTable::Row& row) {
  const std::string name = table.text(row, "id") + ',' + table.text(row, "source") + ',' + table.text(row, "block");
  return name == ",," ? std::string() : name;
}

/// Key of the piece of a block: its number; its mass in tables that do not number pieces (observed crossings, runs of
/// earlier versions), where pieces of equal mass are one.
std::string piece_of(const CsvTable& table, const CsvTable::Row& row) {
  const std::string& piece = table.text(row, "piece");
  return piece.empty() ? "mass " + table.text(row, "mass_kg") : piece;
}

/// Numbers the blocks in the order of their first rows; a row without a key is a block of its own.
class BlockNumbers {
 public:
  std::size_t of(const std::string& block) {
    if (block.empty()) return count_++;
    const auto [known, is_new] = numbers_.try_emplace(block, count_);
    count_ += is_new ? 1U : 0U;
    return known->second;
  }
  std::size_t count() const { return count_; }

 private:
  std::unordered_map<std::string, std::size_t> numbers_;
  std::size_t count_ = 0;
};

}  // namespace

CrossingTable read_crossings(const std::string& path, const std::string& screen) {
  const CsvTable table(path,
                       {"id", "source", "block", "screen", "speed_ms", "energy_kj", "total_energy_kj", "jump_height_m",
                        "angular_velocity_rads", "mass_kg", "x", "y", "piece"},
                       {"screen"});
  CrossingTable out;
  BlockNumbers blocks;
  std::unordered_map<std::string, std::size_t> seen;  // the first crossing of each block or piece
  for (const CsvTable::Row& row : table.rows()) {
    const std::string& of = table.text(row, "screen");
    if (of.empty()) table.refuse(row, "screen", "must be given: a crossing of no screen would count nowhere");
    if (of != screen) {
      ++out.others[of];
      continue;
    }
    ++out.rows;
    const auto speed = table.number(row, "speed_ms", kSpeed), energy = table.number(row, "energy_kj", kEnergy),
               height = table.number(row, "jump_height_m", kHeight), mass = table.number(row, "mass_kg", kMass),
               x = table.number(row, "x", kPlace), y = table.number(row, "y", kPlace);
    const std::string block = block_of(table, row);
    if (!block.empty()) {
      const auto [first, fresh] = seen.try_emplace(block + ',' + piece_of(table, row), out.count);
      if (!fresh) {
        out.again.push_back({first->second,
                             speed.value_or(kNotGiven),
                             height.value_or(kNotGiven),
                             mass.value_or(kNotGiven),
                             {x.value_or(kNotGiven), y.value_or(kNotGiven)}});
        continue;
      }
    }
    ++out.count;
    out.source.push_back(table.text(row, "source"));
    out.block.push_back(table.text(row, "block"));
    out.number.push_back(blocks.of(block));
    if (speed) out.speed.push_back(*speed);
    if (height) out.height.push_back(*height);
    if (mass) out.mass.push_back(*mass);
    if (energy)
      out.energy.push_back(*energy * 1e3);
    else if (mass && speed)
      out.energy.push_back(0.5 * *mass * *speed * *speed);
    if (x && y) out.places.emplace_back(*x, *y);
  }
  out.blocks = blocks.count();
  return out;
}

std::optional<std::size_t> crossings_in_summary(const std::string& path, const std::string& screen) {
  constexpr Bounds kCount{"crossings", "1", "crossings of the screen", 0.0, 1e15, Bounds::Closed, true};
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return std::nullopt;
  const CsvTable table(path, {}, {"screen", "crossings"});
  for (const CsvTable::Row& row : table.rows())
    if (table.text(row, "screen") == screen) return static_cast<std::size_t>(table.required(row, "crossings", kCount));
  throw InputError(path + ": has no row of screen '" + screen +
                   "', must be as talus run has written it; run the scenario again");
}

}  // namespace talus::io
