#pragma once
#include "commands.hpp"
#include "talus/io/campaign/campaign_file.hpp"
#include "talus/io/files/output_folder.hpp"
#include "talus/io/reports/fit_record.hpp"
#include "talus/io/reports/score_report.hpp"

/// Common options of `calibrate` and `diagnose`: a campaign or several, a new folder, the display of progress.
struct CampaignCommand {
  std::string name;  ///< "talus calibrate"
  std::vector<std::string> campaigns;
  std::string out, progress;
  std::optional<std::string> surface;
  bool overwrite = false, quiet = false;
  bool all_rows = false;  ///< fit the rows that the campaign holds out, too

  /// Adds the options, those of a search among them, and takes the name of the command.
  void add_to(CLI::App& command, std::uint32_t& trials, int fewest_trials, std::vector<std::string>& keys,
              std::uint64_t& seed, int& threads);
};

/// Reads the campaigns of a command. Until then a signal ends the program at once; from then on see `catch_signals`.
std::vector<talus::io::LoadedCampaign> read_campaigns(const CampaignCommand& command);

/// Throws InputError if no quantity was measured often enough to be fitted.
void require_measurements(const std::string& path, const talus::Campaign& campaign);

/// Throws InputError if the releases of the blocks are not known.
void require_releases(const std::string& path, const talus::Campaign& campaign);

/// Prints a warning, unless the command is quiet, and adds it to those of the record.
void warn(const CampaignCommand& command, talus::io::FitRecord& record, const std::string& warning);

/// Takes the file of a model from which a fit starts among the inputs of a record. Throws InputError if it lies in the
/// folder that the results replace.
void take_start(const std::string& file, const talus::io::OutputFolder& folder, talus::io::FitRecord& record);

/// Warns of the groups in which a fitted model scores as the climatology, where a search can hide, and of the
/// quantities that it scatters too much or too little.
/// @param of  of several campaigns, the one that it was fitted to: "south: "
void warn_of_scores(const CampaignCommand& command, talus::io::FitRecord& record, const talus::io::ScoredRows& scored,
                    const std::string& of = "");

/// A campaign that was read, and the new folder for its results.
struct OpenedCampaign {
  talus::io::LoadedCampaign loaded;
  talus::io::OutputFolder folder;

  /// Reads the campaign, guards its files from being overwritten, prints its warnings and fills the head of the report.
  /// Throws InputError if nothing can be fitted to it.
  OpenedCampaign(const CampaignCommand& command, talus::io::FitRecord& record);
};
