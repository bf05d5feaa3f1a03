// SPDX-License-Identifier: MIT
#include "frames/experiments.h"

#include <cairn/bullet/constraint_solver.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "frames/span_times.h"
#include "measure/instrumented_solver.h"
#include "measure/substep.h"
#include "run/scene_run.h"
#include "support/machine/cold_caches.h"
#include "support/machine/run_context.h"
#include "support/machine/stopwatch.h"
#include "support/statistics.h"
#include "support/text_table.h"

namespace cairn::frames {
namespace {

using bench::Substep;

enum Part {
  kBodies,
  kJoints,
  kContacts,
  kPlan,
  kPack,
  kSweeps,
  kMeasuring,
  kGuards,
  kSteps,
  kTension,
  kResults,
  kWrite,
  kOther,
  kParts,
};

constexpr std::array<const char*, kParts> kNames = {
    "build: bodies", "build: joints", "build: contacts", "plan",    "pack",  "sweeps", "measuring",
    "guards",        "steps",         "tension",         "results", "write", "other"};

/// What of a substep a solver is given.
enum class Given { kBodies, kBodiesAndJoints };

Substep OfThose(const Substep& substep, Given given) {
  Substep less;
  less.Begin(0, 0);
  for (Substep::Group group : substep.groups()) {
    if (given == Given::kBodies) group.joints.clear();
    group.manifolds.clear();
    less.Add(std::move(group), nullptr);
  }
  return less;
}

bool HasJoints(const Substep& substep) {
  return std::ranges::any_of(substep.groups(),
                             [](const Substep::Group& group) { return !group.joints.empty(); });
}

/// A solver that is given substeps of the world which another one drives.
class Shadow {
 public:
  explicit Shadow(const Settings& settings) : solver_(settings) {}

  /// Takes down spans from now on.
  void Record() { solver_.settings().tuning.spans = &spans_; }

  /// @param caches  emptied before, unless there are none
  /// @return its time, wall clock [us]
  double Solve(const Substep& state, const Substep& given, const btContactSolverInfo& info,
               cli::ColdCaches* caches) {
    info_ = info;
    state.Restore();
    joints_.Put(given);
    spans_.Clear();
    if (caches != nullptr) caches->Empty();
    const cli::ThreadStopwatch stopwatch;
    given.SolveWith(&solver_, info_, nullptr);
    const cli::ThreadTime time = stopwatch.Read();
    joints_.Keep(given);
    preempted_ = preempted_ || time.preempted;
    return 1e3 * time.wall;
  }
  double Solve(const Substep& state, const btContactSolverInfo& info, cli::ColdCaches* caches) {
    return Solve(state, state, info, caches);
  }

  /// Whether it was taken off its core since the last call.
  bool TakePreempted() { return std::exchange(preempted_, false); }
  SpanTimes times() const { return SpanTimes(spans_.spans(0)); }

 private:
  static constexpr int kMostSpans = 65536;

  SpanRecorder spans_{1, kMostSpans};
  bullet::ConstraintSolver solver_;
  btContactSolverInfo info_;  ///< Stays where it is: Cairn knows a world again by it.
  bench::JointImpulses joints_;
  bool preempted_ = false;
};

/// Parts of what the frames of a scene took [us].
struct Times {
  std::array<std::vector<double>, kParts> parts;
  std::vector<double> together, without_clocks;
  std::vector<bool> preempted;
};

/// What spans do not tell apart is told by solving the same substep in other ways: building is
/// that of bodies, of joints with them, and of all; and a plan is what setting up takes less in
/// the second of two solves of the same structure.
class Dissection {
 public:
  Dissection(const Settings& settings, cli::ColdCaches* caches)
      : whole_(settings),
        plain_(settings),
        again_(SweepsAlone(settings)),
        bodies_(SweepsAlone(settings)),
        joints_(SweepsAlone(settings)),
        caches_(caches) {
    for (Shadow* shadow : {&whole_, &again_, &bodies_, &joints_}) shadow->Record();
  }

  void Look(const Substep& substep, const btContactSolverInfo& info, bool keep) {
    const double plain = plain_.Solve(substep, info, caches_);
    const double together = whole_.Solve(substep, info, caches_);
    const SpanTimes times = whole_.times();
    again_.Solve(substep, info, nullptr);
    again_.Solve(substep, info, caches_);
    const double packing = again_.times().of(SpanKind::kSetUp);
    const double bodies = Building(substep, Given::kBodies, info, &bodies_);
    const double joints =
        HasJoints(substep) ? Building(substep, Given::kBodiesAndJoints, info, &joints_) : bodies;
    bool preempted = false;
    for (Shadow* shadow : {&whole_, &plain_, &again_, &bodies_, &joints_}) {
      preempted = shadow->TakePreempted() || preempted;
    }
    if (!keep) return;

    std::array<double, kParts> parts{};
    const double all = times.of(SpanKind::kRead), set_up = times.of(SpanKind::kSetUp);
    parts[kBodies] = std::min(bodies, all);
    parts[kJoints] = std::clamp(joints - bodies, 0.0, all - parts[kBodies]);
    parts[kContacts] = all - parts[kBodies] - parts[kJoints];
    parts[kPack] = std::min(packing, set_up);
    parts[kPlan] = set_up - parts[kPack];
    parts[kSweeps] = times.of(SpanKind::kSweep);
    parts[kMeasuring] = times.of(SpanKind::kMeasure);
    parts[kGuards] = times.of(SpanKind::kGuard);
    parts[kSteps] = times.of(SpanKind::kStep) + times.of(SpanKind::kFactorise);
    parts[kTension] = times.of(SpanKind::kTension);
    parts[kResults] = times.of(SpanKind::kResults);
    parts[kWrite] = times.of(SpanKind::kWrite);
    parts[kOther] = together - times.together() + times.of(SpanKind::kWait);
    for (size_t i = 0; i < kParts; ++i) result.parts[i].push_back(parts[i]);
    result.together.push_back(together);
    result.without_clocks.push_back(plain);
    result.preempted.push_back(preempted);
  }

  Times result;

 private:
  static Settings SweepsAlone(Settings settings) {
    settings.k_sm = 0;
    return settings;
  }

  double Building(const Substep& substep, Given given, const btContactSolverInfo& info,
                  Shadow* shadow) const {
    shadow->Solve(substep, OfThose(substep, given), info, caches_);
    return shadow->times().of(SpanKind::kRead);
  }

  Shadow whole_, plain_, again_, bodies_, joints_;
  cli::ColdCaches* caches_;
};

Times TimesOf(const SceneChoice& choice, const WindowOptions& options, const Settings& settings,
              cli::ColdCaches* caches) {
  bullet::ConstraintSolver driver(settings);
  cli::SceneRun run(choice, &driver);
  Dissection dissection(settings, caches);
  const int first = choice.FirstFrame(options.frame);
  // some frames before the first, in which solvers learn what they would know
  constexpr int kLearning = 20;
  run.Skip(std::max(0, first - kLearning));
  while (run.frame() < first + options.frames) {
    const bool keep = run.frame() >= first;
    run.StepAfter([&](Substep* substep, const btContactSolverInfo& info) {
      dissection.Look(*substep, info, keep);
    });
  }
  return std::move(dissection.result);
}

/// Medians, and what each is of all of them.
void AddColumns(const Times& times, std::vector<std::vector<std::string>>* rows) {
  const auto median_of = [&](const std::vector<double>& values) {
    return cli::Median(cli::Undisturbed(values, times.preempted));
  };
  std::array<double, kParts> medians{};
  double sum = 0;
  for (size_t i = 0; i < kParts; ++i) sum += medians[i] = median_of(times.parts[i]);
  for (size_t i = 0; i < kParts; ++i) {
    (*rows)[i].push_back(fmt::format("{:.1f}", medians[i]));
    (*rows)[i].push_back(fmt::format("{:.0f} %", 100 * medians[i] / sum));
  }
  const auto add = [](double value, std::vector<std::string>* row) {
    row->push_back(fmt::format("{:.1f}", value));
    row->push_back("");
  };
  add(median_of(times.together), &(*rows)[kParts]);
  add(median_of(times.without_clocks), &(*rows)[kParts + 1]);
}

}  // namespace

void PrintParts(const WindowOptions& options, Steps steps, const std::string& command) {
  Settings settings;
  if (steps == Steps::kNone) settings.k_sm = 0;
  fmt::print("{}", cli::Origin("Parts of a substep: Cairn in Bullet's worlds, one thread",
                               cli::DescribeContext(command)));
  fmt::print(
      "- {} frames in a row; each substep is solved again by solvers beside the one that drives "
      "the world;\n  medians of those in which the thread kept its core, wall clock, us, and "
      "shares of their sum; {}\n"
      "- cold: {} MiB written before each solve\n"
      "- plan: what setting up takes more than in a second solve of the same structure, which is "
      "pack;\n  build: that of bodies alone, what joints add, and what contacts add\n"
      "- other: what has no clock, such as the pattern of a factor where bodies touch anew, copies "
      "of states\n  that a step may go back to, and checks\n"
      "- together: with clocks around each part; without clocks: the substep alone\n\n",
      options.frames, steps == Steps::kNone ? "no steps" : "steps where they are predicted to pay",
      cli::ColdCaches::kBytes >> 20);
  std::vector<std::string> columns = {"part"};
  std::vector<std::vector<std::string>> rows;
  for (const char* name : kNames) rows.push_back({name});
  rows.push_back({"together"});
  rows.push_back({"without clocks"});
  cli::ColdCaches caches;
  for (const SceneChoice& scene : options.scenes) {
    for (cli::ColdCaches* const emptied : {static_cast<cli::ColdCaches*>(nullptr), &caches}) {
      columns.push_back(
          fmt::format("{} {} us", NameOf(scene), emptied == nullptr ? "hot" : "cold"));
      columns.push_back("share");
      AddColumns(TimesOf(scene, options, settings, emptied), &rows);
    }
  }
  cli::TextTable table = cli::TableOf(std::move(columns));
  table.rows = std::move(rows);
  fmt::print("{}\n", table.ToMarkdown());
}

}  // namespace cairn::frames
