#include <algorithm>
#include <chrono>

#include "progress.hpp"
#include "several_campaigns.hpp"
#include "talus/fit/diagnose/several_sites.hpp"
#include "talus/io/reports/sites_report.hpp"
#include "talus/simulate/scenario/presets.hpp"

namespace {

constexpr std::uint32_t kDiagnosisScoreTrials = 200;

void write_results(const OpenedSites& opened, const talus::io::SitesRecord& record) {
  const std::filesystem::path& out = opened.folder.temporary();
  talus::io::write_text(out / "diagnosis.json", talus::io::sites_json(record));
  talus::io::write_text(out / "report.html", talus::io::sites_page(record));
  const talus::SitesDiagnosis& d = record.diagnosis;
  opened.write_models(d.base, "fitted.toml", "The ground alone, fitted by talus diagnose with several campaigns.",
                      record.evidence, &talus::io::BeforeAfter::before);
  opened.write_models(d.with_effects, "with_effect.toml",
                      d.rounds.size() > 1
                          ? "The ground of this site and what talus diagnose found missing at all sites."
                          : "The ground alone: talus diagnose found nothing to add at all sites.",
                      record.evidence, &talus::io::BeforeAfter::after);
}

bool holds_out(const talus::Site& site) {
  return talus::count_of_rows(talus::holdout_rows(*site.campaign)) > 0;
}

}  // namespace

/// @param how    `nested`: where no site holds anything out
/// @param start  file of a ground; empty: the default preset
int diagnose_several(const CampaignCommand& command, const talus::DiagnoseOptions& how, const std::string& start) {
  const auto begin = std::chrono::steady_clock::now();
  talus::io::SitesRecord record;
  OpenedSites opened(command, record);
  for (std::size_t i = 0; i < opened.sites.size(); ++i) require_releases(opened.paths[i], *opened.sites[i].campaign);
  talus::give_own_streams(opened.sites);
  record.files = opened.paths;
  record.options = how;
  record.options.base_fits = 1;
  record.options.nested = how.nested && std::ranges::none_of(opened.sites, holds_out);
  Progress progress(Progress::mode_of(command.quiet, command.progress), 0, "diagnose");
  record.options.proceed = [&progress](double share) { return progress.update(share) && !interrupted(); };
  record.start_name = start.empty() ? std::string(talus::kDefaultPreset) : start;
  std::vector<talus::Model> grounds;
  for (const talus::Site& site : opened.sites) {
    std::vector<std::string> warnings;
    grounds.push_back(start_ground(start, *site.campaign, how.keys, warnings));
    for (const std::string& warning : warnings) warn(command, record, site.name + ": " + warning);
  }
  take_start(start, opened.folder, record);
  try {
    record.diagnosis = talus::diagnose_sites(opened.sites, grounds, record.options);
  } catch (const talus::FitInterrupted&) {
    stop_interrupted();
  }
  talus::ObserveOptions unseen{
      .trials = kDiagnosisScoreTrials, .seed = how.seed + 1, .threads = how.threads, .proceed = [] {
        return !interrupted();
      }};
  talus::io::open_holdout(opened.sites, record, unseen);
  if (interrupted()) stop_interrupted();
  warn_of_sites(command, record, record.evidence);
  for (const std::string& warning : talus::io::sites_warnings(record)) warn(command, record, warning);
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  write_results(opened, record);
  opened.folder.commit();
  progress.finish();
  if (!command.quiet)
    print("%swritten: %s\n", talus::io::sites_summary(record).c_str(), opened.folder.final_path().c_str());
  return 0;
}
