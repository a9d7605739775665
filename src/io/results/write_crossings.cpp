#include "talus/io/results/write_crossings.hpp"

#include <cerrno>
#include <stdexcept>

#include "io/files/posix_bytes.hpp"
#include "talus/base/expect.hpp"
#include "talus/base/text.hpp"

namespace talus::io {
CrossingsWriter::CrossingsWriter(const std::filesystem::path& file, const Scenario& scenario, const GeoReference& geo)
    : name_(file.filename().string()),
      pieces_(scenario.effects.fragmentation.threshold > 0.0),
      file_(std::fopen(file.c_str(), "wb")),
      place_(geo, scenario.surface.grid()) {
  if (!file_) fail();
  for (const Screen& screen : scenario.screens) screens_.push_back(csv_field(screen.id));
  put("source,block,screen,speed_ms,energy_kj,total_energy_kj,jump_height_m,angular_velocity_rads,mass_kg,x,y" +
      std::string(pieces_ ? ",piece\n" : "\n"));
}

void CrossingsWriter::write(std::span<const Crossing> crossings) {
  std::string text;
  for (const Crossing& c : crossings) {
    TALUS_EXPECT(c.screen < screens_.size(), "a crossing is of a screen of the scenario");
    const double energy = kinetic_energy_kj(c.mass, c.speed);
    const double rotation = Block{c.diameter, c.mass}.rotational_energy_kj(c.spin);
    text += std::to_string(c.source) + ',' + std::to_string(c.block) + ',' + screens_[c.screen];
    for (const double value : {c.speed, energy, energy + rotation, c.height, c.spin, c.mass})
      (text += ',') += significant(value, 6);
    (text += ',') += with_decimals(place_.x(c.x), 3);
    (text += ',') += with_decimals(place_.y(c.y), 3);
    if (pieces_) text += ',' + std::to_string(c.piece);
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
  throw std::runtime_error(name_ + ": cannot be written: " + system_text(errno));
}

}  // namespace talus::io
