#include "diagnosis_summary.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "coverage_report.hpp"
#include "evidence.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
namespace {

constexpr double kSharper = 0.5;      // share of a limit at which further measurements are worth a word
constexpr std::size_t kFewRows = 50;  // held-out rows below which more blocks are advised

std::string percent_in_tenths(double share) {
  return with_decimals(100.0 * share, 1) + " %";
}

Markup bold(const std::string& text) {
  return "<b>"_html + text + "</b>";
}

/// "a", "a and b", "a, b and c".
template <class Text>
Text in_a_sentence(const std::vector<Text>& words) {
  Text text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += std::string_view(i + 1 == words.size() ? " and " : ", ");
    text += words[i];
  }
  return text;
}

bool found(const DiagnosisRound& round) {
  return names_effect(round.effect);
}

std::string with_values(const DiagnosisRound& round) {
  std::vector<std::string> values;
  const FittedCandidate& c = round.candidates.front();
  for (std::size_t i = 0; i < c.parameters.size(); ++i) {
    const Parameter& p = c.parameters[i];
    values.push_back(p.key.substr(p.key.rfind('.') + 1) + " " + with_digits(c.values[i], 2) + unit_text(p.unit));
  }
  return values.empty() ? "" : ": " + in_a_sentence(values);
}

Markup missing(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  std::vector<Markup> effects;
  for (const DiagnosisRound& round : d.rounds)
    if (found(round)) effects.push_back(bold(round.effect) + " (" + round.where + with_values(round) + ")");
  if (!effects.empty()) return "The model lacks "_html + in_a_sentence(effects) + ".";
  if (d.rounds.front().effect == "unexplained")
    return "Something is missing that no effect of the library explains better than chance."_html;
  if (d.rounds.front().p_value <= record.options.level_of_round(0))
    return "Something may be missing: what is left is unlikely to be noise, but no effect of the library can be named for it."_html;
  const auto tested = [](const FamilyTest& family) { return !std::isnan(family.p_value); };
  if (std::ranges::none_of(d.rounds.front().families, tested))
    return "It cannot be said: no family of effects could be tested."_html;
  return "Nothing that these data can show: what is left looks like noise."_html;
}

/// Whether other fits of the ground come to the same first verdict.
Markup repeated(const Stability& stability) {
  if (stability.fits.size() < 2)
    return " One fit of the ground was made: --base-fits 5 shows whether others come to the same."_html;
  const Interval p = p_range_of(stability);
  const std::string undecided = undecided_text(stability), places = places_text(stability);
  return " "_html + std::to_string(stability.fits.size()) + " independent fits of the ground: " +
         (!undecided.empty() ? bold(undecided)
          : !places.empty()  ? "the same first effect from each, at different places ("_html + places + ")"
                             : "the same first verdict from each"_html) +
         ", smallest p from " + with_digits(p.low, 1) + " to " + with_digits(p.high, 1) + ".";
}

/// Says so where the interval of the gain in cross-validation, which decided, holds zero.
std::string gain_in_doubt(const DiagnosisRound& round) {
  if (!found(round)) return "";
  const FittedCandidate& chosen = round.candidates.front();
  const Interval gain = chosen.unseen_gain_interval();
  if (!(gain.low <= 0.0)) return "";
  return " Blocks left out of its fit do not show the gain of " + round.effect +
         " for sure: it lowers the objective by " + with_decimals(chosen.unseen_gain(), 3) +
         " (95 %: " + interval_text(gain, 1.0, 3) + ") after the price of its place.";
}

/// Names the families that are significant in the first round, at its level, and the row of the residual table that is
/// significant at the stricter level of later rounds.
Markup sure(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  const DiagnosisRound& first = d.rounds.front();
  const double level = record.options.level_of_round(0);
  std::vector<std::string> rare;
  for (const FamilyTest& family : first.families)
    if (family.p_corrected <= level) rare.push_back(family.name + " (p " + with_digits(family.p_corrected, 1) + ")");
  std::string text = rare.empty() ? "No family of effects is significant (smallest p " + with_digits(first.p_value, 2) +
                                        ", corrected for their number)."
                                  : "What the ground alone leaves depends on: " + in_a_sentence(rare) +
                                        ", corrected for the number of families.";
  if (const std::string row = residual_text(first, record.options.later_level); !row.empty())
    text += (rare.empty() ? " But " : " And ") + row + ".";
  if (found(first) && first.alike.empty()) text += " No other effect that may be named explains it nearly as well.";
  for (const DiagnosisRound& round : d.rounds) text += gain_in_doubt(round);
  return Markup() + text + repeated(d.stability);
}

bool in_all_groups(const DiagnosisRecord& record) {
  return record.errors.empty() || small_groups(record).empty();
}

/// Why nothing can be said of unseen blocks; empty where something can.
std::string no_unseen(const DiagnosisRecord& record) {
  if (!record.errors.empty() && record.errors[record.unseen].after.blocks == 0)
    return "It cannot be said: no row was held out, and none was judged out of its fold (--nested does so).";
  if (std::isnan((in_all_groups(record) ? record.whole : record.headline).before))
    return "It cannot be said: no group of held-out rows is large enough.";
  return "";
}

/// Whether the model found is nearer to unseen blocks than the measurements of others are, and to which side it errs.
Markup predicts(const DiagnosisRecord& record) {
  if (const std::string why = no_unseen(record); !why.empty()) return Markup() + why;
  ScoredRows rows = record.errors[record.unseen].after;
  const std::string side = runout_side(rows);
  if (!in_all_groups(record)) rows = in_large_groups(std::move(rows), record.clusters);
  Reduction skill = judged_skill(rows);
  const bool seen = choice_has_seen(record);
  if (seen) skill.interval.low = std::min(skill.interval.low, 0.0);
  Markup text = std::isnan(skill.share)       ? "It cannot be said."_html
                : !(skill.share > 0.0)        ? bold("No: do not take it for a map.")
                : !(skill.interval.low > 0.0) ? bold("Not shown.")
                                              : bold("Yes.");
  if (const std::string sentence = skill_sentence(rows); !sentence.empty())
    text += (seen ? " The choice of the effect has seen these rows. On "_html : " On "_html) + sentence +
            ". The climatology has no model: it takes what was measured of other blocks.";
  if (!side.empty()) text += " "_html + bold(side) + "; one right model in twenty shows this by chance.";
  return text;
}

Markup gained(const DiagnosisRecord& record) {
  const HoldoutError& e = in_all_groups(record) ? record.whole : record.headline;
  if (const std::string why = no_unseen(record); !why.empty()) return Markup() + why;
  const bool seen = choice_has_seen(record);
  Markup text = Markup() +
                (seen ? "On blocks left out of the fits, but not of the choice of the effect, the error is "
                      : "On blocks that no fit has seen the error is ") +
                with_decimals(e.before, 3) + " with the ground alone";
  if (record.diagnosis.rounds.size() > 1 && !std::isnan(e.reduction.share))
    text += " and "_html + bold(with_decimals(e.after, 3)) + " with what was found: lower by " +
            bold(percent_in_tenths(e.reduction.share)) + " (95 %: " + percent_in_tenths(e.reduction.interval.low) +
            " to " + percent_in_tenths(e.reduction.interval.high) + ")" +
            (e.reduction.interval.low <= 0.0 ? ": there may be no gain" : "");
  text += ".";
  if (const NatsGained& nats = record.errors[record.unseen].nats;
      record.diagnosis.rounds.size() > 1 && !std::isnan(nats.per_block))
    text += " By the log score, over all groups, the measurements of a block are "_html +
            with_digits(std::exp(nats.per_block), 3) +
            " times as likely as with the ground alone (95 %: " + with_digits(std::exp(nats.interval.low), 3) + " to " +
            with_digits(std::exp(nats.interval.high), 3) + ")" +
            (nats.interval.low <= 0.0 ? ": there may be no gain." : ".");
  return text;
}

std::string undecided(const Diagnosis& d) {
  std::string text;
  for (const DiagnosisRound& round : d.rounds)
    if (found(round) && !round.alike.empty())
      text += round.effect + " cannot be told apart from " + in_a_sentence(round.alike) + " on these data. ";
  for (const DiagnosisRound& round : d.rounds)
    for (const FittedCandidate& c : round.candidates)
      if (c.effect != round.effect && !std::isnan(c.confirmation.fitted))
        text += c.effect + " gains enough to be named (" + with_decimals(c.gain, 3) +
                " of the objective), but with new random numbers not again (" +
                with_decimals(c.confirmation.fitted, 3) + "; in cross-validation " +
                with_decimals(c.confirmation.unseen, 3) + "). ";
  for (const FamilyTest& family : d.rounds.front().families)
    if (!family.may_name)
      text += family.note + ". ";
    else if (std::isnan(family.p_value))
      text += "The family " + family.name + " could not be tested: " + family.note + ". ";
  std::vector<std::string> hidden;
  for (const DetectionLimit& limit : d.rounds.back().limits)
    if (std::isnan(limit.amount)) hidden.push_back(limit.effect);
  if (!hidden.empty()) text += "Even a large amount of these would not show for sure: " + in_a_sentence(hidden) + ".";
  return text.empty() ? "None of the effects of the library is hidden: one above its amount below would most likely "
                        "have been seen."
                      : text;
}

/// Names the effects that speeds at more screens would show at a smaller amount, or at all; empty if there are none.
std::string further_speeds(std::span<const DetectionLimit> limits) {
  std::vector<std::string> sharper, only_then, words;
  for (const DetectionLimit& limit : limits)
    if (std::isnan(limit.amount) && !std::isnan(limit.with_further_speeds))
      only_then.push_back(limit.effect);
    else if (limit.with_further_speeds - limit.off < kSharper * (limit.amount - limit.off))
      sharper.push_back(limit.effect);
  if (!sharper.empty()) words.push_back("would show " + in_a_sentence(sharper) + " at less than half the amount");
  if (!only_then.empty())
    words.push_back("would show a large amount of " + in_a_sentence(only_then) + ", of which these data show none");
  return words.empty() ? "" : "Speeds at more screens (12 were assumed): they " + in_a_sentence(words) + ". ";
}

/// Blocks of which something was scored: of others, as of those that left the DEM, nothing was measured that counts.
std::size_t blocks_scored(const Score& score) {
  std::set<std::uint32_t> blocks;
  for (const auto& row : score.rows) blocks.insert(row.block);
  return blocks.size();
}

/// Advice where few blocks were held out: with a finding, its gain rests on these; without, all that were fitted count.
std::string more_blocks(const DiagnosisRecord& record) {
  if (record.errors.empty()) return "";
  const std::size_t unseen = blocks_scored(record.errors[record.unseen].after.score);
  if (unseen >= kFewRows) return "";
  if (found(record.diagnosis.rounds.front()))
    return "More blocks: the gain rests on " + std::to_string(unseen) + " of them. ";
  const std::size_t fitted = blocks_scored(record.errors.front().after.score);
  return fitted >= kFewRows ? "" : "More blocks: " + std::to_string(fitted) + " were fitted. ";
}

std::string next(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  std::string text = further_speeds(d.rounds.back().limits);
  for (const FamilyTest& family : d.rounds.front().families)
    if (!family.may_name)
      text += family.name == "day" ? "More releases on several days within one group. "
                                   : "More rocks that are released at one place (six different ones at least). ";
    else if (std::isnan(family.p_value))
      text += "For the family " + family.name + " " + family.note + ". ";
  text += more_blocks(record);
  return text.empty() ? "Nothing that would change this verdict." : text;
}

}  // namespace

Markup summary_html(const DiagnosisRecord& record) {
  const Diagnosis& d = record.diagnosis;
  const std::pair<const char*, Markup> rows[] = {{"What is missing", missing(record)},
                                                 {"How sure that is", sure(record)},
                                                 {"Does it predict", predicts(record)},
                                                 {"What was gained", gained(record)},
                                                 {"What could not be decided", Markup() + undecided(d)},
                                                 {"What to measure next", Markup() + next(record)}};
  Markup html = "<table>\n"_html;
  for (const auto& [heading, text] : rows) html += "<tr><th>"_html + heading + "</th><td>" + text + "</td></tr>\n";
  return html + "</table>\n";
}

}  // namespace talus::io
