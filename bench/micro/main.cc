// SPDX-License-Identifier: MIT
// How long the kernels take for a row, and Bullet's row solver for the same rows.
#include <cstdio>
#include <string>

#include <benchmark/benchmark.h>

#include "micro/memory.h"
#include "micro/same_rows.h"
#include "micro/scene_kind.h"
#include "micro/sweep_benchmarks.h"
#include "simd/target.h"

int main(int argc, char** argv) {
  using namespace cairn;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;

  for (const micro::SceneKind kind : micro::kSceneKinds) {
    const std::string fault = micro::FindFault(kind);
    if (fault.empty()) continue;
    const std::string name(micro::NameOf(kind));
    std::fprintf(stderr, "cairn_micro: scene %s: %s\n", name.c_str(), fault.c_str());
    return 1;
  }

  micro::Memory memory;
  memory.Measure(simd::BestTarget());
  micro::AddContext(memory);
  micro::RegisterBenchmarks(memory);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
