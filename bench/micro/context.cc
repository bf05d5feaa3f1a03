// SPDX-License-Identifier: MIT
#include "micro/sweep_benchmarks.h"

#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "simd/target.h"
#include "support/machine/build_info.h"
#include "support/machine/machine.h"

namespace cairn::micro {
namespace {

#if defined(__OPTIMIZE__) && defined(NDEBUG)
constexpr bool kOptimized = true;
#else
constexpr bool kOptimized = false;
#endif

std::string TargetNames() {
  std::vector<std::string_view> names;
  for (const simd::Target target : simd::SupportedTargets()) {
    names.push_back(simd::TargetName(target));
  }
  return fmt::format("{}", fmt::join(names, " "));
}

}  // namespace

void AddContext(const Memory& memory) {
  const cli::Machine machine = cli::DescribeMachine();
  const cli::BuildInfo build = cli::DescribeBuild();
  benchmark::AddCustomContext("cpu", machine.cpu);
  benchmark::AddCustomContext("targets", TargetNames());
  benchmark::AddCustomContext("bullet", cli::DescribeBullet(build));
  benchmark::AddCustomContext("compiler", build.compiler);
  benchmark::AddCustomContext("build_type", build.build_type);
  for (const MemoryLevel& level : memory.levels()) {
    benchmark::AddCustomContext(fmt::format("stream_{}", level.name),
                                fmt::format("{:.1f} GB/s", level.bytes_per_second * 1e-9));
  }
  if (!kOptimized) {
    benchmark::AddCustomContext("WARNING", "not an optimised build: the figures mean nothing");
  }
}

}  // namespace cairn::micro
