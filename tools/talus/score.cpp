#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "talus/base/error.hpp"
#include "talus/io/campaign/model_file.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/reports/score_report.hpp"
#include "talus/io/results/write_block_runs.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace {

constexpr std::uint32_t kFewestTrials = 100;  // for each block of a score that is reported

struct ScoreOptions {
  std::string campaign, parameters, preset, rows = "all", dump;
  std::optional<std::string> surface;
  std::uint32_t trials = 100;
  std::uint64_t seed = 1;
  int threads = 0;
  bool json = false, quiet = false;
};

/// The scores of the rows that are asked for: the fitting rows first.
std::vector<talus::io::ScoredRows> scores_of(const std::string& rows, const talus::Campaign& campaign,
                                             const std::vector<talus::BlockRuns>& runs) {
  std::vector<talus::io::ScoredRows> scores;
  if (rows != "holdout") scores.push_back(talus::io::scored("fit", campaign, runs, talus::fitting_rows(campaign)));
  if (rows != "fit") scores.push_back(talus::io::scored("holdout", campaign, runs, talus::holdout_rows(campaign)));
  return scores;
}

/// @throws InputError  where there is no row that gives the spread of the measurements, or none to score
void refuse_nothing(const ScoreOptions& options, const talus::Campaign& campaign,
                    const std::vector<talus::io::ScoredRows>& scores) {
  const std::vector<bool> fitting = talus::fitting_rows(campaign);
  if (talus::count_of_rows(fitting) == 0)
    throw talus::InputError(
        options.campaign + ": nothing to score: all " + std::to_string(fitting.size()) +
        " blocks are held out (holdout = 1), must be some that are not: these give the spread of the "
        "measurements, in which errors are counted");
  if (std::all_of(scores.begin(), scores.end(), [](const auto& s) { return s.score.groups.empty(); }))
    throw talus::InputError(options.campaign + ": nothing to score: no quantity has values of " +
                            std::to_string(talus::kFewestRows) +
                            " of the asked blocks that differ: measure more, or see by --dump what the model does" +
                            (options.rows == "all" ? "" : ", or ask for --rows all"));
}

/// The model that is asked for: that of a file, or a preset in every zone.
talus::Model model_of(const ScoreOptions& options, const talus::Campaign& campaign,
                      std::vector<std::string>& warnings) {
  if (options.parameters.empty() == options.preset.empty())
    throw talus::InputError("score: give the model, either --parameters fitted.toml, or --preset " +
                            std::string(talus::kDefaultPreset) +
                            " (or another that talus presets lists) for a ground that nobody has fitted");
  if (!options.preset.empty() && talus::is_of_plane(talus::find_preset(options.preset)))
    warnings.push_back("--preset " + options.preset +
                       ": is of the 2D model, psi_scale = 0: blocks are not turned sideways, so that what was measured "
                       "across the slope scores too badly: take a preset whose name ends in -3d");
  return options.preset.empty() ? talus::io::read_model(options.parameters, campaign, &warnings)
                                : talus::model_of_preset(campaign, options.preset);
}

int score_model(const ScoreOptions& options) {
  talus::io::LoadedCampaign loaded = talus::io::read_campaign(options.campaign, options.surface);
  const talus::Campaign& campaign = loaded.campaign;
  const talus::Model model = model_of(options, campaign, loaded.warnings);
  if (options.trials < kFewestTrials)
    loaded.warnings.push_back(
        "--trials " + std::to_string(options.trials) + ": must be " + std::to_string(kFewestTrials) +
        " at least for a score to rest on: rows with few simulated values score as the climatology");
  catch_signals();
  if (!options.quiet)
    for (const std::string& warning : loaded.warnings) say("warning", warning);
  std::optional<talus::io::OutputFolder> dump;
  if (!options.dump.empty()) {
    if (std::filesystem::is_directory(options.dump) && !std::filesystem::is_empty(options.dump))
      throw talus::InputError(options.dump + ": the folder is there and not empty; give a new name");
    dump.emplace(options.dump, false);
  }

  talus::ObserveOptions how;
  how.trials = options.trials;
  how.seed = options.seed;
  how.first_trial = talus::kUnseen;  // as the errors of talus calibrate
  how.threads = options.threads;
  how.proceed = [] { return !interrupted(); };
  if (options.rows != "all")
    how.blocks = options.rows == "fit" ? talus::fitting_rows(campaign) : talus::holdout_rows(campaign);
  const std::vector<talus::BlockRuns> runs = talus::observe(campaign, model, how);
  if (interrupted()) stop_interrupted();

  const std::vector<talus::io::ScoredRows> scores = scores_of(options.rows, campaign, runs);
  if (!dump) refuse_nothing(options, campaign, scores);
  std::vector<std::string> warnings = loaded.warnings;
  for (const talus::io::ScoredRows& s : scores)
    for (const std::string& warning : talus::io::score_warnings(s)) {
      if (!options.quiet) say("warning", warning);
      warnings.push_back(warning);
    }
  const talus::io::ScoreSettings settings{campaign.name, options.trials, options.seed,
                                          std::string(talus::name_of(campaign.surface.kind())), warnings};
  const std::string text =
      options.json ? talus::io::score_json(settings, scores) : talus::io::score_table(settings, scores);
  if (dump) {
    talus::io::write_block_runs(dump->temporary(), loaded, runs);
    dump->commit();
  }
  print_text(text);
  return 0;
}

}  // namespace

void add_score(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ScoreOptions>();
  CLI::App* command = app.add_subcommand("score", "Say how far a model is from measured data, group by group");
  with(command->add_option("campaign", options->campaign, "measured data: campaign.toml")->required(),
       file_of({"toml"}));
  with(command->add_option("--parameters", options->parameters, "the model: fitted.toml, as talus calibrate writes it"),
       file_of({"toml"}));
  with(command->add_option("--preset", options->preset,
                           "in place of a model: a parameter set in every zone, without effects; talus presets lists "
                           "them"),
       preset_choice(""));
  add_surface(*command, options->surface);
  with(command->add_option("--trials", options->trials, "simulated trajectories per block (100)")
           ->check(CLI::Range(10, 100000)),
       default_of(options->trials));
  with(command->add_option("--seed", options->seed, "of the random numbers (1)")->check(seed_number()),
       scalar_of("seed"));
  with(command->add_option("--rows", options->rows, "fit, holdout or all (all)")
           ->check(CLI::IsMember({"fit", "holdout", "all"})),
       default_of(options->rows));
  command->add_flag("--json", options->json, "print JSON");
  with(command->add_option("--dump", options->dump, "new folder for what was simulated, by block and trial (CSV)"),
       new_folder());
  add_threads(*command, options->threads);
  command->add_flag("-q,--quiet", options->quiet, "say nothing but errors and the result");
  command->footer(
      "Example:\n  talus score campaign.toml --parameters result/fitted.toml\n"
      "  talus score campaign.toml --preset upper-talus-3d\n\n"
      "0: the model gives the measured value exactly; about 0.56: it knows only the spread of the measurements.");
  command->callback([&action, options] { action = [options] { return score_model(*options); }; });
}
