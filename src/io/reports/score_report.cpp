#include "talus/io/reports/score_report.hpp"

#include <algorithm>
#include <cmath>

#include "coverage_report.hpp"
#include "deposit_report.hpp"
#include "evidence.hpp"
#include "io/scenario/fitted_on.hpp"
#include "talus/base/text.hpp"
#include "talus/fit/diagnose/diagnosis_rules.hpp"

namespace talus::io {
namespace {

/// @param few  whether a group has so few rows that it stays out of a headline
std::string cell(double score, const Interval& interval, std::size_t rows, bool few = false) {
  if (std::isnan(score)) return "       -                        -";
  const auto aligned = [](const std::string& text, std::size_t width) {
    return std::string(width - std::min(width, text.size()), ' ') + text;
  };
  return "  " + aligned(with_decimals(score, 3), 6) + "  " + aligned(with_decimals(interval.low, 3), 6) + " to " +
         aligned(with_decimals(interval.high, 3), 6) + "  " + aligned((few ? "*" : "") + std::to_string(rows), 5);
}

/// Names of the groups of all scores, in the order in which they first appear.
std::vector<std::string> group_names(std::span<const ScoredRows> scores) {
  std::vector<std::string> names;
  for (const ScoredRows& s : scores)
    for (const GroupScore& group : s.score.groups)
      if (std::find(names.begin(), names.end(), group.name) == names.end()) names.push_back(group.name);
  return names;
}

/// What the table does not say: marks, skill, the tail, the spread.
std::string notes_of(std::span<const ScoredRows> scores) {
  std::string text;
  for (const ScoredRows& s : scores)
    if (std::ranges::any_of(s.score.groups, [](const GroupScore& g) { return g.rows < kHeadlineRows; })) {
      text += "* fewer than " + std::to_string(kHeadlineRows) + " rows: one block may rule the group\n";
      break;
    }
  for (const ScoredRows& s : scores) text += judgement_lines(s);
  return text;
}

/// Score of a group of the climatology; NaN if there is no such group.
double score_of(const Score& score, const std::string& group) {
  const auto found = std::ranges::find(score.groups, group, &GroupScore::name);
  return found == score.groups.end() ? kNotGiven : found->score;
}

Json climatology_json(const ScoredRows& s) {
  return {{"score", json_of(s.climatology.total, six_decimals)},
          {"ci95", json_of(s.climatology_interval, six_decimals)},
          {"skill", json_of(s.skill.share, six_decimals)},
          {"skill_ci95", json_of(s.skill.interval, six_decimals)},
          {"ways_from_release",
           {{"score", json_of(s.ways.total, six_decimals)},
            {"skill", json_of(s.skill_over_ways.share, six_decimals)},
            {"skill_ci95", json_of(s.skill_over_ways.interval, six_decimals)}}}};
}

Json tail_json(const ScoredRows& s) {
  return {{"beyond_m", json_of(s.tail_begin)},
          {"score", json_of(s.tail.total, six_decimals)},
          {"ci95", json_of(s.tail_interval, six_decimals)},
          {"climatology", json_of(s.tail_climatology.total, six_decimals)},
          {"skill", json_of(s.tail_skill.share, six_decimals)},
          {"skill_ci95", json_of(s.tail_skill.interval, six_decimals)},
          {"rows", s.tail.rows.size()}};
}

/// Share of a score, on average over its groups, that is of rows with too few simulated values: these score as the
/// climatology.
double unseen_share(const Score& score) {
  double share = 0.0;
  for (const GroupScore& group : score.groups) share += static_cast<double>(group.unseen) / group.rows;
  return score.groups.empty() ? 0.0 : share / static_cast<double>(score.groups.size());
}

/// Skill against the climatology; NaN for a model that hardly simulates what was measured.
Reduction skill_of(const Score& score, const Score& climatology, std::span<const std::uint32_t> clusters) {
  if (score.rows.empty() || climatology.rows.empty() || hardly_simulated(score)) return {};
  return reduction(climatology, score, clusters);
}

constexpr const char* kWereFitted = "; these rows were fitted, which lowers their error without any skill";

/// "skill 9.3 % (95 %: 1.2 to 17.4 %)".
std::string skill_text(const Reduction& skill) {
  return "skill " + reduction_in_words(skill);
}

/// The climatology with the smaller error, of the places or by release: a model has skill if it beats this one.
struct Rival {
  double error;
  Reduction skill;  // over it
  std::string text;
};
Rival rival_of(const ScoredRows& s) {
  if (s.ways.total < s.climatology.total)
    return {s.ways.total, s.skill_over_ways,
            with_decimals(s.ways.total, 3) +
                " of the climatology by release (the other blocks' ways from their releases, begun at this block's)"};
  return {s.climatology.total, s.skill,
          "the climatology's " + with_decimals(s.climatology.total, 3) +
              (s.deposits ? " (blocks anywhere on the mapped ground)" : "")};
}

/// Skill that a fit of so many numbers shows on its own rows although it has none on others: the price of a number in
/// Akaike's criterion (`DiagnosisRules::price`), as if the groups were independent of each other.
double skill_of_fit(const ScoredRows& s) {
  double shares = 0.0;
  for (const GroupScore& group : s.compared.groups) shares += 1.0 / group.rows;
  const auto groups = static_cast<double>(s.compared.groups.size());
  return DiagnosisRules{}.price * s.fitted * shares / (groups * groups) / rival_of(s).error;
}

/// Number of blocks that were measured at rest, of which more than a quarter of the simulated trials leave the DEM. A
/// fit holds them back only from a half on, so that it may end below it. Of mapped blocks more than half: other blocks
/// of their sources may have left it.
std::size_t blocks_that_leave(const Campaign& campaign, std::span<const BlockRuns> runs, const std::vector<bool>& ask) {
  std::size_t leaving = 0;
  const std::uint32_t times = campaign.deposits == nullptr ? 4 : 2;
  for (std::size_t b = 0; b < runs.size(); ++b)
    if (ask[b] && campaign.blocks[b].stop && times * runs[b].ends[static_cast<std::size_t>(End::Left)] > runs[b].trials)
      ++leaving;
  return leaving;
}

/// Counts the asked blocks of which a quantity was measured; names it where no group of the score has this name.
class Uncounted {
 public:
  Uncounted(const Campaign& campaign, const std::vector<bool>& ask, const Score& score)
      : campaign_(campaign), ask_(ask), score_(score) {}

  template <class Measured>
  void look_for(const std::string& group, Measured measured) {
    std::size_t blocks = 0;
    for (std::size_t b = 0; b < campaign_.blocks.size(); ++b)
      if (ask_[b] && measured(campaign_.blocks[b])) ++blocks;
    if (blocks > 0 && std::ranges::count(score_.groups, group, &GroupScore::name) == 0)
      names.push_back(group + " (" + std::to_string(blocks) + " of " + std::to_string(count_of_rows(ask_)) + ")");
  }

  std::vector<std::string> names;  // with the number of blocks: "speed lower (3 of 20)"

 private:
  const Campaign& campaign_;
  const std::vector<bool>& ask_;
  const Score& score_;
};

/// Quantities that were measured of some of the asked blocks, but are no group of the score. Masses are not named: they
/// count only where blocks broke.
std::vector<std::string> measured_but_not_scored(const Campaign& campaign, const std::vector<bool>& ask,
                                                 const Score& score) {
  if (campaign.deposits != nullptr) return {};
  Uncounted uncounted(campaign, ask, score);
  uncounted.look_for("stop", [](const MeasuredBlock& b) { return b.stop.has_value(); });
  for (std::size_t s = 0; s < campaign.screens.size(); ++s) {
    const std::string& id = campaign.screens[s].id;
    uncounted.look_for("crossed " + id, [s](const MeasuredBlock& b) { return b.passages[s].has_value(); });
    for (const auto& [name, value] :
         {std::pair{"speed ", &Passage::speed}, {"jump ", &Passage::jump}, {"spin ", &Passage::spin}})
      uncounted.look_for(name + id, [s, member = value](const MeasuredBlock& b) {
        return b.passages[s] && !std::isnan((*b.passages[s]).*member);
      });
  }
  for (const auto& [name, value] : {std::pair{"sample speed", &Sample::speed}, {"sample spin", &Sample::spin}})
    uncounted.look_for(name, [member = value](const MeasuredBlock& b) {
      return std::ranges::any_of(b.samples, [member](const Sample& s) { return !std::isnan(s.*member); });
    });
  return std::move(uncounted.names);
}

/// Says that blocks leave the DEM in the model, and what that does to a fit; empty where few do.
std::string leaving_warning(const ScoredRows& s) {
  const std::string blocks =
      std::to_string(s.leaving) + " of " + std::to_string(s.blocks) + " " + rows_in_words(s.rows) + " ";
  if (s.deposits)
    return s.leaving == 0 ? ""
                          : "more than half of the trials of " + blocks +
                                "mapped blocks leave the DEM, and only those that stay are compared: the ground lets "
                                "blocks go too far, or the DEM is too small (a fit then makes run-outs too short)";
  const bool too_many = s.leaving_trials.p_value < kWrongSpread;
  if (s.leaving == 0 && !too_many) return {};
  const std::string trials = "of " + blocks +
                             "blocks more than a quarter of the trials leave the DEM, though these came to rest on it" +
                             (too_many ? " (" + leaving_text(s.leaving_trials) + ")" : "");
  return (s.leaving > 0 ? trials : rows_in_words(s.rows) + " rows: " + leaving_text(s.leaving_trials)) +
         ": the ground lets blocks go too far, or the DEM is too small or has gaps there (a fit then makes run-outs "
         "too short)";
}

}  // namespace

bool hardly_simulated(const Score& score) {
  // A group without simulated values scores better than its climatology, which leaves out the block's own value.
  const auto unseen = [](const GroupScore& group) { return 2 * group.unseen > group.rows; };
  return unseen_share(score) > 0.5 || std::ranges::any_of(score.groups, unseen);
}

std::string rows_in_words(const std::string& rows) {
  return rows == "fit" ? "fitting" : rows == "holdout" ? "held-out" : rows;
}

ScoredRows scored(const std::string& rows, const Campaign& campaign, std::span<const BlockRuns> runs,
                  const std::vector<bool>& ask, const std::vector<std::uint32_t>& folds) {
  const std::vector<std::uint32_t> clusters = clusters_of(campaign);
  ScoreOptions how{ScoreRule::Fair, kFewestSimulated, folds};
  ScoredRows out;
  out.rows = rows;
  out.blocks = static_cast<std::size_t>(std::count(ask.begin(), ask.end(), true));
  out.score = score(campaign, runs, ask, how);
  out.intervals = score_intervals(out.score, clusters);
  out.climatology = score_of_climatology(campaign, ask, how);
  out.climatology_interval = score_intervals(out.climatology, clusters).total;
  if (campaign.deposits == nullptr) {
    ScoreOptions knowing_releases = how;
    knowing_releases.ways_from_release = true;
    out.ways = score_of_climatology(campaign, ask, knowing_releases);
    out.ways_interval = score_intervals(out.ways, clusters).total;
  }
  ScoreOptions without_own = how;
  without_own.own_value_too = false;
  out.compared = folds.empty() ? score(campaign, runs, ask, without_own) : out.score;  // out of fold no row has it
  out.skill = skill_of(out.compared, out.climatology, clusters);
  out.skill_over_ways = skill_of(out.compared, out.ways, clusters);
  out.tail_begin = tail_begin(campaign);
  out.tail = tail_score(campaign, runs, ask, folds);
  out.tail_interval = score_intervals(out.tail, clusters).total;
  out.tail_climatology = tail_score_of_climatology(campaign, ask, folds);
  out.tail_skill = skill_of(out.tail, out.tail_climatology, clusters);
  out.coverage = coverage(campaign, runs, ask);
  out.leaving_trials = leaving_test(campaign, runs, ask);
  out.leaving = blocks_that_leave(campaign, runs, ask);
  out.not_counted = measured_but_not_scored(campaign, ask, out.score);
  if (campaign.deposits != nullptr) {
    out.deposits = check_deposits(campaign, runs, ask);
    return out;
  }
  how.rule = ScoreRule::LogDensity;
  out.log_score = score(campaign, runs, ask, how);
  out.log_climatology = score_of_climatology(campaign, ask, how);
  return out;
}

BeforeAfter compared(const Campaign& campaign, ScoredRows before, ScoredRows after) {
  const std::vector<std::uint32_t> clusters = clusters_of(campaign);
  const Reduction whole = reduction(before.score, after.score, clusters);
  const Reduction tail = reduction(before.tail, after.tail, clusters);
  const NatsGained nats = nats_gained(before.log_score, after.log_score, clusters);
  const UsedClusters used = used_clusters(before.score, clusters);
  return {std::move(before), std::move(after), whole, tail, nats, used};
}

ScoredRows in_large_groups(ScoredRows scored, std::span<const std::uint32_t> clusters) {
  scored.score = of_large_groups(scored.score);
  scored.climatology = of_large_groups(scored.climatology);
  scored.ways = of_large_groups(scored.ways);
  scored.compared = of_large_groups(scored.compared);
  scored.skill = skill_of(scored.compared, scored.climatology, clusters);
  scored.skill_over_ways = skill_of(scored.compared, scored.ways, clusters);
  return scored;
}

std::string skill_sentence(const ScoredRows& s) {
  if (hardly_simulated(s.score))
    return rows_in_words(s.rows) + " rows: skill cannot be told: " + percent(unseen_share(s.score)) +
           " of the score is of rows that have too few simulated values and score as the climatology";
  if (std::isnan(s.skill.share)) return {};
  const Rival rival = rival_of(s);
  const std::string errors = with_decimals(s.compared.total, 3) + " against " + rival.text;
  const std::string rows = rows_in_words(s.rows) + " rows: ";
  if (!(rival.skill.share > 0.0) && s.deposits) return rows + "no skill: " + errors;
  if (!(rival.skill.share > 0.0))
    return rows + "no skill: " + errors + ": the measurements of the " + (s.rows == "fit" ? "other " : "") +
           "fitting blocks, without any model, are " +
           (rival.skill.interval.high < 0.0 ? "nearer" : "as near or nearer");
  const double of_fit = std::isnan(s.fitted) ? 0.0 : skill_of_fit(s);
  std::string of_numbers;
  if (std::isnan(s.fitted)) of_numbers = kWereFitted;
  if (of_fit > 0.0)
    of_numbers = "; fitting " + with_decimals(s.fitted, 1) + " free numbers to these " +
                 std::to_string(s.compared.rows.size()) + " rows gains some " + with_decimals(100.0 * of_fit, 1) +
                 " % on them without any skill";
  return rows + skill_text(rival.skill) + ": " + errors + of_numbers +
         (rival.skill.interval.low > of_fit ? "" : "; it may have no skill");
}

Reduction judged_skill(const ScoredRows& s) {
  if (std::isnan(s.skill.share)) return {};
  Reduction skill = rival_of(s).skill;
  double& low = skill.interval.low;
  if (s.fitted > 0.0)
    low -= skill_of_fit(s);
  else if (s.rows == "fit")
    low = std::min(low, 0.0);  // numbers were fitted, how many is not known
  return skill;
}

Reduction skill_of_model(const ScoredRows& fitting, const ScoredRows& unseen, std::span<const std::uint32_t> clusters) {
  if (fitting.deposits) return {};
  const Reduction skill = judged_skill(in_large_groups(unseen, clusters));
  return std::isnan(skill.share) ? judged_skill(in_large_groups(fitting, clusters)) : skill;
}

std::string tail_against_climatology(const ScoredRows& s) {
  const std::string errors =
      with_decimals(s.tail.total, 3) + " against the climatology's " + with_decimals(s.tail_climatology.total, 3);
  if (!(s.tail_skill.share > 0.0)) return errors + ": no skill";
  return skill_text(s.tail_skill) + ": " + errors + (s.fitted == 0.0 ? "" : kWereFitted) +
         (s.tail_skill.interval.low > 0.0 ? "" : "; it may have no skill");
}

std::string tail_sentence(const ScoredRows& s) {
  if (s.tail.groups.empty()) return {};
  const std::string beyond = rows_in_words(s.rows) + " rows: run-out beyond " + with_digits(s.tail_begin, 3) + " m: ";
  if (hardly_simulated(s.tail)) return beyond + "cannot be told: too few simulated values";
  return beyond + tail_against_climatology(s);
}

std::vector<std::string> unscored_warnings(const ScoredRows& s) {
  std::vector<std::string> warnings;
  for (const GroupScore& group : s.score.groups)
    if (2 * group.unseen > group.rows)
      warnings.push_back(
          group.name + ": " + std::to_string(group.unseen) + " of " + std::to_string(group.rows) + " " +
          rows_in_words(s.rows) + " rows have fewer than " + std::to_string(kFewestSimulated) +
          " simulated values and score as the climatology, so that the score says nothing of them: too few "
          "trials, or the model seldom does there what was measured");
  return warnings;
}

std::vector<std::string> score_warnings(const ScoredRows& s) {
  std::vector<std::string> warnings = unscored_warnings(s);
  for (const std::string& warning : {leaving_warning(s), too_few_leave(s)})
    if (!warning.empty()) warnings.push_back(warning);
  for (std::string& warning : coverage_warnings(s)) warnings.push_back(std::move(warning));
  return warnings;
}

std::string cut_short_line(double share, std::uint32_t most_vertices) {
  return "note: in the fit " + with_decimals(100.0 * share, 2) + " % of the trajectories did not end within " +
         std::to_string(most_vertices) + " vertices; they count against the model (docs/diagnosis-time.md)";
}

std::string judgement_lines(const ScoredRows& s) {
  std::string text;
  if (!s.not_counted.empty())
    text += rows_in_words(s.rows) + " rows: too few, or too much alike, to be scored: " + joined(s.not_counted) +
            " blocks\n";
  for (const std::string& sentence : {skill_sentence(s), tail_sentence(s)})
    if (!sentence.empty()) text += sentence + "\n";
  for (const std::string& sentence : deposit_sentences(s)) text += sentence + "\n";
  return text + coverage_lines(s);
}

std::string score_table(const ScoreSettings& settings, std::span<const ScoredRows> scores) {
  std::string text = "campaign " + settings.campaign + ": " + std::to_string(settings.trials) +
                     " trials per block, seed " + std::to_string(settings.seed) + ", " + settings.surface +
                     " surface\n";
  const std::vector<std::string> names = group_names(scores);
  std::size_t width = 24;
  for (const std::string& name : names) width = std::max(width, name.size());
  text += padded("", width);
  for (const ScoredRows& s : scores)
    text += padded("  " + rows_in_words(s.rows) + " rows (" + std::to_string(s.blocks) + " blocks)", 33);
  text += "\n" + padded("group", width);
  for (std::size_t i = 0; i < scores.size(); ++i) text += "   score  95 % interval    rows";
  for (const std::string& name : names) {
    text += "\n" + padded(name, width);
    for (const ScoredRows& s : scores) {
      const auto& groups = s.score.groups;
      const auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name; });
      const auto index = static_cast<std::size_t>(found - groups.begin());
      text += found == groups.end()
                  ? padded("       -", 33)
                  : cell(found->score, s.intervals.groups[index], found->rows, found->rows < kHeadlineRows);
    }
  }
  text += "\n" + padded("mean normalised score", width);
  for (const ScoredRows& s : scores) text += cell(s.score.total, s.intervals.total, s.score.rows.size());
  text += "\n" + padded("climatology", width);
  for (const ScoredRows& s : scores)
    text += cell(s.climatology.total, s.climatology_interval, s.climatology.rows.size());
  if (std::ranges::any_of(scores, [](const ScoredRows& s) { return s.ways.total < s.climatology.total; })) {
    text += "\n" + padded("climatology by release", width);
    for (const ScoredRows& s : scores) text += cell(s.ways.total, s.ways_interval, s.ways.rows.size());
  }
  text += "\n" + padded("run-out tail", width);
  for (const ScoredRows& s : scores) text += cell(s.tail.total, s.tail_interval, s.tail.rows.size());
  return text + "\n" + notes_of(scores);
}

std::string score_json(const ScoreSettings& settings, std::span<const ScoredRows> scores) {
  Json json{{"campaign", settings.campaign}, {"metric", "mean normalised score"}, {"trials", settings.trials},
            {"seed", settings.seed},         {"surface", settings.surface},       {"warnings", settings.warnings}};
  for (const ScoredRows& s : scores) {
    Json groups = Json::array();
    for (std::size_t g = 0; g < s.score.groups.size(); ++g)
      groups.push_back({{"group", s.score.groups[g].name},
                        {"score", json_of(s.score.groups[g].score, six_decimals)},
                        {"ci95", json_of(s.intervals.groups[g], six_decimals)},
                        {"climatology", json_of(score_of(s.climatology, s.score.groups[g].name), six_decimals)},
                        {"rows", s.score.groups[g].rows},
                        {"rows_as_climatology", s.score.groups[g].unseen}});
    json[s.rows] = {{"score", json_of(s.score.total, six_decimals)},
                    {"ci95", json_of(s.intervals.total, six_decimals)},
                    {"blocks", s.blocks},
                    {"rows", s.score.rows.size()},
                    {"climatology", climatology_json(s)},
                    {"tail", tail_json(s)},
                    {"coverage", json_of(s.coverage)},
                    {"leaving", json_of(s.leaving_trials)},
                    {"groups", groups},
                    {"not_scored", s.not_counted}};
    if (s.deposits) json[s.rows]["deposits"] = deposits_json(s);
  }
  return json_text(json);
}

}  // namespace talus::io
