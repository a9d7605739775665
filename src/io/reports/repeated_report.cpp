#include "repeated_report.hpp"

#include <algorithm>
#include <cmath>

#include "evidence.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr const char* kOutOfFold = "out-of-fold";

/// The p-values of the base fits, in words.
std::string p_text(const Interval& range) {
  if (std::isnan(range.low)) return "-";
  const std::string low = with_digits(range.low, 2), high = with_digits(range.high, 2);
  return low == high ? low : low + " to " + high;
}

std::string found_text(const OuterFold& loop) {
  return loop.effects.empty() ? "nothing" : joined(loop.effects);
}

const BeforeAfter* out_of_fold(const DiagnosisRecord& record) {
  const auto found =
      std::ranges::find_if(record.errors, [](const BeforeAfter& e) { return e.after.rows == kOutOfFold; });
  return found == record.errors.end() ? nullptr : &*found;
}

/// Verdicts with the number of base fits that gave each: "4 of 5 block-shape, 1 of 5 none".
std::string verdicts_text(const Stability& stability) {
  std::string text;
  for (const std::string& verdict : verdicts_of(stability))
    text += (text.empty() ? "" : ", ") +
            std::to_string(std::ranges::count(stability.fits, verdict, &BaseFitVerdict::effect)) + " of " +
            std::to_string(stability.fits.size()) + " " + verdict;
  return text;
}

/// Number of the groups or blocks that an interval is over: "8 groups".
std::string clusters_text(const BeforeAfter& e, const DiagnosisRecord& record) {
  const bool few = !e.clusters.given && !record.clusters.empty();
  return std::to_string(e.clusters.count) + (e.clusters.are_groups() ? " groups" : " blocks") +
         (few ? " (fewer than three groups: blocks are taken to be independent)" : "") +
         (e.clusters.by_block.empty()
              ? ""
              : " (seen in fewer than three of them, by block: " + joined(e.clusters.by_block) + ")");
}

/// Says that the folds did not choose, and why; empty where they did.
std::string quick_folds_note(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  if (!d.nested || d.nested->naming) return "";
  const std::string what =
      "the folds took the effects that all rows chose, and numbers near those of all rows: the error has seen the "
      "choice";
  if (record.options.naming_in_folds) return what;
  return what + "; the diagnosis of all rows traced " + with_decimals(billions(d.vertices), 1) +
         " billion vertices, more than " + with_decimals(record.options.rules.costly, 1) +
         " (--no-quick-folds chooses anew)";
}

/// Warning of so few blocks, or so few trials, that the verdict means little. Empty where there are enough.
std::string few_numbers_warning(const DiagnosisRecord& record) {
  const std::size_t blocks = record.errors.empty() ? 0 : record.errors.front().after.blocks;
  const std::size_t enough = record.options.rules.fewest_blocks;
  if (blocks > 0 && blocks < enough)
    return "only " + std::to_string(blocks) + " blocks are fitted: fewer than " + std::to_string(enough) +
           " cannot show what a model lacks, and \"none\" says little";
  const TrialsPerBlock usual, &asked = record.options.trials;
  if (asked.search >= usual.search && asked.test >= usual.test) return "";
  return "fewer trials than by default (--trials " + std::to_string(usual.search) + ", --test-trials " +
         std::to_string(usual.test) + "): the verdict may change with more";
}

/// Warnings of what a costly diagnosis left out, with the flag that asks for it.
std::vector<std::string> costly_warnings(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  const std::string costly = ": blocks of this campaign take long (more than " +
                             with_decimals(record.options.rules.enough, 0) + " billion vertices traced or foreseen; --";
  std::vector<std::string> warnings;
  if (d.stability.left_out > 0) {
    const std::size_t made = d.stability.fits.size();
    const std::string asked = std::to_string(record.options.base_fits_at_most());
    warnings.push_back("the verdict is that of " + std::to_string(made) + (made == 1 ? " fit" : " fits") +
                       " of the ground, not of " + asked + costly + "base-fits " + asked + " makes all)");
  }
  if (d.ended_early)
    warnings.push_back("no effect was fitted after " + d.rounds[d.rounds.size() - 2].effect + costly + "most-effects " +
                       std::to_string(record.options.effects_at_most()) + " fits more)");
  return warnings;
}

}  // namespace

std::string far_ground_warning(const FittedModel& base, const std::string& way_out) {
  constexpr double kFar = 1.5;  // standard deviations of the prior: in the study false alarms were more frequent beyond
  std::string far;
  for (Eigen::Index i = 0; i < base.z.size(); ++i)
    if (std::abs(base.z[i]) > kFar)
      far += (far.empty() ? "" : ", ") + base.free[static_cast<std::size_t>(i)].key + " by " +
             with_decimals(std::abs(base.z[i]), 1);
  if (far.empty()) return "";
  return "the fitted ground is far from its start (" + far +
         " standard deviations of the prior), which holds it back: the instruments may be blamed falsely; " + way_out;
}

std::string folds_text(const NestedValidation& nested) {
  std::vector<std::pair<std::string, int>> counts;
  for (const OuterFold& loop : nested.loops) {
    const auto same = std::ranges::find(counts, found_text(loop), &std::pair<std::string, int>::first);
    if (same == counts.end())
      counts.emplace_back(found_text(loop), 1);
    else
      ++same->second;
  }
  std::ranges::stable_sort(counts, std::greater<>{}, &std::pair<std::string, int>::second);
  std::string text;
  for (const auto& [found, count] : counts)
    text +=
        (text.empty() ? "" : "; ") + std::to_string(count) + " of " + std::to_string(nested.loops.size()) + " " + found;
  return text;
}

BeforeAfter out_of_fold_rows(const Campaign& campaign, const NestedValidation& nested) {
  const std::vector<bool> rows = fitting_rows(campaign);
  const std::vector<std::uint32_t>& folds = nested.folds.fold_of;
  return compared(campaign, scored(kOutOfFold, campaign, nested.base, rows, folds),
                  scored(kOutOfFold, campaign, nested.found, rows, folds));
}

void judge_nested(const Campaign& campaign, DiagnosisRecord& record) {
  const NestedValidation& nested = *record.diagnosis.nested;
  const std::vector<bool> rows = fitting_rows(campaign);
  const std::vector<std::uint32_t>& folds = nested.folds.fold_of;
  record.errors.push_back(out_of_fold_rows(campaign, nested));
  if (nested.ground.empty()) return;
  const auto judged = [&](const std::vector<BlockRuns>& runs, ScoreRule rule) {
    return score(campaign, runs, rows, {rule, kFewestSimulated, folds});
  };
  const auto both = [&](const std::vector<BlockRuns>& runs) {
    return runs.empty() ? std::pair<Score, Score>{}
                        : std::pair{judged(runs, ScoreRule::Fair), judged(runs, ScoreRule::LogDensity)};
  };
  const auto ground = both(nested.ground), held = both(nested.held);
  const std::vector<FittedCandidate>& candidates = record.diagnosis.rounds.front().candidates;
  for (std::size_t i = 0; i < nested.candidates.size(); ++i) {
    if (nested.candidates[i].empty()) continue;
    const auto [own, log_own] = both(nested.candidates[i]);
    const auto& [reference, log_reference] = candidates[i].with_ground ? ground : held;
    record.evidence[i].push_back({kOutOfFold, own, log_own, reference, log_reference});
  }
}

bool choice_has_seen(const DiagnosisRecord& record) {
  const std::optional<NestedValidation>& nested = record.diagnosis.nested;
  const bool chosen = record.diagnosis.rounds.size() > 1;
  return chosen && nested && !nested->naming && record.errors[record.unseen].after.rows == kOutOfFold;
}

std::vector<std::string> diagnosis_warnings(const DiagnosisRecord& record) {
  std::vector<std::string> warnings = costly_warnings(record);
  const Diagnosis& d = record.diagnosis;
  if (const std::string few = few_numbers_warning(record); !few.empty()) warnings.push_back(few);
  const std::string again = "see whether a diagnosis from there says the same (--parameters with this fitted.toml)";
  if (const std::string far = far_ground_warning(d.base, again); !far.empty()) warnings.push_back(far);
  if (d.nested && d.nested->folds.splits_groups) warnings.emplace_back(kSplitGroups);
  if (!d.with_effects.model.zones.values.empty())
    warnings.push_back(
        "with_effect.toml is not the whole model: no file can hold the band of undeclared-zone, with which the rest "
        "was fitted; for a map take fitted.toml, or draw the band as a zone of its own and fit again");
  return warnings;
}

std::string verdict_text(const Diagnosis& diagnosis) {
  const std::string undecided = undecided_text(diagnosis.stability);
  return undecided.empty() ? diagnosis.rounds.front().effect : undecided;
}

Json evidence_of(const DiagnosisRecord& record) {
  Json list = evidence_json(record.errors, record.clusters, "ground", "found");
  const std::vector<FittedCandidate>& candidates = record.diagnosis.rounds.front().candidates;
  for (std::size_t i = 0; i < record.evidence.size(); ++i) {
    Json entry{{"model", candidates[i].effect}, {"where", candidates[i].where}, {"candidate", true}};
    for (const CandidateEvidence& e : record.evidence[i]) {
      entry[e.rows] = judged_json({e.score, e.log_score}, {e.ground, e.log_ground}, record.clusters);
      entry[e.rows]["ground_error"] = json_of(e.ground.total);
      entry[e.rows]["ground_log_score"] = json_of(-e.log_ground.total);
    }
    list.push_back(entry);
  }
  return list;
}

Json stability_json(const Stability& stability) {
  Json verdicts = Json::array(), where = Json::array(), p_values = Json::array(), seeds = Json::array(),
       families = Json::array();
  for (const BaseFitVerdict& fit : stability.fits) {
    verdicts.push_back(fit.effect);
    where.push_back(fit.where);
    p_values.push_back(json_of(fit.p_value));
    seeds.push_back(fit.seed);
  }
  for (const FamilyTest& family : stability.fits.front().families)
    families.push_back({{"name", family.name}, {"p_range", json_of(p_range_of(stability, family.name))}});
  const std::vector<std::string> names = verdicts_of(stability);
  return {{"fits", stability.fits.size()},
          {"verdicts", verdicts},
          {"where", where},
          {"p_range", json_of(p_range_of(stability))},
          {"p_values", p_values},
          {"seeds", seeds},
          {"reported", stability.reported},
          {"left_out", stability.left_out},
          {"undecided_between", names.size() > 1 ? Json(names) : Json::array()},
          {"families", families}};
}

Json nested_json(const DiagnosisRecord& record) {
  const NestedValidation& nested = *record.diagnosis.nested;
  const BeforeAfter& e = *out_of_fold(record);
  Json loops = Json::array();
  for (const OuterFold& loop : nested.loops)
    loops.push_back({{"blocks", loop.blocks},
                     {"groups", loop.groups},
                     {"effects", loop.effects},
                     {"where", loop.where},
                     {"p_value", json_of(loop.p_value)}});
  return {{"folds_by", nested.folds.by_group ? "group" : "block"},
          {"naming_in_folds", nested.naming},
          {"trials_per_block", nested.trials},
          {"folds", loops},
          {"before", json_of(e.before.score.total)},
          {"after", json_of(e.after.score.total)},
          {"reduction", json_of(e.reduction.share)},
          {"ci95", json_of(e.reduction.interval)},
          {"nats_gained", json_of(e.nats.per_block)},
          {"nats_gained_ci95", json_of(e.nats.interval)},
          {"interval_over", clusters_text(e, record)}};
}

std::string repeated_lines(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  std::string text;
  if (d.stability.fits.size() > 1) {
    text += "verdict: " + verdict_text(d) + "\n  of independent base fits: " + verdicts_text(d.stability) + "; p " +
            p_text(p_range_of(d.stability)) + "\n";
    for (const FamilyTest& family : d.stability.fits.front().families)
      if (!std::isnan(family.p_value))
        text += "  " + family.name + ": p " + p_text(p_range_of(d.stability, family.name)) + " uncorrected\n";
  }
  for (const BeforeAfter& e : record.errors)
    if (e.after.rows != "fit" && !std::isnan(e.nats.per_block))
      text += "log score, " + rows_in_words(e.after.rows) + " rows: better by " + with_decimals(e.nats.per_block, 2) +
              " nats per block (95 %: " + interval_text(e.nats.interval, 1.0, 2) + "); intervals over " +
              clusters_text(e, record) + "\n";
  if (d.nested)
    text += "out of fold (" + std::to_string(d.nested->folds.count) + " folds by " +
            (d.nested->folds.by_group ? "group" : "block") + (d.nested->naming ? "), found: " : "), given: ") +
            folds_text(*d.nested) + "\n";
  if (const std::string note = quick_folds_note(record); !note.empty()) text += "  " + note + "\n";
  return text;
}

Markup repeated_html(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  Markup html;
  if (d.stability.fits.size() > 1) {
    html += "<h2>Stability</h2>\n<p>Independent fits of the ground to the same rows: "_html +
            verdicts_text(d.stability) + ".</p>\n<table><tr><th>family</th><th>p over the fits</th></tr>\n";
    for (const FamilyTest& family : d.stability.fits.front().families)
      html +=
          "<tr><td>"_html + family.name + "</td><td>" + p_text(p_range_of(d.stability, family.name)) + "</td></tr>\n";
    html += "</table>\n";
  }
  if (d.nested) {
    html +=
        "<h2>Every block out of its fold</h2>\n<table><tr><th>fold</th><th>blocks left out</th><th>groups</th><th>"_html +
        std::string(d.nested->naming ? "found" : "given") + " without them</th><th>p</th></tr>\n";
    for (std::size_t f = 0; f < d.nested->loops.size(); ++f) {
      const OuterFold& loop = d.nested->loops[f];
      html += "<tr><td>"_html + std::to_string(f + 1) + "</td><td>" + std::to_string(loop.blocks) + "</td><td>" +
              joined(loop.groups) + "</td><td>" + found_text(loop) + "</td><td>" +
              (std::isnan(loop.p_value) ? "" : with_digits(loop.p_value, 2)) + "</td></tr>\n";
    }
    html += "</table>\n";
    if (const std::string note = quick_folds_note(record); !note.empty()) html += "<p>"_html + note + ".</p>\n";
  }
  html +=
      "<h2>Evidence</h2>\n<p>Each effect at its best place against the ground alone, on rows that its numbers "
      "have not seen; out of fold, the ground that was held with an effect has seen them, in both models. "
      "Positive is better.</p>\n<table><tr><th>effect</th><th>rows</th><th>error lower by, 95 %</th>"
      "<th>log score better by [nats per block], 95 %</th><th>rows by group</th></tr>\n";
  for (std::size_t i = 0; i < record.evidence.size(); ++i)
    for (const CandidateEvidence& e : record.evidence[i]) {
      const Reduction less = reduction(e.ground, e.score, record.clusters);
      const NatsGained nats = nats_gained(e.log_ground, e.log_score, record.clusters);
      std::string rows;
      for (const GroupScore& group : e.score.groups)
        rows += (rows.empty() ? "" : ", ") + group.name + " " + rows_text(group);
      const FittedCandidate& c = d.rounds.front().candidates[i];
      html += "<tr><td>"_html + c.effect + (c.with_ground ? "" : " (ground held)") + "</td><td>" +
              rows_in_words(e.rows) + "</td><td>" + with_decimals(100.0 * less.share, 1) + " % (" +
              interval_text(less.interval, 100.0, 1) + ")</td><td>" + with_decimals(nats.per_block, 2) + " (" +
              interval_text(nats.interval, 1.0, 2) + ")</td><td>" + rows + "</td></tr>\n";
    }
  return html + "</table>\n";
}

}  // namespace talus::io
