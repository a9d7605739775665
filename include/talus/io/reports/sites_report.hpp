#pragma once
#include "talus/fit/diagnose/several_sites.hpp"
#include "talus/io/reports/diagnosis_report.hpp"
#include "talus/io/reports/fit_report.hpp"

namespace talus::io {

/// The error before and after on rows of one kind, of one site or of all together.
struct ErrorChange {
  std::size_t blocks = 0, rows = 0;
  double before = kNotGiven, after = kNotGiven, climatology = kNotGiven;
  Reduction reduction;  ///< 95 % over the blocks
};

/// The errors of one site, or of all together.
struct SiteEvidence {
  std::string site;  ///< "pooled": all
  ErrorChange fit, holdout;
  ErrorChange headline;             ///< of the held-out groups with ten rows and more
  std::vector<BeforeAfter> errors;  ///< of a site alone: fitting and held-out rows
};

/// Scores two models of each site on all its rows and on those of all sites together.
///
/// @param how  trials, seed, first trial, threads
/// @return the sites in their order, "pooled" last
std::vector<SiteEvidence> evidence_of_sites(std::span<const Site> sites, std::span<const Model> before,
                                            std::span<const Model> after, const ObserveOptions& how);

/// Results of `talus diagnose` with several campaigns.
struct SitesRecord : FitRecord {
  DiagnoseOptions options;
  SitesDiagnosis diagnosis;
  std::vector<SiteEvidence> evidence;
  std::vector<std::string> files;  ///< by site: its campaign.toml
  double seconds = 0.0;
};

/// The text of diagnosis.json, of report.html, and of the summary on the terminal. docs/several-campaigns.md.
std::string sites_json(const SitesRecord& record);
std::string sites_page(const SitesRecord& record);
std::string sites_summary(const SitesRecord& record);

/// A fitted number of several campaigns.
struct SitesParameter {
  std::string key, unit;
  std::vector<std::string> sites;  ///< more than one: shared
  double start = 0.0, value = 0.0;
  Interval interval;  ///< 95 %
  bool identifiable = true;
};

/// Results of `talus calibrate` with several campaigns.
struct SitesCalibration : FitRecord {
  FitOptions options;
  std::vector<std::string> share, files;
  std::vector<SitesParameter> parameters;
  std::vector<SiteEvidence> evidence;
};

/// The text of calibration.json, of report.md, and of the summary on the terminal.
std::string sites_calibration_json(const SitesCalibration& calibration);
std::string sites_calibration_report(const SitesCalibration& calibration);
std::string sites_calibration_summary(const SitesCalibration& calibration);

}  // namespace talus::io
