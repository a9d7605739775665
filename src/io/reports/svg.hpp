#pragma once
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "markup.hpp"

namespace talus::io {

/// A scale of a plot: `first` lies at the place `from` of the drawing, `last` at `from + length` [px].
struct Axis {
  double first, last, from, length;
  double operator()(double value) const { return from + length * (value - first) / (last - first); }
};

/// Places of about `wanted` ticks at 1, 2 or 5 times a power of ten.
std::vector<double> ticks(double low, double high, int wanted);

/// A drawing as text, element by element, for a file of its own or for a page.
class Svg {
 public:
  /// An attribute of an element; its value is escaped. Numbers are lengths, to a tenth of a pixel; whole ones stay
  /// whole.
  struct Attribute {
    Attribute(std::string_view key, double number);
    Attribute(std::string_view key, int number) : name(key), value(std::to_string(number)) {}
    Attribute(std::string_view key, std::string text) : name(key), value(std::move(text)) {}
    std::string_view name;
    std::string value;
  };
  using Attributes = std::initializer_list<Attribute>;

  /// @param quote  around values
  /// @param end    after each element
  explicit Svg(char quote = '"', std::string_view end = "\n") : quote_(quote), end_(end) {}

  void element(std::string_view name, Attributes attributes);
  void words(Attributes attributes, std::string_view text);  ///< <text>
  /// The drawing: the <svg> element with all that was added.
  /// @param head  before the elements, such as a <style>
  Markup drawing(Attributes attributes, const Markup& head = {}) const;
  /// The elements alone, for a group in a drawing.
  const Markup& elements() const { return body_; }

 private:
  void add_tag(Markup& to, std::string_view name, Attributes attributes) const;
  char quote_;
  std::string_view end_;
  Markup body_;
};

}  // namespace talus::io
