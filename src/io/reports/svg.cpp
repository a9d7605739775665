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
  add_tag(body_, name, attributes);
  body_ += "/>";
  body_ += end_;
}

void Svg::words(Attributes attributes, std::string_view text) {
  add_tag(body_, "text", attributes);
  body_ += ">"_html + text + "</text>" + end_;
}

Markup Svg::drawing(Attributes attributes, const Markup& head) const {
  Markup svg;
  add_tag(svg, "svg", attributes);
  return svg + ">" + end_ + head + body_ + "</svg>\n";
}

void Svg::add_tag(Markup& to, std::string_view name, Attributes attributes) const {
  to += "<";
  to += name;
  const std::string_view quote(&quote_, 1);
  for (const Attribute& attribute : attributes)
    (to += " "_html + attribute.name + "=" + quote).add_value(attribute.value) += quote;
}

}  // namespace talus::io
