#pragma once
#include "talus/io/reports/diagnosis_report.hpp"

namespace talus::io {

/// The text of report.html, one self-contained page: what was found, the error before and after, the candidates, plots
/// of the residuals.
std::string diagnosis_page(const Campaign& campaign, const DiagnosisRecord& record);

}  // namespace talus::io
