#include "several_campaigns.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>
#include <set>

#include "talus/base/error.hpp"
#include "talus/base/printable.hpp"
#include "talus/base/text.hpp"
#include "talus/io/campaign/model_file.hpp"

namespace {

/// A name as the name of a folder: letters, digits, '.', '_' and '-'.
std::string folder_name(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_' && c != '-') c = '-';
  return name.empty() || name.front() == '.' ? "site-" + name : name;
}

bool all_differ(const std::vector<std::string>& names) {
  return std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

/// Throws InputError if a site cannot have a folder of its name among the results, which are written last.
void check_folder(const std::string& name, const std::string& path) {
  constexpr std::size_t kLongest = 255;  // [byte], of a file system
  std::string fault;
  if (talus::io::is_fit_file(name)) fault = "must not be the name of a file of the results";
  if (name == talus::io::OutputFolder::kWork) fault = "must not be the name of the folder for saved work";
  if (name.size() > kLongest) fault = "has " + std::to_string(name.size()) + " bytes, must have at most 255";
  if (!fault.empty())
    throw talus::InputError(path + ": name = '" + talus::shortened(name, 60) + "': becomes that of a folder and " +
                            fault + "; give it another name = \"...\"");
}

/// Names of the sites: of the campaigns or, where two are the same, of their folders.
std::vector<std::string> site_names(const std::vector<std::string>& paths,
                                    const std::vector<talus::io::LoadedCampaign>& loaded,
                                    std::vector<std::string>& warnings) {
  std::vector<std::string> names, folders;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    names.push_back(folder_name(loaded[i].campaign.name));
    folders.push_back(folder_name(std::filesystem::canonical(paths[i]).parent_path().filename().string()));
  }
  if (all_differ(names)) return names;
  if (!all_differ(folders))
    throw talus::InputError("two campaigns have the same name (" + talus::joined(names) +
                            ") and lie in folders of the same name: is one given twice? Else give one another name = "
                            "\"...\" in its campaign.toml");
  warnings.push_back("two campaigns have the same name (" + talus::joined(names) +
                     "): all are called by their folders: " + talus::joined(folders));
  return folders;
}

/// Warns where two campaigns have equal tables.
void warn_of_copies(const std::vector<std::string>& paths, const std::vector<talus::io::LoadedCampaign>& loaded,
                    std::vector<std::string>& warnings) {
  const auto tables_of = [](const talus::io::LoadedCampaign& campaign) {
    std::vector<std::string> sums;
    for (const talus::io::InputFile& input : campaign.inputs)
      if (input.path.ends_with(".csv")) sums.push_back(input.role + input.sha256);
    return sums;
  };
  for (std::size_t i = 0; i < paths.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (const auto tables = tables_of(loaded[i]); !tables.empty() && tables == tables_of(loaded[k]))
        warnings.push_back(paths[i] + ": has the same measurements as " + paths[k] +
                           " (equal tables): they count twice, and intervals are too narrow (unsafe); leave one out");
}

/// Sorts by the names of the sites, so that the order of the command line changes nothing.
template <class T>
void reorder(std::vector<T>& list, const std::vector<std::size_t>& order) {
  std::vector<T> sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(list[i]));
  list = std::move(sorted);
}

}  // namespace

OpenedSites::OpenedSites(const CampaignCommand& command, talus::io::FitRecord& record)
    : paths(command.campaigns),
      loaded(read_campaigns(command)),
      folder(command.out, command.overwrite, talus::io::OutputFolder::Unfinished::Ignore, command.name) {
  for (std::size_t i = 0; i < paths.size(); ++i) require_measurements(paths[i], loaded[i].campaign);
  std::vector<std::string> names = site_names(paths, loaded, record.warnings);
  warn_of_copies(paths, loaded, record.warnings);
  for (std::size_t i = 0; i < paths.size(); ++i) check_folder(names[i], paths[i]);
  std::vector<std::size_t> order(paths.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::size_t i) { return names[i]; });
  reorder(paths, order), reorder(loaded, order), reorder(names, order);
  record.command = command_line();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (const talus::io::InputFile& input : loaded[i].inputs) {
      folder.protect(input.path);
      record.inputs.push_back(input);
    }
    for (const std::string& warning : loaded[i].warnings) record.warnings.push_back(names[i] + ": " + warning);
    sites.push_back({names[i], &loaded[i].campaign});
    record.campaign += (i > 0 ? ", " : "") + names[i];
  }
  if (!command.quiet)
    for (const std::string& warning : record.warnings) say("warning", warning);
}

void OpenedSites::write_models(std::span<const talus::Model> models, const char* name, const std::string& heading,
                               std::span<const talus::io::SiteEvidence> evidence,
                               talus::io::ScoredRows talus::io::BeforeAfter::*scored) const {
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const std::filesystem::path own = folder.temporary() / sites[i].name;
    std::filesystem::create_directories(own);
    const std::vector<talus::io::BeforeAfter>& errors = evidence[i].errors;
    const talus::Reduction skill = talus::io::skill_of_model(errors.front().*scored, errors.back().*scored,
                                                             talus::clusters_of(loaded[i].campaign));
    talus::io::write_text(own / name, talus::io::model_text(models[i], loaded[i], heading, skill));
  }
}

void warn_of_sites(const CampaignCommand& command, talus::io::FitRecord& record,
                   std::span<const talus::io::SiteEvidence> evidence) {
  for (const talus::io::SiteEvidence& site : evidence)
    for (const talus::io::BeforeAfter& e : site.errors) warn_of_scores(command, record, e.after, site.site + ": ");
}
