// Compiled for each number of lanes, as src/physics/lanes/engine.cpp.
#include "formulas.hpp"

#include "physics/lanes/lanes.hpp"
#include "talus/physics/flight.hpp"

namespace talus::test {
namespace {

constexpr int N = TALUS_LANES;
using L = Lanes<N>;

void logs(const double* x, double* result, int count) {
  for (int i = 0; i < count; i += N) natural_log(L::load(x + i)).store(result + i);
}

void sines(const double* turn, double* sine, double* cosine, int count) {
  for (int i = 0; i < count; i += N) {
    const BasicSineCosine<L> value = sine_cosine_of_turn(L::load(turn + i));
    value.sine.store(sine + i);
    value.cosine.store(cosine + i);
  }
}

void mix(std::uint64_t* words, const std::uint64_t* key, int count) {
  const auto load = [](const std::uint64_t* from) {
    return LaneWords<N>{Instructions<N>::words_of(L::load(reinterpret_cast<const double*>(from)).x)};
  };
  const auto store = [](LaneWords<N> word, std::uint64_t* to) {
    alignas(64) double numbers[N];
    number_of(word).store(numbers);
    for (int lane = 0; lane < N; ++lane) to[lane] = static_cast<std::uint64_t>(numbers[lane]);
  };
  for (int i = 0; i < count; i += N) {
    Philox<LaneWords<N>> philox{
        load(words + i), load(words + count + i), load(words + 2 * count + i), load(words + 3 * count + i),
        load(key + i),   load(key + count + i)};
    philox.mix();
    store(philox.c0, words + i);
    store(philox.c1, words + count + i);
    store(philox.c2, words + 2 * count + i);
    store(philox.c3, words + 3 * count + i);
  }
}

void contacts(const double* f0, const double* f1, const double* f2, const double* until, double* result, int count) {
  for (int i = 0; i < count; i += N)
    first_contact<L>(L::load(f0 + i), L::load(f1 + i), L::load(f2 + i), L::load(until + i)).store(result + i);
}

void products(const double* u, const double* v, double* dot, double* cross, int count) {
  for (int i = 0; i < count; i += N) {
    const auto load = [&](const double* from) {
      return LaneVector<N>(L::load(from + i), L::load(from + count + i), L::load(from + 2 * count + i));
    };
    const LaneVector<N> a = load(u), b = load(v), c = a.cross(b);
    a.dot(b).store(dot + i);
    c.x().store(cross + i);
    c.y().store(cross + count + i);
    c.z().store(cross + 2 * count + i);
  }
}

}  // namespace

#define TALUS_JOINED(a, b, c) a##b##c
#define TALUS_FORMULAS_IN(lanes) TALUS_JOINED(formulas_in_, lanes, _lanes)
Formulas TALUS_FORMULAS_IN(TALUS_LANES)() {
  return {logs, sines, mix, contacts, products};
}

}  // namespace talus::test
