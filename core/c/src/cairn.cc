// SPDX-License-Identifier: MIT
#include "cairn/cairn.h"
#include "cairn/cairn_doubles.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cairn/detail/memory.h"
#include "cairn/detail/recorder.h"
#include "cairn/detail/threads.h"
#include "convert.h"
#include "same_layout.h"

using namespace cairn;

namespace {

/// The job system of a solver.
class Jobs {
 public:
  /// nullptr where there is none. Others lie elsewhere than those of before, for which a solver
  /// would take them.
  Executor* Take(const CairnJobs& jobs) {
    if (jobs.submit == nullptr) return nullptr;
    std::optional<c::CJobs>& now = jobs_[now_];
    const bool same =
        now && now->jobs().submit == jobs.submit && now->jobs().context == jobs.context;
    if (!same) {
      now_ = 1 - now_;
      jobs_[now_].emplace(jobs);
    }
    return &*jobs_[now_];
  }

 private:
  std::optional<c::CJobs> jobs_[2];
  int now_ = 0;
};

}  // namespace

struct CairnSolver : detail::Placed {
  explicit CairnSolver(detail::Heap::Owner owner)
      : heap(std::move(owner)), solver(Settings{}, heap.get()) {}

  detail::Heap::Owner heap;  ///< all of this lies in it, and itself
  Solver solver;
  Jobs jobs;
  Recorder recorder{"cairn.h"};
  // memory of a step, used again
  Array<Body> bodies;
  Array<Velocity> velocities;
  Report report;
  c::Misfit misfit;                   ///< of the last step, where it got no further
  CairnStatus last = cairnOk;         ///< what came of the last step
  bool reported = true;               ///< report is of that step: it got as far as Solve()
  std::optional<Recording> recorded;  ///< one that is solved, with its start
};

struct CairnRecording {
  Recording recording;
};

namespace {

bool SameLayout(const CairnLayout& a, const CairnLayout& b) {
  // the patch may differ: neither structs nor their meaning do
  const bool version = a.version >> 8 == b.version >> 8;
  return version && a.body == b.body && a.contactPoint == b.contactPoint &&
         a.contactImpulse == b.contactImpulse && a.contactTwist == b.contactTwist &&
         a.twistImpulse == b.twistImpulse && a.manifold == b.manifold && a.jointRow == b.jointRow &&
         a.joint == b.joint && a.problem == b.problem && a.solution == b.solution &&
         a.settings == b.settings && a.report == b.report && a.island == b.island;
}

/// Those that have no counterpart in C++, too.
BadSetting FindBad(const CairnSettings& settings) {
  const int kind = static_cast<int>(settings.budgetKind);
  if (kind < cairnUnlimited || kind > cairnWork) {
    return {"budgetKind", static_cast<double>(kind), "one of CairnBudgetKind"};
  }
  return FindBadSetting(c::ToSettings(settings));
}

CairnStatus Accept(const CairnSettings& settings, CairnSolver* solver) {
  if (FindBad(settings).name != nullptr) return cairnBadSettings;
  solver->solver.settings() = c::ToSettings(settings);
  Executor* const jobs = solver->jobs.Take(settings.jobs);
  solver->solver.settings().executor = jobs;
  // at once: others may come to lie where those of before were
  solver->solver.threads().Follow(settings.threads, jobs);
  return cairnOk;
}

/// Solves, and gives a report; velocities come from the memory of the solver.
CairnStatus Run(const c::View& view, CairnSolver* solver, CairnReport* report) {
  solver->velocities.resize(view.problem.bodies.size());
  solver->solver.Solve(view.problem, view.impulses, solver->velocities, &solver->report);
  solver->reported = true;
  if (report != nullptr) *report = c::ToReport(solver->report);
  return c::ToStatus(solver->report.status);
}

CairnStatus Refuse(CairnStatus status, CairnReport* report) {
  if (report == nullptr) return status;
  *report = c::ToReport({});
  report->status = status;
  return status;
}

/// cairnSolve() and cairnSolveD().
/// @pre solver, problem and solution are there
template <class BodyOfC, class VelocityOfC>
CairnStatus Solve(CairnSolver* solver, const CairnProblem& problem, const BodyOfC* bodies,
                  const CairnSolution& solution, VelocityOfC* velocities, CairnReport* report) {
  solver->reported = false;
  solver->misfit = {};
  const CairnStatus status = c::Guarded([&] {
    c::View view;
    const CairnStatus looked =
        c::Look(problem, bodies, solution, velocities, &solver->bodies, &view, &solver->misfit);
    if (looked != cairnOk) return Refuse(looked, report);
    const bool recording = solver->recorder.Begin(view.problem, view.impulses);
    const CairnStatus solved = Run(view, solver, report);
    if (solved == cairnOk) c::CopyVelocities(solver->velocities, velocities);
    if (recording) solver->recorder.End(solver->solver.settings(), solver->report);
    solver->recorder.NextFrame();
    return solved;
  });
  solver->last = status;
  if (report != nullptr) report->status = status;
  return status;
}

/// cairnMeanVelocities() and cairnMeanVelocitiesD().
template <class VelocityOfC>
CairnStatus MeanVelocities(const CairnSolver* solver, VelocityOfC* velocities, int32_t count) {
  if (solver == nullptr || (velocities == nullptr && count > 0)) return cairnNullPointer;
  const bool solved = solver->last == cairnOk;
  const auto bodies = static_cast<int32_t>(solver->velocities.size());
  if (!solved || count != bodies) return cairnWrongSize;
  const std::span<const Velocity> means = solver->solver.mean_velocities();
  c::CopyVelocities(means.empty() ? std::span<const Velocity>(solver->velocities) : means,
                    velocities);
  return cairnOk;
}

/// A body as C++ has it by default.
template <class BodyOfC>
BodyOfC DefaultBody() {
  BodyOfC body{};
  for (auto& factor : body.linearFactor) factor = 1;
  return body;
}

}  // namespace

const char* cairnDescribe(CairnStatus status) {
  switch (status) {
    case cairnWrongVersion:
      return "the program was compiled with another version of cairn.h";
    case cairnNullPointer:
      return "a pointer is null where its count is above 0, or must not be null";
    case cairnOutOfMemory:
      return "out of memory";
    case cairnBadFile:
      return "the file cannot be read or written, or is no recording";
    case cairnFailed:
      return "failed for a reason that has no name";
    case cairnBadInput:
      return "what a helper was given is out of its range";
    default:
      return Describe(static_cast<Status>(status)).data();  // of literals, which end in a zero
  }
}

uint32_t cairnVersion(void) { return cairnLayout().version; }

CairnBody cairnDefaultBody(void) { return DefaultBody<CairnBody>(); }
CairnBodyD cairnDefaultBodyD(void) { return DefaultBody<CairnBodyD>(); }
CairnContactPoint cairnDefaultContactPoint(void) {
  return c::Same<CairnContactPoint>(ContactPoint{});
}
CairnManifold cairnDefaultManifold(void) {
  return {.bodyA = kWorld,
          .bodyB = kWorld,
          .firstPoint = 0,
          .points = Manifold{}.points,
          .tangents = Manifold{}.tangents,
          .soft = false,
          .twists = false,
          .speeds = 0,
          .sweepLimit = Manifold{}.host.max_sweeps};
}
CairnJointRow cairnDefaultJointRow(void) { return c::Same<CairnJointRow>(JointRow{}); }
CairnJoint cairnDefaultJoint(void) {
  return {.bodyA = kWorld,
          .bodyB = kWorld,
          .firstRow = 0,
          .rows = Joint{}.rows,
          .bounded = 0,
          .angular = 0,
          .errors = 0,
          .damping = Joint{}.damping,
          .soft = false,
          .opposite = false,
          .sweepLimit = Joint{}.host.max_sweeps};
}
CairnProblem cairnDefaultProblem(void) { return {}; }

CairnSettings cairnDefaultSettings(void) {
  const Settings from;
  return {.method = static_cast<CairnMethod>(from.method),
          .path = static_cast<CairnPath>(from.path),
          .kGs = from.k_gs,
          .kSm = from.k_sm,
          .steps = from.steps,
          .relax = from.relax,
          .maxSweeps = from.max_sweeps,
          .geometricStiffness = from.geometric_stiffness,
          .substeps = from.substeps,
          .tolerance = from.tolerance,
          .quietSpeed = from.tuning.quiet_speed,
          .unitsPerMetre = from.tuning.units_per_metre,
          .budgetKind = cairnUnlimited,
          .budget = 0,
          .minSweeps = from.tuning.min_sweeps,
          .threads = from.threads,
          .jobs = {},
          .memory = {}};
}

size_t cairnDescribeSettings(const CairnSettings* settings, char* text, size_t size) {
  return c::Say(text, size, [&](std::string* said) {
    if (settings == nullptr) return cairnNullPointer;
    const BadSetting bad = FindBad(*settings);
    *said = bad.name == nullptr ? "" : Describe(bad);
    return cairnOk;
  });
}

CairnStatus cairnCreateSolver(CairnLayout layout, const CairnSettings* settings,
                              CairnSolver** solver) {
  return c::Guarded([&] {
    if (!SameLayout(layout, cairnLayout())) return cairnWrongVersion;
    if (settings == nullptr || solver == nullptr) return cairnNullPointer;
    const CairnMemory& memory = settings->memory;
    if (memory.allocate != nullptr && memory.free == nullptr) return cairnNullPointer;
    detail::Heap::Owner heap = c::HeapOf(memory);
    const detail::MemoryScope scope(heap.get());
    auto made = std::make_unique<CairnSolver>(std::move(heap));
    const CairnStatus status = Accept(*settings, made.get());
    if (status == cairnOk) *solver = made.release();
    return status;
  });
}

void cairnDestroySolver(CairnSolver* solver) { delete solver; }

size_t cairnBytes(const CairnSolver* solver, size_t* most) {
  if (most != nullptr) *most = solver == nullptr ? 0 : solver->heap.get()->most_bytes();
  return solver == nullptr ? 0 : solver->heap.get()->bytes();
}

CairnStatus cairnSetSettings(CairnSolver* solver, const CairnSettings* settings) {
  return c::Guarded([&] {
    if (solver == nullptr || settings == nullptr) return cairnNullPointer;
    return Accept(*settings, solver);
  });
}

void cairnReset(CairnSolver* solver) {
  if (solver != nullptr) solver->solver.Reset();
}

CairnStatus cairnCopyState(CairnSolver* solver, CairnSolver* other) {
  if (solver == nullptr || other == nullptr) return cairnNullPointer;
  return c::Guarded([&] {
    solver->solver.CopyStateTo(&other->solver);
    return cairnOk;
  });
}

CairnStatus cairnSolve(CairnSolver* solver, const CairnProblem* problem,
                       const CairnSolution* solution, CairnReport* report) {
  if (solver == nullptr || problem == nullptr || solution == nullptr) {
    return Refuse(cairnNullPointer, report);
  }
  return Solve(solver, *problem, problem->bodies, *solution, solution->velocities, report);
}

CairnStatus cairnSolveD(CairnSolver* solver, const CairnProblem* problem, const CairnBodyD* bodies,
                        const CairnSolution* solution, CairnVelocityD* velocities,
                        CairnReport* report) {
  if (solver == nullptr || problem == nullptr || solution == nullptr) {
    return Refuse(cairnNullPointer, report);
  }
  return Solve(solver, *problem, bodies, *solution, velocities, report);
}

size_t cairnDescribeReport(const CairnSolver* solver, char* text, size_t size) {
  return c::Say(text, size, [&](std::string* said) {
    if (solver == nullptr) return cairnNullPointer;
    if (solver->reported) {
      *said = Describe(solver->report);
    } else if (solver->misfit.counted != nullptr) {
      *said = c::Describe(solver->misfit);
    } else {
      *said = cairnDescribe(solver->last);
    }
    return cairnOk;
  });
}

CairnStatus cairnGetIsland(const CairnSolver* solver, int32_t index, CairnIsland* island) {
  if (solver == nullptr || island == nullptr) return cairnNullPointer;
  const Array<IslandReport>& islands = solver->report.islands;
  if (!solver->reported || index < 0 || static_cast<size_t>(index) >= islands.size())
    return cairnWrongSize;
  *island = c::ToIsland(islands[index]);
  return cairnOk;
}

const int32_t* cairnIslandOf(const CairnSolver* solver, int32_t* count) {
  const bool known = solver != nullptr && solver->reported && !solver->report.island_of.empty();
  if (count != nullptr) *count = known ? static_cast<int32_t>(solver->report.island_of.size()) : 0;
  return known ? solver->report.island_of.data() : nullptr;
}

size_t cairnValidateStrictly(const CairnProblem* problem, const CairnSolution* solution, char* text,
                             size_t size) {
  return c::Say(text, size, [&](std::string* said) {
    if (problem == nullptr || solution == nullptr) return cairnNullPointer;
    Array<Body> bodies;
    c::View view;
    c::Misfit misfit;
    const CairnStatus looked = c::Look(*problem, problem->bodies, *solution, solution->velocities,
                                       &bodies, &view, &misfit);
    if (looked == cairnOk) {
      c::AppendFindings(view.problem, view.impulses, said);
    } else {
      *said = c::Describe(misfit) + "\n";
    }
    return cairnOk;
  });
}

CairnStatus cairnRecordNext(CairnSolver* solver, const char* path) {
  return c::Guarded([&] {
    if (solver == nullptr || path == nullptr) return cairnNullPointer;
    solver->recorder.RecordNext(path);
    return cairnOk;
  });
}

int32_t cairnRecordedFiles(const CairnSolver* solver) {
  return solver == nullptr ? 0 : solver->recorder.files().written;
}

CairnStatus cairnLoadRecording(const char* path, CairnRecording** recording) {
  return c::Guarded([&] {
    if (path == nullptr || recording == nullptr) return cairnNullPointer;
    auto loaded = std::make_unique<CairnRecording>();
    if (!Load(path, &loaded->recording).ok()) return cairnBadFile;
    *recording = loaded.release();
    return cairnOk;
  });
}

void cairnFreeRecording(CairnRecording* recording) { delete recording; }

CairnStatus cairnMeanVelocities(const CairnSolver* solver, CairnVelocity* velocities,
                                int32_t count) {
  return MeanVelocities(solver, velocities, count);
}

CairnStatus cairnMeanVelocitiesD(const CairnSolver* solver, CairnVelocityD* velocities,
                                 int32_t count) {
  return MeanVelocities(solver, velocities, count);
}

int32_t cairnRecordingBodies(const CairnRecording* recording) {
  return recording == nullptr ? 0 : static_cast<int32_t>(recording->recording.bodies.size());
}

CairnStatus cairnSolveRecording(CairnSolver* solver, const CairnRecording* recording,
                                CairnVelocity* velocities, CairnReport* report) {
  if (solver == nullptr || recording == nullptr) return Refuse(cairnNullPointer, report);
  solver->misfit = {};
  solver->reported = false;
  const CairnStatus status = c::Guarded([&] {
    solver->recorded = recording->recording;
    Recording& copy = *solver->recorded;
    const CairnStatus solved = Run({copy.problem(), copy.impulses()}, solver, report);
    if (solved == cairnOk && velocities != nullptr) {
      c::CopyVelocities(solver->velocities, velocities);
    }
    return solved;
  });
  solver->last = status;
  if (report != nullptr) report->status = status;
  return status;
}
