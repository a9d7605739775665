#include "talus/run/summary.hpp"

#include "talus/base/text.hpp"
#include "talus/io/results/run_record.hpp"

namespace talus::run {

std::string share_text(std::uint64_t part, std::uint64_t whole) {
  return percent(static_cast<double>(part) / static_cast<double>(whole));
}

std::string count_text(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, " ");
  return text;
}

std::string ends_text(const Totals& totals, const std::string& terrain) {
  return count_text(totals.ended(End::Stopped)) + " stopped, " + count_text(totals.ended(End::Trapped)) + " trapped, " +
         count_text(totals.ended(End::Left)) + " left the " + terrain + ", " + count_text(totals.ended(End::Caught)) +
         " caught, " + count_text(totals.ended(End::Limit)) + " at a limit";
}

std::string barrier_text(const std::string& id, const BarrierCounts& counts, bool pieces) {
  return "barrier " + id + ": " + count_text(counts.caught) + (pieces ? " blocks and pieces" : "") + " caught, " +
         count_text(counts.over) + " over it, " + count_text(counts.broken) + " through it (it broke)";
}

std::string limits_text(const Totals& totals) {
  const std::uint64_t limits = totals.limited_blocks, by_pieces = limits - totals.ended(End::Limit);
  return count_text(limits) + " of " + count_text(totals.released) + " trajectories (" +
         share_text(limits, totals.released) + ", allowed are " + percent(io::kAllowedLimitShare) +
         ") ended at the limit of impacts, time or vertices" +
         (by_pieces > 0 ? ", " + count_text(by_pieces) + " of them with smaller pieces only" : "");
}

/// Advice on trajectories that left the terrain.
///
/// @param into_gaps  how many of them left, with their largest piece, into gaps inside the DEM
static std::string advice_on_left(const Totals& totals, std::uint64_t into_gaps) {
  const std::string fill =
      "gaps inside it: fill holes of the survey (gdal_fillnodata.py -md N, half the width of the widest in cells); a "
      "lake may stay";
  const std::uint64_t left = totals.ended(End::Left), at_edge = left - into_gaps;
  const std::uint64_t by_pieces = totals.left_blocks - left;
  if (into_gaps == 0 && by_pieces == 0) return "a larger DEM would";
  if (at_edge == 0 && by_pieces == 0) return "all of them left it into " + fill;
  std::string text;
  const auto tell = [&](std::uint64_t blocks, const std::string& how) {
    if (blocks > 0) text += (text.empty() ? "" : "; ") + share_text(blocks, totals.released) + how;
  };
  tell(at_edge, " left it at its edge: take a larger DEM");
  tell(into_gaps, " left it into " + fill);
  tell(by_pieces,
       " left it with smaller pieces only (exits.tif of a run shows where): take a larger DEM, or fill gaps inside it");
  return text;
}

/// Warnings about trajectories that left the terrain or were trapped, if they are many, and of each that a limit cut
/// short, unless these are too many for the run.
///
/// @param left, trapped  what to say of these after their number
static std::vector<std::string> warnings_of_ends(const Totals& totals, const std::string& whole,
                                                 const std::string& left, const std::string& trapped) {
  std::vector<std::string> warnings;
  const auto tell = [&](std::uint64_t count, double share, const std::string& text) {
    if (static_cast<double>(count) > share * static_cast<double>(totals.released))
      warnings.push_back(share_text(count, totals.released) + " of the " + whole + " (" + count_text(count) + ") " +
                         text);
  };
  tell(totals.left_blocks, io::kWarnedLeftShare, left);
  tell(totals.ended(End::Trapped), io::kWarnedTrappedShare,
       std::string(io::kTrappedWarning) +
           ", on ground too steep to rest on: where these are not in the real terrain, " + trapped);
  if (!io::too_many_limits(totals))
    tell(totals.limited_blocks, 0.0,
         std::string(io::kLimitWarning) +
             " time, impacts or vertices, or a piece of them: they would go farther; raise time_limit or "
             "impact_limit in [model], and look at the stops with end = limit");
  return warnings;
}

std::vector<std::string> warnings_of(const Totals& totals, std::uint64_t into_gaps, const std::string& whole) {
  return warnings_of_ends(
      totals, whole,
      "left the DEM or met missing data: the maps do not show how far they go; " + advice_on_left(totals, into_gaps),
      "the maps end too early; trapped.tif shows where; a part of them may lie at pits and dammed cells of the DEM, "
      "which talus check --pits maps");
}

std::vector<std::string> profile_warnings(const Totals& totals) {
  return warnings_of_ends(
      totals, "trajectories",
      "left the profile at its ends: the results do not show how far they go; a longer profile would",
      "the runout is too short; stops.csv shows where (end = trapped): look at the profile there, and whether its line "
      "is the fall line");
}

std::string profile_limits_text(const Totals& totals) {
  return limits_text(totals) +
         "; stops.csv shows where (end = limit), with their seconds and impacts: raise time_limit or impact_limit in "
         "[model], or look at the profile there";
}

std::optional<std::string> many_trajectories_warning(std::uint64_t trajectories, std::uint32_t parts) {
  constexpr double kMany = 1e9, kSeconds = 1e-4, kStopBytes = 172.0;  // docs/performance.md
  const double here = static_cast<double>(trajectories) / parts;
  if (!(here > kMany)) return std::nullopt;
  return count_text(static_cast<std::uint64_t>(here)) + " trajectories: at 0.1 ms each they take about " +
         with_digits(here * kSeconds / 86400.0, 2) + " days of one processor, their stops about " +
         with_digits(here * kStopBytes / 1e12, 2) +
         " TB of disk, and a cell that more than 4 294 967 295 of them cross ends the run; talus check estimates time "
         "and disk; is --trajectories the number of blocks per source cell that you meant?";
}

std::vector<std::string> held_warnings(std::uint64_t held, std::uint64_t released, const Effects& effects,
                                       const std::string& whole) {
  if (!(static_cast<double>(held) > io::kWarnedHeldShare * static_cast<double>(released))) return {};
  return {share_text(held, released) + " of the " + whole + " (" + count_text(held) +
          ") came to rest within two diameters of their release: " +
          (find_effect("rest-in-roughness")->acts(effects)
               ? "[effects.rest-in-roughness] may hold blocks that start from rest; try a lower kappa, or leave it out"
               : "look at the slope of the sources, at phi and at the effects there")};
}

}  // namespace talus::run
