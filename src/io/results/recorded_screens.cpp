#include "recorded_screens.hpp"

#include "talus/base/error.hpp"

namespace talus::io {

std::vector<Screen> recorded_screens(const Json& run) {
  std::vector<Screen> screens;
  for (const Json& one : run.value("screens", Json::array())) {
    Screen& screen = screens.emplace_back(Screen{one.at("id").get<std::string>(), {}});
    for (const Json& line : one.at("lines")) {
      auto& places = screen.lines.emplace_back();
      for (const Json& place : line) places.emplace_back(place.at(0).get<double>(), place.at(1).get<double>());
      if (places.size() < 2) throw InputError("screen '" + screen.id + "' has a line of less than two places");
    }
  }
  return screens;
}

}  // namespace talus::io
