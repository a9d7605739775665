#pragma once
#include <functional>
#include <utility>

#include "campaign_command.hpp"
#include "talus/fit/calibrate/uncertainty.hpp"
#include "talus/fit/campaign/sites.hpp"
#include "talus/fit/diagnose/diagnosis.hpp"
#include "talus/io/reports/fit_report.hpp"
#include "talus/io/reports/sites_report.hpp"

/// Several campaigns that were read, in the order of their names, and the new folder for their results.
struct OpenedSites {
  std::vector<std::string> paths;  ///< of the files campaign.toml
  std::vector<talus::io::LoadedCampaign> loaded;
  std::vector<talus::Site> sites;  ///< point to `loaded`
  talus::io::OutputFolder folder;

  /// Reads the campaigns as `OpenedCampaign` does. The name of a site is that of its campaign, as a name of a folder;
  /// where two have the same, all are called by their folders, which is said. Throws InputError where these are the
  /// same, too, and where nothing can be fitted to one of them.
  OpenedSites(const CampaignCommand& command, talus::io::FitRecord& record);

  /// Writes OUT/SITE/NAME for the models of all sites.
  ///
  /// @param evidence  of the sites in their order
  /// @param scored    which of the two models of the evidence these are
  void write_models(std::span<const talus::Model> models, const char* name, const std::string& heading,
                    std::span<const talus::io::SiteEvidence> evidence,
                    talus::io::ScoredRows talus::io::BeforeAfter::*scored) const;
};

/// `warn_of_scores` of each site.
void warn_of_sites(const CampaignCommand& command, talus::io::FitRecord& record,
                   std::span<const talus::io::SiteEvidence> evidence);

/// The work of `calibrate` and `diagnose` where there are several campaigns.
///
/// @param start  file of a model; empty: the default preset
/// @param fit    keys
/// @param share  those that the sites share
int calibrate_sites(const CampaignCommand& command, const talus::FitOptions& how, const std::string& start,
                    const std::vector<std::string>& fit, const std::vector<std::string>& share);
int diagnose_several(const CampaignCommand& command, const talus::DiagnoseOptions& how, const std::string& start);

/// The ground of a file, from which the fits of `diagnose` start; without a file the default preset. Throws InputError
/// where the model has more than its ground, and where one of the fitted parameters starts at zero.
///
/// @param keys  of the parameters that are fitted
talus::Model start_ground(const std::string& file, const talus::Campaign& campaign,
                          const std::vector<std::string>& keys, std::vector<std::string>& warnings);

// Steps of `calibrate` for one campaign, or each of several.

/// The model of a file, from which a fit starts; without a file the default preset.
talus::Model start_model(const std::string& file, const talus::Campaign& campaign, std::vector<std::string>& warnings);

/// Chooses what is fitted: the asked parameters of the zones that simulated paths touch, then the asked numbers of
/// effects.
void choose_parameters(const talus::Campaign& campaign, const std::vector<std::string>& keys,
                       talus::io::Calibration& c);

/// Fits, then finds the uncertainty. Ends the program where `proceed` returns false.
///
/// @param share    of the whole work that these two are
/// @param proceed  receives the share of the whole work that they have done
std::pair<talus::Fit, talus::Uncertainty> fit_with_uncertainty(const talus::FitProblem& problem, talus::FitOptions how,
                                                               double share,
                                                               const std::function<bool(double)>& proceed);
