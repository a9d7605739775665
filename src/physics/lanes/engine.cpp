// Compiled once for each number of lanes, TALUS_LANES, with the instructions of the processors that have them. It calls
// no inline function that other files use, too: see src/physics/lanes/lanes.hpp.
#include "engine.hpp"

#include <utility>

#include "lanes.hpp"
#include "physics/anchor.hpp"
#include "physics/crossing.hpp"
#include "pool.hpp"
#include "talus/physics/impact.hpp"
#include "talus/physics/trace.hpp"

namespace talus {

template <int N>
class Engine {
  using L = Lanes<N>;
  using Mask = LaneMask<N>;
  using Vector = LaneVector<N>;
  using I = Instructions<N>;
  using Patches = BasicPatch<L>;

 public:
  [[gnu::always_inline]] explicit Engine(Pool& pool) : pool_(pool), world_(pool.terrain) {}

  /// Flights in lanes that are refilled when a block lands; impacts of as many landed blocks as there are lanes.
  [[gnu::always_inline]] void follow() {
    flights_.active = 0;
    for (int lane = 0; lane < N; ++lane) slots_[lane] = nullptr;
    do {
      fly();
      while (pool_.landed.size() >= N) land(N);
      if (flights_.active == 0 && pool_.flying.size() == 0 && pool_.landed.size() > 0) land(pool_.landed.size());
      pool_.landed.pack();
    } while (flights_.active != 0 || pool_.flying.size() > 0 || pool_.landed.size() > 0);
  }

 private:
  /// The flights in the lanes.
  struct Flights {
    L u0, v0, rate_u, rate_v, z0, v_z, next_column, every_column, next_row, every_row, plan2, column, row;
    L t, p, q, z, crossed;
    unsigned active;   // lanes with a block
    unsigned leaving;  // lanes whose block is on the surface and moves away from it
  };

  /// Reads the patches of these indices, which are whole numbers within the grid.
  [[gnu::always_inline]] Patches read(L column, L row) const {
    const L index = row * world_.columns + column + 0x1p52;  // its last digits are the index
    const auto cell = I::words_of(index.x) ^ I::words_of(L(0x1p52).x);
    const auto south = I::gather_pairs(world_.heights, cell);
    const auto north = I::gather_pairs(world_.heights + static_cast<std::ptrdiff_t>(world_.columns), cell);
    const L sw = I::low_float(south), se = I::low_float(I::template down<32>(south));
    const L nw = I::low_float(north), ne = I::low_float(I::template down<32>(north));
    return {sw, se - sw, nw - sw, (ne - nw) - (se - sw)};
  }
  [[gnu::always_inline]] static Patches choose_patch(Mask m, const Patches& yes, const Patches& no) {
    return {choose(m, yes.corner, no.corner), choose(m, yes.east, no.east), choose(m, yes.north, no.north),
            choose(m, yes.twist, no.twist)};
  }

  /// Gives blocks that wait for a flight to the free lanes.
  [[gnu::always_inline]] void refill(Flights& f) {
    auto& queue = pool_.flying;
    unsigned free = ~f.active & ((1U << N) - 1), take = 0;
    int count = 0;
    for (; free != 0 && count < queue.size(); ++count) {
      take |= free & -free;
      free &= free - 1;
    }
    const int first = queue.first;
    queue.first += count;
    const Mask into = Mask::of(take);
    const auto next = [&](L& lanes, int number) { lanes = spread(lanes, into, L::load(queue.at[number] + first)); };
    L slots = L::load(reinterpret_cast<const double*>(slots_)), grounded(0.0);
    next(slots, flight::Place);
    slots.store(reinterpret_cast<double*>(slots_));
    next(f.u0, flight::U0);
    next(f.v0, flight::V0);
    next(f.rate_u, flight::RateU);
    next(f.rate_v, flight::RateV);
    next(f.z0, flight::Z0);
    next(f.v_z, flight::Rise);
    next(f.next_column, flight::NextColumn);
    next(f.every_column, flight::EveryColumn);
    next(f.next_row, flight::NextRow);
    next(f.every_row, flight::EveryRow);
    next(f.plan2, flight::Plan2);
    next(f.column, flight::Column);
    next(f.row, flight::Row);
    next(grounded, flight::Grounded);
    f.t = choose(into, L(0.0), f.t);
    f.crossed = choose(into, L(0.0), f.crossed);
    f.z = choose(into, f.z0, f.z);
    f.p = choose(into, f.u0 - f.column, f.p);
    f.q = choose(into, f.v0 - f.row, f.q);
    if (queue.size() == 0) queue.first = queue.end = 0;
    f.leaving |= (grounded > 0.0).number() & take;
    f.active |= take;
  }

  /// Flies patch by patch until lanes are free, none waits for a flight, and enough have landed for an impact.
  void fly() {
    Flights f = flights_;
    for (;;) {
      if (f.active != (1U << N) - 1) {
        if (pool_.flying.size() > 0) refill(f);
        if (f.active == 0 || (f.active != (1U << N) - 1 && pool_.landed.size() >= N)) break;
      }
      step(f);
    }
    flights_ = f;
  }

  /// Each block crosses one patch, or one half of a creased patch; written as in `fly` of one block (flight.cpp).
  [[gnu::always_inline]] void step(Flights& f) {
    const Mask active = Mask::of(f.active), leaving = Mask::of(f.leaving);
    const Mask inside = (f.column >= 0.0) & (f.column < world_.columns - 1.0) & (f.row >= 0.0) &
                        (f.row < world_.rows - 1.0) & (f.crossed <= world_.most_crossed) & active;
    Patches patch = read(choose(inside, f.column, L(0.0)), choose(inside, f.row, L(0.0)));
    const Mask there = inside & (patch.twist == patch.twist);
    const Course<L> course{f.p, f.q, f.z, f.rate_u, f.rate_v, f.v_z - kGravity * f.t};
    L crease_after(kNever);
    if (world_.creased) {
      const Creases<L> creases = creases_of(patch);
      const Mask creased = creases.there();
      if (any(creased)) {
        const Mask north = on_northern_half<L>(creases.rising, f.p, f.q, f.rate_u, f.rate_v);
        patch = choose_patch(creased, half_of<L>(patch, creases.rising, north), patch);
        crease_after = choose(creased, time_to_crease<L>(creases.rising, north, course), crease_after);
      }
    }
    const L edge = smaller(f.next_column, f.next_row) - f.t;
    const L until = smaller(edge, crease_after);
    const Clearance<L> clearance = clearance_over<L>(patch, course, leaving);
    const L contact = first_contact<L>(clearance.f0, clearance.f1, clearance.f2, until);
    const Mask lands = contact < kNever;
    const L dt = choose(lands, contact, until);
    const Mask goes = there & (dt < kNever);
    f.t = choose(goes, f.t + dt, f.t);
    const L p_from = f.p, q_from = f.q;
    f.p = f.u0 + f.rate_u * f.t - f.column;
    f.q = f.v0 + f.rate_v * f.t - f.row;
    const L end_height = choose(lands, L(0.0), larger(L(0.0), clearance.f0 + dt * (clearance.f1 + dt * clearance.f2)));
    const unsigned gone = write_spans(goes, f, pair_of(I::float_bits(p_from.x), I::float_bits(q_from.x)),
                                      pair_of(I::float_bits(clearance.f0.x), I::float_bits(end_height.x)),
                                      pair_of(I::float_bits((clearance.f2 * dt * dt).x), I::float_bits(f.plan2.x)),
                                      pair_of(I::float_bits(course.rise.x), I::float_bits((f.v_z - kGravity * f.t).x)));
    const Mask landed = goes & lands & opposite(Mask::of(gone)), left = active & opposite(goes);
    if (any(landed)) push_landed(landed, f, patch.height(f.p, f.q));
    const unsigned out = left.number();
    if (out != 0) {
      alignas(64) double time[N];
      f.t.store(time);
      for (int lane = 0; lane < N; ++lane)
        if ((out >> lane & 1U) != 0) pool_.leave(*slots_[lane], time[lane]);
    }
    f.active &= ~(landed.number() | out | gone);
    f.leaving = 0;
    f.z = f.z0 + f.t * (f.v_z - 0.5 * kGravity * f.t);
    const Mask crosses = opposite(crease_after < edge);
    const Mask by_column = crosses & (f.next_column <= f.next_row);
    const Mask by_row = crosses & opposite(by_column);
    cross(by_column, f.rate_u, f.every_column, f.next_column, f.column, f.p);
    cross(by_row, f.rate_v, f.every_row, f.next_row, f.row, f.q);
    f.crossed = f.crossed + 1.0;
  }

  [[gnu::always_inline]] static void cross(Mask m, L rate, L every, L& next, L& index, L& share) {
    const L step = choose(m, choose(rate < 0.0, L(-1.0), L(1.0)), L(0.0));
    index = index + step;
    share = choose(m, share - step, share);
    next = choose(m, next + every, next);
  }

  /// Two numbers of 32 bits as one of 64.
  [[gnu::always_inline]] static L pair_of(typename I::Words low, typename I::Words high) {
    return I::reals_of(low | I::template up<32>(high));
  }

  /// Cells over which the blocks will be three patches later: their heights are fetched ahead. The cell, if it is in
  /// the grid, is in the last digits; other numbers do no harm.
  [[gnu::always_inline]] L places_ahead(const Flights& f) const {
    const L time = 3.0 * smaller(f.every_column, f.every_row);
    return whole_below(f.row + f.rate_v * time) * world_.columns + whole_below(f.column + f.rate_u * time) + 0x1p52;
  }

  /// Writes one span for each of these blocks.
  /// Returns the lanes whose blocks are no longer there.
  [[gnu::always_inline]] unsigned write_spans(Mask goes, const Flights& f, L from, L heights, L bend_plan2, L rises) {
    L rows[8] = {pair_of(I::whole_bits(f.column.x), I::whole_bits(f.row.x)),
                 from,
                 pair_of(I::float_bits(f.p.x), I::float_bits(f.q.x)),
                 heights,
                 bend_plan2,
                 rises,
                 L(0.0),
                 L(0.0)};
    transpose(rows);
    const unsigned lanes = goes.number();
    unsigned gone = 0;
    alignas(64) std::uint64_t soon[N];
    places_ahead(f).store(reinterpret_cast<double*>(soon));
    in_each_lane([&](auto lane) {
      __builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(world_.heights) +
                                                       sizeof(float) * (soon[lane] & 0xFFFF'FFFF'FFFF)));
      if ((lanes >> lane & 1U) == 0) return;
      Slot& slot = *slots_[lane];
      if (slot.span == slot.last_span) [[unlikely]]
        if (!pool_.more_spans(slot)) {
          gone |= 1U << lane;
          return;
        }
      double* to = reinterpret_cast<double*>(slot.span);
      for (int part = 0; part < 8 / N; ++part) rows[lane + part * N].store(to + part * N);
      slot.span += 1;
    });
    return gone;
  }

  template <class Work>
  [[gnu::always_inline]] static void in_each_lane(const Work& work) {
    [&]<int... lane>(std::integer_sequence<int, lane...>) __attribute__((always_inline)) {
      (work(std::integral_constant<int, lane>()), ...);
    }
    (std::make_integer_sequence<int, N>());
  }

  /// Turns eight numbers of each lane into the eight numbers of lane 0, those of lane 1, ... (with four lanes: the
  /// first four of each lane, then the others), or back.
  [[gnu::always_inline]] static void transpose(L (&numbers)[8]) {
    for (int part = 0; part < 8 / N; ++part) {
      typename I::Reals square[N];
      for (int i = 0; i < N; ++i) square[i] = numbers[part * N + i].x;
      I::transpose(square);
      for (int i = 0; i < N; ++i) numbers[part * N + i] = square[i];
    }
  }

  [[gnu::always_inline]] void push_landed(Mask landed, const Flights& f, L height) {
    auto& queue = pool_.landed;
    const auto put = [&](int number, L lanes) { together(landed, lanes).store(queue.at[number] + queue.end); };
    put(landing::Place, L::load(reinterpret_cast<const double*>(slots_)));
    put(landing::Time, f.t);
    put(landing::Z, height);
    put(landing::Column, f.column);
    put(landing::Row, f.row);
    queue.end += __builtin_popcount(landed.number());
  }

  /// The numbers of the blocks of a pack, and what the steps of their impact find.
  struct Pack {
    Slot* slots[N];
    L state[field::Count];
    L column, row;
    Mask there;  // lanes with a block

    [[gnu::always_inline]] Vector vector(int first) const { return {state[first], state[first + 1], state[first + 2]}; }
    [[gnu::always_inline]] void set(int first, Mask m, const Vector& v) {
      state[first] = choose(m, v.x(), state[first]);
      state[first + 1] = choose(m, v.y(), state[first + 1]);
      state[first + 2] = choose(m, v.z(), state[first + 2]);
    }
  };
  /// Size and motion of the blocks, for the impact law.
  struct Ball {
    L diameter;
    [[gnu::always_inline]] L radius() const { return 0.5 * diameter; }
  };
  struct Moving {
    Vector velocity, spin;
  };

  /// Ends the flights of some landed blocks, and does their impacts; as `Walk` of one block (trace.cpp).
  void land(int count) {
    Pack pack;
    end_flights(pack, count);
    const Mask stays = pack.there & (pack.state[field::Time] - pack.state[field::AnchorTime] >
                                     longest_stay(world_.trap_time, pack.state[field::Diameter]));
    const Mask bounded =
        opposite(stays) &
        (pack.there & (Mask::of(at_limits(pack)) | opposite(pack.state[field::Time] < world_.time_limit)));
    const Mask meets = pack.there & opposite(stays) & opposite(bounded);

    Patches patch = read(pack.column, pack.row);
    const L p = patch_coordinate(pack.state[field::X], world_.per_cell_x) - pack.column;
    const L q = patch_coordinate(pack.state[field::Y], world_.per_cell_y) - pack.row;
    const Moving before{pack.vector(field::VelocityX), pack.vector(field::SpinX)};
    if (world_.creased) {
      const Creases<L> creases = creases_of(patch);
      if (any(creases.there()))
        patch = choose_patch(creases.there(),
                             facet_of<L>(patch, creases.rising, p, q, before.velocity.x() * world_.per_cell_x,
                                         before.velocity.y() * world_.per_cell_y),
                             patch);
    }
    const Vector normal = normal_of<L>((patch.east + patch.twist * q) * world_.per_cell_x,
                                       (patch.north + patch.twist * p) * world_.per_cell_y);
    const BasicGround<L> ground = grounds_of(pack);
    const BasicContact<L> contact = impact(world_.impact, ground, Ball{pack.state[field::Diameter]}, before, normal,
                                           asperity_of(draw(pack), ground), NoChanges{});
    pack.set(field::VelocityX, meets, contact.velocity);
    pack.set(field::SpinX, meets, contact.spin);
    write_impacts(pack, meets, contact);

    const Mask fast = contact.velocity.squaredNorm() >= world_.stop_speed * world_.stop_speed;
    const L steep = root(normal.x() * normal.x() + normal.y() * normal.y());
    const Mask stops = meets & opposite(fast) & (steep <= ground.tan_phi * normal.z());
    const Mask slides = meets & opposite(stops) & (contact.velocity.dot(normal) < kSlideSpeed);
    push_flights(pack, meets & opposite(stops) & opposite(slides));
    hand_over(pack, normal, {stays.number(), bounded.number(), stops.number(), slides.number()});
  }

  /// Takes the last blocks of the queue, and moves them to the ends of their flights.
  [[gnu::always_inline]] void end_flights(Pack& pack, int count) {
    auto& queue = pool_.landed;
    const int first = queue.first;
    queue.first += count;
    pack.there = Mask::of((1U << count) - 1);
    const auto next = [&](int number) { return choose(pack.there, L::load(queue.at[number] + first), L(0.0)); };
    for (int lane = 0; lane < N; ++lane)  // lanes without a block look at the first one's; a pointer lies in a double
      __builtin_memcpy(&pack.slots[lane], queue.at[landing::Place] + first + (lane < count ? lane : 0), sizeof(double));
    const L t = next(landing::Time);
    pack.column = next(landing::Column);
    pack.row = next(landing::Row);
    for (int group = 0; group < field::Count; group += 8) {
      L rows[8];
      in_each_lane([&](auto lane) {
        for (int part = 0; part < 8 / N; ++part)
          rows[lane + part * N] = L::load(pack.slots[lane]->state + group + part * N);
      });
      transpose(rows);
      for (int i = 0; i < 8; ++i) pack.state[group + i] = rows[i];
    }
    auto& s = pack.state;
    const Vector v = pack.vector(field::VelocityX);
    s[field::Length] = s[field::Length] + arc_length<L>(v, t);
    s[field::PlanLength] = s[field::PlanLength] + root(v.x() * v.x() + v.y() * v.y()) * t;
    s[field::Time] = s[field::Time] + t;
    s[field::X] = s[field::X] + v.x() * t;
    s[field::Y] = s[field::Y] + v.y() * t;
    s[field::Z] = next(landing::Z);
    s[field::VelocityZ] = v.z() - kGravity * t;
    move_anchor(s);
  }

  /// As Anchor::holds of one block.
  [[gnu::always_inline]] static void move_anchor(L (&s)[field::Count]) {
    const L x = s[field::X] - s[field::AnchorX], y = s[field::Y] - s[field::AnchorY],
            z = s[field::Z] - s[field::AnchorZ];
    const L farthest = s[field::Diameter] * s[field::Diameter];
    const Mask away = (x * x + y * y > farthest) | (z * z > farthest);
    s[field::AnchorX] = choose(away, s[field::X], s[field::AnchorX]);
    s[field::AnchorY] = choose(away, s[field::Y], s[field::AnchorY]);
    s[field::AnchorZ] = choose(away, s[field::Z], s[field::AnchorZ]);
    s[field::AnchorTime] = choose(away, s[field::Time], s[field::AnchorTime]);
  }

  /// Blocks at the limits of a path, but that of time.
  [[gnu::always_inline]] unsigned at_limits(const Pack& pack) const {
    unsigned bounded = 0;
    for (int lane = 0; lane < N; ++lane) {
      const Slot& slot = *pack.slots[lane];
      const auto vertices =
          reinterpret_cast<const char*>(slot.vertex) - reinterpret_cast<const char*>(slot.first_vertex);
      const auto spans = reinterpret_cast<const char*>(slot.span) - reinterpret_cast<const char*>(slot.first_span);
      if (slot.impacts >= world_.impact_limit || static_cast<std::size_t>(vertices) >= world_.most_vertices ||
          static_cast<std::size_t>(spans) >= world_.most_spans)
        bounded |= 1U << lane;
    }
    return bounded;
  }

  [[gnu::always_inline]] BasicGround<L> grounds_of(const Pack& pack) const {
    if (world_.zones == nullptr) {
      const Ground& g = world_.grounds[0];
      return {g.theta_scale, g.psi_scale, g.En50, g.Et50, g.tan_phi, g.shape_min, g.shape_max};
    }
    alignas(64) double column[N], row[N], numbers[7][N];
    whole_below(pack.state[field::X] / world_.cell_x).store(column);
    whole_below(pack.state[field::Y] / world_.cell_y).store(row);
    for (int lane = 0; lane < N; ++lane) {
      const bool there = (pack.there.number() >> lane & 1U) != 0;
      const auto cell = there ? static_cast<std::size_t>(row[lane]) * static_cast<std::size_t>(world_.columns) +
                                    static_cast<std::size_t>(column[lane])
                              : 0;
      const Ground& g = world_.grounds[world_.zones[cell]];
      numbers[0][lane] = g.theta_scale, numbers[1][lane] = g.psi_scale, numbers[2][lane] = g.En50;
      numbers[3][lane] = g.Et50, numbers[4][lane] = g.tan_phi;
      numbers[5][lane] = g.shape_min, numbers[6][lane] = g.shape_max;
    }
    return {L::load(numbers[0]), L::load(numbers[1]), L::load(numbers[2]), L::load(numbers[3]),
            L::load(numbers[4]), L::load(numbers[5]), L::load(numbers[6])};
  }

  /// The random numbers of the impacts: as Asperities::at.
  [[gnu::always_inline]] AsperityDraw<L> draw(const Pack& pack) const {
    const auto words = [&](std::uint32_t part) {
      const auto word = [&](int number) { return LaneWords<N>{I::words_of(pack.state[number].x)}; };
      Philox<LaneWords<N>> philox{word(field::Event),       word(field::PurposeWord), word(field::Source),
                                  word(field::BlockNumber), word(field::KeyLow),      word(field::KeyHigh)};
      philox.c0 += part;
      philox.mix();
      return philox;
    };
    const auto first = words(0);
    AsperityDraw<L> draw = asperity_draw(first.c0, first.c1, first.c2, first.c3);
    if (world_.impact.roughness == Roughness::Resample) {
      Mask below = draw.longitudinal < kLowestBracket;
      for (std::uint32_t part = 1; any(below) && part < kMaxRedraws; ++part) {
        const auto again = words(part);
        draw.longitudinal = choose(below, box_muller(uniform(again.c0), uniform(again.c1)).first, draw.longitudinal);
        below = draw.longitudinal < kLowestBracket;
      }
    }
    return draw;
  }

  /// Writes the states back; for these blocks also the vertex and the spin of an impact.
  [[gnu::always_inline]] void write_impacts(Pack& pack, Mask meets, const BasicContact<L>& contact) {
    alignas(64) double spin[N];
    contact.spin.norm().store(spin);
    L low[8], high[8];
    for (int i = 0; i < 8; ++i) low[i] = pack.state[i], high[i] = pack.state[8 + i];
    transpose(low);
    transpose(high);
    const unsigned there = pack.there.number(), impacts = meets.number(), dropped = contact.psi_dropped.number();
    in_each_lane([&](auto lane) {
      if ((there >> lane & 1U) == 0) return;
      Slot& slot = *pack.slots[lane];
      for (int part = 0; part < 8 / N; ++part) {
        low[lane + part * N].store(slot.state + part * N);
        high[lane + part * N].store(slot.state + 8 + part * N);
      }
      if ((impacts >> lane & 1U) == 0) return;
      if (slot.vertex == slot.last_vertex) [[unlikely]]
        pool_.more_vertices(slot);
      __builtin_memcpy(static_cast<void*>(slot.vertex), slot.state, sizeof(Motion));
      slot.vertex->event = talus::Event::Impact;
      slot.vertex += 1;
      slot.spin->span = static_cast<std::size_t>(slot.span - slot.first_span);
      slot.spin->spin = spin[lane];
      slot.spin += 1;
      slot.span[-1].impacts += 1;
      slot.impacts += 1;
      slot.psi_dropped += dropped >> lane & 1U;
      const std::uint64_t event = std::uint64_t{slot.impacts} << 8U;
      __builtin_memcpy(slot.state + field::Event, &event, sizeof(event));
    });
  }

  /// These blocks start a flight from their places.
  [[gnu::always_inline]] void push_flights(const Pack& pack, Mask m) {
    if (!any(m)) return;
    auto& queue = pool_.flying;
    const auto put = [&](int number, L lanes) { together(m, lanes).store(queue.at[number] + queue.end); };
    const auto& s = pack.state;
    const L v_x = s[field::VelocityX], v_y = s[field::VelocityY];
    const L rate_u = v_x * world_.per_cell_x, rate_v = v_y * world_.per_cell_y;
    const L u0 = patch_coordinate(s[field::X], world_.per_cell_x),
            v0 = patch_coordinate(s[field::Y], world_.per_cell_y);
    const Lines<L> columns(u0 - pack.column, rate_u), rows(v0 - pack.row, rate_v);
    put(flight::Place, L::load(reinterpret_cast<const double*>(pack.slots)));
    put(flight::U0, u0);
    put(flight::V0, v0);
    put(flight::RateU, rate_u);
    put(flight::RateV, rate_v);
    put(flight::Z0, s[field::Z]);
    put(flight::Rise, s[field::VelocityZ]);
    put(flight::NextColumn, columns.next);
    put(flight::EveryColumn, columns.every);
    put(flight::NextRow, rows.next);
    put(flight::EveryRow, rows.every);
    put(flight::Plan2, v_x * v_x + v_y * v_y);
    put(flight::Column, pack.column);
    put(flight::Row, pack.row);
    put(flight::Grounded, L(1.0));
    queue.end += __builtin_popcount(m.number());
  }

  /// Blocks for which one-lane code does the next step.
  struct Others {
    unsigned stay, bounded, stop, slide;
  };
  [[gnu::always_inline]] void hand_over(const Pack& pack, const Vector& normal, const Others& others) {
    if ((others.stay | others.bounded | others.stop | others.slide) == 0) return;
    alignas(64) double column[N], row[N], x[N], y[N], z[N];
    pack.column.store(column);
    pack.row.store(row);
    normal.x().store(x);
    normal.y().store(y);
    normal.z().store(z);
    for (int lane = 0; lane < N; ++lane) {
      Slot& slot = *pack.slots[lane];
      const int at_column = static_cast<int>(column[lane]), at_row = static_cast<int>(row[lane]);
      const double n[3] = {x[lane], y[lane], z[lane]};
      const auto is_of = [&](unsigned lanes) { return (lanes >> lane & 1U) != 0; };
      if (is_of(others.stay)) pool_.stay(slot, at_column, at_row);
      if (is_of(others.bounded)) pool_.end(slot, End::Limit);
      if (is_of(others.stop)) pool_.end(slot, End::Stopped);
      if (is_of(others.slide)) pool_.slide(slot, n, at_column, at_row);
    }
  }

  Pool& pool_;
  const LaneWorld& world_;
  Flights flights_{};
  alignas(64) Slot* slots_[N];  // of the flights
};

#define TALUS_JOINED(a, b, c) a##b##c
#define TALUS_FOLLOW_IN(lanes) TALUS_JOINED(follow_in_, lanes, _lanes)
void TALUS_FOLLOW_IN(TALUS_LANES)(Pool& pool) {
  Engine<TALUS_LANES> engine(pool);
  engine.follow();
}

}  // namespace talus
