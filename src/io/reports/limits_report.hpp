#pragma once
#include <span>
#include <string>

#include "io/files/json.hpp"
#include "markup.hpp"
#include "talus/fit/diagnose/detection_limit.hpp"

/// What a campaign could not have shown: docs/detection-limits.md.
namespace talus::io {

/// `detection_limits` of diagnosis.json.
/// @param further  whether the limits with further speeds were computed (not for several campaigns)
Json limits_json(std::span<const DetectionLimit> limits, bool further = true);
/// The limits as an HTML table.
Markup limits_html(std::span<const DetectionLimit> limits);

}  // namespace talus::io
