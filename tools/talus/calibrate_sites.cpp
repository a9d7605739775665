#include "progress.hpp"
#include "several_campaigns.hpp"
#include "talus/base/text.hpp"
#include "talus/fit/calibrate/joint_parameters.hpp"
#include "talus/io/reports/fit_report.hpp"
#include "talus/io/reports/sites_calibration.hpp"

namespace {

constexpr std::uint32_t kFitScoreTrials = 100;

/// The work of one calibration of several campaigns.
class SitesFit {
 public:
  SitesFit(const CampaignCommand& command, const OpenedSites& opened, Progress& progress,
           talus::io::SitesCalibration& c)
      : command_(command), opened_(opened), progress_(progress), c_(c) {}

  /// Reads the model from which each site starts, and chooses what is fitted.
  void choose(const std::string& start, const std::vector<std::string>& keys) {
    for (std::size_t i = 0; i < opened_.sites.size(); ++i) {
      const talus::Campaign& campaign = *opened_.sites[i].campaign;
      talus::io::Calibration own;
      own.options = c_.options;
      own.start = start_model(start, campaign, own.warnings);
      choose_parameters(campaign, keys, own);
      for (const std::string& zone : own.untouched)
        own.warnings.push_back("zone " + zone + ": too few simulated paths touch it; not fitted");
      for (const std::string& warning : own.warnings) warn(command_, c_, opened_.sites[i].name + ": " + warning);
      start_.push_back(std::move(own.start));
      free_.push_back(std::move(own.free));
      rows_.push_back(talus::fitting_rows(campaign));
      names_.push_back(opened_.sites[i].name);
    }
  }

  /// Fits some sites by one objective.
  void fit(std::size_t first, std::size_t count) {
    const talus::JointParameters joint = talus::joint_parameters(std::span(names_).subspan(first, count),
                                                                 std::span(free_).subspan(first, count), c_.share);
    std::vector<talus::FitSite> sites;
    for (std::size_t i = first; i < first + count; ++i)
      sites.push_back(
          {count > 1 ? names_[i] : "", *opened_.sites[i].campaign, start_[i], rows_[i], joint.sites[i - first]});
    const talus::FitProblem problem(std::move(sites), joint.free);
    const double share = static_cast<double>(count) / static_cast<double>(names_.size());
    const auto [fitted, uncertainty] = fit_with_uncertainty(
        problem, c_.options, share, [&](double done) { return progress_.update(done_ + done) && !interrupted(); });
    done_ += share;
    c_.cut_short = std::max(c_.cut_short, fitted.score.cut_short);
    for (const talus::Model& model : problem.models(fitted.z)) models_.push_back(model);
    for (std::size_t k = 0; k < joint.free.size(); ++k) {
      const talus::Parameter& p = joint.free[k];
      talus::io::SitesParameter out{p.key,
                                    p.unit,
                                    {},
                                    0.0,
                                    p.value(fitted.z[static_cast<Eigen::Index>(k)]),
                                    uncertainty.intervals[k],
                                    uncertainty.identifiable[k],
                                    uncertainty.at_bound[k]};
      for (std::size_t i = 0; i < count; ++i)
        for (const talus::SiteParameter& own : joint.sites[i])
          if (own.number == k) out.sites.push_back(names_[first + i]), out.start = own.get(start_[first + i]);
      if (out.at_bound)
        warn(command_, c_, talus::joined(out.sites) + ": " + talus::io::bound_warning(out.key, out.interval));
      c_.parameters.push_back(std::move(out));
    }
  }

  const std::vector<talus::Model>& start() const { return start_; }
  const std::vector<talus::Model>& models() const { return models_; }

 private:
  const CampaignCommand& command_;
  const OpenedSites& opened_;
  Progress& progress_;
  talus::io::SitesCalibration& c_;
  std::vector<std::string> names_;
  std::vector<talus::Model> start_, models_;
  std::vector<std::vector<talus::Parameter>> free_;
  std::vector<std::vector<bool>> rows_;
  double done_ = 0.0;
};

}  // namespace

int calibrate_sites(const CampaignCommand& command, const talus::FitOptions& how, const std::string& start,
                    const std::vector<std::string>& fit, const std::vector<std::string>& share) {
  talus::check_shared(share, fit);
  talus::io::SitesCalibration c;
  OpenedSites opened(command, c);
  c.options = how;
  c.share = share;
  c.files = opened.paths;
  if (!share.empty()) talus::give_own_streams(opened.sites);
  Progress progress(Progress::mode_of(command.quiet, command.progress), 0, "fit");
  SitesFit work(command, opened, progress, c);
  work.choose(start, fit);
  take_start(start, opened.folder, c);
  const std::size_t together = share.empty() ? 1 : opened.sites.size();
  for (std::size_t i = 0; i < opened.sites.size(); i += together) work.fit(i, together);
  talus::ObserveOptions unseen{.trials = kFitScoreTrials,
                               .seed = how.seed,
                               .first_trial = talus::kUnseen,
                               .threads = how.threads,
                               .proceed = [] { return !interrupted(); }};
  c.evidence = talus::io::evidence_of_sites(opened.sites, work.start(), work.models(), unseen);
  if (interrupted()) stop_interrupted();
  for (std::size_t i = 0; i < opened.sites.size(); ++i) c.evidence[i].errors.front().after.fitted = talus::kNotGiven;
  warn_of_sites(command, c, c.evidence);
  talus::io::write_text(opened.folder.temporary() / "calibration.json", talus::io::sites_calibration_json(c));
  talus::io::write_text(opened.folder.temporary() / "report.md", talus::io::sites_calibration_report(c));
  opened.write_models(work.models(), "fitted.toml",
                      "Fitted by talus calibrate to the campaigns " + c.campaign +
                          ", shared: " + (share.empty() ? "nothing" : talus::joined(share)) +
                          ".\nUncertainty, and what is not identifiable: report.md of the folder above.",
                      c.evidence, &talus::io::BeforeAfter::after);
  for (const talus::io::SiteEvidence& site : c.evidence)
    if (const std::string ranks = talus::io::ranks_picture(site.errors); !ranks.empty())
      talus::io::write_text(opened.folder.temporary() / site.site / "ranks.svg", ranks);
  opened.folder.commit();
  progress.finish();
  if (!command.quiet)
    print("%swritten: %s\n", talus::io::sites_calibration_summary(c).c_str(), opened.folder.final_path().c_str());
  return 0;
}
