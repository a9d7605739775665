#include "repeated_fits.hpp"

#include <algorithm>

namespace talus {
namespace {

constexpr const char* kRepeatedFits = "repeated fits";  // of the time sheet

/// The fit of the most frequent verdict; the first one where it is among the most frequent.
std::size_t fit_to_report(const Stability& stability) {
  const auto count = [&](const std::string& name) {
    return std::ranges::count(stability.fits, name, &BaseFitVerdict::effect);
  };
  const std::string most = verdicts_of(stability).front();
  if (count(stability.fits.front().effect) == count(most)) return 0;
  return static_cast<std::size_t>(std::ranges::find(stability.fits, most, &BaseFitVerdict::effect) -
                                  stability.fits.begin());
}

}  // namespace

BaseFitVerdict verdict_of(const Diagnosis& diagnosis, std::uint64_t seed) {
  const DiagnosisRound& first = diagnosis.rounds.front();
  return {seed, first.effect, first.where, first.p_value, first.families};
}

Diagnosis repeated_diagnosis(const Campaign& campaign, const Model& start, DiagnosisWork& work) {
  const std::uint64_t seed = work.options().seed;
  Diagnosis whole = run_loop(campaign, start, work.next(false), {});
  Stability stability;
  stability.fits.push_back(verdict_of(whole, seed));
  LoopScope brief;
  brief.brief = brief.first_round = true;
  Timesheet repetitions;
  double traced = billions(whole.vertices), next = kBrief * traced;
  for (int number = 1; number < work.options().base_fits_at_most(); ++number) {
    if (!work.options().base_fits && traced + next > work.options().rules.enough) {
      stability.left_out = work.options().base_fits_at_most() - number;
      break;
    }
    const Timesheet::Phase phase(repetitions, kRepeatedFits);
    DiagnoseOptions options = work.next(true);
    options.seed = seed_of_fit(seed, static_cast<std::size_t>(number));
    const Diagnosis repeated = run_loop(campaign, start, options, brief);
    stability.fits.push_back(verdict_of(repeated, options.seed));
    next = billions(repeated.vertices);
    traced += next;
  }
  stability.reported = fit_to_report(stability);
  if (stability.reported != 0) {
    DiagnoseOptions options = work.next(false);
    options.seed = stability.fits[stability.reported].seed;
    for (const PhaseTime& time : whole.times.phases()) repetitions.add({kRepeatedFits, "", time.cpu});
    whole = run_loop(campaign, start, options, {});
    stability.fits[stability.reported] = verdict_of(whole, options.seed);
  }
  whole.stability = std::move(stability);
  whole.times.add(repetitions);
  return whole;
}

}  // namespace talus
