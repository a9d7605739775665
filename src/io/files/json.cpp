#include "json.hpp"

#include <cmath>
#include <cstdlib>

#include "talus/base/text.hpp"

namespace talus::io {

double six_digits(double value) {
  return std::strtod(with_digits(value, 6).c_str(), nullptr);
}

double six_decimals(double value) {
  return std::round(value * 1e6) / 1e6;
}

Json json_of(double value, double (*rounded)(double)) {
  return std::isnan(value) ? Json() : Json(rounded(value));
}

Json json_of(const Interval& interval, double (*rounded)(double)) {
  return Json::array({json_of(interval.low, rounded), json_of(interval.high, rounded)});
}

Json json_of(std::span<const InputFile> files) {
  Json list = Json::array();
  for (const InputFile& file : files)
    list.push_back({{"role", file.role}, {"path", file.path}, {"sha256", file.sha256}});
  return list;
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace talus::io
