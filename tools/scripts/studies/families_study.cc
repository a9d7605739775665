// Size and power of the tests of families on a campaign: see families_study.py, which compiles and calls it.
#include <cstdio>
#include <cstring>
#include <numeric>

#include "talus/base/random.hpp"
#include "talus/fit/calibrate/calibrate.hpp"
#include "talus/fit/diagnose/energy_component.hpp"
#include "talus/fit/diagnose/property_test.hpp"
#include "talus/fit/diagnose/residual_table.hpp"
#include "talus/io/campaign/campaign_file.hpp"
#include "talus/io/campaign/model_file.hpp"

using namespace talus;

namespace {

constexpr std::uint32_t kTrials = 600;
constexpr int kDraws = 2000;

/// A number in (0, 1) of a draw and a block.
double number(std::uint32_t draw, std::size_t block, std::uint32_t event) {
  return uniform(Random(77, draw, static_cast<std::uint32_t>(block), Purpose::Bootstrap, 9).words(event)[0]);
}

std::size_t trial_of(std::uint32_t draw, std::size_t block) {
  return static_cast<std::size_t>(number(draw, block, 0) * kTrials);
}

/// `n` blocks: those of the campaign in turn, each with an id of its own.
Campaign with_blocks(const Campaign& campaign, std::size_t n, const std::vector<std::size_t>& rows) {
  Campaign c = campaign;
  c.blocks.clear();
  for (std::size_t i = 0; i < n; ++i) {
    c.blocks.push_back(campaign.blocks[rows[i % rows.size()]]);
    c.blocks.back().id += "-" + std::to_string(i / rows.size());
  }
  return c;
}

struct Study {
  const Campaign& campaign;
  const ResidualSpace& space;
  const std::vector<BlockRuns>& runs;  // of the model that is tested
  const EnergyComponent& energy;
  std::vector<std::size_t> rows;
  mutable double correlation = 0.0;  // mean rank correlation of the last draws with L1/L2

  /// Share of draws with p <= 0.05 of the property test; n blocks.
  /// @param truth    runs of the model that makes the data
  /// @param scatter  by which the residuals are multiplied
  /// @param sites    two sites, the heavier blocks mostly at the second, where all go further
  /// @param made     if not empty: n copies of the rows, of which each is drawn anew
  double alarms(const std::vector<BlockRuns>& truth, std::size_t n, double scatter, bool sites) const {
    Campaign c = with_blocks(campaign, n, rows);
    int alarms = 0;
    correlation = 0.0;
    for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
      std::vector<double> a;
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t b = rows[i % rows.size()];
        a.push_back(scatter * energy.of(b, space.of_trial(b, truth[b], trial_of(draw, i))));
        if (!sites) continue;
        const bool second = number(draw, i, 1) < (c.blocks[i].mass > 700.0 ? 0.75 : 0.25);
        c.blocks[i].group = second ? "second" : "first";
        if (second) a.back() += 1.5;
      }
      DiagnosisRules rules;
      rules.arrangements = 1000;
      std::vector<double> seen, of;
      for (std::size_t i = 0; i < n; ++i)
        if (!std::isnan(a[i])) seen.push_back(a[i]), of.push_back(c.blocks[i].axes.x() / c.blocks[i].axes.y());
      correlation += spearman(seen, of) / kDraws;
      alarms += property_test(c, a, rules, draw).regression.permuted.p_value <= 0.05 ? 1 : 0;
    }
    return 100.0 * alarms / kDraws;
  }
};

/// Takes trials of the model as the measurements, in place of the stops.
void measure(Campaign& c, const std::vector<BlockRuns>& runs, std::uint32_t draw) {
  for (std::size_t b = 0; b < c.blocks.size(); ++b) {
    if (runs[b].trials == 0) continue;
    const std::size_t t = trial_of(draw, b);
    c.blocks[b].stop.reset();
    if (!std::isnan(runs[b].x[t])) c.blocks[b].stop = Eigen::Vector2d(runs[b].x[t], runs[b].y[t]);
    for (std::size_t s = 0; s < c.screens.size(); ++s) {
      const auto& at = runs[b].screens[s];
      c.blocks[b].passages[s].reset();
      if (!std::isnan(at.speed[t])) c.blocks[b].passages[s] = Passage{at.speed[t], at.jump[t], at.spin[t]};
    }
  }
}

void print_measured(const Study& s) {
  std::vector<double> a(s.campaign.blocks.size(), kNotGiven);
  for (const std::size_t b : s.rows) a[b] = s.energy.of_measured(b);
  const PropertyTest p = property_test(s.campaign, a, {}, 1);
  std::printf("property: %zu blocks, %zu rocks, by rock %d, sites %zu: F %.2f, p of F %.2g, permuted p %.4g of %zu%s\n",
              p.blocks, p.rocks, p.by_rock, p.sites, p.regression.f, p.regression.p_of_f, p.regression.permuted.p_value,
              p.regression.permuted.arrangements, p.regression.permuted.exact ? " (all)" : "");
  for (std::size_t i = 0; i < p.names.size(); ++i)
    std::printf("  %s: partial correlation %.2f, p %.2g\n", p.names[i].c_str(), p.slopes[i].correlation,
                p.slopes[i].p_value);
  const DayTest d = day_test(s.campaign, a, {}, 1);
  if (d.tested) std::printf("day: %zu days, p %.4g\n", d.days.size(), d.regression.permuted.p_value);
}

/// Data of the model, the ground fitted to them anew, and the tests: does the fit change their size?
void refitted(const Campaign& campaign, const Model& model, const std::vector<BlockRuns>& truth,
              const std::vector<std::size_t>& rows, int sets) {
  Campaign c = campaign;
  std::vector<bool> used(c.blocks.size(), false);
  for (const std::size_t b : rows) used[b] = true;
  const auto free =
      ground_parameters(c, model, std::vector<std::string>{"theta_scale", "Et50"}, touched_zones(c, truth));
  int property[2] = {0, 0};
  for (int set = 0; set < sets; ++set) {
    measure(c, truth, static_cast<std::uint32_t>(set));
    FitOptions how;
    how.trials = 24, how.comparison_trials = 100, how.starts = 0, how.rounds = 3, how.seed = 100 + set, how.threads = 1;
    const Fit fit = fit_parameters(c, model, free, used, how);
    const Model* models[2] = {&model, &fit.model};
    for (int k = 0; k < 2; ++k) {
      const auto runs = observe(c, *models[k], {200, 900 + static_cast<std::uint64_t>(set), kUnseen, 1, used, {}});
      const ResidualSpace space(c, runs);
      const EnergyComponent energy(space, runs);
      std::vector<double> a(c.blocks.size(), kNotGiven);
      for (const std::size_t b : rows) a[b] = energy.of_measured(b);
      DiagnosisRules rules;
      rules.arrangements = 1000;
      property[k] += property_test(c, a, rules, set).regression.permuted.p_value <= 0.05;
    }
  }
  std::printf("%zu parameters of the ground, %zu blocks\n", free.size(), rows.size());
  for (int k = 0; k < 2; ++k)
    std::printf("%s: p <= 0.05 of %d sets: property %d\n",
                k == 0 ? "the model that made the data" : "the ground fitted to each set", sets, property[k]);
}

}  // namespace

/// Usage: families_study CAMPAIGN MODEL all|fit [--truth MODEL] [--refit SETS] [--surface KIND]
int main(int count, char** words) {
  std::string truth, surface;
  int sets = 0;
  for (int i = 4; i + 1 < count; i += 2) {
    if (std::strcmp(words[i], "--truth") == 0) truth = words[i + 1];
    if (std::strcmp(words[i], "--refit") == 0) sets = std::atoi(words[i + 1]);
    if (std::strcmp(words[i], "--surface") == 0) surface = words[i + 1];
  }
  io::LoadedCampaign loaded =
      io::read_campaign(words[1], surface.empty() ? std::nullopt : std::optional<std::string>(surface));
  Campaign& campaign = loaded.campaign;
  const Model model = io::read_model(words[2], campaign);
  if (std::strcmp(words[3], "all") == 0)
    for (MeasuredBlock& b : campaign.blocks) b.holdout = false;
  std::vector<std::size_t> rows;
  for (std::size_t b = 0; b < campaign.blocks.size(); ++b)
    if (!campaign.blocks[b].holdout) rows.push_back(b);
  const ObserveOptions how{kTrials, 1, kUnseen, 1, fitting_rows(campaign), {}};
  const std::vector<BlockRuns> runs = observe(campaign, model, how);
  if (sets > 0) {
    refitted(campaign, model, runs, rows, sets);
    return 0;
  }
  const ResidualSpace space(campaign, runs);
  const EnergyComponent energy(space, runs);
  const Study study{campaign, space, runs, energy, rows};
  print_measured(study);
  const std::size_t n = rows.size();
  std::printf("size of the property test, %% of %d draws: %.1f; scatter x1.6: %.1f; two sites that differ: %.1f\n",
              kDraws, study.alarms(runs, n, 1.0, false), study.alarms(runs, n, 1.6, false),
              study.alarms(runs, n, 1.0, true));
  if (truth.empty()) return 0;
  ObserveOptions other = how;
  other.seed = 2;
  const std::vector<BlockRuns> with = observe(campaign, io::read_model(truth, campaign), other);
  for (const std::size_t blocks : {24, 48, 89}) {
    const double power = study.alarms(with, blocks, 1.0, false);
    std::printf("power at %zu blocks: %.0f %% (mean rank correlation with L1/L2 %.2f)\n", blocks, power,
                study.correlation);
  }
}
