#pragma once
#include "evidence.hpp"
#include "talus/io/reports/diagnosis_report.hpp"

namespace talus::io {

/// The key `times` of diagnosis.json: processor time in all and by phase.
Json times_json(const DiagnosisRecord& record);

}  // namespace talus::io
