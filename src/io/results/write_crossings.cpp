#include "talus/io/results/write_crossings.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <stdexcept>
#include <system_error>

namespace talus::io {
namespace {

/// Appends a comma and the number.
void add(std::string& line, double value, std::chars_format format, int precision) {
  std::array<char, 400> text;  // the longest double in fixed notation has 309 digits before the point
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, precision).ptr;
  line += ',';
  line.append(text.data(), end);
}

void add(std::string& line, double value) {
  add(line, value, std::chars_format::general, 6);
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

CrossingsWriter::CrossingsWriter(const std::filesystem::path& file, const Scenario& scenario, const GeoReference& geo)
    : name_(file.filename().string()),
      file_(std::fopen(file.c_str(), "wb")),
      west_(geo.west),
      south_(geo.north - scenario.surface.grid().rows * geo.cell_y) {
  if (!file_) fail();
  for (const Screen& screen : scenario.screens) screens_.push_back(csv_field(screen.id));
  put("source,block,screen,speed_ms,energy_kj,total_energy_kj,jump_height_m,angular_velocity_rads,mass_kg,x,y\n");
}

void CrossingsWriter::write(std::span<const Crossing> crossings) {
  std::string text;
  for (const Crossing& c : crossings) {
    const double energy = 0.5e-3 * c.mass * c.speed * c.speed;
    const double rotation = 0.5e-3 * Block{c.diameter, c.mass}.inertia() * c.spin * c.spin;
    text += std::to_string(c.source) + ',' + std::to_string(c.block) + ',' + screens_[c.screen];
    for (const double value : {c.speed, energy, energy + rotation, c.height, c.spin, c.mass}) add(text, value);
    add(text, west_ + c.x, std::chars_format::fixed, 3);
    add(text, south_ + c.y, std::chars_format::fixed, 3);
    text += '\n';
  }
  put(text);
}

void CrossingsWriter::finish() {
  if (std::fclose(file_.release()) != 0) fail();
}

void CrossingsWriter::put(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail();
}

void CrossingsWriter::fail() const {
  throw std::runtime_error(name_ + ": cannot be written: " + std::system_category().message(errno));
}

}  // namespace talus::io
