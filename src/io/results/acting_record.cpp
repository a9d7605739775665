#include "acting_record.hpp"

namespace talus::io {

std::vector<std::string> acting_in(const Json& run) {
  std::vector<std::string> names;
  for (const Json& effect : run.at("effects")) names.push_back(effect.at("name").get<std::string>());
  return names;
}

}  // namespace talus::io
