#include "packed_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace talus::io {
namespace {

constexpr std::size_t kNodeBytes = 4 + 51 * 24;  // what SQLite chooses for two dimensions and pages of 4096 bytes

/// The largest float that is not above a value, and the smallest that is not below it.
float below(double value) {
  const auto f = static_cast<float>(value);
  return f > value ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float above(double value) {
  const auto f = static_cast<float>(value);
  return f < value ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

/// Position along a Hilbert curve through 2^16 x 2^16 squares. The usual xy2d, as in Wikipedia's "Hilbert curve".
std::uint32_t hilbert(std::uint32_t x, std::uint32_t y) {
  std::uint32_t position = 0;
  for (std::uint32_t side = 1U << 15U; side > 0; side /= 2) {
    const bool right = (x & side) != 0, upper = (y & side) != 0;
    position += side * side * ((right ? 3U : 0U) ^ (upper ? 1U : 0U));
    if (upper) continue;
    if (right) {
      x = ~x;
      y = ~y;
    }
    std::swap(x, y);
  }
  return position;
}

/// Writes a number, the highest byte first.
template <class Number>
unsigned char* put(unsigned char* at, Number value) {
  for (int shift = 8 * int{sizeof(Number)} - 8; shift >= 0; shift -= 8)
    *at++ = static_cast<unsigned char>(value >> static_cast<unsigned>(shift));
  return at;
}

/// Rows of a table of the tree: a number, and what belongs to it.
SqliteRows rows_of(sqlite3* database, const std::string& table) {
  return {database, "REPLACE INTO \"" + table + "\"", 2};
}

}  // namespace

PackedIndex::PackedIndex(sqlite3* database, const std::string& table)
    : nodes_(rows_of(database, table + "_node")),
      parents_(rows_of(database, table + "_parent")),
      rowids_(rows_of(database, table + "_rowid")) {}

void PackedIndex::add(std::int64_t id, const Box& box) {
  entries_.push_back({id, box});
  if (entries_.size() == kRun) pack_entries();
}

std::vector<std::size_t> PackedIndex::hilbert_order() const {
  const auto centre = [](double a, double b) { return 0.5 * (a + b); };
  Box all = entries_.front().box;
  for (const auto& [id, box] : entries_)
    all = {std::min(all.west, box.west), std::max(all.east, box.east), std::min(all.south, box.south),
           std::max(all.north, box.north)};
  const double size = std::max({all.east - all.west, all.north - all.south, 1e-3});
  const auto square = [size](double d) { return static_cast<std::uint32_t>(65535.0 * d / size); };
  std::vector<std::uint64_t> keys(entries_.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Box& box = entries_[i].box;
    const std::uint32_t column = square(centre(box.west, box.east) - all.west),
                        row = square(centre(box.south, box.north) - all.south);
    keys[i] = (std::uint64_t{hilbert(column, row)} << 32U) | i;
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](std::uint64_t key) { return key & 0xffffffffU; });
  return order;
}

void PackedIndex::pack_entries() {
  if (entries_.empty()) return;
  const std::vector<std::size_t> order = hilbert_order();
  std::vector<std::int64_t> node_of(entries_.size());
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin < order.size(); begin += kCells) {
    cells.clear();
    for (std::size_t i = begin; i < std::min(begin + kCells, order.size()); ++i) {
      const auto& [id, box] = entries_[order[i]];
      cells.push_back({id, {below(box.west), above(box.east), below(box.south), above(box.north)}});
      node_of[order[i]] = next_node_;
    }
    leaves_.push_back(write_node(next_node_++, 0, cells.data(), cells.data() + cells.size()));
  }
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    rowids_.add(entries_[i].id);
    rowids_.add(node_of[i]);
    rowids_.insert();
  }
  entries_.clear();
}

std::vector<PackedIndex::Cell> PackedIndex::pack_nodes(const std::vector<Cell>& cells) {
  std::vector<Cell> upper;
  for (std::size_t begin = 0; begin < cells.size(); begin += kCells) {
    const std::size_t end = std::min(begin + kCells, cells.size());
    upper.push_back(write_node(next_node_++, 0, &cells[begin], &cells[begin] + (end - begin)));
    for (std::size_t i = begin; i < end; ++i) write_parent(cells[i].id, upper.back().id);
  }
  return upper;
}

void PackedIndex::finish() {
  pack_entries();
  if (leaves_.empty()) return;
  int depth = 1;
  for (; leaves_.size() > kCells; ++depth) leaves_ = pack_nodes(leaves_);
  for (const Cell& cell : leaves_) write_parent(cell.id, 1);
  write_node(1, depth, leaves_.data(), leaves_.data() + leaves_.size());
}

void PackedIndex::write_parent(std::int64_t node, std::int64_t parent) {
  parents_.add(node);
  parents_.add(parent);
  parents_.insert();
}

PackedIndex::Cell PackedIndex::write_node(std::int64_t number, int depth, const Cell* begin, const Cell* end) {
  std::array<unsigned char, kNodeBytes> bytes{};
  unsigned char* at = put(bytes.data(), static_cast<std::uint16_t>(depth));
  at = put(at, static_cast<std::uint16_t>(end - begin));
  Cell node{number, begin->box};
  for (const Cell* cell = begin; cell != end; ++cell) {
    at = put(at, static_cast<std::uint64_t>(cell->id));
    for (std::size_t side = 0; side < 4; ++side) {
      const float value = cell->box[side];
      at = put(at, std::bit_cast<std::uint32_t>(value));
      node.box[side] = side % 2 == 0 ? std::min(node.box[side], value) : std::max(node.box[side], value);
    }
  }
  nodes_.add(number);
  nodes_.add_bytes(bytes.data(), bytes.size());
  nodes_.insert();
  return node;
}

}  // namespace talus::io
