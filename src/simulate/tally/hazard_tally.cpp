#include "talus/simulate/tally/hazard_tally.hpp"

#include <algorithm>
#include <cmath>

#include "talus/base/expect.hpp"
#include "talus/simulate/tally/checked_sum.hpp"

namespace talus {
namespace {

/// [square_unit] of one squared weight; the ratio of the units is a power of two.
double squares_per_unit(const WeightScale& scale) {
  return scale.unit * (scale.unit / scale.square_unit);
}

std::uint64_t rounded(double value) {
  return static_cast<std::uint64_t>(value + 0.5);
}

}  // namespace

void StratumSums::add(const AnnualShare& annual_share, float energy, ScratchVector<std::int64_t>& overlaps) {
  if (blocks_ == 0 || annual_share.stratum != stratum_) {
    finish(overlaps);
    stratum_ = annual_share.stratum;
    blocks_ = annual_share.blocks;
  }
  const auto weight = static_cast<double>(annual_share.weight);
  const auto& thresholds = rules_.bins.thresholds();
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    if (level > 0 && !(energy > thresholds[level - 1])) break;  // ascending: the rest is not exceeded
    levels_[level].sum += annual_share.weight;
    levels_[level].squares += weight * weight;
    levels_[level].hits += 1;
  }
}

void StratumSums::finish(ScratchVector<std::int64_t>& overlaps) {
  if (overlaps.empty()) overlaps.resize(levels_.size());
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    Level& level = levels_[i];
    if (level.hits > 1 && blocks_ > 1) {
      const auto sum = static_cast<double>(level.sum);
      const double pairs = std::max(0.0, sum * sum - level.squares);
      overlaps[i] += static_cast<std::int64_t>(pairs / (blocks_ - 1.0) * squares_per_unit(rules_.scale));
    }
    level = {};
  }
  blocks_ = 0;
}

void HazardCell::cover(int low, int high) {
  const int end = first_ + static_cast<int>(bins_.size());
  if (bins_.empty()) {
    first_ = low;
    bins_.resize(static_cast<std::size_t>(high - low + 1));
    return;
  }
  if (low < first_) {
    bins_.insert(bins_.begin(), static_cast<std::size_t>(first_ - low), Bin{});
    first_ = low;
  }
  if (high >= end) {
    bins_.reserve(static_cast<std::size_t>(high - first_ + 1));  // no more than that: most cells see few bins
    bins_.resize(static_cast<std::size_t>(high - first_ + 1));
  }
}

void HazardCell::add(const HazardRules& rules, std::span<const float> energies,
                     std::span<const AnnualShare> annual_shares) {
  if (energies.empty()) return;
  TALUS_EXPECT(annual_shares.size() >= energies.size(), "each value has its annual share");
  const auto [low, high] = std::ranges::minmax_element(energies);
  cover(rules.bins.of(*low), rules.bins.of(*high));
  const double scale = squares_per_unit(rules.scale);
  StratumSums stratum(rules);
  for (std::size_t i = 0; i < energies.size(); ++i) {
    const AnnualShare& annual_share = annual_shares[i];
    if (annual_share.weight == 0) continue;
    TALUS_EXPECT(annual_share.weight > 0, "no event is taken back");
    Bin& bin = bins_[static_cast<std::size_t>(rules.bins.of(energies[i]) - first_)];
    const auto weight = static_cast<double>(annual_share.weight);
    bin.weight += annual_share.weight;
    bin.square += static_cast<std::int64_t>(std::ceil(weight * weight * scale));
    stratum.add(annual_share, energies[i], overlaps_);
  }
  stratum.finish(overlaps_);
}

void HazardCell::add_lengths(const HazardRules& rules, std::span<const float> lengths, const AnnualShare& annual_share,
                             double diameter) {
  if (annual_share.weight == 0) return;
  if (lengths_.empty()) lengths_.resize(rules.levels());
  const auto weight = static_cast<double>(annual_share.weight);
  const double square = weight * weight * squares_per_unit(rules.scale), room = rules.scale.room;
  for (std::size_t level = 0; level < lengths.size() && lengths[level] > 0.0F; ++level) {
    const double length = lengths[level];
    WeightedLengths& sums = lengths_[level];
    sums.length += rounded(weight * length * room / WeightedLengths::kLengthUnit);
    sums.by_diameter += rounded(weight * length * diameter * room / WeightedLengths::kDiameterUnit);
    sums.squares += static_cast<std::uint64_t>(std::ceil(square * length * room / WeightedLengths::kLengthUnit));
  }
}

void HazardCell::merge(const HazardCell& other) {
  if (!other.bins_.empty()) cover(other.first_, other.first_ + static_cast<int>(other.bins_.size()) - 1);
  for (std::size_t i = 0; i < other.bins_.size(); ++i) {
    Bin& bin = bins_[i + static_cast<std::size_t>(other.first_ - first_)];
    add_checked(bin.weight, other.bins_[i].weight);
    add_checked(bin.square, other.bins_[i].square);
  }
  overlaps_.resize(std::max(overlaps_.size(), other.overlaps_.size()));
  for (std::size_t i = 0; i < other.overlaps_.size(); ++i) add_checked(overlaps_[i], other.overlaps_[i]);
  lengths_.resize(std::max(lengths_.size(), other.lengths_.size()));
  for (std::size_t i = 0; i < other.lengths_.size(); ++i) {
    lengths_[i].length += other.lengths_[i].length;
    lengths_[i].by_diameter += other.lengths_[i].by_diameter;
    lengths_[i].squares += other.lengths_[i].squares;
  }
}

HazardCell HazardCell::restored(int first, const std::vector<Bin>& bins, const std::vector<std::int64_t>& overlaps,
                                const std::vector<WeightedLengths>& lengths) {
  HazardCell cell;
  cell.first_ = first;
  cell.bins_.assign(bins.begin(), bins.end());
  cell.overlaps_.assign(overlaps.begin(), overlaps.end());
  cell.lengths_.assign(lengths.begin(), lengths.end());
  return cell;
}

void HazardCell::save(ByteWriter& out) const {
  out.put(first_);
  out.put_all(std::span<const Bin>(bins_));
  out.put_all(std::span<const std::int64_t>(overlaps_));
  out.put_all(std::span<const WeightedLengths>(lengths_));
}

HazardCell HazardCell::restored(const HazardRules& rules, ByteReader& in) {
  const auto first = in.get<int>();
  const auto bins = in.get_all<Bin>();
  const auto overlaps = in.get_all<std::int64_t>();
  const auto lengths = in.get_all<WeightedLengths>();
  const auto most = static_cast<std::size_t>(rules.bins.count());
  if (first < 0 || bins.size() > most || static_cast<std::size_t>(first) > most - bins.size() ||
      overlaps.size() > rules.levels() || lengths.size() > rules.levels())
    throw std::out_of_range("bins of the hazard");
  return restored(first, bins, overlaps, lengths);
}

bool HazardCell::operator==(const HazardCell& other) const {
  return first_ == other.first_ && bins_ == other.bins_ && overlaps_ == other.overlaps_ && lengths_ == other.lengths_;
}

}  // namespace talus
