#pragma once
#include <string>

namespace talus::io {

/// What inputs may reach: docs/security.md. Local files only, and from a VRT only those below its own folder, below the
/// folder of the scenario or campaign, or below a folder that is allowed by name. These say more; call them before the
/// first input is opened.

/// Inputs may be named by addresses (https://..., /vsicurl/..., /vsis3/...): --allow-network.
void allow_network();
bool network_is_allowed();

/// A VRT may name files below this folder, too: --allow-folder, and the folder of a scenario or campaign.
void allow_folder(const std::string& folder);

/// The folder of a file, as `allow_folder`.
void allow_folder_of(const std::string& file);

}  // namespace talus::io
