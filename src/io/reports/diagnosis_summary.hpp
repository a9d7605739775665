#pragma once
#include <string>

#include "markup.hpp"
#include "talus/io/reports/diagnosis_report.hpp"

/// A diagnosis in words, as HTML: what is missing, how sure that is, what was gained, what could not be decided, what
/// to measure next.
namespace talus::io {

Markup summary_html(const DiagnosisRecord& record);

}  // namespace talus::io
