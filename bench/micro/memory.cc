// SPDX-License-Identifier: MIT
#include "micro/memory.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "simd/stream_read.h"
#include "support/machine/stopwatch.h"

namespace cairn::micro {
namespace {

constexpr size_t kKi = 1024, kMi = 1024 * kKi;
constexpr int kRepetitions = 7;
constexpr double kLeastSeconds = 0.02;  // of one repetition

double BestBandwidth(simd::Target target, size_t bytes) {
  const std::vector<simd::Line> lines(bytes / sizeof(simd::Line));
  double best = 0;
  for (int i = 0; i < kRepetitions; ++i) {
    const cli::Stopwatch stopwatch(cli::SolverClock::kThreadCpu);
    double seconds = 0, read = 0;
    while (seconds < kLeastSeconds) {
      for (size_t done = 0; done < kMi; done += bytes) {
        benchmark::DoNotOptimize(simd::StreamRead(target, lines.data(), lines.size()));
        read += static_cast<double>(bytes);
      }
      seconds = 1e-3 * stopwatch.Read();
    }
    best = std::max(best, read / seconds);
  }
  return best;
}

}  // namespace

Memory::Memory()
    : levels_{{{"L1", 16 * kKi, 16 * kKi},
               {"L2", 256 * kKi, 256 * kKi},
               {"L3", 8 * kMi, 8 * kMi},
               {"memory", 256 * kMi, SIZE_MAX}}} {
  for (const benchmark::CPUInfo::CacheInfo& cache : benchmark::CPUInfo::Get().caches) {
    if (cache.type == "Instruction" || cache.level < 1 || cache.level > 3) continue;
    size_t& capacity = levels_[cache.level - 1].capacity;
    capacity = std::max(capacity, static_cast<size_t>(cache.size));
  }
}

void Memory::Measure(simd::Target target) {
  for (MemoryLevel& level : levels_) {
    level.bytes_per_second = BestBandwidth(target, level.stream_bytes);
  }
}

const MemoryLevel& Memory::LevelOf(size_t working_set) const {
  return *std::find_if(levels_.begin(), levels_.end(),
                       [&](const MemoryLevel& level) { return working_set <= level.capacity; });
}

}  // namespace cairn::micro
