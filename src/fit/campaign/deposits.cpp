#include "talus/fit/campaign/deposits.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "nearest_source.hpp"
#include "talus/base/elementary.hpp"
#include "talus/base/expect.hpp"
#include "talus/base/random.hpp"
#include "talus/base/text.hpp"

namespace talus {
namespace {

constexpr std::size_t kMostClasses = 3, kFewestInClass = 20;

constexpr double kNanometres = 1e9;  // per metre

/// A diameter as classes compare it: the number that was written, whatever its way through a mass and a density.
double compared(double diameter) {
  return std::round(kNanometres * diameter) / kNanometres;
}

Raster<std::uint32_t> sources_by_cell(const Grid& grid, std::span<const DepositSource> sources) {
  Raster<std::uint32_t> cells(grid, kNoSource);
  for (std::uint32_t i = 0; i < sources.size(); ++i)
    cells.at(grid.column_of(sources[i].place.x()), grid.row_of(sources[i].place.y())) = i;
  return cells;
}

/// Centres of cells drawn with replacement from those of a region, always the same ones.
std::vector<Eigen::Vector2d> places_in(const Raster<std::uint8_t>& region, std::uint8_t number) {
  std::vector<Eigen::Vector2d> all, drawn;
  const Grid& grid = region.grid;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (region.at(column, row) == number) all.emplace_back(grid.centre_x(column), grid.centre_y(row));
  for (std::uint32_t i = 0; i < kAnywhere && !all.empty(); ++i) {
    const Words words = Random(1, number, i, Purpose::Bootstrap).words(0);
    const Eigen::Vector2d inside((uniform(words[1]) - 0.5) * grid.cell_x, (uniform(words[2]) - 0.5) * grid.cell_y);
    drawn.push_back(all[static_cast<std::size_t>(uniform(words[0]) * static_cast<double>(all.size()))] + inside);
  }
  return drawn;
}

Eigen::Vector2d mean_of(std::span<const Eigen::Vector2d> places) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& place : places) sum += place;
  return sum / static_cast<double>(places.size());
}

/// Values that cut ascending numbers into pieces of like size, each of at least `fewest`. A cut through equal numbers
/// moves to the nearer end of them, else to the other; it is left out where neither leaves enough.
std::vector<double> cuts_of(const std::vector<double>& sorted, std::size_t pieces, std::size_t fewest) {
  std::vector<double> cuts;
  std::size_t begin = 0;  // of the piece under way
  for (std::size_t piece = 1; piece < pieces; ++piece) {
    const std::size_t wanted = piece * sorted.size() / pieces;
    const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), sorted[wanted]);
    std::array<std::size_t, 2> ends{static_cast<std::size_t>(low - sorted.begin()),
                                    static_cast<std::size_t>(high - sorted.begin())};
    if (ends[1] - wanted < wanted - ends[0]) std::swap(ends[0], ends[1]);
    for (const std::size_t at : ends) {
      if (at < begin + fewest || at + fewest > sorted.size()) continue;
      cuts.push_back(0.5 * (sorted[at - 1] + sorted[at]));
      begin = at;
      break;
    }
  }
  return cuts;
}

}  // namespace

MappedDeposits mapped_deposits(std::vector<DepositSource> sources, Raster<std::uint8_t> region) {
  TALUS_EXPECT(!sources.empty(), "mapped blocks have a source");
  MappedDeposits out;
  double sum = 0.0;
  for (const DepositSource& source : sources) out.share.push_back(sum += source.area);
  for (double& share : out.share) share /= sum;
  out.nearest = nearest_sources(sources_by_cell(region.grid, sources));
  const unsigned regions = *std::max_element(region.values.begin(), region.values.end());
  out.anywhere.emplace_back();  // 0 is no region
  for (unsigned number = 1; number <= regions; ++number)
    out.anywhere.push_back(places_in(region, static_cast<std::uint8_t>(number)));
  out.sources = std::move(sources);
  out.region = std::move(region);
  return out;
}

std::uint8_t region_at(const MappedDeposits& deposits, const Eigen::Vector2d& place) {
  const Grid& grid = deposits.region.grid;
  if (!(place.x() >= 0.0 && place.y() >= 0.0 && place.x() < grid.width() && place.y() < grid.height())) return 0;
  const int column = grid.column_of(place.x()), row = grid.row_of(place.y());
  return grid.contains(column, row) ? deposits.region.at(column, row) : 0;
}

const DepositSource& source_at(const MappedDeposits& deposits, double share) {
  const auto found = std::upper_bound(deposits.share.begin(), deposits.share.end(), share);
  const auto last = std::ssize(deposits.share) - 1;
  return deposits.sources[static_cast<std::size_t>(std::min(found - deposits.share.begin(), last))];
}

RunOut run_out(const Campaign& campaign, const Eigen::Vector2d& place) {
  const MappedDeposits& deposits = *campaign.deposits;
  const Grid& grid = deposits.nearest.grid;
  if (std::isnan(place.x())) return {};
  const int column = grid.column_of(place.x()), row = grid.row_of(place.y());
  const std::optional<double> height = campaign.surface.height(place.x(), place.y());
  if (!grid.contains(column, row) || !height) return {};
  const Vec3& source = deposits.sources[deposits.nearest.at(column, row)].place;
  const double distance = std::hypot(source.x() - place.x(), source.y() - place.y());
  const bool beside = distance < std::max(grid.cell_x, grid.cell_y);
  return {distance, beside ? kNotGiven : angle_of_rise(source.z() - *height, distance)};
}

std::vector<double> class_limits(std::vector<double> diameters) {
  std::ranges::transform(diameters, diameters.begin(), compared);
  std::sort(diameters.begin(), diameters.end());
  return cuts_of(diameters, std::clamp<std::size_t>(diameters.size() / kFewestInClass, 1, kMostClasses),
                 kFewestInClass);
}

std::size_t class_of(const MappedDeposits& deposits, double diameter) {
  const auto above = std::ranges::upper_bound(deposits.limits, compared(diameter), {}, compared);
  return static_cast<std::size_t>(above - deposits.limits.begin());
}

std::string class_name(const MappedDeposits& deposits, std::size_t number) {
  const std::vector<double>& limits = deposits.limits;
  if (limits.empty()) return "deposits";
  if (number == 0) return "deposits below " + with_digits(limits.front(), 3) + " m";
  if (number == limits.size()) return "deposits from " + with_digits(limits.back(), 3) + " m";
  return "deposits " + with_digits(limits[number - 1], 3) + " to " + with_digits(limits[number], 3) + " m";
}

std::size_t Strips::of(const Eigen::Vector2d& place) const {
  return static_cast<std::size_t>(std::upper_bound(limits.begin(), limits.end(), across.dot(place)) - limits.begin());
}

Strips strips_of(const MappedDeposits& deposits, std::span<const Eigen::Vector2d> blocks, std::size_t count) {
  TALUS_EXPECT(!blocks.empty(), "strips hold blocks");
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  double area = 0.0;
  for (const DepositSource& source : deposits.sources) {
    from += source.area * source.place.head<2>();
    area += source.area;
  }
  const Eigen::Vector2d down = mean_of(blocks) - from / area;
  Strips strips;
  if (down.norm() > 0.0) strips.across = Eigen::Vector2d(-down.y(), down.x()).normalized();
  std::vector<double> at;
  for (const Eigen::Vector2d& block : blocks) at.push_back(strips.across.dot(block));
  std::sort(at.begin(), at.end());
  strips.limits = cuts_of(at, count, 1);
  return strips;
}

}  // namespace talus
