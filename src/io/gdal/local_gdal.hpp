#pragma once

namespace talus::io {

/// Registers the drivers of GDAL that Talus reads and writes, and no others; keeps GDAL and PROJ off the network unless
/// it is allowed, and from running code of inputs. docs/security.md.
void register_drivers();

}  // namespace talus::io
