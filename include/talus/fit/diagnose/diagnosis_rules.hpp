#pragma once
#include <cstddef>
#include <cstdint>

#include "talus/fit/calibrate/search_rules.hpp"

namespace talus {

/// Numbers that rule a diagnosis, the same for every campaign. Each comment says what the number is, its unit and why
/// it has this value; where no reason is given, the value is a choice that has not been tuned.
/// docs/diagnosis-method.md, "Rules", has them as a table.
struct DiagnosisRules {
  SearchRules search;  ///< of all its fits

  // The residual
  /// Simulated values below which the rank of a measured one is not used [-]: as few as a row of the score needs.
  std::size_t fewest_values = 10;
  /// Share of the pooled correlations that is taken away [-], so that the correlation matrix can be inverted safely.
  double shrink = 0.1;
  /// Blocks below which a row of the residual table is left out [-].
  std::size_t fewest_blocks = 10;
  /// Variance of the number of crossings below which a row is left out [-]: with less that number is not nearly normal.
  double fewest_crossings = 5.0;

  // The candidates
  /// Amount of an effect that one would notice [z]. The score test moves a candidate by it; the prior of an effect,
  /// of sd 1 in z, is then four times as wide.
  double noticed = 0.25;
  /// Bands of other ground along the slope [-].
  int bands = 12;
  /// Neighbouring bands that are joined, at most [-]: a third of the slope.
  std::size_t most_joined = 4;
  /// Places of an undeclared barrier along the slope [-].
  int barrier_places = 16;
  /// Days up to which every set of them is tried [-]: 62 sets of six. Of more days only runs are tried.
  std::size_t few_days = 6;

  // The score test
  /// Amount by which a parameter of the base is moved for its signature [z].
  double base_step = 0.5;
  /// Standard deviation of a parameter of the base [z]: that of its prior, so that what the data do not constrain stays
  /// in place.
  double base_sd = 1.0;
  /// Newton steps of the base before the test, at most [-]: a ground at the bounds of its search, 2.5 sd from the
  /// start, gets to the start with them.
  int settling = 4;
  /// Statistic of the base's own scores up to which the base has settled, over the number of its parameters [-]: the
  /// mean of a right model.
  double settled = 1.0;
  /// Longest of these steps, by the parameter that moves most [z]: the standard deviation of its prior.
  double longest_move = 1.0;
  /// By how much the upper limit of `shape` is moved in the test, in all zones together [-]. The standard deviation
  /// that it is given is this times base_sd / base_step, 0.2: presets have 1.5, spheres 1.
  double other_shape = 0.1;
  /// Grounds among those that the measurements leave open from which data sets without an effect are drawn, in pairs
  /// [-]: of 2000 sets each gives 21.
  int open_grounds = 96;

  // The families
  /// Arrangements of a permutation test, the measured one included [-]: a p of 0.01 is then known to 0.001.
  std::size_t arrangements = 10000;
  /// Different rocks below which no property of the block can be named [-]: with five there are 120 arrangements, of
  /// which the best is no rarer than 0.008, four families corrected no rarer than 0.03.
  std::size_t fewest_rocks = 6;

  // The detection limits
  /// Standard errors at which an effect would be seen [-]: a test of a linear model then finds it in nearly all
  /// campaigns, also after the correction for the other families and places. docs/detection-limits.md has what is lost
  /// where the effect is not linear.
  double shown = 4.5;
  /// Screens across the slope that the limits with further speeds assume [-].
  int further_screens = 12;

  // The fits
  /// Gain by which a round of the quadratic model must lower the objective for another one [objective].
  double worth_a_round = 0.002;
  /// Gain that one more fitted number must bring, times the number of fitting blocks [objective]. Akaike's price, one
  /// unit of log likelihood, in units of the score: near the optimum of a normal forecast the score rises by 0.56 of
  /// it.
  double price = 0.56;
  /// Effects fitted after the first round, at most [-]: with an effect in the model a fit takes several times as long.
  std::size_t later_fits = 6;
  /// Effects whose fits are continued, at most, in the first round and in later ones [-].
  std::size_t contenders = 4, later_contenders = 2;
  /// Height above its minimum at which a first fit may have ended [objective]: an effect that is further behind cannot
  /// win any more.
  double unfinished = 0.02;
  /// Rounds by which the fit of the model that was chosen goes on, at most [-].
  int last_rounds = 6;
  /// Rise of the objective over that without an effect at which larger amounts of it are not tried [objective]:
  /// fourteen times the noise of a total. An effect whose smallest amount costs as much is not fitted.
  double hopeless = 0.1;
  /// Share of `worth_naming` from which on the longer fit of an effect may yet get there [-].
  double half_way = 0.5;

  // The folds
  /// Vertices that the loop over all rows may trace for its folds to choose their effects anew [1e9]: alone, without
  /// further fits of the ground, it then takes less than twenty minutes on two processors with them.
  /// docs/diagnosis-time.md.
  double costly = 2.5;
  /// Vertices, traced or foreseen, beyond which a diagnosis makes no further fit of the ground, and fits no effects
  /// after its first round [1e9]. By the time of ginkgo 38 minutes of one core (docs/diagnosis-time.md).
  double enough = 12.0;

  // The choice
  /// Share of the objective that an effect must take away on the fitting rows [-]: gains differ by 1 to 2 % from seed
  /// to seed.
  double worth_naming = 0.02;
  /// Least share in cross-validation [-]: half, as each fold is fitted to fewer blocks and pays the price of its
  /// numbers.
  double worth_unseen = 0.01;
  /// Least amount of an effect, in units of what one would notice [-]: less of it explains nothing.
  double least_amount = 0.1;
  /// Parts into which the blocks are cut in cross-validation [-].
  std::size_t folds = 5;
  /// Random orders in which the blocks are cut [-]: one order may be unlucky.
  std::uint32_t fold_orders = 5;
  /// Trials that confirm a choice, as a multiple of those that compare fits [-]: half their noise.
  std::uint32_t confirming = 4;

  // Few blocks
  /// Fitting blocks for which the numbers of trials are meant [-]. Fewer blocks get more trials each.
  double many_blocks = 72.0;
  /// Multiple of the trials per block, at most [-], so that five blocks do not ask for thousands.
  double most_of_one = 4.0;
  /// Trials per block, at least [-]: with fewer, a block that rarely stops is not scored and hides behind the
  /// climatology.
  std::uint32_t fewest_of_one = 20;
};

/// A number of vertices [1e9].
inline double billions(std::uint64_t vertices) {
  return 1e-9 * static_cast<double>(vertices);
}

}  // namespace talus
