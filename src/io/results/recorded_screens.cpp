#include "recorded_screens.hpp"

#include "talus/base/error.hpp"

namespace talus::io {

Screen recorded_line(const Json& json) {
  Screen screen{json.at("id").get<std::string>(), {}};
  for (const Json& line : json.value("lines", Json::array())) {
    auto& places = screen.lines.emplace_back();
    for (const Json& place : line) places.emplace_back(place.at(0).get<double>(), place.at(1).get<double>());
    if (places.size() < 2) throw InputError("'" + screen.id + "' has a line of less than two places");
  }
  return screen;
}

std::vector<Screen> recorded_screens(const Json& run) {
  std::vector<Screen> screens;
  for (const Json& one : run.value("screens", Json::array())) {
    if (!one.contains("lines")) throw InputError("screen without lines");
    screens.push_back(recorded_line(one));
  }
  return screens;
}

}  // namespace talus::io
