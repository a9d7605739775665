#pragma once
#include <immintrin.h>

#include "talus/base/elementary.hpp"
#include "talus/base/lane.hpp"
#include "talus/base/random.hpp"

/// Numbers in the lanes of one instruction: only for the files that are compiled for the processors that have them.
/// Such a file must not instantiate an inline function that others also use: the linker may keep its copy for all.
namespace talus {

#define TALUS_LANE [[gnu::always_inline]] static inline

/// The instructions of one width. Names as in `Lanes`.
template <int N>
struct Instructions;

#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
template <>
struct Instructions<8> {
  using Reals = __m512d;
  using Words = __m512i;
  using Bits = __mmask8;
  TALUS_LANE Reals repeat(double x) { return _mm512_set1_pd(x); }
  TALUS_LANE Words repeat(std::uint64_t x) { return _mm512_set1_epi64(static_cast<long long>(x)); }
  TALUS_LANE Reals load(const double* from) { return _mm512_loadu_pd(from); }
  TALUS_LANE void store(double* to, Reals x) { _mm512_storeu_pd(to, x); }
  TALUS_LANE Words words_of(Reals x) { return _mm512_castpd_si512(x); }
  TALUS_LANE Reals reals_of(Words x) { return _mm512_castsi512_pd(x); }
  TALUS_LANE Reals root(Reals x) { return _mm512_sqrt_pd(x); }
  TALUS_LANE Reals floor(Reals x) { return _mm512_roundscale_pd(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); }
  TALUS_LANE Reals magnitude(Reals x) { return _mm512_abs_pd(x); }
  TALUS_LANE Reals smaller(Reals a, Reals b) { return _mm512_min_pd(b, a); }
  TALUS_LANE Reals larger(Reals a, Reals b) { return _mm512_max_pd(b, a); }
  TALUS_LANE Reals choose(Bits m, Reals yes, Reals no) { return _mm512_mask_blend_pd(m, no, yes); }
  template <int Predicate>
  TALUS_LANE Bits compare(Reals a, Reals b) {
    return _mm512_cmp_pd_mask(a, b, Predicate);
  }
  TALUS_LANE Bits both(Bits a, Bits b) { return a & b; }
  TALUS_LANE Bits either(Bits a, Bits b) { return a | b; }
  TALUS_LANE Bits opposite(Bits a) { return static_cast<Bits>(~a); }
  TALUS_LANE unsigned number_of(Bits a) { return a; }
  TALUS_LANE Bits bits_of(unsigned number) { return static_cast<Bits>(number); }
  TALUS_LANE Words product(Words a, Words b) { return _mm512_mul_epu32(a, b); }
  template <int Count>
  TALUS_LANE Words down(Words x) {
    return _mm512_srli_epi64(x, Count);
  }
  template <int Count>
  TALUS_LANE Words up(Words x) {
    return _mm512_slli_epi64(x, Count);
  }
  TALUS_LANE Words gather_pairs(const float* from, Words index) { return _mm512_i64gather_epi64(index, from, 4); }
  TALUS_LANE Reals low_float(Words x) { return _mm512_cvtps_pd(_mm256_castsi256_ps(_mm512_cvtepi64_epi32(x))); }
  TALUS_LANE Words float_bits(Reals x) { return _mm512_cvtepu32_epi64(_mm256_castps_si256(_mm512_cvtpd_ps(x))); }
  TALUS_LANE Words whole_bits(Reals x) { return _mm512_cvtepu32_epi64(_mm512_cvttpd_epi32(x)); }
  /// The chosen lanes of `x`, together from lane 0 on.
  TALUS_LANE Reals together(Bits m, Reals x) { return _mm512_maskz_compress_pd(m, x); }
  /// Lanes 0, 1, ... of `x` in the chosen lanes of `old`.
  TALUS_LANE Reals spread(Reals old, Bits m, Reals x) { return _mm512_mask_expand_pd(old, m, x); }
  TALUS_LANE void transpose(Reals (&r)[8]) {
    const Reals a0 = _mm512_unpacklo_pd(r[0], r[1]), a1 = _mm512_unpackhi_pd(r[0], r[1]);
    const Reals a2 = _mm512_unpacklo_pd(r[2], r[3]), a3 = _mm512_unpackhi_pd(r[2], r[3]);
    const Reals a4 = _mm512_unpacklo_pd(r[4], r[5]), a5 = _mm512_unpackhi_pd(r[4], r[5]);
    const Reals a6 = _mm512_unpacklo_pd(r[6], r[7]), a7 = _mm512_unpackhi_pd(r[6], r[7]);
    quarters(a0, a2, a4, a6, r[0], r[2], r[4], r[6]);
    quarters(a1, a3, a5, a7, r[1], r[3], r[5], r[7]);
  }
  /// Transposes four rows of four pairs.
  TALUS_LANE void quarters(Reals a, Reals b, Reals c, Reals d, Reals& first, Reals& second, Reals& third,
                           Reals& fourth) {
    const Reals ab = _mm512_shuffle_f64x2(a, b, 0x44), cd = _mm512_shuffle_f64x2(c, d, 0x44);
    const Reals ab_high = _mm512_shuffle_f64x2(a, b, 0xEE), cd_high = _mm512_shuffle_f64x2(c, d, 0xEE);
    first = _mm512_shuffle_f64x2(ab, cd, 0x88);
    second = _mm512_shuffle_f64x2(ab, cd, 0xDD);
    third = _mm512_shuffle_f64x2(ab_high, cd_high, 0x88);
    fourth = _mm512_shuffle_f64x2(ab_high, cd_high, 0xDD);
  }
};
#endif

#if defined(__AVX2__)
/// For each choice of four lanes, which halves of the chosen ones come together, and which are spread.
struct Orders {
  alignas(32) std::int32_t together[16][8], spread[16][8];
};
constexpr Orders make_orders() {
  Orders orders{};
  for (int chosen = 0; chosen < 16; ++chosen)
    for (int lane = 0, next = 0; lane < 4; ++lane) {
      if ((chosen >> lane & 1) == 0) continue;
      for (int half = 0; half < 2; ++half) {
        orders.together[chosen][2 * next + half] = 2 * lane + half;
        orders.spread[chosen][2 * lane + half] = 2 * next + half;
      }
      ++next;
    }
  return orders;
}
static constexpr Orders kOrders = make_orders();

template <>
struct Instructions<4> {
  using Reals = __m256d;
  using Words = __m256i;
  using Bits = __m256d;
  TALUS_LANE Reals repeat(double x) { return _mm256_set1_pd(x); }
  TALUS_LANE Words repeat(std::uint64_t x) { return _mm256_set1_epi64x(static_cast<long long>(x)); }
  TALUS_LANE Reals load(const double* from) { return _mm256_loadu_pd(from); }
  TALUS_LANE void store(double* to, Reals x) { _mm256_storeu_pd(to, x); }
  TALUS_LANE Words words_of(Reals x) { return _mm256_castpd_si256(x); }
  TALUS_LANE Reals reals_of(Words x) { return _mm256_castsi256_pd(x); }
  TALUS_LANE Reals root(Reals x) { return _mm256_sqrt_pd(x); }
  TALUS_LANE Reals floor(Reals x) { return _mm256_floor_pd(x); }
  TALUS_LANE Reals magnitude(Reals x) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), x); }
  TALUS_LANE Reals smaller(Reals a, Reals b) { return _mm256_min_pd(b, a); }
  TALUS_LANE Reals larger(Reals a, Reals b) { return _mm256_max_pd(b, a); }
  TALUS_LANE Reals choose(Bits m, Reals yes, Reals no) { return _mm256_blendv_pd(no, yes, m); }
  template <int Predicate>
  TALUS_LANE Bits compare(Reals a, Reals b) {
    return _mm256_cmp_pd(a, b, Predicate);
  }
  TALUS_LANE Bits both(Bits a, Bits b) { return _mm256_and_pd(a, b); }
  TALUS_LANE Bits either(Bits a, Bits b) { return _mm256_or_pd(a, b); }
  TALUS_LANE Bits opposite(Bits a) { return _mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))); }
  TALUS_LANE unsigned number_of(Bits a) { return static_cast<unsigned>(_mm256_movemask_pd(a)); }
  TALUS_LANE Bits bits_of(unsigned number) {
    const Words place = _mm256_set_epi64x(8, 4, 2, 1);
    return _mm256_castsi256_pd(
        _mm256_cmpeq_epi64(_mm256_and_si256(repeat(static_cast<std::uint64_t>(number)), place), place));
  }
  TALUS_LANE Words product(Words a, Words b) { return _mm256_mul_epu32(a, b); }
  template <int Count>
  TALUS_LANE Words down(Words x) {
    return _mm256_srli_epi64(x, Count);
  }
  template <int Count>
  TALUS_LANE Words up(Words x) {
    return _mm256_slli_epi64(x, Count);
  }
  TALUS_LANE Words gather_pairs(const float* from, Words index) {
    return _mm256_i64gather_epi64(reinterpret_cast<const long long*>(from), index, 4);
  }
  TALUS_LANE Reals low_float(Words x) {
    const Words low = _mm256_permutevar8x32_epi32(x, _mm256_set_epi32(6, 4, 2, 0, 6, 4, 2, 0));
    return _mm256_cvtps_pd(_mm_castsi128_ps(_mm256_castsi256_si128(low)));
  }
  TALUS_LANE Words float_bits(Reals x) { return _mm256_cvtepu32_epi64(_mm_castps_si128(_mm256_cvtpd_ps(x))); }
  TALUS_LANE Words whole_bits(Reals x) { return _mm256_cvtepu32_epi64(_mm256_cvttpd_epi32(x)); }
  TALUS_LANE Reals in_order(const std::int32_t* order, Reals x) {
    return _mm256_castsi256_pd(_mm256_permutevar8x32_epi32(_mm256_castpd_si256(x),
                                                           _mm256_load_si256(reinterpret_cast<const __m256i*>(order))));
  }
  TALUS_LANE Reals together(Bits m, Reals x) { return in_order(kOrders.together[number_of(m)], x); }
  TALUS_LANE Reals spread(Reals old, Bits m, Reals x) {
    return _mm256_blendv_pd(old, in_order(kOrders.spread[number_of(m)], x), m);
  }
  TALUS_LANE void transpose(Reals (&r)[4]) {
    const Reals a0 = _mm256_unpacklo_pd(r[0], r[1]), a1 = _mm256_unpackhi_pd(r[0], r[1]);
    const Reals a2 = _mm256_unpacklo_pd(r[2], r[3]), a3 = _mm256_unpackhi_pd(r[2], r[3]);
    r[0] = _mm256_permute2f128_pd(a0, a2, 0x20);
    r[1] = _mm256_permute2f128_pd(a1, a3, 0x20);
    r[2] = _mm256_permute2f128_pd(a0, a2, 0x31);
    r[3] = _mm256_permute2f128_pd(a1, a3, 0x31);
  }
};
#endif

/// A condition on each lane.
template <int N>
struct LaneMask {
  using I = Instructions<N>;
  typename I::Bits bits;

  [[gnu::always_inline]] static LaneMask of(unsigned number) { return {I::bits_of(number)}; }
  [[gnu::always_inline]] unsigned number() const { return I::number_of(bits); }  ///< bit i: lane i
  [[gnu::always_inline]] friend LaneMask operator&(LaneMask a, LaneMask b) { return {I::both(a.bits, b.bits)}; }
  [[gnu::always_inline]] friend LaneMask operator|(LaneMask a, LaneMask b) { return {I::either(a.bits, b.bits)}; }
  [[gnu::always_inline]] friend LaneMask opposite(LaneMask a) { return {I::opposite(a.bits)}; }
  [[gnu::always_inline]] friend bool any(LaneMask a) { return a.number() != 0; }
  [[gnu::always_inline]] friend bool all(LaneMask a) { return a.number() == (1U << N) - 1; }
};

/// N numbers; each lane computes as a double does.
template <int N>
struct Lanes {
  using I = Instructions<N>;
  using Mask = LaneMask<N>;
  typename I::Reals x;

  Lanes() = default;
  [[gnu::always_inline]] Lanes(typename I::Reals reals) : x(reals) {}    // NOLINT
  [[gnu::always_inline]] Lanes(double number) : x(I::repeat(number)) {}  // NOLINT: a number is the same in all lanes
  [[gnu::always_inline]] static Lanes load(const double* from) { return I::load(from); }
  [[gnu::always_inline]] void store(double* to) const { I::store(to, x); }

  [[gnu::always_inline]] friend Lanes operator+(Lanes a, Lanes b) { return a.x + b.x; }
  [[gnu::always_inline]] friend Lanes operator-(Lanes a, Lanes b) { return a.x - b.x; }
  [[gnu::always_inline]] friend Lanes operator*(Lanes a, Lanes b) { return a.x * b.x; }
  [[gnu::always_inline]] friend Lanes operator/(Lanes a, Lanes b) { return a.x / b.x; }
  [[gnu::always_inline]] friend Lanes operator-(Lanes a) { return -a.x; }
  [[gnu::always_inline]] friend Mask operator<(Lanes a, Lanes b) { return {I::template compare<_CMP_LT_OQ>(a.x, b.x)}; }
  [[gnu::always_inline]] friend Mask operator<=(Lanes a, Lanes b) {
    return {I::template compare<_CMP_LE_OQ>(a.x, b.x)};
  }
  [[gnu::always_inline]] friend Mask operator>(Lanes a, Lanes b) { return b < a; }
  [[gnu::always_inline]] friend Mask operator>=(Lanes a, Lanes b) { return b <= a; }
  [[gnu::always_inline]] friend Mask operator==(Lanes a, Lanes b) {
    return {I::template compare<_CMP_EQ_OQ>(a.x, b.x)};
  }
  [[gnu::always_inline]] friend Mask operator!=(Lanes a, Lanes b) {
    return {I::template compare<_CMP_NEQ_UQ>(a.x, b.x)};
  }
  [[gnu::always_inline]] friend Lanes choose(Mask m, Lanes yes, Lanes no) { return I::choose(m.bits, yes.x, no.x); }
  [[gnu::always_inline]] friend Lanes smaller(Lanes a, Lanes b) { return I::smaller(a.x, b.x); }
  [[gnu::always_inline]] friend Lanes larger(Lanes a, Lanes b) { return I::larger(a.x, b.x); }
  [[gnu::always_inline]] friend Lanes root(Lanes a) { return I::root(a.x); }
  [[gnu::always_inline]] friend Lanes magnitude(Lanes a) { return I::magnitude(a.x); }
  [[gnu::always_inline]] friend Lanes whole_below(Lanes a) { return I::floor(a.x); }
  [[gnu::always_inline]] friend Lanes together(Mask m, Lanes a) { return I::together(m.bits, a.x); }
  [[gnu::always_inline]] friend Lanes spread(Lanes old, Mask m, Lanes a) { return I::spread(old.x, m.bits, a.x); }
};

/// Three numbers in each lane, with the functions of Vec3; sums in the order of Eigen.
template <int N>
class LaneVector {
 public:
  using Number = Lanes<N>;
  LaneVector() = default;
  [[gnu::always_inline]] LaneVector(Number x, Number y, Number z) : x_(x), y_(y), z_(z) {}
  [[gnu::always_inline]] static LaneVector Zero() { return {0.0, 0.0, 0.0}; }

  [[gnu::always_inline]] Number x() const { return x_; }
  [[gnu::always_inline]] Number y() const { return y_; }
  [[gnu::always_inline]] Number z() const { return z_; }
  [[gnu::always_inline]] Number dot(const LaneVector& b) const { return x_ * b.x_ + y_ * b.y_ + z_ * b.z_; }
  [[gnu::always_inline]] Number squaredNorm() const { return dot(*this); }
  [[gnu::always_inline]] Number norm() const { return root(squaredNorm()); }
  [[gnu::always_inline]] LaneVector cross(const LaneVector& b) const {
    return {y_ * b.z_ - z_ * b.y_, z_ * b.x_ - x_ * b.z_, x_ * b.y_ - y_ * b.x_};
  }
  [[gnu::always_inline]] friend LaneVector operator+(const LaneVector& a, const LaneVector& b) {
    return {a.x_ + b.x_, a.y_ + b.y_, a.z_ + b.z_};
  }
  [[gnu::always_inline]] friend LaneVector operator-(const LaneVector& a, const LaneVector& b) {
    return {a.x_ - b.x_, a.y_ - b.y_, a.z_ - b.z_};
  }
  [[gnu::always_inline]] friend LaneVector operator*(Number s, const LaneVector& a) {
    return {s * a.x_, s * a.y_, s * a.z_};
  }
  [[gnu::always_inline]] friend LaneVector operator*(const LaneVector& a, Number s) {
    return {a.x_ * s, a.y_ * s, a.z_ * s};
  }
  [[gnu::always_inline]] friend LaneVector choose(LaneMask<N> m, const LaneVector& yes, const LaneVector& no) {
    return {choose(m, yes.x_, no.x_), choose(m, yes.y_, no.y_), choose(m, yes.z_, no.z_)};
  }

 private:
  Number x_, y_, z_;
};

template <int N>
struct LaneTypes<Lanes<N>> {
  using Mask = LaneMask<N>;
  using Vector = LaneVector<N>;
};

/// 32-bit words of the random numbers, one in each lane; bits above 32 mean nothing.
template <int N>
struct LaneWords {
  using I = Instructions<N>;
  typename I::Words bits;

  [[gnu::always_inline]] friend LaneWords operator^(LaneWords a, LaneWords b) { return {a.bits ^ b.bits}; }
  [[gnu::always_inline]] LaneWords& operator+=(std::uint32_t b) {
    bits += I::repeat(std::uint64_t{b});
    return *this;
  }
  [[gnu::always_inline]] friend Product<LaneWords> product(std::uint32_t a, LaneWords b) {
    const typename I::Words whole = I::product(I::repeat(std::uint64_t{a}), b.bits);
    return {{I::template down<32>(whole)}, {whole}};
  }
  /// The words as numbers: those below 2^52 are the last digits of a number from 2^52 on.
  [[gnu::always_inline]] friend Lanes<N> number_of(LaneWords a) {
    const auto low = a.bits & I::repeat(std::uint64_t{0xFFFFFFFF});
    return Lanes<N>(I::reals_of(low | I::repeat(std::uint64_t{0x4330000000000000}))) - 0x1p52;
  }
};

template <int N>
[[gnu::always_inline]] inline Scaled<Lanes<N>> scaled(Lanes<N> x) {
  using I = Instructions<N>;
  const auto bits = I::words_of(x.x);
  // The exponent, by 1023 too large so that it is positive, is read from the last digits of a number from 2^52 on.
  const auto high = bits - I::repeat(std::uint64_t{kRootHalf});
  const auto exponent = I::template down<52>(high + I::repeat(std::uint64_t{1023} << 52U));
  const auto digits = I::template up<52>(exponent - I::repeat(std::uint64_t{1023}));
  const Lanes<N> e = Lanes<N>(I::reals_of(exponent | I::repeat(std::uint64_t{0x4330000000000000}))) - (0x1p52 + 1023.0);
  return {I::reals_of(bits - digits), e};
}

template <int N>
[[gnu::always_inline]] inline Lanes<N> nearest_quarter(Lanes<N> turn) {
  return whole_below(0.5 * (whole_below(8.0 * turn) + 1.0));
}
template <int N>
[[gnu::always_inline]] inline BasicSineCosine<Lanes<N>> turned(Lanes<N> quarter, Lanes<N> sine, Lanes<N> cosine) {
  const auto first = quarter == 1.0, second = quarter == 2.0, third = quarter == 3.0;
  const Lanes<N> minus(-1.0), plus(1.0);
  return {choose(second | third, minus, plus) * choose(first | third, cosine, sine),
          choose(first | second, minus, plus) * choose(first | third, sine, cosine)};
}

}  // namespace talus
