#pragma once
#include <array>
#include <atomic>
#include <functional>
#include <span>

#include "talus/fit/campaign/campaign.hpp"

namespace talus {

/// Bias of an instrument: the share of the true value by which it reads too high [-].
struct Bias {
  double speed = 0.0, jump = 0.0, spin = 0.0;
};

/// Numbers of the instruments of a campaign, in Model::bias.
inline constexpr std::size_t kSampler = 0;  ///< that of the samples
constexpr std::size_t instrument_of_screen(std::size_t screen) {
  return 1 + screen;
}

/// A model of a campaign: the ground of each zone, the impact law and the effects. It may also have zones, barriers and
/// errors of instruments that the campaign's files do not mention.
struct Model {
  std::vector<Ground> grounds;  ///< by zone: as Campaign::zone_names, or of `zones`
  ImpactModel impact;
  Effects effects;
  Raster<std::uint8_t> zones;     ///< instead of the campaign's; empty: the campaign's
  std::vector<Barrier> barriers;  ///< undeclared ones; they act as those of a run
  std::vector<Bias> bias;         ///< by instrument; those beyond its end have none
};

/// A model with the same ground in all zones of a campaign: the preset of this name, no effect.
/// Throws InputError for a name that is no preset.
Model model_of_preset(const Campaign& campaign, std::string_view preset);

/// Simulated measurements of one block, measurement error included. Arrays have one value per trial; NaN where nothing
/// was seen.
struct BlockRuns {
  struct AtScreen {
    std::vector<double> speed, jump, spin;  ///< of the first crossing [m/s], [m], [rad/s]; NaN: not crossed
  };
  struct AtSample {
    std::vector<double> speed,
        spin;  ///< where the path first reaches the sample's distance; NaN: never
  };

  std::uint32_t trials = 0;                 ///< 0: the block was not asked for
  std::vector<double> x, y;                 ///< place of rest [m, local]; NaN unless the block stays there and, if
                                            ///< blocks were mapped where they lie, in the mapped region of this one
  std::vector<double> mass_share;           ///< share of the mass that is left at the end [-]
  std::vector<AtScreen> screens;            ///< by screen of the campaign
  std::vector<AtSample> samples;            ///< by sample of the block
  std::vector<std::uint32_t> impacts;       ///< by trial
  std::vector<End> end;                     ///< by trial
  std::array<std::uint32_t, kEnds> ends{};  ///< trials by End
  std::vector<std::uint32_t> zone_hits;     ///< trials with an impact in each zone
  std::uint32_t elsewhere = 0;              ///< trials that come to rest in another mapped region than this block's
  std::uint32_t cut_short = 0;              ///< trials that ended at a limit, if `Effort` bounds them: in a search
};

/// The places where the trials of a block came to rest [m, local].
std::vector<Eigen::Vector2d> stops_of(const BlockRuns& runs);

/// First of the trials that score a fitted model: no search has used their random numbers.
inline constexpr std::uint32_t kUnseen = 1'000'000'000;

/// Thrown when a `proceed` returns false: the user has ended the fit.
struct FitInterrupted {};

/// Vertices that simulations have traced: what they cost, the same whatever the machine and the threads.
using TracedVertices = std::atomic<std::uint64_t>;

struct ObserveOptions {
  std::uint32_t trials = 100;  ///< per block
  std::uint64_t seed = 1;
  std::uint32_t first_trial = 0;       ///< number of the first trial; each number of a seed is another trajectory
  int threads = 0;                     ///< 0: as many as the machine has
  std::vector<bool> blocks = {};       ///< true for those that are simulated; empty: all
  std::function<bool()> proceed = {};  ///< called now and then, from any thread; false ends the work. May be empty
  Effort effort = {};                  ///< what each trajectory may cost; searches bound it
  int lanes = 0;  ///< trajectories in one instruction, as for Tracer; 0: as many as the processor has
  TracedVertices* traced = nullptr;  ///< those of this simulation are added; null: not counted
};

/// Simulates every block of a campaign and measures the paths as the campaign did.
///
/// @return one entry per block of the campaign, with trials = 0 for those not asked for (or not reached when `proceed`
///         returned false)
///
/// Common random numbers: the draws of (seed, stream of the block, trial), the place of release in its disc and the
/// errors of the measurement among them, do not depend on the model, so that two models are compared with the same
/// random numbers. Bits are equal for any number of threads, any order and any choice of blocks. A screen's values are
/// those of `screens.csv`. Precondition: model.grounds has one entry per zone.
std::vector<BlockRuns> observe(const Campaign& campaign, const Model& model, const ObserveOptions& options);

/// The release of one trial of a block, as `observe` makes it. A place without terrain gives a height of NaN.
Release release_of(const Campaign& campaign, std::uint32_t block, std::uint64_t seed, std::uint32_t trial);

}  // namespace talus
