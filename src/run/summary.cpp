#include "talus/run/summary.hpp"

#include "talus/base/text.hpp"

namespace talus::run {
namespace {

/// "3.14 %".
std::string share_text(std::uint64_t part, std::uint64_t whole) {
  return with_digits(100.0 * static_cast<double>(part) / static_cast<double>(whole), 3) + " %";
}

}  // namespace

std::string count_text(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, " ");
  return text;
}

std::uint64_t count_of(const Totals& totals, End end) {
  return totals.ends[static_cast<std::size_t>(end)];
}

std::string ends_text(const Totals& totals) {
  return count_text(count_of(totals, End::Stopped)) + " stopped, " + count_text(count_of(totals, End::Left)) +
         " left the map, " + count_text(count_of(totals, End::Caught)) + " caught, " +
         count_text(count_of(totals, End::Limit)) + " at a limit";
}

std::string limits_text(const Totals& totals) {
  const std::uint64_t limits = count_of(totals, End::Limit);
  return count_text(limits) + " of " + count_text(totals.released) + " trajectories (" +
         share_text(limits, totals.released) + ", allowed are 0.1 %) ended at the limit of impacts or time";
}

std::vector<std::string> warnings_of(const Totals& totals) {
  const std::uint64_t left = count_of(totals, End::Left);
  if (static_cast<double>(left) <= 0.01 * static_cast<double>(totals.released)) return {};
  return {share_text(left, totals.released) + " of the trajectories (" + count_text(left) +
          ") left the DEM or met missing data: the maps do not show how far they go; a larger DEM would"};
}

}  // namespace talus::run
