#pragma once
#include "evidence.hpp"
#include "talus/io/reports/diagnosis_report.hpp"

namespace talus::io {

/// The key `seconds` of diagnosis.json: by the clock, of the processor, and the latter by phase.
Json times_json(const DiagnosisRecord& record);

}  // namespace talus::io
