#include "talus/products/profile_bins.hpp"

#include <algorithm>
#include <cmath>

#include "simulate/tally/span_maxima.hpp"
#include "talus/base/expect.hpp"
#include "talus/simulate/scenario/scenario.hpp"

namespace talus {
namespace {

constexpr Maxima kNotThere{-1.0F, 0.0F};

}  // namespace

BinDistribution distribution_of(std::vector<float> values) {
  BinDistribution d;
  d.count = values.size();
  if (values.empty()) {
    d.mean = d.p50 = d.p95 = d.p99 = d.max = kNotGiven;
    return d;
  }
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto rank = [&](double share) {
    return static_cast<double>(values[static_cast<std::size_t>(std::max(1.0, std::ceil(share * n))) - 1]);
  };
  double sum = 0.0;
  for (const float value : values) sum += value;
  d.mean = sum / n;
  d.p50 = rank(0.5);
  d.p95 = rank(0.95);
  d.p99 = rank(0.99);
  d.max = values.back();
  return d;
}

ProfileBins::ProfileBins(int columns, double step, double width)
    : width_(width), columns_per_bin_(static_cast<int>(std::lround(width / step))) {
  values_.resize(static_cast<std::size_t>((columns + columns_per_bin_ - 1) / columns_per_bin_));
}

void ProfileBins::add(const Path& path, double mass) {
  std::vector<Maxima> records(values_.size(), kNotThere);
  for (const Span& span : path.spans) {  // a span lies in one column, so in one bin
    TALUS_EXPECT(static_cast<std::size_t>(span.patch.column / columns_per_bin_) < records.size(),
                 "a path stays on its profile");
    Maxima& record = records[static_cast<std::size_t>(span.patch.column / columns_per_bin_)];
    raise(record, span, {0.0F, span.height_from, span.rise_from}, {1.0F, span.height_to, span.rise_to});
  }
  const std::lock_guard guard(mutex_);
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].speed_squared < 0.0F) continue;
    const auto value = [&](Quantity q) { return kQuantityTable[index_of(q)].value(records[i], mass); };
    values_[i].speed.push_back(value(Quantity::Speed));
    values_[i].energy.push_back(value(Quantity::Energy));
    values_[i].height.push_back(value(Quantity::Height));
  }
}

std::vector<ProfileBin> ProfileBins::bins() const {
  std::vector<ProfileBin> bins;
  for (const Values& values : values_) {
    const double from = width_ * static_cast<double>(bins.size());
    bins.push_back({from, from + width_, distribution_of(values.speed), distribution_of(values.energy),
                    distribution_of(values.height)});
  }
  return bins;
}

void RunoutCounter::add(std::span<const StopRow> rows) {
  for (const StopRow& row : rows) {
    ++counts_.released;
    if (!rests(row.end)) continue;
    const double distance = std::abs(row.x - row.x_release);
    distances_.push_back(static_cast<float>(distance));
    const auto bin = static_cast<std::size_t>(distance / width_);
    if (bin >= counts_.stops.size()) counts_.stops.resize(bin + 1);
    ++counts_.stops[bin];
  }
}

Runout RunoutCounter::result() const {
  Runout runout = counts_;
  runout.stopped = distribution_of(distances_);
  return runout;
}

}  // namespace talus
