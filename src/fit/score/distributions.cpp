#include "talus/fit/score/distributions.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/sample.hpp"
#include "talus/fit/campaign/deposits.hpp"
#include "talus/fit/score/score.hpp"
#include "talus/fit/score/tail.hpp"

namespace talus {
namespace {

/// Measured and simulated values of one quantity, without NaN.
struct Values {
  std::vector<double> measured, simulated;

  void measure(double value) {
    if (!std::isnan(value)) measured.push_back(value);
  }
  void simulate(std::span<const double> values) {
    for (const double value : values)
      if (!std::isnan(value)) simulated.push_back(value);
  }

  void add_to(Comparison& out, const std::string& name, const char* unit) {
    if (measured.size() < kFewestRows || simulated.empty()) return;
    std::sort(measured.begin(), measured.end());
    std::sort(simulated.begin(), simulated.end());
    Distribution d{name, unit, measured.size(), simulated.size(), {}, {}};
    for (std::size_t i = 0; i < kCompared.size(); ++i) {
      d.measured[i] = quantile(measured, kCompared[i]);
      d.simulated[i] = quantile(simulated, kCompared[i]);
    }
    out.distributions.push_back(std::move(d));
  }
};

void compare_runout(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                    Comparison& out) {
  Values runout;
  for (std::size_t b = 0; b < runs.size(); ++b) {
    const MeasuredBlock& block = campaign.blocks[b];
    if (!ask[b] || !block.stop) continue;
    runout.measure(runout_of(campaign, block));
    runout.simulate(runouts_of(campaign, block, runs[b]));
  }
  runout.add_to(out, "runout", "m");
}

/// Distance and angle from the nearest source, of blocks that were mapped where they lie.
void compare_deposits(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                      Comparison& out) {
  Values distance, angle;
  for (std::size_t b = 0; b < runs.size(); ++b) {
    if (!ask[b]) continue;
    const RunOut measured = run_out(campaign, *campaign.blocks[b].stop);
    distance.measure(measured.distance);
    angle.measure(degrees(measured.angle));
    for (std::uint32_t t = 0; t < runs[b].trials; ++t) {
      const RunOut simulated = run_out(campaign, {runs[b].x[t], runs[b].y[t]});
      distance.simulate({&simulated.distance, 1});
      const double below = degrees(simulated.angle);
      angle.simulate({&below, 1});
    }
  }
  distance.add_to(out, "distance from the nearest source", "m");
  angle.add_to(out, "run-out angle", "deg");
}

void compare_screen(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask,
                    std::size_t screen, Comparison& out) {
  Values speed, jump, spin;
  double blocks = 0.0, hits = 0.0, trials = 0.0;
  for (std::size_t b = 0; b < runs.size(); ++b) {
    if (!ask[b]) continue;
    blocks += 1.0;
    trials += runs[b].trials;
    speed.simulate(runs[b].screens[screen].speed);
    jump.simulate(runs[b].screens[screen].jump);
    spin.simulate(runs[b].screens[screen].spin);
    const auto& passage = campaign.blocks[b].passages[screen];
    if (!passage) continue;
    hits += 1.0;
    speed.measure(passage->speed);
    jump.measure(passage->jump);
    spin.measure(passage->spin);
  }
  const std::string id = campaign.screens[screen].id;
  if (blocks > 0.0 && trials > 0.0)
    out.crossings.push_back({id, hits / blocks, static_cast<double>(speed.simulated.size()) / trials});
  speed.add_to(out, "speed " + id, "m/s");
  jump.add_to(out, "jump " + id, "m");
  spin.add_to(out, "spin " + id, "rad/s");
}

}  // namespace

Comparison compare(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask) {
  Comparison out;
  if (campaign.deposits != nullptr)
    compare_deposits(campaign, runs, ask, out);
  else
    compare_runout(campaign, runs, ask, out);
  for (std::size_t s = 0; s < campaign.screens.size(); ++s) compare_screen(campaign, runs, ask, s, out);
  Values speed, spin;
  for (std::size_t b = 0; b < runs.size(); ++b) {
    const auto& samples = campaign.blocks[b].samples;
    for (std::size_t i = 0; ask[b] && i < samples.size(); ++i) {
      speed.measure(samples[i].speed);
      spin.measure(samples[i].spin);
      if (!std::isnan(samples[i].speed)) speed.simulate(runs[b].samples[i].speed);
      if (!std::isnan(samples[i].spin)) spin.simulate(runs[b].samples[i].spin);
    }
  }
  speed.add_to(out, "sample speed", "m/s");
  spin.add_to(out, "sample spin", "rad/s");
  return out;
}

}  // namespace talus
