#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>

#include "talus/simulate/tally/source_reach.hpp"

namespace talus {

/// The cells that each source cell has reached, remembered beyond one unit of work: a source cell counts once in a
/// cell, however many units, rounds or sessions trace it. A source cell is given by its place in the order of work.
class Reaches {
 public:
  /// @param units   units of work per source cell in one round
  /// @param keep    keeps the cells of all source cells, for further rounds
  /// @param memory  where the cells are stored
  Reaches(std::uint32_t units, bool keep, MemoryPolicy memory) : units_(units), keep_(keep), memory_(memory) {}
  ~Reaches();
  Reaches(const Reaches&) = delete;
  Reaches& operator=(const Reaches&) = delete;

  /// Cells of one source cell; call it once per unit. Empty if one unit holds the whole source cell. Safe to call from
  /// several threads.
  std::shared_ptr<SourceReach> of(std::uint32_t place);

  /// Hands out the cells of each source cell, one after the other: all together may not fit into the memory.
  void save(const std::function<void(std::string_view)>& put) const;
  /// Adds the saved cells of a source cell, if `wanted(place)`.
  void restore(ByteReader& in, const std::function<bool(std::uint32_t)>& wanted);

 private:
  struct Entry {
    std::shared_ptr<SourceReach> reach;
    std::uint32_t asked = 0;
  };
  std::uint32_t units_;
  bool keep_;
  MemoryPolicy memory_;
  std::mutex mutex_;
  std::map<std::uint32_t, Entry> open_;
};

}  // namespace talus
