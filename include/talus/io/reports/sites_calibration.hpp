#pragma once
#include "talus/io/reports/sites_report.hpp"

namespace talus::io {

/// A fitted number of several campaigns.
struct SitesParameter {
  std::string key, unit;
  std::vector<std::string> sites;  ///< more than one: shared
  double start = 0.0, value = 0.0;
  Interval interval;                           ///< 95 %
  bool identifiable = true, at_bound = false;  ///< as in Uncertainty
};

/// Results of `talus calibrate` with several campaigns.
struct SitesCalibration : FitRecord {
  FitOptions options;
  std::vector<std::string> share, files;
  std::vector<SitesParameter> parameters;
  std::vector<SiteEvidence> evidence;
  double cut_short = 0.0;  ///< share of the trials of the fitted models that did not end; of the worst site
};

/// The text of calibration.json, of report.md, and of the summary on the terminal.
std::string sites_calibration_json(const SitesCalibration& calibration);
std::string sites_calibration_report(const SitesCalibration& calibration);
std::string sites_calibration_summary(const SitesCalibration& calibration);

}  // namespace talus::io
