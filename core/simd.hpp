// Packs: the vector types of the hot kernels.
//
// Two meanings of a lane are used side by side:
//   Pack       lane = particle. Weights, constitutive laws, motion: plain arithmetic without branches.
//   Reg<N>     lane = component of one grid node (mass, momentum, force, ...). Transfers between particles
//   and grid.
// transpose() joins the two.
//
// A source file that uses this header is compiled once for each vector level (cmake/PolderOptions.cmake),
// every time in a namespace of its own, so that one program can carry all levels. The number of lanes never
// changes results that are computed lane by lane; levels differ from each other by the rounding of fused
// multiply-adds.
#pragma once

#include <cmath>
#include <cstdint>

#ifndef POLDER_SIMD_NAMESPACE
#define POLDER_SIMD_NAMESPACE simd_native
#endif
#define POLDER_INLINE inline __attribute__((always_inline))

namespace polder::POLDER_SIMD_NAMESPACE {

#if defined(__AVX512F__)
inline constexpr int kLanes = 8;
#elif defined(__AVX__)
inline constexpr int kLanes = 4;
#else
inline constexpr int kLanes = 2;
#endif

namespace detail {
template <int N>
struct VectorTypes;
template <>
struct VectorTypes<2> {
  typedef double Real __attribute__((vector_size(16)));
  typedef std::int64_t Int __attribute__((vector_size(16)));
};
template <>
struct VectorTypes<4> {
  typedef double Real __attribute__((vector_size(32)));
  typedef std::int64_t Int __attribute__((vector_size(32)));
};
template <>
struct VectorTypes<8> {
  typedef double Real __attribute__((vector_size(64)));
  typedef std::int64_t Int __attribute__((vector_size(64)));
};
}  // namespace detail

using Pack = detail::VectorTypes<kLanes>::Real;  // kLanes particles
using Mask = detail::VectorTypes<kLanes>::Int;   // 0 or -1 in each lane; also the integer pack

// ---- packs
// ---------------------------------------------------------------------------------------------------------

POLDER_INLINE Pack broadcast(double x) {
  return x - Pack{};
}  // x - 0 folds away, x + 0 does not (signed zero)
POLDER_INLINE Pack load(const double* p) {
  return *reinterpret_cast<const Pack*>(p);
}  // p aligned to a pack
POLDER_INLINE void store(double* p, Pack x) {
  *reinterpret_cast<Pack*>(p) = x;
}
POLDER_INLINE Pack select(Mask m, Pack a, Pack b) {
  return m ? a : b;
}
POLDER_INLINE Pack max(Pack a, Pack b) {
  return a > b ? a : b;
}
POLDER_INLINE Pack min(Pack a, Pack b) {
  return a < b ? a : b;
}
POLDER_INLINE Pack max(Pack a, double b) {
  return max(a, broadcast(b));
}
POLDER_INLINE Pack min(Pack a, double b) {
  return min(a, broadcast(b));
}
POLDER_INLINE Pack clamp(Pack x, double lo, double hi) {
  return min(max(x, lo), hi);
}
POLDER_INLINE Pack abs(Pack a) {
  return a < 0 ? -a : a;
}
POLDER_INLINE Pack sqrt(Pack x) {
  Pack r;
  for (int i = 0; i < kLanes; ++i) r[i] = std::sqrt(x[i]);  // one vector instruction under -fno-math-errno
  return r;
}
POLDER_INLINE bool any(Mask m) {
  // the sign bits in one instruction; adding up the lanes takes ten
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  typedef long long Signs __attribute__((vector_size(64)));
  return __builtin_ia32_cvtq2mask512((Signs)m) != 0;
#elif defined(__AVX__) && !defined(__AVX512F__)
  return __builtin_ia32_movmskpd256((Pack)m) != 0;
#elif defined(__SSE2__) && !defined(__AVX__)
  return __builtin_ia32_movmskpd((Pack)m) != 0;
#else
  std::int64_t r = 0;
  for (int i = 0; i < kLanes; ++i) r |= m[i];
  return r != 0;
#endif
}
POLDER_INLINE bool all(Mask m) {
  return !any(~m);
}
POLDER_INLINE Mask to_int(Pack x) {
  return __builtin_convertvector(x, Mask);
}  // towards zero
POLDER_INLINE Pack to_real(Mask i) {
  return __builtin_convertvector(i, Pack);
}
POLDER_INLINE Mask floor_to_int(Pack x) {
  const Mask i = to_int(x);
  return i + (to_real(i) > x);  // the comparison is -1 where truncation went up
}

// exp(x), relative error below 1e-13 for |x| <= 700; the argument is clamped to that range.
// Range reduction x = n ln 2 + r with a two-part ln 2, Taylor polynomial of degree 13 on |r| <= ln(2)/2.
POLDER_INLINE Pack exp(Pack x) {
  x = clamp(x, -700.0, 700.0);
  const double magic = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to the nearest integer
  const Pack n = (x * 1.4426950408889634 + magic) - magic;
  const Pack r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
  const double c[] = {
      1. / 6227020800, 1. / 479001600, 1. / 39916800, 1. / 3628800, 1. / 362880, 1. / 40320, 1. / 5040,
      1. / 720,        1. / 120,       1. / 24,       1. / 6,       0.5,         1.0,        1.0};
  Pack p = broadcast(c[0]);
  for (int i = 1; i < 14; ++i) p = p * r + c[i];
  const Mask e = (to_int(n) + 1023) << 52;
  return p * (Pack)e;  // same bits
}

// ---- node registers
// ------------------------------------------------------------------------------------------------

namespace detail {
// N / 2 doubles from memory in both halves of a register; one instruction.
template <int N>
POLDER_INLINE typename VectorTypes<N>::Real load_twice(const double* p) {
  static_assert(N == 4 || N == 8);
  using Half [[maybe_unused]] = typename VectorTypes<N / 2>::Real;
#if defined(__AVX512F__)
  if constexpr (N == 8)
    return __builtin_ia32_broadcastf64x4_512(*reinterpret_cast<const Half*>(p), VectorTypes<8>::Real{}, -1);
#endif
#if defined(__AVX__)
  if constexpr (N == 4) return __builtin_ia32_vbroadcastf128_pd256(reinterpret_cast<const Half*>(p));
#endif
}
POLDER_INLINE VectorTypes<4>::Real lower_half(VectorTypes<8>::Real x) {
  return __builtin_shufflevector(x, x, 0, 1, 2, 3);
}
POLDER_INLINE VectorTypes<2>::Real lower_half(VectorTypes<4>::Real x) {
  return __builtin_shufflevector(x, x, 0, 1);
}
}  // namespace detail

// N doubles of one node, held in as few machine registers as the vector level allows.
template <int N>
struct Reg {
  static constexpr int kChunk = N < kLanes ? N : kLanes;
  static constexpr int kCount = N / kChunk;
  using Chunk = typename detail::VectorTypes<kChunk>::Real;
  Chunk r[kCount];

  static POLDER_INLINE Reg zero() { return Reg{}; }
  static POLDER_INLINE Reg load(const double* p) {
    Reg a;
    for (int i = 0; i < kCount; ++i) a.r[i] = reinterpret_cast<const Chunk*>(p)[i];
    return a;
  }
  // From any address.
  static POLDER_INLINE Reg load_any(const double* p) {
    typedef Chunk Loose __attribute__((aligned(8)));
    Reg a;
    for (int i = 0; i < kCount; ++i) a.r[i] = *reinterpret_cast<const Loose*>(p + i * kChunk);
    return a;
  }
  POLDER_INLINE void store(double* p) const {
    for (int i = 0; i < kCount; ++i) reinterpret_cast<Chunk*>(p)[i] = r[i];
  }
  // All lanes x; the lower half lo and the upper hi.
  static POLDER_INLINE Reg all(double x) {
    Reg a;
    for (int i = 0; i < kCount; ++i) a.r[i] = x - Chunk{};
    return a;
  }
  static POLDER_INLINE Reg halves(double lo, double hi) {
    Reg a;
    if constexpr (kCount == 1) {
      typename detail::VectorTypes<kChunk>::Int upper;
      for (int i = 0; i < N; ++i) upper[i] = i < N / 2 ? 0 : -1;
      a.r[0] = upper ? hi - Chunk{} : lo - Chunk{};
    } else {
      for (int i = 0; i < kCount; ++i) a.r[i] = (i < kCount / 2 ? lo : hi) - Chunk{};
    }
    return a;
  }
  // N / 2 doubles, twice.
  static POLDER_INLINE Reg twice(const double* p) {
    Reg a;
    if constexpr (kCount > 1) {
      for (int i = 0; i < kCount; ++i)
        a.r[i] = reinterpret_cast<const Chunk*>(p)[i < kCount / 2 ? i : i - kCount / 2];
    } else {
      a.r[0] = detail::load_twice<N>(p);
    }
    return a;
  }
  // The lanes named, in that order; -1 gives zero.
  template <int... kFrom>
  POLDER_INLINE Reg pick() const {
    static_assert(sizeof...(kFrom) == N);
    Reg a;
    if constexpr (kCount == 1) {
      a.r[0] = __builtin_shufflevector(r[0], Chunk{}, (kFrom < 0 ? N : kFrom)...);
    } else {
      constexpr int from[] = {kFrom...};
      for (int i = 0; i < N; ++i)
        a.r[i / kChunk][i % kChunk] =
            from[i] < 0 ? 0.0 : r[(from[i] & (N - 1)) / kChunk][from[i] & (kChunk - 1)];
    }
    return a;
  }
  // The first M lanes, M at least a machine register's or half a register's.
  template <int M>
  POLDER_INLINE Reg<M> low() const {
    Reg<M> a;
    if constexpr (M >= kChunk)
      for (int i = 0; i < M / kChunk; ++i) a.r[i] = r[i];
    else
      a.r[0] = detail::lower_half(r[0]);
    return a;
  }
  friend POLDER_INLINE Reg operator+(Reg a, const Reg& b) {
    for (int i = 0; i < kCount; ++i) a.r[i] += b.r[i];
    return a;
  }
  friend POLDER_INLINE Reg operator*(Reg a, double s) {
    for (int i = 0; i < kCount; ++i) a.r[i] *= s;
    return a;
  }
  friend POLDER_INLINE Reg operator/(Reg a, double s) {
    for (int i = 0; i < kCount; ++i) a.r[i] /= s;
    return a;
  }
  friend POLDER_INLINE Reg operator*(Reg a, const Reg& b) {
    for (int i = 0; i < kCount; ++i) a.r[i] *= b.r[i];
    return a;
  }
  POLDER_INLINE Reg& operator+=(const Reg& b) { return *this = *this + b; }
};

namespace detail {
// r[i], r[j] <- the two interleavings of r[i] and r[j] that a butterfly transpose needs at distance S.
template <int S>
POLDER_INLINE void butterfly(Pack& a, Pack& b) {
  const Pack x = a, y = b;
#if defined(__AVX512F__)
  if constexpr (S == 4) {
    a = __builtin_shufflevector(x, y, 0, 1, 2, 3, 8, 9, 10, 11);
    b = __builtin_shufflevector(x, y, 4, 5, 6, 7, 12, 13, 14, 15);
  } else if constexpr (S == 2) {
    a = __builtin_shufflevector(x, y, 0, 1, 8, 9, 4, 5, 12, 13);
    b = __builtin_shufflevector(x, y, 2, 3, 10, 11, 6, 7, 14, 15);
  } else {
    a = __builtin_shufflevector(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
    b = __builtin_shufflevector(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
  }
#elif defined(__AVX__)
  if constexpr (S == 2) {
    a = __builtin_shufflevector(x, y, 0, 1, 4, 5);
    b = __builtin_shufflevector(x, y, 2, 3, 6, 7);
  } else {
    a = __builtin_shufflevector(x, y, 0, 4, 2, 6);
    b = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  }
#else
  a = __builtin_shufflevector(x, y, 0, 2);
  b = __builtin_shufflevector(x, y, 1, 3);
#endif
}
}  // namespace detail

// Transpose a kLanes x kLanes square in registers: row i, lane j -> row j, lane i.
POLDER_INLINE void transpose(Pack (&r)[kLanes]) {
  if constexpr (kLanes == 8)
    for (int i = 0; i < 4; ++i) detail::butterfly<4>(r[i], r[(i + 4) % kLanes]);
  if constexpr (kLanes >= 4)
    for (int g = 0; g < kLanes; g += 4)
      for (int i = 0; i < 2; ++i) detail::butterfly<2>(r[(g + i) % kLanes], r[(g + i + 2) % kLanes]);
  for (int i = 0; i < kLanes; i += 2) detail::butterfly<1>(r[i], r[i + 1]);
}

#if defined(__AVX512F__)
namespace detail {
// Two 4 x 4 squares side by side: row i, lane j (and 4 + j) -> row j, lane i (and 4 + i).
POLDER_INLINE void transpose_halves(Pack (&r)[4]) {
  for (int i = 0; i < 2; ++i) butterfly<2>(r[i], r[i + 2]);
  for (int i = 0; i < 4; i += 2) butterfly<1>(r[i], r[i + 1]);
}
}  // namespace detail
#endif

// Fields of kLanes particles (lane = particle) to one register for each particle (lane = component), N = 4
// or 8.
template <int N>
POLDER_INLINE void to_nodes(const Pack (&fields)[N], Reg<N> (&nodes)[kLanes]) {
  if constexpr (N >= kLanes) {
    for (int part = 0; part < N / kLanes; ++part) {
      Pack square[kLanes];
      for (int i = 0; i < kLanes; ++i) square[i] = fields[part * kLanes + i];
      transpose(square);
      for (int i = 0; i < kLanes; ++i) nodes[i].r[part] = square[i];
    }
  } else {
#if defined(__AVX512F__)
    Pack half[4] = {fields[0], fields[1], fields[2], fields[3]};
    detail::transpose_halves(half);
    for (int i = 0; i < 4; ++i) {
      nodes[i].r[0] = __builtin_shufflevector(half[i], half[i], 0, 1, 2, 3);
      nodes[i + 4].r[0] = __builtin_shufflevector(half[i], half[i], 4, 5, 6, 7);
    }
#endif
  }
}

// The inverse: one register for each particle to fields with lane = particle.
template <int N>
POLDER_INLINE void to_packs(const Reg<N> (&nodes)[kLanes], Pack (&fields)[N]) {
  if constexpr (N >= kLanes) {
    for (int part = 0; part < N / kLanes; ++part) {
      Pack square[kLanes];
      for (int i = 0; i < kLanes; ++i) square[i] = nodes[i].r[part];
      transpose(square);
      for (int i = 0; i < kLanes; ++i) fields[part * kLanes + i] = square[i];
    }
  } else {
#if defined(__AVX512F__)
    Pack half[4];
    for (int i = 0; i < 4; ++i)
      half[i] = __builtin_shufflevector(nodes[i].r[0], nodes[i + 4].r[0], 0, 1, 2, 3, 4, 5, 6, 7);
    detail::transpose_halves(half);
    for (int i = 0; i < N; ++i) fields[i] = half[i];
#endif
  }
}

}  // namespace polder::POLDER_SIMD_NAMESPACE
