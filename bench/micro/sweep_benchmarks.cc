// SPDX-License-Identifier: MIT
#include "micro/sweep_benchmarks.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "micro/bullet_rows.h"
#include "micro/pair_scene.h"
#include "micro/row_scene.h"
#include "simd/stream_read.h"
#include "support/machine/stopwatch.h"

namespace cairn::micro {
namespace {

using simd::Target;

// Pairs; multiples of 16.
constexpr int kCounts[] = {64, 1024, 8192};
constexpr int kOutOfCache = 65536;
constexpr int kPassCounts[] = {1024, 8192};
constexpr int kRowsOfManifold = 12;
constexpr int kGrowthCounts[] = {96, 336, 1008, 4176, 16672};

struct Pass {
  std::string_view name;
  simd::PairKernels::Kernel simd::PairKernels::*kernel;
};
constexpr Pass kSweep = {"sweep", &simd::PairKernels::sweep};
constexpr Pass kOtherPasses[] = {{"measured_sweep", &simd::PairKernels::measured_sweep},
                                 {"measure", &simd::PairKernels::measure},
                                 {"start", &simd::PairKernels::start}};

struct BulletOrder {
  std::string_view name;
  void (BulletRows::*sweep)();
};
constexpr BulletOrder kBulletOrders[] = {{"bullet", &BulletRows::Sweep},
                                         {"bullet_pair_by_pair", &BulletRows::SweepPairByPair}};

/// A scene at rest, made again only if it is not the one that was asked for last: the benchmark
/// calls for it several times in a row, and two large ones are too many.
template <class Scene>
Scene& SceneAtRest(SceneKind kind, int count) {
  static std::pair<SceneKind, int> last;
  static std::optional<Scene> scene;
  if (!scene || last != std::pair(kind, count)) {
    scene.emplace(MakeRowScene(kind, count));
    last = {kind, count};
  }
  scene->Reset();
  return *scene;
}

std::string NameOf(SceneKind kind, const Pass& pass) {
  return std::string(NameOf(kind)) + "_" + std::string(pass.name);
}

template <class... Parts>
std::string Path(const std::string& first, const Parts&... parts) {
  std::string path = first;
  ((path += "/", path += parts), ...);
  return path;
}

/// CPU time of the loop of a benchmark [s]. The library knows it too, but shows what is counted per
/// time as a rate, whatever it is.
template <class Function>
double Time(benchmark::State* state, const Function& function) {
  const cli::Stopwatch stopwatch(cli::SolverClock::kThreadCpu);
  for (auto _ : *state) {
    function();
    benchmark::ClobberMemory();
  }
  return 1e-3 * stopwatch.Read();
}

void CountBytes(double bytes, double seconds, const MemoryLevel& level, benchmark::State* state) {
  const double per_second = bytes * static_cast<double>(state->iterations()) / seconds;
  state->counters["GB/s"] = per_second * 1e-9;
  state->counters["of_stream"] = per_second / level.bytes_per_second;
  state->SetLabel(std::string(level.name));
}

template <class Scene>
void CountRows(const Scene& scene, double seconds, const Memory& memory, benchmark::State* state) {
  const std::int64_t rows = scene.rows() * static_cast<std::int64_t>(state->iterations());
  const double bytes = static_cast<double>(scene.bytes_per_sweep());
  state->SetItemsProcessed(rows);
  state->counters["ns_per_row"] = seconds * 1e9 / static_cast<double>(rows);
  state->counters["bytes_per_row"] = bytes / scene.rows();
  CountBytes(bytes, seconds, memory.LevelOf(scene.working_set()), state);
  if (!scene.IsSound()) state->SkipWithError("infinite or denormal numbers");
}

void RegisterPass(const std::string& name, const Pass& pass, Target target, SceneKind kind,
                  int count, const Memory& memory) {
  benchmark::RegisterBenchmark(name.c_str(), [=, &memory](benchmark::State& state) {
    PairScene& scene = SceneAtRest<PairScene>(kind, count);
    const simd::PairKernels& kernels = simd::PairKernelsFor(target);
    kernels.sweep(scene.Work());  // impulses, for passes that make none
    const simd::PairKernels::Kernel kernel = kernels.*pass.kernel;
    const double seconds = Time(&state, [&] { kernel(scene.Work()); });
    CountRows(scene, seconds, memory, &state);
  });
}

void RegisterBullet(const std::string& name, const BulletOrder& order, SceneKind kind, int count,
                    const Memory& memory) {
  benchmark::RegisterBenchmark(name.c_str(), [=, &memory](benchmark::State& state) {
    BulletRows& rows = SceneAtRest<BulletRows>(kind, count);
    const double seconds = Time(&state, [&] { (rows.*order.sweep)(); });
    CountRows(rows, seconds, memory, &state);
  });
}

void RegisterStreams(const Memory& memory) {
  for (const MemoryLevel& level : memory.levels()) {
    for (const Target target : simd::SupportedTargets()) {
      const std::string name = Path("stream_read", simd::TargetName(target), level.name);
      benchmark::RegisterBenchmark(name.c_str(), [=, &level](benchmark::State& state) {
        const std::vector<simd::Line> lines(level.stream_bytes / sizeof(simd::Line));
        const double seconds = Time(&state, [&] {
          benchmark::DoNotOptimize(simd::StreamRead(target, lines.data(), lines.size()));
        });
        CountBytes(static_cast<double>(level.stream_bytes), seconds, level, &state);
      });
    }
  }
}

/// Our sweep on every target and Bullet's, over the same scene.
void RegisterSweeps(SceneKind kind, int count, const Memory& memory) {
  const std::string group = NameOf(kind, kSweep), size = std::to_string(count);
  for (const Target target : simd::SupportedTargets()) {
    RegisterPass(Path(group, simd::TargetName(target), size), kSweep, target, kind, count, memory);
  }
  for (const BulletOrder& order : kBulletOrders) {
    RegisterBullet(Path(group, order.name, size), order, kind, count, memory);
  }
}

}  // namespace

void RegisterBenchmarks(const Memory& memory) {
  const Target best = simd::BestTarget();
  RegisterStreams(memory);
  for (const SceneKind kind : kSceneKinds) {
    for (const int count : kCounts) RegisterSweeps(kind, count, memory);
  }
  RegisterSweeps(SceneKind::kContact, kOutOfCache, memory);
  for (const Pass& pass : kOtherPasses) {
    for (const int count : kPassCounts) {
      const std::string name =
          Path(NameOf(SceneKind::kContact, pass), simd::TargetName(best), std::to_string(count));
      RegisterPass(name, pass, best, SceneKind::kContact, count, memory);
    }
  }
  for (const int count : kGrowthCounts) {
    const std::string rows = std::to_string(kRowsOfManifold * count);
    RegisterPass(Path("contact_growth", simd::TargetName(best), rows), kSweep, best,
                 SceneKind::kContact, count, memory);
  }
}

}  // namespace cairn::micro
