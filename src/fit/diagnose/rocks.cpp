#include "rocks.hpp"

#include <algorithm>
#include <map>

namespace talus {
namespace {

// Differences of logarithms. A rock that is weighed and measured again differs by some 0.3 % to 1 %.
constexpr double kEqualSize = 0.02, kWidest = 0.06;

using Size = Eigen::Array4d;
using Members = std::vector<std::size_t>;

/// Logarithms of the mass and the axes.
Size size_of(const MeasuredBlock& b) {
  return Size(b.mass, b.axes.x(), b.axes.y(), b.axes.z()).log();
}

/// Parts whose members are linked by steps of at most `step`.
std::vector<Members> linked(const std::vector<Size>& sizes, Members rest, double step) {
  std::vector<Members> parts;
  while (!rest.empty()) {
    Members part{rest.back()};
    rest.pop_back();
    for (std::size_t k = 0; k < part.size(); ++k) {
      const Size from = sizes[part[k]];
      const auto near = std::stable_partition(rest.begin(), rest.end(), [&](std::size_t other) {
        return !((sizes[other] - from).abs().maxCoeff() <= step);
      });
      part.insert(part.end(), near, rest.end());
      rest.erase(near, rest.end());
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

double width_of(const std::vector<Size>& sizes, const Members& part) {
  Size least = sizes[part.front()], most = least;
  for (const std::size_t i : part) least = least.min(sizes[i]), most = most.max(sizes[i]);
  return (most - least).maxCoeff();
}

/// Ends, as a chain of n steps is no wider than n times the step.
void add_rocks(const std::vector<Size>& sizes, Members members, double step, std::vector<Members>& rocks) {
  for (Members& part : linked(sizes, std::move(members), step))
    if (width_of(sizes, part) > kWidest)
      add_rocks(sizes, std::move(part), 0.5 * step, rocks);
    else
      rocks.push_back(std::move(part));
}

}  // namespace

std::vector<std::size_t> rocks_of(const Campaign& campaign, std::span<const std::size_t> blocks) {
  std::map<std::string, Members> named;
  std::vector<Size> sizes;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    named[campaign.blocks[blocks[i]].rock].push_back(i);
    sizes.push_back(size_of(campaign.blocks[blocks[i]]));
  }
  std::vector<Members> rocks;
  for (auto& [name, members] : named)
    if (name.empty())
      add_rocks(sizes, std::move(members), kEqualSize, rocks);
    else
      rocks.push_back(std::move(members));
  for (Members& members : rocks) std::ranges::sort(members);
  std::ranges::sort(rocks);  // by the first member
  std::vector<std::size_t> numbers(blocks.size());
  for (std::size_t rock = 0; rock < rocks.size(); ++rock)
    for (const std::size_t i : rocks[rock]) numbers[i] = rock;
  return numbers;
}

}  // namespace talus
