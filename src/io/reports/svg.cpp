#include "svg.hpp"

#include <cmath>

#include "talus/base/text.hpp"

namespace talus::io {

std::vector<double> ticks(double low, double high, int wanted) {
  const double unit = std::pow(10.0, std::floor(std::log10((high - low) / wanted)));
  double every = unit;
  for (const double k : {1.0, 2.0, 5.0, 10.0})
    if ((high - low) / (k * unit) <= wanted) {
      every = k * unit;
      break;
    }
  std::vector<double> out;
  for (double at = std::ceil(low / every) * every; at <= high + 1e-9 * every; at += every) out.push_back(at);
  return out;
}

Svg::Attribute::Attribute(std::string_view key, double number) : name(key), value(with_decimals(number, 1)) {}

void Svg::element(std::string_view name, Attributes attributes) {
  body_.append(tag(name, attributes)).append("/>").append(end_);
}

void Svg::words(Attributes attributes, std::string_view text) {
  body_.append(tag("text", attributes)).append(">").append(escaped(text)).append("</text>").append(end_);
}

std::string Svg::drawing(Attributes attributes, std::string_view head) const {
  return tag("svg", attributes).append(">").append(end_).append(head).append(body_).append("</svg>\n");
}

std::string Svg::tag(std::string_view name, Attributes attributes) const {
  std::string text = "<";
  text += name;
  for (const Attribute& attribute : attributes)
    ((text.append(" ").append(attribute.name) += '=') += quote_).append(attribute.value) += quote_;
  return text;
}

}  // namespace talus::io
