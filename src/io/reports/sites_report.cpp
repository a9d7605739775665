#include "talus/io/reports/sites_report.hpp"

#include <cmath>

#include "coverage_report.hpp"
#include "diagnosis_parts.hpp"
#include "evidence.hpp"
#include "limits_report.hpp"
#include "page_frame.hpp"
#include "repeated_report.hpp"
#include "sites_evidence.hpp"
#include "talus/base/shell.hpp"
#include "talus/base/text.hpp"
#include "talus/base/version.hpp"

namespace talus::io {
namespace {

std::string p_text(double p) {
  return std::isnan(p) ? "-" : with_decimals(p, 4);
}

/// @param site  of its test; "pooled": all
Json family_of_site(const FamilyTest& family, const std::string& site) {
  Json item{{"site", site}};
  item.update(family_json(family));
  return item;
}

/// @param holdout  error of each candidate on the held-out rows of all sites
Json candidates_json(const JointRound& round, const std::vector<double>& holdout) {
  Json list = Json::array();
  for (std::size_t i = 0; i < round.candidates.size(); ++i) {
    Json item = effect_json(round.candidates[i]);
    item["family"] = round.family.name;
    item["fit"] = json_of(round.candidates[i].fitted.score.total);
    item["holdout"] = json_of(holdout[i]);
    item["p_value"] = json_of(round.family.p_value);
    list.push_back(std::move(item));
  }
  return list;
}

Json rounds_json(const SitesRecord& record) {
  Json rounds = Json::array();
  double before = record.diagnosis.nested.empty() ? record.evidence.back().unseen.before : kNotGiven;
  for (std::size_t i = 0; i < record.diagnosis.rounds.size(); ++i) {
    const JointRound& round = record.diagnosis.rounds[i];
    Json turn{{"effect", round.effect}, {"p_value", json_of(round.family.p_corrected)}};
    if (names_effect(round.effect)) {
      const double after = record.candidates[i].front();
      turn["where"] = round.where;
      turn["indistinguishable_from"] = round.alike;
      turn["holdout"] = {{"before", json_of(before)}, {"after", json_of(after)}};
      before = after;
    }
    turn["family"] = family_of_site(round.family, "pooled");
    turn["candidates"] = candidates_json(round, record.candidates[i]);
    rounds.push_back(turn);
  }
  return rounds;
}

/// All families of the first round: the pooled one, then those of each site.
Json families_json(const SitesDiagnosis& d) {
  Json list = Json::array({family_of_site(d.rounds.front().family, "pooled")});
  for (const SiteDiagnosis& site : d.sites)
    for (const FamilyTest& family : site.families) list.push_back(family_of_site(family, site.name));
  return list;
}

Json sites_of(const SitesRecord& record) {
  const SitesDiagnosis& d = record.diagnosis;
  Json list = Json::array();
  for (std::size_t i = 0; i < d.sites.size(); ++i) {
    const SiteDiagnosis& site = d.sites[i];
    const SiteEvidence& evidence = record.evidence[i];
    Json ground = Json::object(), after = Json::object(), families = Json::array();
    for (const Parameter& p : site.base.free) {
      ground[p.key] = json_of(p.get(d.base[i]));
      after[p.key] = json_of(p.get(d.with_effects[i]));
    }
    for (const FamilyTest& family : site.families) families.push_back(family_of_site(family, site.name));
    list.push_back({{"name", site.name},
                    {"campaign", record.files[i]},
                    {"p_value", json_of(site.families.front().p_value)},
                    {"error", errors_json(evidence)},
                    {"families", families},
                    {"evidence", evidence_json(evidence.errors, evidence.clusters, "ground", "found")},
                    {"coverage", coverage_json(evidence.errors)},
                    {"tail", tail_json(evidence.errors)},
                    {"base_parameters", ground},
                    {"ground_with_effect", after},
                    {"trials_per_block", trials_json(site.trials)},
                    {"files", {site.name + "/fitted.toml", site.name + "/with_effect.toml"}}});
  }
  return list;
}

/// What is known of each site, one list after another, each item with its `site`.
template <class ListOfSite>
Json by_site(const SitesDiagnosis& d, ListOfSite&& list_of) {
  Json all = Json::array();
  for (std::size_t i = 0; i < d.sites.size(); ++i)
    for (Json& item : list_of(i)) {
      item["site"] = d.sites[i].name;
      all.push_back(std::move(item));
    }
  return all;
}

Json evidence_by_site(const SitesRecord& record) {
  return by_site(record.diagnosis, [&](std::size_t i) {
    const SiteEvidence& e = record.evidence[i];
    return evidence_json(e.errors, e.clusters, "ground", "found");
  });
}

/// As `coverage_json`, each observable with its `site`.
Json coverage_by_site(const SitesRecord& record) {
  Json coverage;
  for (const char* when : {"before", "after"})
    for (const std::string& rows : {std::string("fit"), record.evidence.back().unseen_rows})
      coverage[when][rows] = by_site(record.diagnosis, [&](std::size_t i) {
        return coverage_json(record.evidence[i].errors)[when].value(rows, Json::array());
      });
  return coverage;
}

/// As of one campaign: for an effect the share of the bootstraps in which it is the best. None is a probability of
/// being right.
double probability_of(const SitesDiagnosis& d) {
  const JointRound& first = d.rounds.front();
  if (names_effect(first.effect)) return first.candidates.front().chosen_share;
  return first.effect == "none" ? d.p_value : 1.0 - d.p_value;
}

/// Each site is fitted once.
Json stability_of(const SitesRecord& record) {
  const JointRound& first = record.diagnosis.rounds.front();
  Stability once;
  once.fits.push_back({record.options.seed, first.effect, first.where, record.diagnosis.p_value, {first.family}});
  return stability_json(once);
}

/// As of one campaign, with the blocks that each site leaves out.
Json nested_of(const SitesDiagnosis& d) {
  Json loops = Json::array();
  for (std::size_t fold = 0; fold < d.nested.front().loops.size(); ++fold) {
    const OuterFold& found = d.nested.front().loops[fold];
    Json left_out = Json::object();
    for (std::size_t i = 0; i < d.sites.size(); ++i) left_out[d.sites[i].name] = d.nested[i].loops[fold].blocks;
    loops.push_back({{"blocks", left_out},
                     {"effects", found.effects},
                     {"where", found.where},
                     {"p_value", json_of(found.p_value)}});
  }
  return {{"trials_per_block", d.nested.front().trials}, {"folds", loops}};
}

/// "Repeated 5 times, each without a part of the blocks of every site, it found: 4 of 5 block-shape; 1 of 5 none".
std::string repetitions_text(const SitesDiagnosis& d) {
  return "Repeated " + std::to_string(d.nested.front().loops.size()) +
         " times, each without a part of the blocks of every site, it found: " + folds_text(d.nested.front());
}

/// What was found, in words.
std::string verdict_sentence(const SitesDiagnosis& d) {
  std::string text;
  for (const JointRound& round : d.rounds) {
    if (!names_effect(round.effect)) continue;
    text += (text.empty() ? "The models of all sites lack " : "; then ") + round.effect + " (" + round.where + ")";
    for (const std::string& other : round.alike) text += ", not to be told apart from " + other;
  }
  if (!text.empty()) return text + ", with the same numbers at every site.";
  const FamilyTest& pooled = d.rounds.front().family;
  if (!d.rounds.front().candidates.empty())
    return "All sites together depend on a property of the block (p " + p_text(pooled.p_corrected) +
           " corrected), but no effect with the same numbers at every site explains it.";
  if (std::isnan(pooled.p_value))
    return "Whether all sites together depend on a property of the block could not be tested: " + pooled.note + ".";
  if (!pooled.may_name)
    return "No property of the block can be named for all sites together (p " + p_text(pooled.p_value) +
           "): " + pooled.note + ".";
  return "All sites together show no dependence on a property of the block (p " + p_text(pooled.p_value) + ", " +
         p_text(pooled.p_corrected) + " corrected): no effect is named for them.";
}

/// Families of single sites that are significant: a diagnosis of that site alone can name them.
std::vector<std::string> own_findings(const SitesRecord& record) {
  std::vector<std::string> list;
  const SitesDiagnosis& d = record.diagnosis;
  for (std::size_t i = 0; i < d.sites.size(); ++i)
    for (const FamilyTest& family : d.sites[i].families)
      if (family.p_corrected <= record.options.first_level)
        list.push_back(d.sites[i].name + " alone: " + family.name + " (p " + p_text(family.p_corrected) +
                       " corrected). To name it: talus diagnose " + shell_word(record.files[i]));
  return list;
}

Markup error_cells(const ErrorChange& c) {
  if (c.rows == 0)
    return "<td>"_html + (c.blocks == 0 ? "none declared" : "too few rows") +
           "</td><td>-</td><td>-</td><td>-</td><td>-</td>";
  return "<td>"_html + std::to_string(c.blocks) + " blocks, " + std::to_string(c.rows) + " rows</td><td>" +
         score_text(c.before) + "</td><td>" + score_text(c.after) + "</td><td>" + score_text(c.climatology) +
         "</td><td>" + change_text(c) + "</td>";
}

/// p of a site, or of all sites together, that nothing depends on a property of the block.
double property_p(const SitesDiagnosis& d, std::size_t site) {
  return site < d.sites.size() ? d.sites[site].families.front().p_value : d.rounds.front().family.p_value;
}

Markup evidence_html(const SitesRecord& record) {
  const std::string unseen = rows_in_words(record.evidence.back().unseen_rows) + " rows";
  Markup html =
      "<table><tr><th rowspan='2'>site</th><th rowspan='2'>p, block property</th><th colspan='5'>fitting "
      "rows</th><th colspan='5'>"_html +
      unseen + "</th></tr><tr>";
  for (int i = 0; i < 2; ++i) html += "<th>rows</th><th>before</th><th>after</th><th>climatology</th><th>lower by</th>";
  html += "</tr>\n";
  for (std::size_t i = 0; i < record.evidence.size(); ++i) {
    const SiteEvidence& e = record.evidence[i];
    html += "<tr><td>"_html + e.site + "</td><td>" + p_text(property_p(record.diagnosis, i)) + "</td>" +
            error_cells(e.fit) + error_cells(e.unseen) + "</tr>\n";
    if (e.headline.rows != e.unseen.rows)
      html += "<tr><td>"_html + e.site + ", groups of ten " + unseen + " and more</td><td colspan='6'></td>" +
              error_cells(e.headline) + "</tr>\n";
  }
  return html + "</table>\n";
}

Markup families_html(const SitesDiagnosis& d) {
  Markup html = "<table><tr><th>site</th><th>family</th><th>p</th><th>corrected</th><th></th></tr>\n"_html;
  const auto row = [&](const std::string& site, const FamilyTest& f) {
    html += "<tr><td>"_html + site + "</td><td>" + f.name + "</td><td>" + p_text(f.p_value) + "</td><td>" +
            p_text(f.p_corrected) + "</td><td>" + f.note + "</td></tr>\n";
  };
  row("pooled", d.rounds.front().family);
  for (const SiteDiagnosis& site : d.sites)
    for (const FamilyTest& family : site.families) row(site.name, family);
  return html + "</table>\n";
}

Markup candidates_html(const JointRound& round) {
  Markup html =
      "<table><tr><th>effect</th><th>where</th><th>numbers, shared</th><th>gain of the objective</th>"
      "<th>cross-validated</th></tr>\n"_html;
  for (const JointCandidate& c : round.candidates) {
    Markup numbers;
    for (std::size_t i = 0; i < c.values.size(); ++i)
      numbers += Markup() + c.parameters[i].key + " = " + with_digits(c.values[i], 3) + "<br>";
    html += "<tr><td>"_html + c.effect + "</td><td>" + c.where + "</td><td>" + numbers + "</td><td>" +
            gain_text(c.gain, c.gain_interval) + "</td><td>" +
            gain_text(c.cross_validated, c.cross_validated_interval) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

Markup ground_html(const SitesDiagnosis& d) {
  Markup html =
      "<table><tr><th>site</th><th>parameter</th><th>ground alone</th><th>with what was found</th></tr>\n"_html;
  for (std::size_t i = 0; i < d.sites.size(); ++i)
    for (const Parameter& p : d.sites[i].base.free)
      html += "<tr><td>"_html + d.sites[i].name + "</td><td>" + p.key + " " + p.unit + "</td><td>" +
              with_digits(p.get(d.base[i]), 3) + "</td><td>" + with_digits(p.get(d.with_effects[i]), 3) +
              "</td></tr>\n";
  return html + "</table>\n";
}

}  // namespace

std::vector<std::string> sites_warnings(const SitesRecord& record) {
  static constexpr const char* kAlone =
      "see what a diagnosis of this campaign alone says from another start (--parameters)";
  const SitesDiagnosis& d = record.diagnosis;
  std::vector<std::string> warnings;
  if (!d.not_nested.empty())
    warnings.push_back("there is no error of unseen rows: " + d.not_nested + " (measure more, or hold rows out)");
  for (const SiteDiagnosis& site : d.sites)
    if (const std::string far = far_ground_warning(site.base, kAlone); !far.empty())
      warnings.push_back(site.name + ": " + far);
  for (std::size_t i = 0; i < d.nested.size(); ++i)
    if (d.nested[i].folds.splits_groups) warnings.push_back(d.sites[i].name + ": " + kSplitGroups);
  return warnings;
}

std::string sites_json(const SitesRecord& record) {
  const SitesDiagnosis& d = record.diagnosis;
  const JointRound& first = d.rounds.front();
  Json effects = Json::array();
  for (const JointRound& round : d.rounds)
    if (names_effect(round.effect)) effects.push_back(round.effect);
  if (effects.empty()) effects.push_back(first.effect);
  std::vector<std::string> names;
  for (const SiteDiagnosis& site : d.sites) names.push_back(site.name);
  Json json{{"effect", first.effect},
            {"effects", effects},
            {"verdict", first.effect},
            {"campaign", joined(names)},
            {"where", first.where},
            {"probability", json_of(probability_of(d))},
            {"indistinguishable_from", first.alike},
            {"p_value", json_of(d.p_value)},
            {"error", errors_json(record.evidence.back())},
            {"sites", sites_of(record)},
            {"rounds", rounds_json(record)},
            {"families", families_json(d)},
            {"evidence", evidence_by_site(record)},
            {"coverage", coverage_by_site(record)},
            {"detection_limits", by_site(d, [&](std::size_t i) { return limits_json(d.sites[i].limits, false); })},
            {"stability", stability_of(record)},
            {"candidates", candidates_json(first, record.candidates.front())},
            {"residual", by_site(d, [&](std::size_t i) { return residual_json(d.sites[i].residual); })},
            {"findings_of_single_sites", own_findings(record)},
            {"start_model", record.start_name},
            {"seed", record.options.seed},
            {"trials_per_block", trials_json(d.trials)},
            {"seconds", json_of(record.seconds)},
            {"talus", version()},
            {"command", record.command},
            {"warnings", record.warnings}};
  if (!d.nested.empty()) json["nested"] = nested_of(d);
  json["inputs"] = json_of(record.inputs);
  return json_text(json);
}

std::string sites_page(const SitesRecord& record) {
  const SitesDiagnosis& d = record.diagnosis;
  Markup html = "<p><b>"_html + verdict_sentence(d) + "</b></p>\n";
  for (const std::string& finding : own_findings(record)) html += "<p>"_html + finding + "</p>\n";
  if (!d.nested.empty()) html += "<p>"_html + repetitions_text(d) + ".</p>\n";
  html +=
      "<h2>Evidence, by site and pooled</h2>\n<p>Mean normalised score; before: the ground of each site alone; after: "
      "with what was found. Intervals: over the blocks. The climatology is a forecast by the other fitting rows: a "
      "model with a larger error has no skill. Pooled: the mean over the groups of all sites.</p>\n"_html +
      evidence_html(record);
  for (const std::string& warning : record.warnings) html += "<p>Warning: "_html + warning + "</p>\n";
  html +=
      "<h2>Families</h2>\n<p>The family \"block property\" is tested with the blocks of all sites, which change places "
      "only within their own site and group; at a single site it takes no part in the correction (Holm).</p>\n"_html +
      families_html(d);
  for (std::size_t i = 0; i < d.rounds.size(); ++i) {
    const JointRound& round = d.rounds[i];
    html += "<h2>Round "_html + std::to_string(i + 1) + ": " + round.effect +
            "</h2>\n<p>p of the pooled family: " + p_text(round.family.p_value) + "; " + round.family.note + ".</p>\n";
    if (!round.candidates.empty()) html += candidates_html(round);
  }
  html += "<h2>Ground</h2>\n"_html + ground_html(d);
  const std::string footer =
      "seed " + std::to_string(record.options.seed) + ", " + with_decimals(record.seconds, 0) + " s";
  return page_of({"diagnose", "What the models of " + names_in_words(record.evidence) + " lack", footer, {}, true},
                 html);
}

std::string sites_summary(const SitesRecord& record) {
  const SitesDiagnosis& d = record.diagnosis;
  std::string text = verdict_sentence(d) + "\n";
  for (const std::string& finding : own_findings(record)) text += finding + "\n";
  if (!d.nested.empty()) text += repetitions_text(d) + "\n";
  for (std::size_t i = 0; i < record.evidence.size(); ++i) {
    const SiteEvidence& e = record.evidence[i];
    text += e.site + ": p of a block property " + p_text(property_p(d, i));
    for (const auto& [name, change] :
         {std::pair<std::string, ErrorChange>{"fitting", e.fit}, {rows_in_words(e.unseen_rows), e.unseen}})
      text += "; " + name + " rows (" + std::to_string(change.rows) + "): error " + score_text(change.before) +
              " before, " + score_text(change.after) + " after, climatology " + score_text(change.climatology) +
              (change.rows > 0 ? ", lower by " + change_text(change) : "");
    text += "\n";
  }
  return text;
}

}  // namespace talus::io
