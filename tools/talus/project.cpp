#include "project.hpp"

#include "commands.hpp"
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
