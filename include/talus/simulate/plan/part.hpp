#pragma once
#include <cstddef>
#include <cstdint>

namespace talus {

/// One part of a plan that several programs share. A part holds whole source cells that follow each other in the order
/// of work.
struct Part {
  std::uint32_t number = 1, of = 1;

  /// Place of its first source cell in the order of work, out of `sources` in all; the next part begins at `end`.
  std::uint32_t first(std::size_t sources) const { return begin_of(number - 1, sources); }
  std::uint32_t end(std::size_t sources) const { return begin_of(number, sources); }

 private:
  std::uint32_t begin_of(std::uint32_t part, std::size_t sources) const {
    return static_cast<std::uint32_t>(std::uint64_t{part} * sources / of);
  }
};

}  // namespace talus
