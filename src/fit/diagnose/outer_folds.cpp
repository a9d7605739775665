#include "outer_folds.hpp"

#include <algorithm>
#include <map>

#include "effect_fits.hpp"
#include "talus/base/error.hpp"
#include "talus/fit/campaign/block_draws.hpp"
#include "talus/fit/diagnose/diagnose.hpp"

namespace talus {
namespace {

constexpr double kCandidates = 0.96;  // progress when the candidates are simulated out of fold

/// A group or a block, which is left out as a whole.
struct FoldUnit {
  double key = 0.0;  // decides its place in the order
  std::string name;
  std::vector<std::size_t> blocks;
};

/// @param by_group  else each block is a unit
std::vector<FoldUnit> units_of(const Campaign& campaign, const std::vector<bool>& rows, bool by_group,
                               std::uint64_t seed) {
  std::map<std::string, FoldUnit> named;
  for (std::size_t b = 0; b < rows.size(); ++b) {
    if (!rows[b]) continue;
    const MeasuredBlock& block = campaign.blocks[b];
    FoldUnit& unit = named[by_group ? block.group : block.id];
    unit.name = by_group ? block.group : block.id;
    unit.key = draw_of_block(seed, by_group ? stream_of_name(block.group) : block.stream, kNoFold, BlockDraw::Order);
    unit.blocks.push_back(b);
  }
  std::vector<FoldUnit> units;
  for (auto& [name, unit] : named) units.push_back(std::move(unit));
  std::ranges::stable_sort(units, {}, &FoldUnit::key);
  return units;
}

bool groups_can_be_left_out(const Campaign& campaign, const std::vector<bool>& rows, std::size_t folds) {
  std::map<std::string, std::size_t> blocks;
  std::size_t all = 0, largest = 0;
  for (std::size_t b = 0; b < rows.size(); ++b) {
    if (!rows[b]) continue;
    if (campaign.blocks[b].group.empty()) return false;
    ++all;
    largest = std::max(largest, ++blocks[campaign.blocks[b].group]);
  }
  return blocks.size() >= folds && 2 * largest <= all;
}

bool splits_groups(const Campaign& campaign, const OuterFolds& folds) {
  std::map<std::string, std::uint32_t> fold_of;
  for (std::size_t b = 0; b < folds.fold_of.size(); ++b) {
    const std::string& group = campaign.blocks[b].group;
    if (group.empty() || folds.fold_of[b] == kNoFold) continue;
    if (fold_of.emplace(group, folds.fold_of[b]).first->second != folds.fold_of[b]) return true;
  }
  return false;
}

void forget(MeasuredBlock& block) {
  block.holdout = true;
  block.stop.reset();
  block.stop_mass.reset();
  for (std::optional<Passage>& passage : block.passages) passage.reset();
  block.samples.clear();
}

/// Settings with which every left-out block is simulated, whichever model it is.
ObserveOptions unseen_runs(const Campaign& campaign, const DiagnoseOptions& options, std::uint32_t trials) {
  ObserveOptions how;
  how.trials = trials;
  how.seed = options.seed + 1;
  how.threads = options.threads;
  how.blocks.assign(campaign.blocks.size(), false);
  return how;
}

/// Repeats the loop without each fold and simulates the fold's blocks with what it found.
void validate_by_choosing(const Campaign& campaign, const Model& start, DiagnosisWork& work, NestedValidation& nested) {
  LoopScope scope;
  scope.brief = true;
  for (std::uint32_t fold = 0; fold < nested.folds.count; ++fold) {
    const Diagnosis part = run_loop(without_fold(campaign, nested.folds, fold), start, work.next(true), scope);
    simulate_fold(campaign, work.options(), fold, part.base.model, part.with_effects.model, nested);
    nested.loops.push_back(left_out(campaign, nested.folds, fold));
    note_found(nested.loops.back(), part.rounds);
    nested.loops.back().p_value = part.rounds.front().p_value;
  }
}

}  // namespace

OuterFolds outer_folds(const Campaign& campaign, const std::vector<bool>& rows, std::size_t folds, std::uint64_t seed) {
  OuterFolds out;
  out.count = folds;
  out.by_group = groups_can_be_left_out(campaign, rows, folds);
  out.fold_of.assign(rows.size(), kNoFold);
  std::vector<FoldUnit> units = units_of(campaign, rows, out.by_group, seed);
  std::ranges::stable_sort(units, std::greater<>{}, [](const FoldUnit& unit) { return unit.blocks.size(); });
  std::vector<std::size_t> blocks(folds, 0);
  for (const FoldUnit& unit : units) {  // the largest first, each to the smallest fold
    const auto fold = static_cast<std::size_t>(std::ranges::min_element(blocks) - blocks.begin());
    for (const std::size_t b : unit.blocks) out.fold_of[b] = static_cast<std::uint32_t>(fold);
    blocks[fold] += unit.blocks.size();
  }
  out.splits_groups = splits_groups(campaign, out);
  return out;
}

Campaign without_fold(const Campaign& campaign, const OuterFolds& folds, std::uint32_t fold) {
  Campaign rest = campaign;
  for (std::size_t b = 0; b < rest.blocks.size(); ++b)
    if (folds.fold_of[b] == fold || folds.fold_of[b] == kNoFold) forget(rest.blocks[b]);
  return rest;
}

std::string lack_of_fitting_rows(const Campaign& campaign, const OuterFolds& folds) {
  const std::string way = "cross-validation in " + std::to_string(folds.count) + " folds";
  const auto blocks = folds.fold_of.size() - static_cast<std::size_t>(std::ranges::count(folds.fold_of, kNoFold));
  if (blocks < 2 * folds.count)
    return way + " needs at least " + std::to_string(2 * folds.count) + " fitting rows, not " + std::to_string(blocks);
  for (std::uint32_t fold = 0; fold < folds.count; ++fold) {
    const Campaign rest = without_fold(campaign, folds, fold);
    if (score_of_climatology(rest, fitting_rows(rest)).groups.empty())
      return way + ": without fold " + std::to_string(fold + 1) + " no quantity has five values that differ";
  }
  return {};
}

void require_fitting_rows(const Campaign& campaign, const OuterFolds& folds) {
  if (const std::string lack = lack_of_fitting_rows(campaign, folds); !lack.empty())
    throw InputError(lack + ": measure more, give other --folds, or leave it out with --no-nested");
}

OuterFold left_out(const Campaign& campaign, const OuterFolds& folds, std::uint32_t fold) {
  OuterFold out;
  for (std::size_t b = 0; b < folds.fold_of.size(); ++b) {
    if (folds.fold_of[b] != fold) continue;
    ++out.blocks;
    const std::string& group = campaign.blocks[b].group;
    if (folds.by_group && std::ranges::find(out.groups, group) == out.groups.end()) out.groups.push_back(group);
  }
  return out;
}

NestedValidation folds_to_validate(const Campaign& campaign, const DiagnoseOptions& options, std::uint32_t trials) {
  NestedValidation nested;
  nested.folds = outer_folds(campaign, fitting_rows(campaign), options.outer_folds, options.seed);
  nested.trials = trials;
  nested.base.resize(campaign.blocks.size());
  nested.found.resize(campaign.blocks.size());
  return nested;
}

void simulate_fold(const Campaign& campaign, const DiagnoseOptions& options, std::uint32_t fold, const Model& base,
                   const Model& found, NestedValidation& nested) {
  ObserveOptions how = unseen_runs(campaign, options, nested.trials);
  for (std::size_t b = 0; b < how.blocks.size(); ++b) how.blocks[b] = nested.folds.fold_of[b] == fold;
  for (const auto& [model, runs] : {std::pair{&base, &nested.base}, {&found, &nested.found}}) {
    std::vector<BlockRuns> seen = observe(campaign, *model, how);
    for (std::size_t b = 0; b < seen.size(); ++b)
      if (how.blocks[b]) (*runs)[b] = std::move(seen[b]);
  }
}

NestedValidation nested_validation(const Campaign& campaign, const Model& start, DiagnosisWork& work,
                                   const Diagnosis& whole) {
  NestedValidation nested = folds_to_validate(campaign, work.options(), whole.trials.compare);
  const bool costly = billions(whole.vertices) > work.options().rules.costly;
  nested.naming = work.options().naming_in_folds.value_or(!costly);
  if (nested.naming) validate_by_choosing(campaign, start, work, nested);
  DiagnoseOptions options = work.options();
  options.trials = whole.trials;
  const std::vector<bool> rows = fitting_rows(campaign);
  const EffectFits fits(campaign, options, rows,
                        [&](double) { return !options.proceed || options.proceed(kCandidates); });
  const ObserveOptions how = unseen_runs(campaign, options, nested.trials);
  const auto refitted = [&](const FittedModel& fitted) {
    return fits.out_of_fold(fitted, nested.folds.fold_of, nested.folds.count, how);
  };
  nested.ground = refitted(whole.base);
  const std::vector<FittedCandidate>& candidates = whole.rounds.front().candidates;
  if (!std::ranges::all_of(candidates, &FittedCandidate::with_ground)) {
    ObserveOptions every_fold = how;
    every_fold.blocks = rows;
    nested.held = observe(campaign, whole.base.model, every_fold);
  }
  for (const FittedCandidate& candidate : candidates)
    nested.candidates.push_back(candidate.refined ? refitted(candidate.fitted) : std::vector<BlockRuns>{});
  if (!nested.naming) {
    nested.base = nested.ground;
    nested.found = refitted(whole.with_effects);
    for (std::uint32_t fold = 0; fold < nested.folds.count; ++fold) {
      nested.loops.push_back(left_out(campaign, nested.folds, fold));
      note_found(nested.loops.back(), whole.rounds);
    }
  }
  return nested;
}

}  // namespace talus
