#pragma once
#include <cstddef>
#include <cstdint>

namespace talus {

/// The source cells that one program traces of a plan that several share: whole ones, those that follow each other in
/// the order of work.
struct Part {
  std::uint32_t number = 1, of = 1;

  /// The place of its first source cell, of so many in all; the next part's first is this part's end.
  std::uint32_t first(std::size_t sources) const { return begin_of(number - 1, sources); }
  std::uint32_t end(std::size_t sources) const { return begin_of(number, sources); }

 private:
  std::uint32_t begin_of(std::uint32_t part, std::size_t sources) const {
    return static_cast<std::uint32_t>(std::uint64_t{part} * sources / of);
  }
};

}  // namespace talus
