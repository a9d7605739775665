#include "report_profile.hpp"

#include <cmath>

#include "io/gdal/csv_table.hpp"
#include "io/gdal/picture.hpp"
#include "io/gdal/regular_file.hpp"
#include "report_facts.hpp"
#include "talus/base/bounds.hpp"
#include "talus/base/error.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

namespace fs = std::filesystem;

constexpr Bounds kDistance{"distance_to", "m", "in x from the release", 0.0, 1e9};
constexpr Bounds kStops{"stopped", "1", "blocks", 0.0, 1e12};
constexpr Bounds kShare{"share_beyond", "1", "of the blocks", 0.0, 1.0};

/// The first distance that no more than a share of the blocks goes beyond. Throws InputError if the table has not as
/// many stops as the run.
void read_reaches(const fs::path& file, double stops, ProfilePart& part) {
  const CsvTable table(file.string(), {}, {"distance_to", "stopped", "share_beyond"});
  double found = 0.0;
  for (const double share : {0.5, 0.1, 0.05, 0.01}) part.reaches.push_back({share, kNotGiven});
  for (const CsvTable::Row& row : table.rows()) {
    part.end = table.required(row, "distance_to", kDistance);
    found += table.required(row, "stopped", kStops);
    const double beyond = table.required(row, "share_beyond", kShare);
    for (ProfilePart::Reach& reach : part.reaches)
      if (beyond <= reach.share && std::isnan(reach.distance)) reach.distance = part.end;
  }
  if (found != stops)
    throw InputError(file.string() + ": has " + text_of(found) + " blocks that stopped, run.json beside it says " +
                     text_of(stops) +
                     ": must be as talus profile has written it; copy it again, or run the profile again");
}

}  // namespace

ProfilePart read_profile_part(const fs::path& folder, double stops) {
  ProfilePart part;
  std::error_code none;
  const fs::path drawing = folder / "profile.svg", table = folder / "runout.csv";
  if (!fs::exists(drawing, none))
    part.note = "profile.svg is not in the folder.";
  else if (const std::string fault = too_large_for_page(drawing); !fault.empty())
    part.note = fault + ": it is not shown here.";
  else
    part.drawing = read_file(drawing.string(), drawing.string(), "a drawing of talus profile", kMostPageTable);
  if (fs::exists(table, none)) read_reaches(table, stops, part);
  return part;
}

Markup profile_html(const ProfilePart& part) {
  Markup html = "<h2>Profile</h2>\n"_html;
  if (!part.note.empty()) html += "<p class='note'>"_html + part.note + "</p>\n";
  if (!part.drawing.empty()) {
    html += "<figure><img alt='terrain, paths and percentiles along the profile' style='max-width:100%' src=\"";
    html.add_value("data:image/svg+xml;base64," + base64_of(part.drawing)) +=
        "\"><figcaption>profile.svg; the figures are in envelope.csv and runout.csv.</figcaption></figure>\n";
  }
  if (!(part.end > 0.0)) return html;
  html += "<table><tr><th>at most</th><th>of the blocks go farther than [m in x from the release]</th></tr>\n";
  for (const auto& [share, distance] : part.reaches)
    html += "<tr><td class='n'>"_html + percent(share) + "</td><td class='n'>" +
            (std::isnan(distance) ? with_digits(part.end, 4) + " or more, where the profile ends"
                                  : with_digits(distance, 4)) +
            "</td></tr>\n";
  return html + "</table>\n";
}

}  // namespace talus::io
