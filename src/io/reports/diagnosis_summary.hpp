#pragma once
#include <string>

#include "talus/io/reports/diagnosis_report.hpp"

/// A diagnosis in words, as HTML: what is missing, how sure that is, what was gained, what could not be decided, what
/// to measure next.
namespace talus::io {

std::string summary_html(const DiagnosisRecord& record);

}  // namespace talus::io
