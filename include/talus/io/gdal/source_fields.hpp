#pragma once
#include <map>
#include <string>
#include <vector>

namespace talus::io {

/// What the fields of a source layer may hold, by the names under which they are read: name, frequency, diameter,
/// diameter_min, diameter_max, release_height, vx, vy, vz. A field `height` is none of them: it is mostly the cliff's.
const std::vector<std::string>& source_field_names();

/// A field of a source layer that holds one of these under another name.
struct MappedField {
  std::string field;  ///< its name in the layer; empty: not read
  std::string where;  ///< "flag --field diameter=Durchmesser", for messages
};

/// Fields by what they hold: `[sources.fields]` of a scenario and `--field NAME=COLUMN`.
using FieldMap = std::map<std::string, MappedField>;

}  // namespace talus::io
