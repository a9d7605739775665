#include "talus/fit/campaign/observe.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/in_threads.hpp"
#include "talus/fit/campaign/deposits.hpp"
#include "talus/physics/tracer.hpp"
#include "talus/simulate/scenario/presets.hpp"
#include "talus/simulate/screens/screens.hpp"

namespace talus {
namespace {

constexpr std::uint32_t kTrialsPerUnit = 32;
constexpr std::uint32_t kScreenEvents = 0x800000;  // above those of the samples; 23 bits for the screen's name

/// Standard normal numbers of the measurement of one trial: four for each thing that is measured.
class Errors {
 public:
  explicit Errors(const Release& release)
      : random_(release.seed, release.source, release.block, Purpose::Measurement) {}

  std::array<double, 4> at(std::uint32_t event) const {
    const Words w = random_.words(event);
    const auto a = normal_pair(w[0], w[1]), b = normal_pair(w[2], w[3]);
    return {a[0], a[1], b[0], b[1]};
  }
  std::array<double, 4> of_stop() const { return at(0); }
  /// @param stream  of the screen's name: its place in the file does not matter
  std::array<double, 4> of_screen(std::uint32_t stream) const { return at(kScreenEvents | stream % kScreenEvents); }
  std::array<double, 4> of_sample(std::size_t sample) const { return at(1 + static_cast<std::uint32_t>(sample)); }

 private:
  Random random_;
};

/// A speed or spin as an instrument gives it: never below 0.
/// @param bias, error  relative to the value
double measured(double value, double bias, double error) {
  return std::max(0.0, value * (1.0 + bias) * (1.0 + error));
}

/// Measures the paths of one block; its buffers are reused.
class Instrument {
 public:
  Instrument(const Campaign& campaign, const Model& model, const Cover& cover, const ScreenFinder& screens,
             const Effort& effort)
      : campaign_(campaign),
        model_(model),
        cover_(cover),
        screens_(screens),
        bounded_(effort.most_vertices < Effort{}.most_vertices),
        hit_(cover.grounds.size()) {
    for (const Screen& screen : campaign.screens) screen_streams_.push_back(stream_of_name(screen.id));
  }

  void measure(const MeasuredBlock& block, const Release& release, const Path& path, std::uint32_t trial,
               BlockRuns& runs) {
    const Errors errors(release);
    crossings_.clear();
    screens_.find(release, path, crossings_);
    stop(errors, path, release.body.mass, trial, runs);
    if (campaign_.deposits != nullptr) keep_mapped(block, trial, runs);
    passages(errors, trial, runs);
    samples(errors, block, path, trial, runs);
    runs.impacts[trial] = path.impacts;
    runs.end[trial] = path.end;
    if (bounded_ && path.end == End::Limit) std::atomic_ref(runs.cut_short).fetch_add(1, std::memory_order_relaxed);
    std::atomic_ref(runs.ends[static_cast<std::size_t>(runs.end[trial])]).fetch_add(1, std::memory_order_relaxed);
    count_zones(path, runs);
  }

 private:
  void stop(const Errors& errors, const Path& path, double mass, std::uint32_t trial, BlockRuns& runs) const {
    runs.mass_share[trial] = path.mass / mass;
    if (!rests(path.end)) return;
    const auto error = errors.of_stop();
    const Vec3& end = path.vertices.back().motion.position;
    runs.x[trial] = end.x() + campaign_.error.position_m * error[0];
    runs.y[trial] = end.y() + campaign_.error.position_m * error[1];
  }

  /// Leaves out a stop where a block like this would not have been mapped.
  void keep_mapped(const MeasuredBlock& block, std::uint32_t trial, BlockRuns& runs) const {
    const MappedDeposits& deposits = *campaign_.deposits;
    const std::uint8_t region = region_at(deposits, {runs.x[trial], runs.y[trial]});
    if (region == region_at(deposits, *block.stop)) return;
    if (region != 0) std::atomic_ref(runs.elsewhere).fetch_add(1, std::memory_order_relaxed);
    runs.x[trial] = runs.y[trial] = kNotGiven;
  }

  void passages(const Errors& errors, std::uint32_t trial, BlockRuns& runs) const {
    for (const Crossing& crossing : crossings_) {
      const Bias bias = bias_of(instrument_of_screen(crossing.screen));
      BlockRuns::AtScreen& screen = runs.screens[crossing.screen];
      if (!std::isnan(screen.speed[trial])) continue;  // only the first crossing counts
      const auto error = errors.of_screen(screen_streams_[crossing.screen]);
      screen.speed[trial] = measured(crossing.speed, bias.speed, campaign_.error.speed_fraction * error[0]);
      screen.jump[trial] =
          std::max(0.0, crossing.height * (1.0 + bias.jump) + campaign_.error.jump_height_m * error[1]);
      screen.spin[trial] = measured(crossing.spin, bias.spin, campaign_.error.angular_velocity_fraction * error[2]);
    }
  }

  /// On a straight piece the distance from a place is largest at one of the ends. So a sample's distance is first
  /// reached on the first piece that ends beyond it.
  void samples(const Errors& errors, const MeasuredBlock& block, const Path& path, std::uint32_t trial,
               BlockRuns& runs) const {
    const Eigen::Vector2d origin(block.x, block.y);
    std::size_t next = 0;
    for (std::size_t i = 1; i < path.vertices.size(); ++i) {
      const Vertex &from = path.vertices[i - 1], &to = path.vertices[i];
      const Eigen::Vector2d a = from.motion.position.head<2>() - origin, b = to.motion.position.head<2>() - origin;
      for (; next < block.samples.size() && b.norm() >= block.samples[next].distance; ++next) {
        const Eigen::Vector2d way = b - a;
        const double r = block.samples[next].distance, length = way.squaredNorm(), along = way.dot(a);
        const double inside = r * r - a.squaredNorm();  // <= 0: reached at the start of the piece
        const double share =
            inside > 0.0 ? std::min(1.0, (std::sqrt(along * along + length * inside) - along) / length) : 0.0;
        record(errors, next, motion_between(from, to, share), runs.samples[next], trial);
      }
    }
  }

  void record(const Errors& errors, std::size_t sample, const Motion& motion, BlockRuns::AtSample& out,
              std::uint32_t trial) const {
    const auto error = errors.of_sample(sample);
    const Bias bias = bias_of(kSampler);
    out.speed[trial] = measured(motion.velocity.norm(), bias.speed, campaign_.error.speed_fraction * error[0]);
    out.spin[trial] = measured(motion.spin.norm(), bias.spin, campaign_.error.angular_velocity_fraction * error[1]);
  }

  void count_zones(const Path& path, BlockRuns& runs) {
    std::fill(hit_.begin(), hit_.end(), false);
    for (const Vertex& vertex : path.vertices)
      if (vertex.event == Event::Impact)
        hit_[cover_.zone_at(vertex.motion.position.x(), vertex.motion.position.y())] = true;
    for (std::size_t zone = 0; zone < hit_.size(); ++zone)
      if (hit_[zone]) std::atomic_ref(runs.zone_hits[zone]).fetch_add(1, std::memory_order_relaxed);
  }

  Bias bias_of(std::size_t instrument) const {
    return instrument < model_.bias.size() ? model_.bias[instrument] : Bias{};
  }

  const Campaign& campaign_;
  const Model& model_;
  const Cover& cover_;
  const ScreenFinder& screens_;
  const bool bounded_;  // what does not end counts as cut short
  std::vector<std::uint32_t> screen_streams_;
  std::vector<Crossing> crossings_;
  std::vector<char> hit_;  // by zone, of the path
};

void prepare(const Campaign& campaign, const MeasuredBlock& block, std::size_t zones, std::uint32_t trials,
             BlockRuns& runs) {
  const std::vector<double> none(trials, kNotGiven);
  runs.trials = trials;
  runs.x = runs.y = runs.mass_share = none;
  runs.screens.assign(campaign.screens.size(), {none, none, none});
  runs.samples.assign(block.samples.size(), {none, none});
  runs.impacts.assign(trials, 0);
  runs.end.assign(trials, End::Limit);
  runs.zone_hits.assign(zones, 0);
  runs.cut_short = 0;
}

/// Some trials of one block.
struct Unit {
  std::uint32_t block, first, end;
};

std::vector<Unit> units_of(const Campaign& campaign, std::size_t zones, const ObserveOptions& options,
                           std::vector<BlockRuns>& runs) {
  std::vector<Unit> units;
  for (std::uint32_t block = 0; block < campaign.blocks.size(); ++block) {
    if (!options.blocks.empty() && !options.blocks[block]) continue;
    prepare(campaign, campaign.blocks[block], zones, options.trials, runs[block]);
    for (std::uint32_t first = 0; first < options.trials; first += kTrialsPerUnit)
      units.push_back({block, first, std::min(options.trials, first + kTrialsPerUnit)});
  }
  return units;
}

/// All trials that are asked for, and the threads that trace them.
class Observation {
 public:
  Observation(const Campaign& campaign, const Model& model, const ObserveOptions& options, const World& world)
      : campaign_(campaign),
        model_(model),
        options_(options),
        world_(world),
        screens_(campaign.surface, campaign.screens),
        runs_(campaign.blocks.size()),
        units_(units_of(campaign, model.grounds.size(), options, runs_)) {}

  std::vector<BlockRuns> run() {
    in_threads(
        options_.threads, [this] { work(); }, [this] { stop_ = true; });
    return std::move(runs_);
  }

 private:
  /// Traces trials until none is left.
  void work() {
    Instrument instrument(campaign_, model_, world_.cover, screens_, options_.effort);
    Tracer tracer(world_, options_.lanes);
    Unit unit{};
    std::uint64_t vertices = 0;
    tracer.run([&](Release& release, std::uint64_t& tag) { return next(unit, release, tag); },
               [&](const Release& release, const Path& path, std::uint64_t tag) {
                 vertices += path.vertices.size();
                 done(instrument, release, path, tag);
               });
    if (options_.traced != nullptr) *options_.traced += vertices;
  }

  /// The next trial of the unit of a thread, or of another that it takes.
  bool next(Unit& unit, Release& release, std::uint64_t& tag) {
    if (unit.first == unit.end) {
      const std::size_t place = stop_ ? units_.size() : taken_++;
      if (place >= units_.size()) return false;
      unit = units_[place];
    }
    const std::uint32_t trial = unit.first++;
    release = release_of(campaign_, unit.block, options_.seed, options_.first_trial + trial);
    tag = std::uint64_t{unit.block} << 32U | trial;
    return true;
  }

  void done(Instrument& instrument, const Release& release, const Path& path, std::uint64_t tag) {
    const auto block = static_cast<std::uint32_t>(tag >> 32U), trial = static_cast<std::uint32_t>(tag);
    instrument.measure(campaign_.blocks[block], release, path, trial, runs_[block]);
    const bool ends_unit = trial + 1 == options_.trials || (trial + 1) % kTrialsPerUnit == 0;
    if (ends_unit && options_.proceed && !options_.proceed()) stop_ = true;
  }

  const Campaign& campaign_;
  const Model& model_;
  const ObserveOptions& options_;
  const World& world_;
  ScreenFinder screens_;
  std::vector<BlockRuns> runs_;
  std::vector<Unit> units_;
  std::atomic<std::size_t> taken_{0};
  std::atomic<bool> stop_{false};
};

/// Moves the release of a mapped block to a source: each is as likely as its area.
void release_from_source(const Campaign& campaign, const Words& words, Release& release) {
  const DepositSource& source = source_at(*campaign.deposits, uniform(words[0]));
  const Grid& grid = campaign.surface.grid();
  const double x = source.place.x() + (source.point ? 0.0 : (uniform(words[1]) - 0.5) * grid.cell_x);
  const double y = source.place.y() + (source.point ? 0.0 : (uniform(words[2]) - 0.5) * grid.cell_y);
  const double height = source.release_height.at(uniform(words[3]));
  release.motion.position = {x, y, campaign.surface.height(x, y).value_or(kNotGiven) + height};
  release.motion.velocity = source.velocity;
}

}  // namespace

std::vector<Eigen::Vector2d> stops_of(const BlockRuns& runs) {
  std::vector<Eigen::Vector2d> stops;
  for (std::size_t t = 0; t < runs.trials; ++t)
    if (!std::isnan(runs.x[t])) stops.emplace_back(runs.x[t], runs.y[t]);
  return stops;
}

Model model_of_preset(const Campaign& campaign, std::string_view preset) {
  Model model;
  model.grounds.assign(std::max<std::size_t>(1, campaign.zone_names.size()), find_preset(preset).ground);
  return model;
}

Release release_of(const Campaign& campaign, std::uint32_t block, std::uint64_t seed, std::uint32_t trial) {
  const MeasuredBlock& measured = campaign.blocks[block];
  const Words words = Random(seed, measured.stream, trial, Purpose::Release).words(0);
  const SineCosine direction = sine_cosine_of_turn(uniform(words[0]));
  const double radius = measured.release_radius * std::sqrt(uniform(words[1]));
  const double x = measured.x + radius * direction.cosine, y = measured.y + radius * direction.sine;
  Release release;
  release.seed = seed;
  release.source = measured.stream;
  release.block = trial;
  release.body = body_of(measured);
  release.motion.position = {x, y, campaign.surface.height(x, y).value_or(kNotGiven) + measured.release_height};
  release.motion.velocity = measured.velocity;
  release.day = measured.day;
  if (campaign.deposits != nullptr) release_from_source(campaign, words, release);
  return release;
}

std::vector<BlockRuns> observe(const Campaign& campaign, const Model& model, const ObserveOptions& options) {
  const Cover cover{model.grounds, model.zones.values.empty() ? campaign.zones : model.zones};
  const Barriers barriers(model.barriers);
  const World world{campaign.surface,
                    cover,
                    model.impact,
                    EndRules{},
                    model.effects.any() ? &model.effects : nullptr,
                    barriers.empty() ? nullptr : &barriers,
                    options.effort};
  return Observation(campaign, model, options, world).run();
}

}  // namespace talus
