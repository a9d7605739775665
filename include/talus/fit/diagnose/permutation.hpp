#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace talus {

/// Things that could have changed places if nothing depended on which is which: blocks, or rocks.
struct Units {
  std::vector<std::uint32_t> streams;  ///< random numbers of each; a unit has the same ones in every data set
  std::vector<std::size_t> strata;     ///< units change places only within their stratum: a site, a group

  std::size_t size() const { return streams.size(); }
};

/// Result of a permutation test.
struct PermutationTest {
  double p_value = 1.0;
  std::size_t arrangements = 0;  ///< that were compared, the measured one included
  bool exact = false;            ///< these are all that there are
  double least = 0.0;            ///< the smallest p-value that any of them could have had
};

/// Ways in which the units of each stratum can hand each other their values: all of them where there are few, else a
/// random choice. They depend on the streams of the units and not on their order.
class Arrangements {
 public:
  /// @param at_most  number of arrangements, the measured one included
  Arrangements(const Units& units, std::size_t at_most, std::uint64_t seed);

  std::size_t size() const { return givers_.size(); }
  /// All arrangements, not a choice of them.
  bool exact() const { return exact_; }
  /// By unit: the one whose value it gets. Number 0 leaves all in place.
  std::span<const std::size_t> givers(std::size_t number) const { return givers_[number]; }

  /// Share of the arrangements, the measured one included, with a statistic as large as the measured one. If the
  /// values could have changed places, it is at most `alpha` in a share `alpha` of all data sets, for every alpha.
  PermutationTest test(const std::function<double(std::span<const std::size_t> givers)>& statistic) const;

 private:
  void enumerate(const std::vector<std::vector<std::size_t>>& members, std::size_t units);
  void choose(const Units& units, const std::vector<std::vector<std::size_t>>& members, std::size_t at_most,
              std::uint64_t seed);

  std::vector<std::vector<std::size_t>> givers_;
  bool exact_ = false;
};

}  // namespace talus
