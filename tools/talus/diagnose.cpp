#include <chrono>
#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "progress.hpp"
#include "talus/base/error.hpp"
#include "talus/io/campaign_file.hpp"
#include "talus/io/diagnosis_report.hpp"
#include "talus/io/model_file.hpp"
#include "talus/io/output_folder.hpp"
#include "talus/simulate/presets.hpp"

namespace {

struct Options {
  std::string campaign, out, progress;
  talus::DiagnoseOptions how;
  bool overwrite = false, quiet = false;
};

void print_summary(const talus::io::DiagnosisRecord& record, const std::string& folder) {
  const talus::Diagnosis& d = record.diagnosis;
  for (std::size_t i = 0; i < d.rounds.size(); ++i) {
    const talus::Round& round = d.rounds[i];
    std::printf("round %zu: %s", i + 1, round.effect.c_str());
    if (!round.where.empty()) std::printf(", %s", round.where.c_str());
    for (const std::string& other : round.alike)
      std::printf("%s %s", &other == &round.alike.front() ? "; not to be told apart from" : ",", other.c_str());
    std::printf(" (p of noise %.4f)\n", round.p_value);
  }
  std::printf("error, fitting rows: %.3f before, %.3f after\n", d.base.score.total, d.with_effects.score.total);
  const talus::io::HoldoutError& e = record.whole;
  std::printf("error, held-out rows: %.3f before, %.3f after (lower by %.1f %%, 95 %%: %.1f to %.1f %%)\n", e.before,
              e.after, 100.0 * (e.before - e.after) / e.before, 100.0 * e.reduction.low, 100.0 * e.reduction.high);
  std::printf("written: %s\n", folder.c_str());
}

void write_results(const talus::io::OutputFolder& folder, const talus::io::LoadedCampaign& loaded,
                   const talus::io::DiagnosisRecord& record) {
  const talus::Diagnosis& d = record.diagnosis;
  const std::filesystem::path& out = folder.temporary();
  talus::io::write_text(out / "diagnosis.json", talus::io::diagnosis_json(record));
  talus::io::write_text(out / "report.html", talus::io::diagnosis_page(loaded.campaign, record));
  talus::io::write_text(out / "fitted.toml",
                        talus::io::model_text(d.base.model, loaded, "The ground alone, fitted by talus diagnose."));
  talus::io::write_text(
      out / "with_effect.toml",
      talus::io::model_text(d.with_effects.model, loaded, "The ground and what talus diagnose found missing."));
}

int diagnose(const Options& options) {
  catch_signals();
  const auto start = std::chrono::steady_clock::now();
  talus::io::LoadedCampaign loaded = talus::io::read_campaign(options.campaign);
  const talus::Campaign& campaign = loaded.campaign;
  talus::io::OutputFolder folder(options.out, options.overwrite);
  for (const talus::io::InputFile& input : loaded.inputs) folder.protect(input.path);
  if (!options.quiet)
    for (const std::string& warning : loaded.warnings) say("warning", warning);
  talus::io::DiagnosisRecord record;
  record.command = command_line();
  record.inputs = loaded.inputs;
  record.warnings = loaded.warnings;
  record.campaign = campaign.name;
  record.options = options.how;
  Progress progress(Progress::mode_of(options.quiet, options.progress == "machine"), 0);
  record.options.proceed = [&progress](double share, const std::string&) {
    return progress.update(share) && !interrupted();
  };
  try {
    record.diagnosis =
        talus::diagnose(campaign, talus::model_of_preset(campaign, talus::kDefaultPreset), record.options);
    talus::io::open_holdout(campaign, record);
  } catch (const talus::DiagnosisInterrupted&) {
    throw Interrupted("interrupted; nothing was written");
  }
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_results(folder, loaded, record);
  folder.commit();
  progress.finish();
  if (!options.quiet) print_summary(record, folder.final_path().string());
  return 0;
}

}  // namespace

void add_diagnose(CLI::App& app, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("diagnose", "Find what a fitted model leaves of measured data, and which effect explains it");
  command->add_option("campaign", options->campaign, "measured data: campaign.toml")->required();
  command->add_option("-o,--out", options->out, "new folder for the results")->required();
  command->add_flag("--overwrite", options->overwrite, "replace the folder if it holds an earlier result");
  command->add_option("--fit", options->how.keys, "parameters, in every zone: theta_scale,psi_scale,En50,Et50,phi")
      ->delimiter(',');
  command->add_option("--trials", options->how.search_trials, "trajectories per block in the searches (24)")
      ->check(CLI::Range(10, 10000));
  command->add_option("--test-trials", options->how.test_trials, "trajectories per block in the tests (100)")
      ->check(CLI::Range(20, 10000));
  command->add_option("--level", options->how.first_level, "of significance, over all effects and places (0.05)")
      ->check(CLI::Range(0.0001, 0.5));
  command->add_option("--seed", options->how.seed, "of the random numbers (1)");
  command
      ->add_option("--threads", options->how.threads, "all processors where it is not given; the results are the same")
      ->check(CLI::Range(1, 4096));
  command->add_flag("-q,--quiet", options->quiet, "say nothing but errors");
  command->add_option("--progress", options->progress, "machine: lines `progress 42` for other programs")
      ->check(CLI::IsMember({"machine"}));
  command->footer("Example:\n  talus diagnose campaign.toml -o diagnosis\n\nThen open diagnosis/report.html.");
  command->callback([&action, options] { action = [options] { return diagnose(*options); }; });
}
