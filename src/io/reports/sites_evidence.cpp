#include "sites_evidence.hpp"

#include <cmath>

#include "evidence.hpp"
#include "io/scenario/fitted_on.hpp"
#include "repeated_report.hpp"
#include "talus/base/text.hpp"
#include "talus/fit/score/joined_scores.hpp"

namespace talus::io {
namespace {

/// Scores of one kind of rows: the first model, the last one, the climatology.
struct Scores {
  Score before, after, climatology;
};

ErrorChange change_of(const Scores& s, std::size_t blocks, std::span<const std::uint32_t> clusters) {
  ErrorChange change{blocks, s.after.rows.size(), s.before.total, s.after.total, s.climatology.total, {}};
  if (!s.after.rows.empty()) change.reduction = reduction(s.before, s.after, clusters);
  return change;
}

Scores scores_of(const BeforeAfter& e) {
  return {e.before.score, e.after.score, e.after.climatology};
}

Scores large_groups(const Scores& s) {
  return {of_large_groups(s.before), of_large_groups(s.after), of_large_groups(s.climatology)};
}

/// The scores of all sites on rows of one kind (0: fitting, 1: unseen).
Scores joined_of(std::span<const SiteEvidence> sites, std::span<const std::size_t> blocks, std::size_t kind) {
  std::vector<SiteScore> before, after, climatology;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Scores s = scores_of(sites[i].errors[kind]);
    before.push_back({sites[i].site, s.before, blocks[i]});
    after.push_back({sites[i].site, s.after, blocks[i]});
    climatology.push_back({sites[i].site, s.climatology, blocks[i]});
  }
  return {joined_scores(before), joined_scores(after), joined_scores(climatology)};
}

SiteEvidence evidence_of(const Site& site, const Model& before, const Model& after, const ObserveOptions& how,
                         const NestedValidation* nested) {
  const Campaign& campaign = *site.campaign;
  const auto first = observe(campaign, before, how), last = observe(campaign, after, how);
  const std::vector<bool> rows = fitting_rows(campaign);
  SiteEvidence out;
  out.site = site.name;
  out.errors.push_back(compared(campaign, scored("fit", campaign, first, rows), scored("fit", campaign, last, rows)));
  if (nested != nullptr) {
    out.errors.push_back(out_of_fold_rows(campaign, *nested));
  } else {
    const std::vector<bool> held = holdout_rows(campaign);
    out.errors.push_back(
        compared(campaign, scored("holdout", campaign, first, held), scored("holdout", campaign, last, held)));
  }
  out.unseen_rows = out.errors[1].after.rows;
  out.clusters = clusters_of(campaign);
  out.fit = change_of(scores_of(out.errors[0]), out.errors[0].after.blocks, out.clusters);
  out.unseen = change_of(scores_of(out.errors[1]), out.errors[1].after.blocks, out.clusters);
  out.headline = change_of(large_groups(scores_of(out.errors[1])), out.errors[1].after.blocks, out.clusters);
  return out;
}

/// @param rows  which: "fit", "holdout" or "out-of-fold"
Json change_json(const ErrorChange& c, const std::string& rows) {
  return {{"rows", rows},
          {"blocks", c.blocks},
          {"scored_rows", c.rows},
          {"before", json_of(c.before)},
          {"after", json_of(c.after)},
          {"climatology", json_of(c.climatology)},
          {"reduction", json_of(c.reduction.share)},
          {"ci95", json_of(c.reduction.interval)}};
}

std::string markdown_row(const std::string& site, const char* rows, const ErrorChange& c) {
  if (c.rows == 0)
    return "| " + site + " | " + rows + " | " + (c.blocks == 0 ? "none declared" : "too few rows") +
           " | - | - | - | - |\n";
  return "| " + site + " | " + rows + " | " + std::to_string(c.blocks) + " blocks, " + std::to_string(c.rows) +
         " rows | " + score_text(c.before) + " | " + score_text(c.after) + " | " + score_text(c.climatology) + " | " +
         change_text(c) + " |\n";
}

/// The error on the held-out rows of all sites together; NaN where there are none.
double pooled_holdout_error(std::span<const Site> sites, std::span<const Model> models, ObserveOptions how) {
  std::vector<SiteScore> scores;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    const Campaign& campaign = *sites[i].campaign;
    how.blocks = holdout_rows(campaign);
    scores.push_back(
        {sites[i].name, score(campaign, observe(campaign, models[i], how), how.blocks), campaign.blocks.size()});
  }
  return joined_scores(scores).total;
}

}  // namespace

std::vector<SiteEvidence> evidence_of_sites(std::span<const Site> sites, std::span<const Model> before,
                                            std::span<const Model> after, const ObserveOptions& how,
                                            std::span<const NestedValidation> nested) {
  std::vector<SiteEvidence> list;
  std::vector<std::size_t> blocks;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    list.push_back(evidence_of(sites[i], before[i], after[i], how, nested.empty() ? nullptr : &nested[i]));
    blocks.push_back(sites[i].campaign->blocks.size());
  }
  std::vector<std::uint32_t> clusters;
  for (const Site& site : sites)
    for (const std::uint32_t cluster : clusters_of(*site.campaign))
      clusters.push_back(cluster ^ stream_of_name(site.name));  // groups of one name at two sites are two
  SiteEvidence pooled;
  pooled.site = "pooled";
  pooled.unseen_rows = list.front().unseen_rows;
  std::size_t fit = 0, unseen = 0;
  for (const SiteEvidence& site : list) fit += site.fit.blocks, unseen += site.unseen.blocks;
  const Scores held = joined_of(list, blocks, 1);
  pooled.fit = change_of(joined_of(list, blocks, 0), fit, clusters);
  pooled.unseen = change_of(held, unseen, clusters);
  pooled.headline = change_of(large_groups(held), unseen, clusters);
  list.push_back(std::move(pooled));
  return list;
}

void open_holdout(std::span<const Site> sites, SitesRecord& record, const ObserveOptions& how) {
  const SitesDiagnosis& d = record.diagnosis;
  record.evidence = evidence_of_sites(sites, d.base, d.with_effects, how, d.nested);
  for (const JointRound& round : d.rounds) {
    record.candidates.emplace_back();
    for (const JointCandidate& c : round.candidates)
      record.candidates.back().push_back(pooled_holdout_error(sites, c.fitted.models, how));
  }
}

std::string names_in_words(std::span<const SiteEvidence> evidence) {
  std::vector<std::string> names;
  for (const SiteEvidence& e : evidence.first(evidence.size() - 1)) names.push_back(e.site);
  return joined(names);
}

Json errors_json(const SiteEvidence& evidence) {
  Json headline = change_json(evidence.headline, evidence.unseen_rows);
  headline["fewest_rows_of_a_group"] = kHeadlineRows;
  return {{"metric", "mean normalised score"},
          {"fit", change_json(evidence.fit, "fit")},
          {"holdout", change_json(evidence.unseen, evidence.unseen_rows)},
          {"headline", headline}};
}

std::string change_text(const ErrorChange& change) {
  const Reduction& r = change.reduction;
  if (std::isnan(r.share)) return "-";
  return reduction_in_words(r);
}

std::string evidence_markdown(std::span<const SiteEvidence> evidence) {
  std::string text =
      "| site | rows | | before | after | climatology | lower by |\n| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const SiteEvidence& e : evidence) {
    text += markdown_row(e.site, "fitting", e.fit);
    text += markdown_row(e.site, "held out", e.unseen);
    if (e.headline.rows != e.unseen.rows)
      text += markdown_row(e.site, "held out, groups of ten rows and more", e.headline);
  }
  return text;
}

}  // namespace talus::io
