#pragma once
#include <string>

#include "talus/fit/campaign/observe.hpp"
#include "talus/fit/score/intervals.hpp"
#include "talus/io/campaign/campaign_file.hpp"

namespace talus::io {

/// Reads a model for a campaign from `fitted.toml`: [ground] default, [ground.zones.NAME] with the names of the
/// campaign's zones (default: the ground outside all), the impact law in [model], [effects.*], [barriers] and
/// [[instrument_bias]]. A zone that the file does not name has the default ground. Throws InputError with file, line,
/// key, value and what is allowed, also for a zone or a screen that the campaign lacks.
///
/// @param warnings  gets one if the model was fitted on another surface than that of the campaign, and one of the zones
///                  that it leaves to the default ground although it describes others
Model read_model(const std::string& path, const Campaign& campaign, std::vector<std::string>* warnings = nullptr);

/// The record of such a file, with its checksum, as an input of a fit that starts from it.
InputFile model_input(const std::string& path);

/// The text of such a file. It reads back as exactly this model, except that the places of barriers are rounded. A
/// scenario can `include` it. A band of other ground is left out.
///
/// @param heading  comment lines for the top, without the marks
/// @param skill    of the fit over the climatology; NaN: left out
std::string model_text(const Model& model, const LoadedCampaign& loaded, const std::string& heading,
                       const Reduction& skill = {});

}  // namespace talus::io
