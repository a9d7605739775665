#include "talus/fit/diagnose/several_sites.hpp"

#include <algorithm>

#include "choice.hpp"
#include "joint_fits.hpp"
#include "outer_folds.hpp"
#include "talus/fit/diagnose/candidates.hpp"
#include "talus/fit/diagnose/detection_limits.hpp"
#include "talus/fit/diagnose/diagnose.hpp"
#include "talus/fit/diagnose/families.hpp"

namespace talus {
namespace {

using Eigen::VectorXd;

std::size_t fitting_blocks(const Campaign& campaign) {
  return count_of_rows(fitting_rows(campaign));
}

/// Options with the trials of so many blocks.
DiagnoseOptions for_blocks(DiagnoseOptions options, std::size_t blocks) {
  options.trials = raised_for_few_blocks(options.trials, blocks, options.rules);
  return options;
}

std::size_t all_blocks(std::span<const Site> sites) {
  std::size_t blocks = 0;
  for (const Site& site : sites) blocks += fitting_blocks(*site.campaign);
  return blocks;
}

/// What the tests of a site leave for the fits of its effects.
struct SiteTests {
  std::vector<Candidate> candidates;
  ScoreTest score_test;
};

/// The work of one diagnosis of several campaigns.
class SitesLoop {
 public:
  /// @param brief  for a repetition without a fold: as LoopScope::brief
  SitesLoop(std::span<const Site> sites, const DiagnoseOptions& options, bool brief = false)
      : sites_(sites),
        brief_(brief),
        asked_(options),
        options_(for_blocks(options, all_blocks(sites))),
        rules_(options_.rules),
        fits_(sites, options_, [this](double share) { return proceeds(share); }) {}

  SitesDiagnosis run(std::span<const Model> start) {
    SitesDiagnosis d;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      d.sites.push_back(of_site(i, start[i]));
      advance(0.5 / static_cast<double>(sites_.size()));
      d.base.push_back(d.sites.back().base.model);
    }
    d.trials = options_.trials;
    JointRound first;
    first.family = pooled_family(own_runs(d.sites), {});
    d.p_value = correct_all(d.sites, first.family);
    if (!(first.family.p_corrected <= options_.first_level)) {
      first.effect = d.p_value <= options_.later_level ? "unexplained" : "none";
      d.rounds.push_back(std::move(first));
      d.with_effects = d.base;
      return d;
    }
    JointModel model = fits_.fit_ground(d.sites);
    advance(0.1);
    d.base = model.models;
    add_effects(d, std::move(first), std::move(model));
    return d;
  }

 private:
  void advance(double share) { progress_ = std::min(0.95, progress_ + share); }
  bool proceeds(double share) {
    if (progress_ == 0.0) ground_ = std::max(ground_, 0.2 * share);
    return !asked_.proceed || asked_.proceed(std::max(progress_, ground_));
  }

  /// Number of families over which p is corrected: the pooled one and the others of each site.
  std::size_t families() const { return 1 + (kFamilies - 1) * sites_.size(); }

  /// The ground of a site, with the tests of all its families.
  SiteDiagnosis of_site(std::size_t site, const Model& start) {
    const Campaign& campaign = *sites_[site].campaign;
    const std::vector<bool> rows = fitting_rows(campaign);
    const DiagnoseOptions own = for_blocks(asked_, fitting_blocks(campaign));
    EffectFits fits(campaign, own, rows, [this](double share) { return proceeds(share); });
    SiteDiagnosis out;
    out.name = sites_[site].name;
    out.trials = own.trials;
    out.base = fits.begin_round(fits.fit_ground(start, brief_));
    SiteTests tests;
    tests.candidates = candidates_of(campaign, out.base.model, out.base.runs, {}, rules_);
    const ScoreTestOptions how = score_test_options(own, families(), [this] { return proceeds(1.0); });
    tests.score_test =
        settled_test(campaign, {out.base.model, out.base.free, out.base.z, out.base.runs}, tests.candidates, rows, how,
                     [&](const Model& model) { return fits.observed_in(campaign, model); })
            .test;
    const ResidualSpace space(campaign, out.base.runs, rules_);
    out.families = test_families({campaign, space, out.base.runs, rows, tests.score_test},
                                 {how.replicates, own.seed, rules_, options_.level_of_round(0)});
    if (!brief_) {
      out.residual = residual_table(campaign, space, out.base.runs, rows, rules_);
      out.limits =
          detection_limits(campaign, axis_of(campaign, out.base.runs), tests.score_test, tests.candidates, rules_);
      complete_limits(out.limits, out.families, {});
    }
    tests_.push_back(std::move(tests));
    return out;
  }

  static std::vector<const std::vector<BlockRuns>*> own_runs(const std::vector<SiteDiagnosis>& sites) {
    std::vector<const std::vector<BlockRuns>*> runs;
    for (const SiteDiagnosis& site : sites) runs.push_back(&site.base.runs);
    return runs;
  }

  /// The family of all sites together, without the effects that were found.
  FamilyTest pooled_family(const std::vector<const std::vector<BlockRuns>*>& runs,
                           const std::vector<std::string>& found) const {
    std::vector<std::vector<double>> energies;
    for (std::size_t i = 0; i < sites_.size(); ++i)
      energies.push_back(
          energy_by_block(ResidualSpace(*sites_[i].campaign, *runs[i], rules_), *runs[i], fits_.rows()[i]));
    std::vector<BlockNumbers> numbers;
    for (std::size_t i = 0; i < sites_.size(); ++i) numbers.push_back({*sites_[i].campaign, energies[i]});
    FamilyTest family = test_block_property(
        numbers, {options_.replicates(families()), options_.seed, rules_, options_.level_of_round(found.size())});
    std::erase_if(family.members, [&](const std::string& m) { return std::ranges::find(found, m) != found.end(); });
    return family;
  }

  /// Holm over the pooled family and those of the sites that are not pooled. @return the smallest
  double correct_all(std::vector<SiteDiagnosis>& sites, FamilyTest& pooled) const {
    std::vector<FamilyTest*> all{&pooled};
    for (SiteDiagnosis& site : sites)
      for (FamilyTest& family : site.families) {
        family.p_corrected = kNotGiven;
        if (family.name != pooled.name) all.push_back(&family);
      }
    correct(all);
    double smallest = 1.0;
    for (const FamilyTest* family : all)
      if (family->p_corrected < smallest) smallest = family->p_corrected;
    return smallest;
  }

  void add_effects(SitesDiagnosis& d, JointRound first, JointModel model) {
    std::vector<std::string> found;
    for (int number = 0;; ++number) {
      model = fits_.begin_round(std::move(model));
      JointRound round = std::move(first);
      if (number > 0) {
        std::vector<const std::vector<BlockRuns>*> runs;
        for (const auto& own : model.runs) runs.push_back(&own);
        round = JointRound{};
        round.family = pooled_family(runs, found);
        round.family.p_corrected = round.family.p_value;
      }
      const double level = options_.level_of_round(static_cast<std::size_t>(number));
      if (number < options_.effects_at_most() && round.family.may_name && round.family.p_corrected <= level)
        compete(model, round);
      const double smallest = number == 0 ? d.p_value : round.family.p_corrected;  // of the families of the sites, too
      if (round.effect == "none" && smallest <= options_.later_level) round.effect = "unexplained";
      const bool more = names_effect(round.effect);
      if (more) {
        if (!brief_) fits_.complete(model, round.candidates.front());
        found.push_back(round.effect);
        model = round.candidates.front().fitted;
      }
      d.rounds.push_back(std::move(round));
      if (!more) break;
    }
    d.with_effects = model.models;
  }

  /// Every place or variant of an effect that some sites have, by site.
  std::vector<SiteCandidates> variants_of(const std::string& effect) const {
    std::vector<std::string> places;
    for (const SiteTests& tests : tests_)
      for (const Candidate& c : tests.candidates)
        if (c.effect == effect && std::ranges::find(places, c.where) == places.end()) places.push_back(c.where);
    std::vector<SiteCandidates> variants;
    for (const std::string& place : places) {
      variants.emplace_back();
      for (const SiteTests& tests : tests_) {
        const auto own = std::ranges::find_if(
            tests.candidates, [&](const Candidate& c) { return c.effect == effect && c.where == place; });
        variants.back().push_back(own == tests.candidates.end() ? std::nullopt : std::optional(*own));
      }
    }
    return variants;
  }

  /// Amounts from which the fit of an effect may start: the estimates of the sites, and what one would notice.
  std::vector<VectorXd> estimates_of(const std::string& effect, std::size_t tested) const {
    std::vector<VectorXd> all;
    for (const SiteTests& tests : tests_)
      for (const EffectVerdict& verdict : tests.score_test.effects)
        if (verdict.effect == effect) all.push_back(verdict.best.estimate);
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(tested); ++i)
      for (const double sign : {1.0, -1.0}) all.push_back(sign * VectorXd::Unit(static_cast<Eigen::Index>(tested), i));
    return all;
  }

  /// Fits the effects of the family, each in its best variant, and chooses among them.
  void compete(const JointModel& base, JointRound& round) {
    for (const std::string& effect : round.family.members) {
      const std::vector<SiteCandidates> variants = variants_of(effect);
      Evaluation best;
      const SiteCandidates* chosen = nullptr;
      for (const SiteCandidates& variant : variants) {
        const auto own = std::ranges::find_if(variant, [](const auto& c) { return c.has_value(); });
        Evaluation here = fits_.best_start(base, variant, estimates_of(effect, (*own)->tested));
        if (chosen == nullptr || here.objective < best.objective) best = std::move(here), chosen = &variant;
      }
      if (chosen == nullptr) continue;  // blocks are spheres at all sites
      round.candidates.push_back(fits_.fit_effect(base, *chosen, best.z));
      advance(0.1);
    }
    const std::vector<Score> before = fits_.cross_validated(base, Judges::Choice);
    for (JointCandidate& c : round.candidates)
      set_cross_validated(c, before, fits_.cross_validated(c.fitted, Judges::Choice), fits_.streams());
    const Choice choice(base.objective, rules_, fits_.streams());
    choice.rank(round.candidates);
    choice.name_in(round, [&](const JointCandidate& c) { return fits_.confirmation(base, c); });
  }

  std::span<const Site> sites_;
  bool brief_;
  DiagnoseOptions asked_, options_;  // trials as asked for, and raised for the blocks of all sites
  const DiagnosisRules& rules_;
  JointFits fits_;
  std::vector<SiteTests> tests_;
  double progress_ = 0.0, ground_ = 0.0;
};

/// The diagnosis without a fold of every site, which then simulates the blocks of these folds.
void validate_fold(std::span<const Site> sites, std::span<const Model> start, DiagnosisWork& work, std::uint32_t fold,
                   std::vector<NestedValidation>& nested) {
  std::vector<Campaign> rest;
  std::vector<Site> left;
  rest.reserve(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) {
    rest.push_back(without_fold(*sites[i].campaign, nested[i].folds, fold));
    left.push_back({sites[i].name, &rest.back()});
  }
  const SitesDiagnosis found = SitesLoop(left, work.next(true), true).run(start);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Campaign& campaign = *sites[i].campaign;
    simulate_fold(campaign, work.options(), fold, found.base[i], found.with_effects[i], nested[i]);
    OuterFold loop = left_out(campaign, nested[i].folds, fold);
    loop.p_value = found.p_value;
    note_found(loop, found.rounds);
    nested[i].loops.push_back(std::move(loop));
  }
}

/// Why a site cannot be cross-validated; empty if all can.
std::string lack_at_a_site(std::span<const Site> sites, const DiagnoseOptions& options) {
  for (const Site& site : sites) {
    const Campaign& campaign = *site.campaign;
    const OuterFolds folds = outer_folds(campaign, fitting_rows(campaign), options.outer_folds, options.seed);
    if (const std::string lack = lack_of_fitting_rows(campaign, folds); !lack.empty()) return site.name + ": " + lack;
  }
  return {};
}

}  // namespace

SitesDiagnosis diagnose_sites(std::span<const Site> sites, std::span<const Model> start,
                              const DiagnoseOptions& options) {
  const std::string lack = options.nested ? lack_at_a_site(sites, options) : "";
  DiagnoseOptions how = options;
  how.nested = options.nested && lack.empty();
  DiagnosisWork work(how);
  SitesDiagnosis d = SitesLoop(sites, work.next(false)).run(start);
  d.not_nested = lack;
  if (!how.nested) return d;
  for (const Site& site : sites) d.nested.push_back(folds_to_validate(*site.campaign, how, d.trials.compare));
  for (std::uint32_t fold = 0; fold < how.outer_folds; ++fold) validate_fold(sites, start, work, fold, d.nested);
  return d;
}

}  // namespace talus
