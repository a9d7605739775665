#include "campaign_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>
#include <unordered_map>

#include "campaign_checks.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/terrain/no_height.hpp"

namespace talus::io {
namespace {

constexpr Bounds kHeight{"z", "m", "height above the sea", -500.0, 9000.0};
constexpr Bounds kReleaseHeight{"release_height_m", "m", "of the block's lowest point above the terrain", 0.0, 500.0};
constexpr Bounds kRadius{"release_radius_m", "m", "of the disc of release", 0.0, 1000.0};
constexpr Bounds kVelocity{"vx", "m/s", "component of the velocity at the release", -200.0, 200.0};
constexpr Bounds kAxis{"L1_m", "m", "length of an axis of the block", 1e-3, 100.0};
constexpr Bounds kDay{"day", "1", "number of the day of release, 0: not known", 0.0, 1e6, Bounds::Closed, true};
constexpr Bounds kSpeed{"speed_ms", "m/s", "measured speed", 0.0, 300.0};
constexpr Bounds kJump{"jump_height_m", "m", "measured height above the terrain", 0.0, 1000.0};
constexpr Bounds kSpin{"angular_velocity_rads", "rad/s", "measured angular velocity", 0.0, 10000.0};

/// Reads the tables of one campaign; blocks first.
class Tables {
 public:
  Tables(const CampaignFiles& files, Campaign& campaign, std::vector<std::string>& warnings)
      : files_(files), campaign_(campaign), warnings_(warnings) {}

  void read() {
    read_blocks();
    if (!files_.stops.empty()) read_stops();
    if (!files_.passages.empty()) read_passages();
    if (!files_.samples.empty()) read_samples();
    order();
    warn_of_releases(files_.blocks, campaign_, warnings_);
    warn_of_rises(files_.stops, campaign_, warnings_);
  }

 private:
  using Row = CsvTable::Row;

  void read_blocks() {
    const CsvTable table =
        table_of_campaign(files_.blocks,
                          {"id", "x", "y", "release_height_m", "release_radius_m", "vx", "vy", "vz", "mass_kg",
                           "density_kgm3", "L1_m", "L2_m", "L3_m", "day", "group", "rock", "holdout"},
                          {"id", "x", "y", "release_height_m", "mass_kg"}, warnings_);
    std::unordered_map<std::string, int> lines;
    table.for_each_row([&](const Row& row) {
      MeasuredBlock block;
      block.id = table.name(row, "id");
      block.stream = stream_of_name(block.id);
      refuse_second(table, row, lines);
      indices_[block.id] = campaign_.blocks.size();
      const Eigen::Vector2d place = place_of(table, row);
      block.x = place.x();
      block.y = place.y();
      block.release_height = table.required(row, "release_height_m", kReleaseHeight);
      block.release_radius = table.number(row, "release_radius_m", kRadius).value_or(0.0);
      for (const auto& [column, axis] : {std::pair{"vx", 0}, {"vy", 1}, {"vz", 2}})
        block.velocity[axis] = table.number(row, column, kVelocity).value_or(0.0);
      block.mass = table.required(row, "mass_kg", kMass);
      block.density = table.number(row, "density_kgm3", kDensity).value_or(2700.0);
      block.axes = axes_of(table, row, equivalent_diameter(block.mass, block.density));
      block.day = static_cast<int>(table.number(row, "day", kDay).value_or(0.0));
      block.group = table.text(row, "group");
      block.rock = table.text(row, "rock");
      block.holdout = table.number(row, "holdout", kHoldout).value_or(0.0) == 1.0;
      block.passages.resize(campaign_.screens.size());
      check_release(table, row, block);
      campaign_.blocks.push_back(std::move(block));
    });
    if (campaign_.blocks.empty()) throw InputError(files_.blocks + ": has no blocks, must have one row for each");
    warn_of_masses(files_.blocks, campaign_.blocks, warnings_);
    warn_of_median(files_.blocks, campaign_.blocks, warnings_);
  }

  void check_release(const CsvTable& table, const Row& row, const MeasuredBlock& block) const {
    const auto there = [&](double x, double y) { return campaign_.surface.height(x, y).has_value(); };
    if (!there(block.x, block.y))
      table.refuse(row, "x",
                   "with y = " + table.text(row, "y") +
                       " the release is off the terrain, must be on it: are the coordinates those of the "
                       "DEM's system?");
    constexpr int kDirections = 8;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * kPi * i / kDirections, r = block.release_radius;
      if (!there(block.x + r * std::cos(angle), block.y + r * std::sin(angle)))
        table.refuse(row, "release_radius_m", "the disc of release reaches off the terrain, must be on it");
    }
  }

  Eigen::Vector2d place_of(const CsvTable& table, const Row& row) const {
    const Grid& grid = campaign_.surface.grid();
    return {table.required(row, "x", kPlace) - grid.west, table.required(row, "y", kPlace) - grid.south};
  }

  /// Place of a measurement, which must be on the DEM: one place far off would widen the spread that divides all
  /// errors.
  Eigen::Vector2d place_on_map(const CsvTable& table, const Row& row) const {
    Eigen::Vector2d place = place_of(table, row);
    const Grid& grid = campaign_.surface.grid();
    if (place.x() < 0.0 || place.y() < 0.0 || place.x() > grid.width() || place.y() > grid.height())
      table.refuse(row, "x",
                   "with y = " + table.text(row, "y") +
                       " is off the DEM, must be on it: is it mistyped? A block that ran off the DEM has no row");
    return place;
  }

  MeasuredBlock& block_of_row(const CsvTable& table, const Row& row) {
    const auto found = indices_.find(table.name(row, "id"));
    if (found == indices_.end()) table.refuse(row, "id", "is no block of " + files_.blocks + ", must be one");
    return campaign_.blocks[found->second];
  }

  void warn_if_empty(const std::string& file, const CsvTable& table) {
    if (table.rows().empty()) warnings_.push_back(file + ": has a header and no rows: it says nothing of any block");
  }

  void read_stops() {
    const CsvTable table = table_of_campaign(files_.stops, {"id", "x", "y", "mass_kg"}, {"id", "x", "y"}, warnings_);
    warn_if_empty(files_.stops, table);
    std::unordered_map<std::string, int> lines;
    table.for_each_row([&](const Row& row) {
      MeasuredBlock& block = block_of_row(table, row);
      refuse_second(table, row, lines);
      const bool placed = !table.text(row, "x").empty() || !table.text(row, "y").empty();
      if (placed) block.stop = place_on_map(table, row);
      if (const auto mass = stop_mass_of(table, row, block)) block.stop_mass = mass;
    });
  }

  /// Throws InputError if far more arrived than was released: one of them is in another unit.
  std::optional<double> stop_mass_of(const CsvTable& table, const Row& row, const MeasuredBlock& block) const {
    constexpr double kMost = 1.5;  // of the released mass: weighing and density are not exact
    const auto mass = table.number(row, "mass_kg", kMass);
    if (mass && *mass > kMost * block.mass)
      table.refuse(row, "mass_kg",
                   "is more than 1.5 times the " + text_of(block.mass) + " kg that " + files_.blocks +
                       " says was released, must not be: are both in kg?");
    return mass;
  }

  void read_passages() {
    const CsvTable table =
        table_of_campaign(files_.passages, {"id", "screen", "speed_ms", "jump_height_m", "angular_velocity_rads"},
                          {"id", "screen"}, warnings_);
    std::size_t doubled = 0;
    std::string first;
    std::vector<bool> off_map;
    for (const Screen& screen : campaign_.screens) off_map.push_back(is_off_map(screen));
    warn_if_empty(files_.passages, table);
    table.for_each_row([&](const Row& row) {
      MeasuredBlock& block = block_of_row(table, row);
      const std::size_t screen = screen_of(table, row);
      if (off_map[screen])
        table.refuse(row, "screen", "is a line off the DEM, where no simulated block gets to: must cross the DEM");
      Passage passage;
      passage.speed = table.number(row, "speed_ms", kSpeed).value_or(kNotGiven);
      passage.jump = table.number(row, "jump_height_m", kJump).value_or(kNotGiven);
      passage.spin = table.number(row, "angular_velocity_rads", kSpin).value_or(kNotGiven);
      if (!block.passages[screen])
        block.passages[screen] = passage;
      else if (++doubled == 1)
        first = files_.passages + ":" + std::to_string(row.line) + ": block '" + block.id +
                "' has a passage of screen '" + campaign_.screens[screen].id + "' already: the first one counts";
    });
    if (doubled > 1) first += "; so it is in " + std::to_string(doubled - 1) + " more rows";
    if (doubled > 0) warnings_.push_back(first);
  }

  /// Whether a screen has no part on the DEM.
  bool is_off_map(const Screen& screen) const {
    WithoutHeight length;
    for (const auto& line : screen.lines) add_line(length, campaign_.surface.heights(), line);
    return length.whole > 0.0 && length.without >= length.whole;
  }

  std::size_t screen_of(const CsvTable& table, const Row& row) const {
    const std::string& id = table.name(row, "screen");
    std::vector<std::string> ids;
    for (std::size_t s = 0; s < campaign_.screens.size(); ++s) {
      if (campaign_.screens[s].id == id) return s;
      ids.push_back(campaign_.screens[s].id);
    }
    table.refuse(row, "screen",
                 ids.empty() ? "is no screen: name the file of the screens by screens = \"screens.csv\" in the campaign"
                             : "is no screen" + known_names(id, ids));
  }

  void read_samples() {
    const CsvTable table = table_of_campaign(files_.samples, {"id", "x", "y", "z", "speed_ms", "angular_velocity_rads"},
                                             {"id", "x", "y"}, warnings_);
    std::vector<std::string> again;  // lines of samples that are there already
    warn_if_empty(files_.samples, table);
    table.for_each_row([&](const Row& row) {
      MeasuredBlock& block = block_of_row(table, row);
      const Eigen::Vector2d place = place_on_map(table, row);
      Sample sample;
      sample.x = place.x();
      sample.y = place.y();
      sample.z = table.number(row, "z", kHeight).value_or(kNotGiven);
      sample.distance = (place - Eigen::Vector2d(block.x, block.y)).norm();
      sample.speed = table.number(row, "speed_ms", kSpeed).value_or(kNotGiven);
      sample.spin = table.number(row, "angular_velocity_rads", kSpin).value_or(kNotGiven);
      const auto same = [&sample](const Sample& s) {
        const auto equal = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
        return s.x == sample.x && s.y == sample.y && equal(s.speed, sample.speed) && equal(s.spin, sample.spin);
      };
      if (std::ranges::any_of(block.samples, same))
        again.push_back(std::to_string(row.line));
      else
        block.samples.push_back(sample);
    });
    if (!again.empty())
      warnings_.push_back(files_.samples + ": samples that are there already, of which the first one counts: lines " +
                          listed(again));
  }

  /// Puts the blocks in the order of their ids and their samples in that of the distance, so that the order of rows in
  /// the files changes nothing.
  void order() {
    std::ranges::sort(campaign_.blocks, {}, &MeasuredBlock::id);
    const auto nearest_first = [](const Sample& s) {
      const auto known = [](double value) { return std::isnan(value) ? -1.0 : value; };
      return std::tuple(s.distance, s.x, s.y, known(s.speed), known(s.spin));
    };
    for (MeasuredBlock& block : campaign_.blocks) std::ranges::sort(block.samples, {}, nearest_first);
  }

  const CampaignFiles& files_;
  Campaign& campaign_;
  std::vector<std::string>& warnings_;
  std::unordered_map<std::string, std::size_t> indices_;
};

}  // namespace

CsvTable table_of_campaign(const std::string& path, std::vector<std::string> known,
                           const std::vector<std::string>& required, std::vector<std::string>& warnings) {
  const std::array<std::string, 7> remarks{"remark",  "remarks",  "note", "notes",
                                           "comment", "comments", "fid"};  // fid: of a layer in QGIS
  known.insert(known.end(), remarks.begin(), remarks.end());
  CsvTable table(path, known, required);
  std::vector<std::string> unread;
  std::ranges::copy_if(remarks, std::back_inserter(unread), [&](const std::string& name) { return table.has(name); });
  if (!unread.empty())
    warnings.push_back(path + ": " + (unread.size() > 1 ? "columns " : "column ") + joined(unread) + ": not read");
  return table;
}

void refuse_second(const CsvTable& table, const CsvTable::Row& row, std::unordered_map<std::string, int>& lines) {
  const auto [earlier, fresh] = lines.try_emplace(table.name(row, "id"), row.line);
  if (!fresh) table.refuse(row, "id", "is there already in line " + std::to_string(earlier->second));
}

Vec3 axes_of(const CsvTable& table, const CsvTable::Row& row, double diameter) {
  constexpr std::array<const char*, 3> kColumns{"L1_m", "L2_m", "L3_m"};
  std::array<std::optional<double>, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) axes[i] = table.number(row, kColumns[i], kAxis);
  if (!axes[0] && !axes[1] && !axes[2]) return Vec3::Constant(diameter);
  for (std::size_t i = 0; i < 3; ++i)
    if (!axes[i]) table.refuse(row, kColumns[i], "must be given where another axis is, or all three left empty");
  for (std::size_t i = 1; i < 3; ++i)
    if (*axes[i] > *axes[i - 1])
      table.refuse(
          row, kColumns[i],
          std::string("must not be above ") + kColumns[i - 1] + " = " + text_of(*axes[i - 1]) + " (L1 >= L2 >= L3)");
  return {*axes[0], *axes[1], *axes[2]};
}

void read_tables(const CampaignFiles& files, Campaign& campaign, std::vector<std::string>& warnings) {
  Tables(files, campaign, warnings).read();
}

}  // namespace talus::io
