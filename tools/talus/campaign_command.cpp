#include "campaign_command.hpp"

#include "talus/base/error.hpp"
#include "talus/fit/score/score.hpp"
#include "talus/io/campaign/model_file.hpp"
#include "talus/simulate/scenario/presets.hpp"

void require_measurements(const std::string& path, const talus::Campaign& campaign) {
  const std::vector<bool> rows = talus::fitting_rows(campaign);
  const talus::Model model = talus::model_of_preset(campaign, talus::kDefaultPreset);
  const auto runs = talus::observe(
      campaign, model, {.trials = 1, .threads = 1, .blocks = rows});  // which rows exist depends on no parameter
  if (!talus::score(campaign, runs, rows).groups.empty()) return;
  throw talus::InputError(path + ": nothing to fit to: " + std::to_string(talus::count_of_rows(rows)) + " of " +
                          std::to_string(rows.size()) +
                          " blocks are not held out, and no quantity (stop, mass, crossing, speed, jump, spin, sample) "
                          "has values of " +
                          std::to_string(talus::kFewestRows) +
                          " of them that differ: hold out fewer blocks, or measure more");
}

void require_releases(const std::string& path, const talus::Campaign& campaign) {
  if (campaign.deposits != nullptr)
    throw talus::InputError(path +
                            ": [deposits]: talus diagnose needs blocks of known release: a mapped pattern does not "
                            "tell a missing effect from another ground. Use talus calibrate, and talus score to "
                            "compare models that you name");
}

void CampaignCommand::add_to(CLI::App& command, std::uint32_t& trials, int fewest_trials,
                             std::vector<std::string>& keys, std::uint64_t& seed, int& threads) {
  name = "talus " + command.get_name();
  with(command.add_option("campaign", campaigns, "measured data: campaign.toml; several: docs/several-campaigns.md")
           ->required(),
       file_of({"toml"}));
  with(command.add_option("-o,--out", out, "new folder for the results")->required(), new_folder());
  command.add_flag("--overwrite", overwrite, "replace the folder if it holds an earlier result");
  add_surface(command, surface);
  with(command
           .add_option("--fit", keys,
                       "parameters, in every zone: theta_scale,psi_scale,En50,Et50 (these if it is not given),phi")
           ->delimiter(',')
           ->allow_extra_args(false),
       default_of("theta_scale,psi_scale,En50,Et50"));
  with(
      command.add_option("--trials", trials, "trajectories per block in the searches (" + std::to_string(trials) + ")")
          ->check(CLI::Range(fewest_trials, 10000)),
      default_of(trials));
  with(command.add_option("--seed", seed, "of the random numbers (1)")->check(seed_number()), scalar_of("seed"));
  add_threads(command, threads);
  add_quiet(command, quiet);
  add_progress(command, progress);
}

std::vector<talus::io::LoadedCampaign> read_campaigns(const CampaignCommand& command) {
  std::vector<talus::io::LoadedCampaign> loaded;
  for (const std::string& path : command.campaigns) loaded.push_back(talus::io::read_campaign(path, command.surface));
  catch_signals();
  return loaded;
}

void warn(const CampaignCommand& command, talus::io::FitRecord& record, const std::string& warning) {
  if (!command.quiet) say("warning", warning);
  record.warnings.push_back(warning);
}

void take_start(const std::string& file, const talus::io::OutputFolder& folder, talus::io::FitRecord& record) {
  if (file.empty()) return;
  folder.protect(file);
  record.inputs.push_back(talus::io::model_input(file));
}

void warn_of_scores(const CampaignCommand& command, talus::io::FitRecord& record, const talus::io::ScoredRows& scored,
                    const std::string& of) {
  for (const std::string& warning : talus::io::score_warnings(scored)) warn(command, record, of + warning);
}

OpenedCampaign::OpenedCampaign(const CampaignCommand& command, talus::io::FitRecord& record)
    : loaded(std::move(read_campaigns(command).front())),
      folder(command.out, command.overwrite, talus::io::OutputFolder::Unfinished::Ignore, command.name) {
  for (const talus::io::InputFile& input : loaded.inputs) folder.protect(input.path);
  for (const std::string& warning : loaded.warnings) warn(command, record, warning);
  if (command.all_rows)
    for (talus::MeasuredBlock& block : loaded.campaign.blocks) block.holdout = false;
  require_measurements(command.campaigns.front(), loaded.campaign);
  record.command = command_line();
  record.inputs = loaded.inputs;
  record.campaign = loaded.campaign.name;
  record.surface = talus::name_of(loaded.campaign.surface.kind());
  record.surface_from = loaded.surface_from;
}
