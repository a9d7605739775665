#include "point_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace talus::io {
namespace {

constexpr std::size_t kStatementSize = 200'000;  // characters; SQLite takes a million
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

/// Hexadecimal digits of a number, the highest byte first.
void put(std::string& text, std::uint64_t value, int bytes) {
  constexpr const char* kDigits = "0123456789abcdef";
  for (int shift = 8 * bytes - 4; shift >= 0; shift -= 4)
    text += kDigits[(value >> static_cast<unsigned>(shift)) & 15U];
}

}  // namespace

void PointIndex::add(double x, double y) {
  points_.push_back({x, y});
  if (points_.size() == kRun) pack_points();
}

PointIndex::Cell PointIndex::cell_of(std::size_t point) const {
  const Point& p = points_[point];
  return {first_id_ + static_cast<std::int64_t>(point), {below(p.x), above(p.x), below(p.y), above(p.y)}};
}

std::vector<std::size_t> PointIndex::hilbert_order() const {
  Point low = points_.front(), high = low;
  for (const Point& p : points_) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double size = std::max({high.x - low.x, high.y - low.y, 1e-3});
  const auto square = [size](double d) { return static_cast<std::uint32_t>(65535.0 * d / size); };
  std::vector<std::uint64_t> keys(points_.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    keys[i] = (std::uint64_t{hilbert(square(points_[i].x - low.x), square(points_[i].y - low.y))} << 32U) | i;
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> order(keys.size());
  std::transform(keys.begin(), keys.end(), order.begin(), [](std::uint64_t key) { return key & 0xffffffffU; });
  return order;
}

void PointIndex::pack_points() {
  if (points_.empty()) return;
  const std::vector<std::size_t> order = hilbert_order();
  std::vector<std::int64_t> node_of(points_.size());
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin < order.size(); begin += kCells) {
    cells.clear();
    for (std::size_t i = begin; i < std::min(begin + kCells, order.size()); ++i) {
      cells.push_back(cell_of(order[i]));
      node_of[order[i]] = next_node_;
    }
    leaves_.push_back(write_node(next_node_++, 0, cells.data(), cells.data() + cells.size()));
  }
  for (const std::int64_t node : node_of)
    row(rowids_, "_rowid", std::to_string(first_id_++) + "," + std::to_string(node));
  points_.clear();
}

std::vector<PointIndex::Cell> PointIndex::pack_nodes(const std::vector<Cell>& cells) {
  std::vector<Cell> upper;
  for (std::size_t begin = 0; begin < cells.size(); begin += kCells) {
    const std::size_t end = std::min(begin + kCells, cells.size());
    for (std::size_t i = begin; i < end; ++i)
      row(parents_, "_parent", std::to_string(cells[i].id) + "," + std::to_string(next_node_));
    upper.push_back(write_node(next_node_++, 0, &cells[begin], &cells[begin] + (end - begin)));
  }
  return upper;
}

void PointIndex::finish() {
  pack_points();
  if (leaves_.empty()) return;
  int depth = 1;
  for (; leaves_.size() > kCells; ++depth) leaves_ = pack_nodes(leaves_);
  for (const Cell& cell : leaves_) row(parents_, "_parent", std::to_string(cell.id) + ",1");
  write_node(1, depth, leaves_.data(), leaves_.data() + leaves_.size());
  for (std::string* pending : {&nodes_, &parents_, &rowids_}) flush(*pending);
}

PointIndex::Cell PointIndex::write_node(std::int64_t number, int depth, const Cell* begin, const Cell* end) {
  std::string data = std::to_string(number) + ",X'";
  put(data, static_cast<std::uint64_t>(depth), 2);
  put(data, static_cast<std::uint64_t>(end - begin), 2);
  Cell node{number, begin->box};
  for (const Cell* cell = begin; cell != end; ++cell) {
    put(data, static_cast<std::uint64_t>(cell->id), 8);
    for (std::size_t side = 0; side < 4; ++side) {
      const float value = cell->box[side];
      put(data, std::bit_cast<std::uint32_t>(value), 4);
      node.box[side] = side % 2 == 0 ? std::min(node.box[side], value) : std::max(node.box[side], value);
    }
  }
  data.append(2 * (kNodeBytes - 4 - 24 * static_cast<std::size_t>(end - begin)), '0');
  row(nodes_, "_node", data + "'");
  return node;
}

void PointIndex::row(std::string& pending, const char* suffix, const std::string& values) {
  pending += pending.empty() ? "REPLACE INTO \"" + table_ + suffix + "\" VALUES (" : ",(";
  pending += values + ")";
  if (pending.size() > kStatementSize) flush(pending);
}

void PointIndex::flush(std::string& pending) {
  if (!pending.empty()) execute_(pending);
  pending.clear();
}

}  // namespace talus::io
