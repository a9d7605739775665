#pragma once
#include "talus/fit/diagnose/several_sites.hpp"
#include "talus/io/reports/diagnosis_report.hpp"

namespace talus::io {

/// The error before and after on rows of one kind, of one site or of all together.
struct ErrorChange {
  std::size_t blocks = 0, rows = 0;
  double before = kNotGiven, after = kNotGiven, climatology = kNotGiven;
  Reduction reduction;  ///< 95 % over the blocks
};

/// The errors of one site, or of all together. Unseen rows: the held-out ones; where no site holds any out, the fitting
/// ones, each out of its fold.
struct SiteEvidence {
  std::string site;  ///< "pooled": all
  ErrorChange fit, unseen;
  std::string unseen_rows = "holdout";       ///< or "out-of-fold"
  ErrorChange headline;                      ///< of the groups with ten unseen rows and more
  std::vector<BeforeAfter> errors;           ///< of a site alone: fitting and unseen rows
  std::vector<std::uint32_t> clusters = {};  ///< of a site alone: of its blocks (`clusters_of`)
};

/// Scores two models of each site on all its rows and on those of all sites together.
///
/// @param how     trials, seed, first trial, threads
/// @param nested  by site: its blocks out of their folds, which are the unseen rows then; else empty
/// @return the sites in their order, "pooled" last
std::vector<SiteEvidence> evidence_of_sites(std::span<const Site> sites, std::span<const Model> before,
                                            std::span<const Model> after, const ObserveOptions& how,
                                            std::span<const NestedValidation> nested = {});

/// Results of `talus diagnose` with several campaigns.
struct SitesRecord : FitRecord {
  DiagnoseOptions options;
  SitesDiagnosis diagnosis;
  std::vector<SiteEvidence> evidence;
  std::vector<std::vector<double>> candidates;  ///< by round: held-out error of each, of all sites together
  std::vector<std::string> files;               ///< by site: its campaign.toml
  double seconds = 0.0;
  std::string start_name;  ///< of the ground: a preset, everywhere, or the file of a model
};

/// Scores the models before and after what was found, and every candidate, on the rows of all sites; the first and the
/// last out of their folds, too, where these were simulated.
///
/// @param how  trials, seed, first trial, threads
void open_holdout(std::span<const Site> sites, SitesRecord& record, const ObserveOptions& how);

/// Warnings beside those of the scores: why the sites could not be cross-validated, sites whose ground ended far from
/// its start, and sites whose folds split groups.
std::vector<std::string> sites_warnings(const SitesRecord& record);

/// The text of diagnosis.json, of report.html, and of the summary on the terminal. docs/several-campaigns.md.
std::string sites_json(const SitesRecord& record);
std::string sites_page(const SitesRecord& record);
std::string sites_summary(const SitesRecord& record);

}  // namespace talus::io
