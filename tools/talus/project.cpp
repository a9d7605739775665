#include "project.hpp"

#include "commands.hpp"
#include "talus/base/shell.hpp"
#include "talus/io/results/qgis_project.hpp"

void refresh_project(const std::filesystem::path& folder) {
  try {
    if (!talus::io::refresh_project(folder))
      say("warning", std::string(talus::io::kProjectFile) +
                         " was saved in QGIS and stays as it is: add the new layers there, or remove it before");
  } catch (const std::exception& error) {
    say("warning", std::string(talus::io::kProjectFile) + " is as it was before: " + error.what());
  }
}

void say_old_report(const std::filesystem::path& folder) {
  std::error_code none;
  if (std::filesystem::exists(folder / "report.html", none))
    say("warning", "report.html shows the results that were here before: talus report " +
                       talus::shell_word(folder.string()) + " --overwrite makes it anew");
}
