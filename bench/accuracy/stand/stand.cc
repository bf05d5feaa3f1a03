// SPDX-License-Identifier: MIT
#include "accuracy/stand/stand.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "accuracy/command.h"
#include "contestants/watched_solver.h"
#include "scenes/facts.h"
#include "scenes/scene.h"
#include "scenes/world.h"
#include "support/json_number.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::accuracy {
namespace {

constexpr int kRate = 60;

std::vector<btVector3> Places(const bench::World& world) {
  std::vector<btVector3> places;
  for (const btRigidBody* body : world.dynamic_bodies()) {
    places.push_back(body->getCenterOfMassPosition());
  }
  return places;
}

/// How far the body that went furthest to the side is from where it began [m].
double SideWay(const std::vector<btVector3>& began, const bench::World& world) {
  const std::vector<btVector3> places = Places(world);
  double most = 0;
  for (size_t i = 0; i < std::min(began.size(), places.size()); ++i) {
    const btVector3 way = places[i] - began[i];
    most = std::max(most, std::hypot(static_cast<double>(way.x()), static_cast<double>(way.z())));
  }
  return most;
}

StandRun RunSeed(const StandOptions& options, const TensionSolver& solver, std::uint64_t seed) {
  const std::unique_ptr<btConstraintSolver> made = solver.make();
  cli::WatchedSolver watched(made.get());
  bench::World world(&watched);
  watched.Watch(world.bullet());
  btContactSolverInfo& info = world.solver_info();
  info.m_numIterations = solver.iterations;
  if (options.slop) info.m_linearSlop = static_cast<btScalar>(*options.slop);
  if (options.erp) info.m_erp2 = static_cast<btScalar>(*options.erp);
  const std::unique_ptr<bench::Scene> scene = options.scene.make();
  bench::SceneOptions of_seed = options.scene.options();
  of_seed.seed = seed;
  scene->Build(&world, of_seed);
  StandRun run{.seed = seed};
  const double start = bench::TotalEnergy(world);
  const std::vector<btVector3> began = Places(world);
  const int seconds = static_cast<int>(std::lround(options.seconds));
  for (int second = 0; second < seconds && !run.fell; ++second) {
    for (int k = 0; k < kRate; ++k) {
      scene->BeforeStep(&world, second * kRate + k);
      world.Step();
      run.gain = std::max(run.gain, bench::TotalEnergy(world) / start - 1);
    }
    const bench::SceneFacts facts = scene->Measure(world);
    run.lost = std::max(run.lost, facts.height_lost_m);
    run.sway = std::max(run.sway, SideWay(began, world));
    run.gap =
        std::isnan(facts.joint_gap_m) ? facts.joint_gap_m : std::max(run.gap, facts.joint_gap_m);
    run.speed = bench::LargestSpeed(world);
    const bool fallen = facts.verdict == bench::SceneFacts::Verdict::kFallen;
    if (fallen || !watched.failure().empty()) run.fell = second + 1;
  }
  return run;
}

struct Summary {
  int falls = 0;
  std::vector<double> lost, sways, speeds, gaps, gains;  ///< of those that stand
  const StandRun* first_fall = nullptr;
  const StandRun* worst = nullptr;  ///< of those that stand
};

Summary SumUp(const std::vector<StandRun>& runs) {
  Summary sum;
  for (const StandRun& run : runs) {
    if (run.fell) {
      ++sum.falls;
      if (sum.first_fall == nullptr || *run.fell < *sum.first_fall->fell) sum.first_fall = &run;
      continue;
    }
    sum.lost.push_back(run.lost);
    sum.sways.push_back(run.sway);
    sum.speeds.push_back(run.speed);
    sum.gaps.push_back(run.gap);
    sum.gains.push_back(100 * run.gain);
    if (sum.worst == nullptr || run.lost > sum.worst->lost) sum.worst = &run;
  }
  return sum;
}

std::string Millimetres(double metres) { return Digits(1e3 * metres); }

}  // namespace

std::vector<StandRun> RunStand(const StandOptions& options, const TensionSolver& solver) {
  std::vector<StandRun> runs(static_cast<size_t>(options.seeds));
  std::atomic<int> next{0};
  std::mutex mutex;
  int done = 0;
  const auto work = [&] {
    for (int i; (i = next++) < options.seeds;) {
      runs[static_cast<size_t>(i)] =
          RunSeed(options, solver, static_cast<std::uint64_t>(options.first + i));
      const std::lock_guard lock(mutex);
      ++done;
      if (options.progress) options.progress(done);
    }
  };
  std::vector<std::thread> workers;
  for (int i = 1; i < options.jobs; ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  return runs;
}

void PrintStand(const std::vector<StandResult>& results, const StandOptions& options) {
  fmt::print(
      "{} seeds from {}, {} s each. Height lost, sway (the furthest that a body is to the side of "
      "where it began) and gaps are the largest at the ends of seconds [mm], speeds those at the "
      "end [m/s], energy the most above the start [%].\n\n",
      options.seeds, options.first, options.seconds);
  cli::TextTable table =
      cli::TableOf({"solver", "iterations", "fell", "first fall", "lost: median", "worst",
                    "sway: median", "worst", "worst gap", "worst speed", "most energy"});
  for (const StandResult& result : results) {
    const Summary sum = SumUp(result.runs);
    const auto of_seed = [](const StandRun* run, const auto& what) {
      return run == nullptr ? "-" : fmt::format("{} (seed {})", what(*run), run->seed);
    };
    const auto worst = [](const std::vector<double>& values) {
      return values.empty() ? std::numeric_limits<double>::quiet_NaN() : std::ranges::max(values);
    };
    table.rows.push_back(
        {result.solver.name, fmt::format("{}", result.solver.iterations),
         fmt::format("{} of {}", sum.falls, result.runs.size()),
         of_seed(sum.first_fall,
                 [](const StandRun& run) { return fmt::format("{} s", *run.fell); }),
         sum.lost.empty() ? "-" : Millimetres(cli::Median(sum.lost)),
         of_seed(sum.worst, [](const StandRun& run) { return Millimetres(run.lost); }),
         sum.sways.empty() ? "-" : Millimetres(cli::Median(sum.sways)),
         Millimetres(worst(sum.sways)), Millimetres(worst(sum.gaps)), Digits(worst(sum.speeds)),
         Digits(worst(sum.gains))});
  }
  fmt::print("{}", table.ToText());
}

nlohmann::ordered_json ToJson(const std::vector<StandResult>& results,
                              const StandOptions& options) {
  nlohmann::ordered_json json = {{"scene", options.scene.info->name},
                                 {"seconds", options.seconds},
                                 {"solvers", nlohmann::ordered_json::array()}};
  if (options.slop) json["linear_slop_m"] = *options.slop;
  if (options.erp) json["erp2"] = *options.erp;
  for (const StandResult& result : results) {
    nlohmann::ordered_json runs = nlohmann::ordered_json::array();
    for (const StandRun& run : result.runs) {
      nlohmann::ordered_json one = {{"seed", run.seed},
                                    {"height_lost_m", cli::Number(run.lost)},
                                    {"sway_m", cli::Number(run.sway)},
                                    {"joint_gap_m", cli::Number(run.gap)},
                                    {"speed_m_s", cli::Number(run.speed)},
                                    {"energy_gain", cli::Number(run.gain)}};
      if (run.fell) one["fell_s"] = *run.fell;
      runs.push_back(std::move(one));
    }
    json["solvers"].push_back({{"name", result.solver.name},
                               {"iterations", result.solver.iterations},
                               {"runs", std::move(runs)}});
  }
  return json;
}

}  // namespace cairn::accuracy
