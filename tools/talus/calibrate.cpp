#include "talus/fit/calibrate/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

#include "campaign_command.hpp"
#include "progress.hpp"
#include "several_campaigns.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/fit/calibrate/effect_parameters.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"
#include "talus/io/campaign/model_file.hpp"
#include "talus/io/reports/fit_report.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace {

struct CalibrateOptions : CampaignCommand {
  std::vector<std::string> fit{"theta_scale", "psi_scale", "En50", "Et50"};
  std::string parameters;          // file of the model from which the fit starts; empty: the default preset
  std::vector<std::string> share;  // parameters that several campaigns share
  talus::FitOptions how;
};

std::vector<talus::BlockRuns> runs_of(const talus::Campaign& campaign, const talus::Model& model,
                                      const talus::io::Calibration& c, const std::vector<bool>& blocks) {
  const talus::ObserveOptions how{.trials = c.score_trials,
                                  .seed = c.options.seed,
                                  .first_trial = talus::kUnseen,
                                  .threads = c.options.threads,
                                  .blocks = blocks,
                                  .proceed = [] { return !interrupted(); }};
  std::vector<talus::BlockRuns> runs = talus::observe(campaign, model, how);
  if (interrupted()) stop_interrupted();
  return runs;
}

/// Scores start and fit on both kinds of rows, with trials of their own.
void score_both(const talus::Campaign& campaign, talus::io::Calibration& c) {
  const std::vector<bool> all(campaign.blocks.size(), true);
  const auto before = runs_of(campaign, c.start, c, all), after = runs_of(campaign, c.fit.model, c, all);
  for (const auto& [name, rows] :
       {std::pair{"fit", talus::fitting_rows(campaign)}, std::pair{"holdout", talus::holdout_rows(campaign)}}) {
    c.errors.push_back(talus::io::compared(campaign, talus::io::scored(name, campaign, before, rows),
                                           talus::io::scored(name, campaign, after, rows)));
  }
  c.errors.front().after.fitted = talus::effective_numbers(c.uncertainty);
  c.comparison = talus::compare(campaign, after, all);
}

void print_summary(const talus::io::Calibration& c, const std::string& folder) {
  for (std::size_t i = 0; i < c.free.size(); ++i) {
    const talus::Interval& interval = c.uncertainty.intervals[i];
    const std::string note = talus::io::interval_note(c.uncertainty.identifiable[i], c.uncertainty.at_bound[i]);
    print("%-44s %8.3g  95 %%: %.3g to %.3g%s%s\n", c.free[i].key.c_str(), c.free[i].get(c.fit.model), interval.low,
          interval.high, note.empty() ? "" : "  ", note.c_str());
  }
  for (const std::string& zone : c.untouched)
    print("zone %s: too few simulated paths touch it; not fitted\n", zone.c_str());
  for (const talus::io::BeforeAfter& e : c.errors) {
    if (std::isnan(e.after.score.total)) continue;  // no group has five rows: the report says so
    print("error, %s rows (%zu blocks): %.3f before, %.3f after (lower by %s)\n",
          talus::io::rows_in_words(e.after.rows).c_str(), e.after.blocks, e.before.score.total, e.after.score.total,
          talus::io::gain_of_fit(e).c_str());
    print_text(talus::io::judgement_lines(e.after));
  }
  if (c.fit.score.cut_short > 0.0)
    print("%s\n", talus::io::cut_short_line(c.fit.score.cut_short, c.options.rules.most_vertices).c_str());
  print("written: %s\n", folder.c_str());
}

int calibrate(const CalibrateOptions& options) {
  if (options.campaigns.size() > 1)
    return calibrate_sites(options, options.how, options.parameters, options.fit, options.share);
  if (!options.share.empty())
    throw talus::InputError(
        "--share " + talus::joined(options.share) +
        ": there is one campaign, must be several: talus calibrate a/campaign.toml b/campaign.toml");
  talus::io::Calibration c;
  OpenedCampaign opened(options, c);
  const talus::Campaign& campaign = opened.loaded.campaign;
  talus::io::OutputFolder& folder = opened.folder;
  c.options = options.how;
  c.start_name = options.parameters.empty() ? std::string(talus::kDefaultPreset) : options.parameters;
  std::vector<std::string> of_start;
  c.start = start_model(options.parameters, campaign, of_start);
  take_start(options.parameters, folder, c);
  for (const std::string& warning : of_start) warn(options, c, warning);
  choose_parameters(campaign, options.fit, c);
  const std::vector<bool> rows = talus::fitting_rows(campaign);
  Progress progress(Progress::mode_of(options.quiet, options.progress), 0, "fit");
  std::tie(c.fit, c.uncertainty) =
      fit_with_uncertainty({campaign, c.start, c.free, rows}, c.options, 1.0,
                           [&](double share) { return progress.update(share) && !interrupted(); });
  for (std::size_t i = 0; i < c.free.size(); ++i)
    if (c.uncertainty.at_bound[i])
      warn(options, c, talus::io::bound_warning(c.free[i].key, c.uncertainty.intervals[i]));
  score_both(campaign, c);
  for (const talus::io::BeforeAfter& e : c.errors) {
    for (const std::string& warning : talus::io::unscored_warnings(e.before)) warn(options, c, "start: " + warning);
    warn_of_scores(options, c, e.after);
  }

  talus::io::write_text(folder.temporary() / "calibration.json", talus::io::calibration_json(c));
  talus::io::write_text(folder.temporary() / "report.md", talus::io::calibration_report(c));
  if (const std::string ranks = talus::io::ranks_picture(c.errors); !ranks.empty())
    talus::io::write_text(folder.temporary() / "ranks.svg", ranks);
  talus::io::write_text(folder.temporary() / "fitted.toml",
                        talus::io::model_text(c.fit.model, opened.loaded,
                                              "Fitted by talus calibrate to the campaign " + campaign.name +
                                                  ".\nUncertainty, and what is not identifiable: report.md.",
                                              talus::io::skill_of_model(c.errors.front().after, c.errors.back().after,
                                                                        talus::clusters_of(campaign))));
  folder.commit();
  progress.finish();
  if (!options.quiet) print_summary(c, folder.final_path().string());
  return 0;
}

}  // namespace

talus::Model start_model(const std::string& file, const talus::Campaign& campaign, std::vector<std::string>& warnings) {
  return file.empty() ? talus::model_of_preset(campaign, talus::kDefaultPreset)
                      : talus::io::read_model(file, campaign, &warnings);
}

std::pair<talus::Fit, talus::Uncertainty> fit_with_uncertainty(const talus::FitProblem& problem, talus::FitOptions how,
                                                               double share,
                                                               const std::function<bool(double)>& proceed) {
  constexpr double kSearch = 0.7;  // its share of the two
  how.proceed = [&](double done) { return proceed(share * kSearch * done); };
  talus::Fit fit = talus::fit_parameters(problem, how);
  if (fit.interrupted) stop_interrupted();
  how.proceed = [&](double done) { return proceed(share * (kSearch + (1.0 - kSearch) * done)); };
  talus::Uncertainty uncertainty = talus::uncertainty_of(problem, how, {}, fit);
  if (uncertainty.interrupted) stop_interrupted();
  return {std::move(fit), std::move(uncertainty)};
}

void choose_parameters(const talus::Campaign& campaign, const std::vector<std::string>& keys,
                       talus::io::Calibration& c) {
  const auto runs = runs_of(campaign, c.start, c, talus::fitting_rows(campaign));
  const std::vector<bool> touched = talus::touched_zones(campaign, runs);
  for (std::size_t zone = 0; zone < touched.size(); ++zone) {
    const auto& cells = campaign.zones.values;
    const bool there = zone > 0 || cells.empty() || std::find(cells.begin(), cells.end(), 0) != cells.end();
    if (!touched[zone] && there) c.untouched.push_back(campaign.zone_names[zone]);
  }
  std::vector<std::string> of_ground, of_effects;
  for (const std::string& key : keys) (key.starts_with("effects.") ? of_effects : of_ground).push_back(key);
  if (!of_ground.empty()) c.free = talus::ground_parameters(campaign, c.start, of_ground, touched);
  talus::check_start(c.free, c.start);
  for (talus::Parameter& p : talus::effect_parameters(campaign, c.start, of_effects, talus::DiagnosisRules{}.noticed))
    c.free.push_back(std::move(p));
}

void add_calibrate(CLI::App& app, Action& action) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand("calibrate", "Fit the parameters of the ground to measured data");
  const int fewest_trials = static_cast<int>(talus::DiagnosisRules{}.fewest_of_one);
  options->add_to(*command, options->how.trials, fewest_trials, options->fit, options->how.seed, options->how.threads);
  with(command->add_option(
           "--parameters", options->parameters,
           "model from which the fit starts, whose effects it keeps; else upper-talus-3d without effects"),
       file_of({"toml"}));
  with(command->add_option("--starts", options->how.starts, "searches from different starts (3)")
           ->check(CLI::Range(1, 50)),
       default_of(options->how.starts));
  command->add_option("--share", options->share, "parameters that several campaigns share; all others each has its own")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->footer(
      "Example:\n  talus calibrate campaign.toml -o result\n"
      "  talus calibrate a/campaign.toml b/campaign.toml --fit En50,phi --share phi -o result\n\n"
      "--fit takes numbers of effects, too: --fit theta_scale,effects.rest-in-roughness.kappa\n"
      "OUT: fitted.toml (the model: for talus score, and to include in a scenario), report.md, ranks.svg, "
      "calibration.json.");
  command->callback([&action, options] { action = [options] { return calibrate(*options); }; });
}
