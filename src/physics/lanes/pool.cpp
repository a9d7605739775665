#include "pool.hpp"

#include <algorithm>
#include <bit>
#include <iterator>

#include "physics/anchor.hpp"
#include "physics/crossing.hpp"
#include "physics/staying.hpp"
#include "talus/base/expect.hpp"
#include "talus/physics/slide.hpp"
#include "talus/physics/trace.hpp"

namespace talus {
namespace {

constexpr std::size_t kFirstSpans = 512, kFirstVertices = 128;  // of a path's buffers, which grow
constexpr std::size_t kLongPath = 16'384;  // spans: a longer path is traced in one lane, so that one at a time is there
constexpr std::size_t kMostWaiting = 16U << 20U;  // bytes of paths that wait for their turn
constexpr std::size_t kMostSpare = 64;            // buffers that are kept

static_assert(sizeof(Motion) == 10 * sizeof(double) && offsetof(Vertex, motion) == 0);
static_assert(sizeof(Span) == 52 && offsetof(Span, p_from) == 8 && offsetof(Span, height_from) == 24 &&
              offsetof(Span, bend) == 32 && offsetof(Span, rise_from) == 40 && offsetof(Span, impacts) == 48);

std::size_t bytes_of(const Path& path) {
  return path.spans.capacity() * sizeof(Span) + path.vertices.capacity() * sizeof(Vertex) +
         path.spins.capacity() * sizeof(SpinFrom);
}

LaneWorld lane_world(const World& world) {
  const Grid& grid = world.surface.grid();
  const bool zoned = !world.cover.zones.values.empty();
  return {world.surface.heights().values.data(),
          static_cast<double>(grid.columns),
          static_cast<double>(grid.rows),
          world.surface.per_cell_x(),
          world.surface.per_cell_y(),
          grid.cell_x,
          grid.cell_y,
          world.surface.creased(),
          world.cover.grounds.data(),
          zoned ? world.cover.zones.values.data() : nullptr,
          world.impact,
          world.rules.stop_speed,
          world.rules.trap_time,
          world.rules.time_limit,
          world.rules.impact_limit,
          world.effort.most_vertices * sizeof(Vertex),
          kMostSpans * sizeof(Span),
          static_cast<double>((world.surface.creased() ? 2 : 1) * (grid.columns + grid.rows + 2))};
}

}  // namespace

Pool::Pool(const World& world, int lanes)
    : terrain(lane_world(world)), world_(world), size_(4 * lanes), slots_(new Slot[4 * lanes]) {
  TALUS_EXPECT(size_ <= Queue<1>::kMost, "the queues hold all blocks of a pool");
}

Pool::~Pool() = default;

void Pool::fill(const NextRelease& next, const PathDone& done) {
  next_ = &next;
  done_ = &done;
  flying.first = flying.end = landed.first = landed.end = 0;
  exhausted_ = false;
  order_.clear();
  waiting_ = 0;
  idle_.clear();
  for (int i = 0; i < size_; ++i) start(slots_[i]);
}

/// Starts the next block in this slot, if there is one and not too many wait.
void Pool::start(Slot& slot) {
  slot.release = Release{};
  exhausted_ = exhausted_ || (waiting_ < kMostWaiting && !(*next_)(slot.release, slot.tag));
  if (exhausted_ || waiting_ >= kMostWaiting) {
    idle_.push_back(&slot);
    return;
  }
  slot.number = first_ + order_.size();
  order_.emplace_back();
  const Release& release = slot.release;
  open(slot);
  set_motion(slot, release.motion);
  slot.state[field::Length] = slot.state[field::PlanLength] = 0.0;
  slot.state[field::AnchorX] = slot.state[field::AnchorY] = slot.state[field::AnchorZ] = kNever;  // till a contact
  slot.state[field::AnchorTime] = 0.0;
  slot.state[field::Diameter] = release.body.diameter;
  const auto word = [&](int number, std::uint32_t value) {
    slot.state[number] = std::bit_cast<double>(std::uint64_t{value});
  };
  word(field::Event, 0);
  word(field::PurposeWord, Random::purpose_word(Purpose::Impact, release.piece));
  word(field::Source, release.source);
  word(field::BlockNumber, release.block);
  const auto [low, high] = Random::key_of(release.seed);
  word(field::KeyLow, low);
  word(field::KeyHigh, high);
  push_vertex(slot, Event::Release);
  *slot.spin++ = {0, release.motion.spin.norm()};
  push_flight(slot, world_.surface.patch_at(release.motion.position.x(), release.motion.position.y()), false);
}

/// Makes room for a path, with its first and its next vertex and span.
void Pool::open(Slot& slot) {
  Path& path = slot.path;
  path.clear();
  path.spans.resize(kFirstSpans);
  path.vertices.resize(kFirstVertices);
  path.spins.resize(kFirstVertices);
  slot.first_span = slot.span = path.spans.data();
  slot.last_span = slot.first_span + (kFirstSpans - 2);  // a span is written with some bytes after it
  slot.first_vertex = slot.vertex = path.vertices.data();
  slot.last_vertex = slot.first_vertex + (kFirstVertices - 1);
  slot.spin = path.spins.data();
  slot.impacts = slot.psi_dropped = 0;
}

bool Pool::more_spans(Slot& slot) {
  const auto used = slot.span - slot.first_span;
  if (2 * slot.path.spans.size() > kLongPath) {
    trace(world_, slot.release, long_);
    hand_over(slot, long_);
    return false;
  }
  slot.path.spans.resize(2 * slot.path.spans.size());
  slot.first_span = slot.path.spans.data();
  slot.span = slot.first_span + used;
  slot.last_span = slot.first_span + (slot.path.spans.size() - 2);
  return true;
}

void Pool::more_vertices(Slot& slot) {
  const auto used = slot.vertex - slot.first_vertex, spins = slot.spin - slot.path.spins.data();
  slot.path.vertices.resize(2 * slot.path.vertices.size());
  slot.path.spins.resize(slot.path.vertices.size());
  slot.first_vertex = slot.path.vertices.data();
  slot.vertex = slot.first_vertex + used;
  slot.last_vertex = slot.first_vertex + (slot.path.vertices.size() - 1);
  slot.spin = slot.path.spins.data() + spins;
}

Motion Pool::motion_of(const Slot& slot) const {
  const double* s = slot.state;
  return {s[field::Time],
          {s[field::X], s[field::Y], s[field::Z]},
          {s[field::VelocityX], s[field::VelocityY], s[field::VelocityZ]},
          {s[field::SpinX], s[field::SpinY], s[field::SpinZ]}};
}

void Pool::set_motion(Slot& slot, const Motion& motion) const {
  const Vec3 &x = motion.position, &v = motion.velocity, &w = motion.spin;
  const double numbers[] = {motion.time, x.x(), x.y(), x.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
  std::copy(std::begin(numbers), std::end(numbers), slot.state);
}

void Pool::push_vertex(Slot& slot, Event event) {
  if (slot.vertex == slot.last_vertex) more_vertices(slot);
  *slot.vertex++ = {motion_of(slot), event};
}

void Pool::push_flight(Slot& slot, PatchIndex at, bool grounded) {
  if (flying.end == 2 * Queue<1>::kMost) flying.pack();
  const Motion motion = motion_of(slot);
  const double rate_u = motion.velocity.x() * terrain.per_cell_x, rate_v = motion.velocity.y() * terrain.per_cell_y;
  const double u0 = world_.surface.u_of(motion.position.x()), v0 = world_.surface.v_of(motion.position.y());
  const Lines<double> columns(u0 - at.column, rate_u), rows(v0 - at.row, rate_v);
  const auto put = [&](int number, double value) { flying.at[number][flying.end] = value; };
  put(flight::Place, std::bit_cast<double>(&slot));
  put(flight::U0, u0);
  put(flight::V0, v0);
  put(flight::RateU, rate_u);
  put(flight::RateV, rate_v);
  put(flight::Z0, motion.position.z());
  put(flight::Rise, motion.velocity.z());
  put(flight::NextColumn, columns.next);
  put(flight::EveryColumn, columns.every);
  put(flight::NextRow, rows.next);
  put(flight::EveryRow, rows.every);
  put(flight::Plan2, motion.velocity.x() * motion.velocity.x() + motion.velocity.y() * motion.velocity.y());
  put(flight::Column, at.column);
  put(flight::Row, at.row);
  put(flight::Grounded, grounded ? 1.0 : 0.0);
  flying.end += 1;
}

void Pool::leave(Slot& slot, double t) {
  Motion motion = motion_of(slot);
  const Vec3 v = motion.velocity;
  slot.state[field::Length] += arc_length<double>(v, t);
  slot.state[field::PlanLength] += std::sqrt(v.x() * v.x() + v.y() * v.y()) * t;
  motion.time += t;
  motion.position.x() += v.x() * t;
  motion.position.y() += v.y() * t;
  motion.position.z() += t * (v.z() - 0.5 * kGravity * t);
  motion.velocity.z() -= kGravity * t;
  set_motion(slot, motion);
  end(slot, End::Left);
}

void Pool::stay(Slot& slot, int column, int row) {
  const Motion motion = motion_of(slot);
  const Ground& ground = world_.cover.grounds[world_.cover.zone_at(motion.position.x(), motion.position.y())];
  end(slot, end_of_staying(world_, ground, motion, {column, row}, slot.release.body.diameter));
}

/// Asks the anchor of a block that has slid: see Anchor::holds.
bool Pool::holds(Slot& slot, const Motion& motion) const {
  double* s = slot.state;
  Anchor anchor(world_.rules.trap_time);
  const Vec3 place(s[field::AnchorX], s[field::AnchorY], s[field::AnchorZ]);
  anchor.set({s[field::AnchorTime], place, Vec3::Zero(), Vec3::Zero()});
  const bool held = anchor.holds(motion, slot.release.body.diameter);
  s[field::AnchorTime] = anchor.time();
  s[field::AnchorX] = anchor.place().x();
  s[field::AnchorY] = anchor.place().y();
  s[field::AnchorZ] = anchor.place().z();
  return held;
}

void Pool::slide(Slot& slot, const double* normal, int column, int row) {
  const Vec3 n(normal[0], normal[1], normal[2]);
  Motion motion = motion_of(slot);
  motion.velocity -= motion.velocity.dot(n) * n;
  PatchIndex at{column, row};
  slide_.clear();
  slide_.length = slot.state[field::Length];
  slide_.plan_length = slot.state[field::PlanLength];
  const SlideEnd how = talus::slide(world_.surface, world_.cover, motion, at, {slot.release.body.diameter},
                                    world_.rules.stop_speed, slide_);
  slot.state[field::Length] = slide_.length;
  slot.state[field::PlanLength] = slide_.plan_length;
  for (const Span& span : slide_.spans) {
    if (slot.span == slot.last_span && !more_spans(slot)) return;
    *slot.span++ = span;
  }
  for (const Vertex& vertex : slide_.vertices) {
    if (slot.vertex == slot.last_vertex) more_vertices(slot);
    *slot.vertex++ = vertex;
  }
  set_motion(slot, motion);
  if (how == SlideEnd::Left) return end(slot, End::Left);
  if (how == SlideEnd::Stopped) return end(slot, End::Stopped);
  if (how == SlideEnd::Trapped || holds(slot, motion)) return stay(slot, at.column, at.row);
  if (how == SlideEnd::Takeoff) {
    push_vertex(slot, Event::Takeoff);
    return push_flight(slot, at, true);
  }
  if (landed.end == 2 * Queue<1>::kMost) landed.pack();  // many slides in turn, with no flight between
  const auto put = [&](int number, double value) { landed.at[number][landed.end] = value; };
  put(landing::Place, std::bit_cast<double>(&slot));
  put(landing::Time, 0.0);
  put(landing::Z, motion.position.z());
  put(landing::Column, at.column);
  put(landing::Row, at.row);
  landed.end += 1;
}

void Pool::end(Slot& slot, End end) {
  push_vertex(slot, Event::End);
  Path& path = slot.path;
  path.spans.resize(static_cast<std::size_t>(slot.span - slot.first_span));
  path.vertices.resize(static_cast<std::size_t>(slot.vertex - slot.first_vertex));
  path.spins.resize(static_cast<std::size_t>(slot.spin - path.spins.data()));
  path.end = end;
  path.impacts = slot.impacts;
  path.psi_dropped = slot.psi_dropped;
  path.length = slot.state[field::Length];
  path.plan_length = slot.state[field::PlanLength];
  path.mass = slot.release.body.mass;
  TALUS_EXPECT(path.vertices.back().motion.time >= slot.release.motion.time, "time goes on");
  hand_over(slot, path);
}

/// Hands out the path of a block, or keeps it until those before it are handed out; then starts other blocks.
void Pool::hand_over(Slot& slot, Path& path) {
  if (slot.number == first_) {
    (*done_)(slot.release, path, slot.tag);
    order_.pop_front();
    ++first_;
    hand_out();
  } else {
    Waiting& waiting = order_[slot.number - first_];
    waiting.ended = true;
    waiting.tag = slot.tag;
    waiting.release = slot.release;
    if (!spare_.empty()) {
      std::swap(waiting.path, spare_.back());
      spare_.pop_back();
    }
    std::swap(waiting.path, path);
    waiting_ += bytes_of(waiting.path);
  }
  start(slot);
  while (!idle_.empty() && !exhausted_ && waiting_ < kMostWaiting) {
    Slot& other = *idle_.back();
    idle_.pop_back();
    start(other);
  }
}

/// Hands out the paths whose turn has come.
void Pool::hand_out() {
  for (; !order_.empty() && order_.front().ended; order_.pop_front(), ++first_) {
    Waiting& waiting = order_.front();
    (*done_)(waiting.release, waiting.path, waiting.tag);
    waiting_ -= bytes_of(waiting.path);
    if (spare_.size() < kMostSpare && bytes_of(waiting.path) < kMostWaiting / kMostSpare)
      spare_.push_back(std::move(waiting.path));
  }
}

}  // namespace talus
