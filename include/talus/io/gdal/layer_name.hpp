#pragma once
#include <string>

namespace talus::io {

/// The name of a layer as QGIS writes it: "cliffs.gpkg|layername=north".
struct NamedLayer {
  std::string file;    ///< what stands before the first such "|"
  std::string layer;   ///< its name; empty: not given
  int number = -1;     ///< "|layerid=0"; -1: not given
  std::string unread;  ///< the part that is not read: a filter, a kind of geometry, a wrong number; empty: none
};

/// Takes such a name apart. A name without "|layername=" and its like is a file.
NamedLayer named_layer(const std::string& name);

/// "; its layer is named by ..." for a name that is none of a file, if the name begins with that of a file and a "|"
/// ("cliffs.gpkg|layer=north"); else empty.
std::string spelling_of_layer(const std::string& name);

/// The file of such a name.
inline std::string file_of_layer(const std::string& name) {
  return named_layer(name).file;
}

/// Name of a layer with the path of its file replaced: "new.gpkg|layername=houses" of "old.gpkg|layername=houses".
inline std::string same_layer_in(const std::string& file, const std::string& name) {
  return file + name.substr(file_of_layer(name).size());
}

}  // namespace talus::io
