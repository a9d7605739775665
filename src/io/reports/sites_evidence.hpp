#pragma once
#include "io/files/json.hpp"
#include "talus/io/reports/sites_report.hpp"

/// The table of evidence by site and pooled, for the reports of several campaigns.
namespace talus::io {

/// "authume, rocksite (2 campaigns)".
std::string names_in_words(std::span<const SiteEvidence> evidence);
/// {"metric": ..., "fit": {...}, "holdout": {...}, "headline": {...}}.
Json errors_json(const SiteEvidence& evidence);
/// "4.3 % (95 %: 1.2 to 7.5 %)"; "-" where nothing was scored.
std::string change_text(const ErrorChange& change);
/// One line per site and one for all: rows, error before, after, climatology, reduction. Markdown.
std::string evidence_markdown(std::span<const SiteEvidence> evidence);

}  // namespace talus::io
