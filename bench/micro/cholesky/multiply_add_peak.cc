// SPDX-License-Identifier: MIT
#include "micro/cholesky/multiply_add_peak.h"

#include <algorithm>

#include "simd/target.h"
#include "support/machine/stopwatch.h"

#if defined(__x86_64__)
#define CAIRN_WITH(features) __attribute__((target(features)))
#else
#define CAIRN_WITH(features)
#endif

namespace cairn::micro {
namespace {

constexpr int kRounds = 2'000'000;
/// Enough that none waits for the one before.
constexpr int kChains = 10;

/// One function for each instruction set: vectors of the compiler's, since what is measured is the
/// machine and not a way to write kernels.
#define CAIRN_DEFINE_RUN(NAME, FEATURES, BYTES)                               \
  template <class T>                                                          \
  CAIRN_WITH(FEATURES)                                                        \
  double NAME() {                                                             \
    using Vector [[gnu::vector_size(BYTES)]] = T;                             \
    Vector chains[kChains] = {}, a = Vector{} + T(1e-9), b = Vector{} + T(1); \
    const cli::Stopwatch stopwatch(cli::SolverClock::kThreadCpu);             \
    for (int round = 0; round < kRounds; ++round) {                           \
      asm volatile("" : "+x"(a), "+x"(b));                                    \
      _Pragma("GCC unroll 10") for (int i = 0; i < kChains; ++i) {            \
        Vector product = a * b;                                               \
        asm volatile("" : "+x"(product));                                     \
        chains[i] = chains[i] - product;                                      \
      }                                                                       \
    }                                                                         \
    const double seconds = 1e-3 * stopwatch.Read();                           \
    for (const Vector& chain : chains) asm volatile("" : : "x"(chain));       \
    return 2.0 * kChains * kRounds * (BYTES / sizeof(T)) / seconds;           \
  }
#if defined(__x86_64__)
CAIRN_DEFINE_RUN(Run128, "sse2", 16)
CAIRN_DEFINE_RUN(Run256, "avx2", 32)
CAIRN_DEFINE_RUN(Run512, "avx512f", 64)
#endif
#undef CAIRN_DEFINE_RUN

template <class T>
double Run() {
#if defined(__x86_64__)
  switch (simd::BestTarget()) {
    case simd::Target::kAvx512:
      return Run512<T>();
    case simd::Target::kAvx2:
      return Run256<T>();
    default:
      return Run128<T>();
  }
#else
  return 0;
#endif
}

}  // namespace

Peak MeasurePeak() {
  Peak peak{0, 0};
  for (int repetition = 0; repetition < 20; ++repetition) {
    peak.double_flops = std::max(peak.double_flops, Run<double>());
    peak.float_flops = std::max(peak.float_flops, Run<float>());
  }
  return peak;
}

}  // namespace cairn::micro
