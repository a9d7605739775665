#include "talus/fit/diagnose/diagnose.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>

#include "campaign_command.hpp"
#include "progress.hpp"
#include "several_campaigns.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"
#include "talus/io/campaign/model_file.hpp"
#include "talus/io/reports/diagnosis_page.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace {

struct DiagnoseOptions : CampaignCommand {
  talus::DiagnoseOptions how;
  std::string parameters;  // file of the ground from which the fit starts; empty: the default preset
  bool nested = false, no_nested = false, quick_folds = false, no_quick_folds = false;
  std::vector<std::string> of_one;  ///< given flags that hold for one campaign alone
};

void print_error(const char* what, const talus::io::HoldoutError& e) {
  if (std::isnan(e.before))
    print("%s: there are none\n", what);
  else
    print("%s: %.3f before, %.3f after (lower by %.1f %%, 95 %%: %.1f to %.1f %%)\n", what, e.before, e.after,
          100.0 * e.reduction.share, 100.0 * e.reduction.interval.low, 100.0 * e.reduction.interval.high);
}

/// The families that these data can test, or that cannot name anything.
void print_families(const talus::DiagnosisRound& round) {
  for (const talus::FamilyTest& family : round.families) {
    if (!std::isnan(family.p_corrected))
      print("  %s: p %.4f, corrected %.4f\n", family.name.c_str(), family.p_value, family.p_corrected);
    else if (!family.may_name && !std::isnan(family.p_value))
      print("  %s: p %.4f; %s\n", family.name.c_str(), family.p_value, family.note.c_str());
    else if (!family.may_name)
      print("  %s: %s\n", family.name.c_str(), family.note.c_str());
  }
}

void print_summary(const talus::io::DiagnosisRecord& record, const std::string& folder) {
  const talus::Diagnosis& d = record.diagnosis;
  for (std::size_t i = 0; i < d.rounds.size(); ++i) {
    const talus::DiagnosisRound& round = d.rounds[i];
    print("round %zu: %s", i + 1, round.effect.c_str());
    if (!round.where.empty()) print(", %s", round.where.c_str());
    for (const std::string& other : round.alike)
      print("%s %s", &other == &round.alike.front() ? "; not to be told apart from" : ",", other.c_str());
    print(" (smallest corrected p of a family %.4f)\n", round.p_value);
    if (const std::string row = talus::io::residual_text(round, record.options.later_level); !row.empty())
      print("  residual table: %s\n", row.c_str());
    print_families(round);
  }
  print("error, fitting rows: %.3f before, %.3f after\n", d.base.score.total, d.with_effects.score.total);
  const std::string unseen = "error, " + talus::io::rows_in_words(record.errors[record.unseen].after.rows) + " rows";
  if (std::isnan(record.whole.before)) {
    print("%s: nothing can be said, no group has five rows\n", unseen.c_str());
  } else {
    const std::vector<std::string> small = talus::io::small_groups(record);
    if (!small.empty()) print_error((unseen + ", groups of ten rows and more").c_str(), record.headline);
    print_error(unseen.c_str(), record.whole);
    if (!small.empty()) print("  few rows: %s\n", talus::joined(small).c_str());
  }
  print_text(talus::io::repeated_lines(record));
  for (const talus::io::BeforeAfter& e : record.errors) print_text(talus::io::judgement_lines(e.after));
  print_text(talus::io::limits_lines(d.rounds.back().limits));
  const double cut = d.with_effects.score.cut_short;
  if (cut > 0.0) print("%s\n", talus::io::cut_short_line(cut, record.options.rules.search.most_vertices).c_str());
  print("%s\n", talus::io::time_line(record).c_str());
  print("written: %s\n", folder.c_str());
}

void write_results(const talus::io::OutputFolder& folder, const talus::io::LoadedCampaign& loaded,
                   const talus::io::DiagnosisRecord& record) {
  const talus::Diagnosis& d = record.diagnosis;
  const std::filesystem::path& out = folder.temporary();
  talus::io::write_text(out / "diagnosis.json", talus::io::diagnosis_json(record));
  talus::io::write_text(out / "report.html", talus::io::diagnosis_page(loaded.campaign, record));
  talus::io::write_text(out / "fitted.toml",
                        talus::io::model_text(d.base.model, loaded, "The ground alone, fitted by talus diagnose.",
                                              talus::io::skill_of_ground(record)));
  talus::io::write_text(
      out / "with_effect.toml",
      talus::io::model_text(d.with_effects.model, loaded,
                            d.rounds.size() > 1 ? "The ground and what talus diagnose found missing."
                                                : "The ground alone: talus diagnose found nothing to add.",
                            talus::io::skill_of_found(record)));
}

/// Settles whether the loop is repeated without each fold: by default where nothing is held out.
void choose_folds(const DiagnoseOptions& options, const talus::Campaign& campaign, talus::DiagnoseOptions& how) {
  if (options.nested && options.no_nested) throw talus::InputError("flags --nested and --no-nested exclude each other");
  const auto fitting = talus::fitting_rows(campaign);
  const bool all = std::count(fitting.begin(), fitting.end(), false) == 0;
  how.nested = options.nested || (all && !options.no_nested);
  if (options.quick_folds && options.no_quick_folds)
    throw talus::InputError("flags --quick-folds and --no-quick-folds exclude each other");
  if (options.quick_folds || options.no_quick_folds) how.naming_in_folds = options.no_quick_folds;
}

int diagnose(const DiagnoseOptions& options) {
  if (options.campaigns.size() > 1) {
    if (!options.of_one.empty())
      throw talus::InputError("flag " + options.of_one.front() + ": not with several campaigns" +
                              (options.of_one.front() == "--nested"
                                   ? ", of which every block is left out in its turn where no site holds rows out"
                                   : "; diagnose each campaign alone with it"));
    talus::DiagnoseOptions how = options.how;
    how.nested = !options.no_nested;
    return diagnose_several(options, how, options.parameters);
  }
  const auto start = std::chrono::steady_clock::now();
  talus::io::DiagnosisRecord record;
  OpenedCampaign opened(options, record);
  const talus::Campaign& campaign = opened.loaded.campaign;
  require_releases(options.campaigns.front(), campaign);
  record.options = options.how;
  choose_folds(options, campaign, record.options);
  std::vector<std::string> of_start;
  const talus::Model ground = start_ground(options.parameters, campaign, record.options.keys, of_start);
  take_start(options.parameters, opened.folder, record);
  if (!options.parameters.empty() && record.options.nested)
    of_start.emplace_back(
        "the error out of fold is one of unseen rows only if the start (--parameters) was not fitted to these rows");
  for (const std::string& warning : of_start) warn(options, record, warning);
  record.start_name = options.parameters.empty() ? std::string(talus::kDefaultPreset) : options.parameters;
  Progress progress(Progress::mode_of(options.quiet, options.progress), 0, "diagnose");
  record.options.proceed = [&progress](double share) { return progress.update(share) && !interrupted(); };
  try {
    record.diagnosis = talus::diagnose(campaign, ground, record.options);
    talus::io::open_holdout(campaign, record);
  } catch (const talus::FitInterrupted&) {
    stop_interrupted();
  }
  for (const talus::io::BeforeAfter& e : record.errors) warn_of_scores(options, record, e.after);
  for (const std::string& warning : talus::io::diagnosis_warnings(record)) warn(options, record, warning);
  record.cpu_seconds = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_results(opened.folder, opened.loaded, record);
  opened.folder.commit();
  progress.finish();
  if (!options.quiet) print_summary(record, opened.folder.final_path().string());
  return 0;
}

}  // namespace

talus::Model start_ground(const std::string& file, const talus::Campaign& campaign,
                          const std::vector<std::string>& keys, std::vector<std::string>& warnings) {
  talus::Model model = start_model(file, campaign, warnings);
  if (model.effects.any() || !model.barriers.empty() || !model.bias.empty())
    throw talus::InputError("flag --parameters = '" + file +
                            "': has effects, barriers or a bias of instruments, must be ground alone: diagnose looks "
                            "for the rest itself; leave out [effects.*], [barriers] and [[instrument_bias]]");
  const std::vector<bool> all(campaign.zone_names.size(), true);
  talus::check_start(talus::ground_parameters(campaign, model, keys, all), model);
  return model;
}

void add_diagnose(CLI::App& app, Action& action) {
  const auto options = std::make_shared<DiagnoseOptions>();
  CLI::App* command =
      app.add_subcommand("diagnose", "Find what a fitted model leaves of measured data, and which effect explains it");
  talus::DiagnoseOptions& how = options->how;
  options->add_to(*command, how.trials.search, 10, how.keys, how.seed, how.threads);
  with(command->add_option("--parameters", options->parameters,
                           "ground from which the fit starts, without effects; else upper-talus-3d"),
       file_of({"toml"}));
  with(command->add_option("--test-trials", how.trials.test, "trajectories per block in the tests (100)")
           ->check(CLI::Range(10, 10000)),
       default_of(how.trials.test));
  with(command
           ->add_option("--most-effects", how.most_effects,
                        "that are added, one a round (3; fewer where that is costly)")
           ->check(CLI::Range(1, 9)),
       default_of(how.effects_at_most()));
  with(command->add_option("--level", how.first_level, "of significance, over all families of effects (0.05)")
           ->check(between(0.001, 0.5)),
       default_of(how.first_level));
  with(command
           ->add_option("--base-fits", how.base_fits,
                        "independent fits of the ground whose verdicts are compared (5; fewer where that is costly)")
           ->check(CLI::Range(1, 99)),
       default_of(how.base_fits_at_most()));
  command->add_flag("--all-rows", options->all_rows, "fit the rows that the campaign holds out, too");
  command->add_flag("--nested", options->nested,
                    "repeat the whole diagnosis without each fold of the fitting rows, as is done where no row is held "
                    "out: the error is then one of rows that were neither fitted nor chosen by");
  command->add_flag("--no-nested", options->no_nested, "never repeat the diagnosis without a fold");
  with(command->add_option("--folds", how.outer_folds, "parts that are left out in turn: groups, or blocks (5)")
           ->check(CLI::Range(2, 100)),
       default_of(static_cast<double>(how.outer_folds)));
  command->add_flag("--quick-folds", options->quick_folds,
                    "the folds take the effects that all rows chose, and refit the numbers alone: little time, and an "
                    "error that has seen the choice; so is done where the diagnosis of all rows is costly");
  command->add_flag("--no-quick-folds", options->no_quick_folds, "the folds always choose anew");
  command->footer(
      "Where fewer than 72 blocks are fitted, each gets more trajectories, so that there are as many in all; at most "
      "four times as many, and never fewer than 20.\n\n"
      "Examples:\n  talus diagnose campaign.toml -o diagnosis\n"
      "  talus diagnose a/campaign.toml b/campaign.toml -o diagnosis\n\nThen open diagnosis/report.html.");
  command->callback([&action, options, command] {
    for (const char* flag : {"--base-fits", "--all-rows", "--nested", "--quick-folds", "--no-quick-folds"})
      if (command->count(flag) > 0) options->of_one.emplace_back(flag);
    options->how.later_level = std::min(options->how.later_level, options->how.first_level);
    action = [options] { return diagnose(*options); };
  });
}
