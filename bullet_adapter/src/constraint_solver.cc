// SPDX-License-Identifier: MIT
#include "cairn/bullet/constraint_solver.h"

#include <LinearMath/btIDebugDraw.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "cairn/bullet/detail/group_rows.h"
#include "cairn/detail/spans.h"
#include "cairn/detail/threads.h"
#include "cairn/solver.h"
#include "fast_group.h"
#include "gravity.h"
#include "group/bad_objects.h"
#include "group/odd_islands.h"

namespace cairn::bullet {
inline namespace CAIRN_BULLET_PRECISION {
namespace {

using std::chrono::nanoseconds;

/// Share of a budget of time, 1 / kReserve, that is left over, and more: what is set aside for the
/// rest is what that took of late, not what it takes at worst.
constexpr int kReserve = 50;
constexpr nanoseconds kMoreReserve{10'000};
/// What writing took is set aside for it, for so many substeps or so: what is not set aside is
/// overrun. What takes several times as long was interrupted, and says little.
constexpr int kWriteMemory = 50, kMostSurprise = 4;

/// Where an island is done without a budget [m/s] and [rad/s]: less than a thousandth of what
/// gravity adds in a step at 60 Hz, and than ten iterations of Bullet leave on a box on an incline.
constexpr double kGoodEnough = 1e-4;

constexpr const char* kSource =
    sizeof(btScalar) == 4 ? "cairn::bullet, float" : "cairn::bullet, float64";

/// A clock may jump back.
nanoseconds Passed(nanoseconds from, nanoseconds to) { return std::max(to - from, nanoseconds(0)); }

void SetAside(nanoseconds took, nanoseconds* time) {
  if (*time > nanoseconds(0) && took / kMostSurprise > *time) {
    *time += *time / kMostSurprise;
  } else {
    *time = std::max(took, *time - *time / kWriteMemory);
  }
}

/// Whether Bullet's info says how hard to try, not the settings.
bool ByIterations(const Settings& settings, const Options& options) {
  if (options.effort != Effort::kAuto) return options.effort == Effort::kIterations;
  return settings.budget.kind() == Budget::Kind::kUnlimited;
}

/// Rows have limits of their own only where some joint asks for other iterations than the rest.
SweepLimits LimitsOf(bool by_iterations, std::span<btTypedConstraint* const> joints) {
  const bool own = std::any_of(joints.begin(), joints.end(), [](const btTypedConstraint* joint) {
    return joint->getOverrideNumSolverIterations() > 0;
  });
  return own && by_iterations ? SweepLimits::kBullet : SweepLimits::kNone;
}

/// What the last substep was refused for says nothing of the next one.
void ForgetJudgement(Report* report) {
  report->status = Status::kOk;
  report->bad_setting = {};
  report->bad_row = report->bad_body = report->bad_manifold = report->bad_joint = -1;
}

/// Whether the iteration is Bullet's own.
bool SweepsAsBullet(const Settings& settings) {
  return settings.method == Method::kPgs ||
         (settings.method == Method::kPgsSm && (settings.k_sm == 0 || !settings.steps));
}

/// What the user says, or what gravity does.
double UnitsFor(const Settings& user, std::span<btCollisionObject* const> bodies) {
  const double set = user.tuning.units_per_metre;
  return set != 0 ? set : UnitsPerMetre(bodies);
}

/// Iteration settings of one group: what the user asked for, and what Bullet's info says.
Settings ForGroup(const Settings& user, const Options& options, const btContactSolverInfo& info,
                  int max_override, double units_per_metre) {
  Settings settings = user;
  settings.tuning.units_per_metre = units_per_metre;
  settings.geometric_stiffness = false;  // FastGroup sees to it
  if (ByIterations(user, options)) {
    settings.max_sweeps = std::max({0, info.m_numIterations, max_override});
    settings.tolerance = 0;
    if (user.step_policy == StepPolicy::kMeasured) {
      settings.step_policy = StepPolicy::kWeighed;
      if (!SweepsAsBullet(user)) settings.tolerance = kGoodEnough;
    }
    settings.tuning.min_progress =
        std::sqrt(std::max<double>(0, info.m_leastSquaresResidualThreshold)) /
        settings.tuning.units_per_metre;
  }
  return settings;
}

}  // namespace

struct ConstraintSolver::Impl {
  explicit Impl(ConstraintSolver* of) : self(of) {}

  ConstraintSolver* self;
  Settings settings;
  Options options;
  Solver solver, solver_of_rows;  ///< Mode::kFast, and Mode::kReference
  GroupRows rows;
  std::optional<FastGroup> fast{std::in_place};  ///< always there; made anew by a reset
  BadObjects bad_objects;
  OddIslands islands;
  /// What was wrong where Mode::kReference could solve it all the same, or with a part of the group
  /// that was left to it or left out.
  std::string refused;
  std::vector<double> shown_impulses;
  Report report;
  bool fell_back = false, solved_fast = false;
  SubstepTimes times;

  /// Groups between prepareSolve() and allSolved(), to be solved as one.
  bool collecting = false;
  std::vector<btCollisionObject*> bodies;
  std::vector<btPersistentManifold*> manifolds;
  std::vector<btTypedConstraint*> constraints;
  btDispatcher* dispatcher = nullptr;
  void ForgetGroups() {
    bodies.clear();
    manifolds.clear();
    constraints.clear();
  }

  /// What of a Budget::Time is not for the iteration.
  nanoseconds start{0};
  nanoseconds write_time{0}, finish_time{0};  ///< as far as known

  bool Stiffens() const { return options.geometric_stiffness && settings.geometric_stiffness; }
  nanoseconds Now() const;
  void SetTimeLeft(Budget* budget) const;

  std::unique_ptr<Recorder> recorder = Recorder::FromEnvironment(kSource);
  bool recorded = false;  ///< this group was

  /// False, and the report says why, if a setting is out of its range.
  bool AcceptSettings();
  /// What Bullet says beside a group.
  struct Call {
    const btContactSolverInfo& info;
    btIDebugDraw* debug_drawer;
    btDispatcher* dispatcher;
  };
  /// By Mode::kFast, all but what has bad numbers. False if it could not be solved.
  /// @param group  becomes what there is to solve
  bool SolveGood(const Call& call, Group* group);
  /// By Mode::kFast, all but what OddIslands cuts off.
  bool SolveMost(const Call& call, const Group& group,
                 std::span<const btManifoldPoint* const> bad_points);
  bool SolveFast(const Group& group, const btContactSolverInfo& info);
  /// By Mode::kReference.
  btScalar SolveAsBullet(const Call& call, const Group& group);
  std::string told;  ///< the last warning

  /// Takes a copy of the problem if it is to be recorded, on nobody's budget. Of a group that is
  /// solved again as Bullet's rows, after it was refused, the first is the one.
  bool BeginRecording(const ContactProblem& problem, const Impulses& impulses);
};

nanoseconds ConstraintSolver::Impl::Now() const {
  if (settings.tuning.clock != nullptr) return settings.tuning.clock->Now();
  return std::chrono::steady_clock::now().time_since_epoch();
}

void ConstraintSolver::Impl::SetTimeLeft(Budget* budget) const {
  if (budget->kind() != Budget::Kind::kTime || !budget->valid()) return;
  const nanoseconds reserve = budget->time() / kReserve + kMoreReserve;
  const nanoseconds left =
      budget->time() - reserve - Passed(start, Now()) - write_time - finish_time;
  *budget = Budget::Time(std::max(left, nanoseconds(0)));
}

bool ConstraintSolver::Impl::BeginRecording(const ContactProblem& problem,
                                            const Impulses& impulses) {
  if (recorder == nullptr || recorded) return false;
  const nanoseconds begin = Now();
  recorded = recorder->Begin(problem, impulses);
  start += Passed(begin, Now());
  return recorded;
}

bool ConstraintSolver::Impl::AcceptSettings() {
  const BadSetting bad = FindBadSetting(settings);
  if (bad.name == nullptr) return true;
  report = {};
  report.status = Status::kBadSettings;
  report.bad_setting = bad;
  return false;
}

ConstraintSolver::ConstraintSolver(const Settings& settings, const Options& options)
    : impl_(std::make_unique<Impl>(this)) {
  impl_->settings = settings;
  impl_->options = options;
}

ConstraintSolver::~ConstraintSolver() = default;

Settings& ConstraintSolver::settings() { return impl_->settings; }

Options& ConstraintSolver::options() { return impl_->options; }

const Report& ConstraintSolver::report() const { return impl_->report; }

SubstepTimes ConstraintSolver::times() const { return impl_->times; }

bool ConstraintSolver::fell_back() const { return impl_->fell_back; }

std::string ConstraintSolver::complaint() const {
  if (!impl_->report.ok()) return Describe(impl_->report);
  return impl_->refused.empty() ? recorded().last_failure : impl_->refused;
}

void ConstraintSolver::Warn(btIDebugDraw* debug_drawer) {
  std::string complaint = this->complaint();
  if (complaint == impl_->told) return;
  impl_->told = std::move(complaint);
  if (debug_drawer == nullptr || impl_->told.empty()) return;
  debug_drawer->reportErrorWarning(("cairn: " + impl_->told).c_str());
}

ContactProblem ConstraintSolver::problem() const {
  return impl_->solved_fast ? impl_->fast->problem() : impl_->rows.problem();
}

int ConstraintSolver::place_of(const btRigidBody& body) const {
  return impl_->solved_fast ? impl_->fast->place_of(body) : -1;
}

std::span<const double> ConstraintSolver::impulses() const {
  if (!impl_->solved_fast) return impl_->rows.impulses();
  impl_->shown_impulses = AllImpulses(impl_->fast->problem(), impl_->fast->impulses());
  return impl_->shown_impulses;
}

void ConstraintSolver::RecordNext(std::string path, std::int64_t frame) {
  if (impl_->recorder == nullptr) impl_->recorder = std::make_unique<Recorder>(kSource);
  impl_->recorder->RecordNext(std::move(path), frame);
}

const RecordedFiles& ConstraintSolver::recorded() const {
  static const RecordedFiles none;
  return impl_->recorder != nullptr ? impl_->recorder->files() : none;
}

void ConstraintSolver::prepareSolve(int, int) {
  impl_->collecting = true;
  impl_->ForgetGroups();
}

btScalar ConstraintSolver::solveGroup(btCollisionObject** bodies, int num_bodies,
                                      btPersistentManifold** manifolds, int num_manifolds,
                                      btTypedConstraint** constraints, int num_constraints,
                                      const btContactSolverInfo& info, btIDebugDraw* debug_drawer,
                                      btDispatcher* dispatcher) {
  if (impl_->collecting) {
    impl_->bodies.insert(impl_->bodies.end(), bodies, bodies + num_bodies);
    impl_->manifolds.insert(impl_->manifolds.end(), manifolds, manifolds + num_manifolds);
    impl_->constraints.insert(impl_->constraints.end(), constraints, constraints + num_constraints);
    impl_->dispatcher = dispatcher;
    return 0;
  }
  impl_->start = impl_->Now();
  impl_->fell_back = impl_->solved_fast = impl_->recorded = false;
  impl_->refused.clear();
  ForgetJudgement(&impl_->report);
  impl_->times = {};
  Group group{{bodies, static_cast<size_t>(num_bodies)},
              {manifolds, static_cast<size_t>(num_manifolds)},
              {constraints, static_cast<size_t>(num_constraints)}};
  const Impl::Call call{info, debug_drawer, dispatcher};
  bool solved = false;
  if (impl_->options.mode == Mode::kFast) {
    group.units_per_metre = UnitsFor(impl_->settings, group.bodies);
    solved = impl_->SolveGood(call, &group);
    if (!solved) {
      impl_->fell_back = true;
      impl_->refused = complaint();
    }
  }
  btScalar result = 0;
  if (!solved) {
    impl_->fast->Forget();
    result = impl_->SolveAsBullet(call, group);
  }
  Warn(debug_drawer);
  if (impl_->recorder != nullptr) impl_->recorder->NextFrame();
  return result;
}

bool ConstraintSolver::Impl::SolveGood(const Call& call, Group* group) {
  const Group whole = *group;
  if (bad_objects.CutThoseOfLast(whole)) {
    *group = bad_objects.others();
    fell_back = true;
    refused = bad_objects.complaint();
  }
  if (SolveMost(call, *group, {})) return true;
  const bool named = report.bad_body >= 0 || report.bad_row >= 0 || report.bad_joint >= 0 ||
                     report.bad_manifold >= 0;
  if (!named) return false;
  const BadThings found = fast->FindBad();
  std::string why = Describe(report);
  if (bad_objects.Cut(whole, found, why)) {
    *group = bad_objects.others();
    why = bad_objects.complaint();
  } else if (found.points.empty()) {
    return false;
  }
  fast->Unread();
  if (!SolveMost(call, *group, found.points)) return false;
  fell_back = true;
  refused = why;
  return true;
}

bool ConstraintSolver::Impl::SolveMost(const Call& call, const Group& group,
                                       std::span<const btManifoldPoint* const> bad_points) {
  if (bad_points.empty() && AllOfKnownType(group.joints)) return SolveFast(group, call.info);
  if (!islands.Cut(group, bad_points) || !SolveFast(islands.others(), call.info)) return false;
  fell_back = true;
  // the report is that of all others
  Report of_others = std::exchange(report, {});
  SolveAsBullet(call, islands.odd());
  if (!report.ok()) refused = Describe(report);
  report = std::move(of_others);
  return true;
}

btScalar ConstraintSolver::Impl::SolveAsBullet(const Call& call, const Group& group) {
  // Bullet asks for lists that it could write to, and does not
  const auto list = []<class Entry>(std::span<Entry* const> entries) {
    return const_cast<Entry**>(entries.data());
  };
  const auto size = [](const auto& entries) { return static_cast<int>(entries.size()); };
  return self->btSequentialImpulseConstraintSolver::solveGroup(
      list(group.bodies), size(group.bodies), list(group.manifolds), size(group.manifolds),
      list(group.joints), size(group.joints), call.info, call.debug_drawer, call.dispatcher);
}

void ConstraintSolver::allSolved(const btContactSolverInfo& info, btIDebugDraw* debug_drawer) {
  if (!std::exchange(impl_->collecting, false)) return;
  const auto size = [](const auto& list) { return static_cast<int>(list.size()); };
  solveGroup(impl_->bodies.data(), size(impl_->bodies), impl_->manifolds.data(),
             size(impl_->manifolds), impl_->constraints.data(), size(impl_->constraints), info,
             debug_drawer, impl_->dispatcher);
  impl_->ForgetGroups();
}

void ConstraintSolver::reset() {
  btSequentialImpulseConstraintSolver::reset();
  impl_->solver.Reset();
  impl_->solver_of_rows.Reset();
  impl_->fast.emplace();
  impl_->rows = {};
  impl_->shown_impulses = {};
  if (!impl_->collecting) {
    impl_->bodies = {};
    impl_->manifolds = {};
    impl_->constraints = {};
  }
  impl_->write_time = impl_->finish_time = {};
  impl_->report = {};
  impl_->refused.clear();
  impl_->fell_back = false;
}

bool ConstraintSolver::Impl::SolveFast(const Group& group, const btContactSolverInfo& info) {
  if (!AcceptSettings()) return false;
  detail::Threads& threads = solver.threads();
  threads.Follow(settings.threads, settings.executor);
  threads.RecordTo(settings.tuning.spans);
  // from reading to writing back; how many are worth it the last substep tells
  const detail::AwakeHelpers awake(&threads, detail::ThreadsFor(fast->rows(), settings.threads));
  {
    const SpanClock clock(settings.tuning.spans, 0, {SpanKind::kRead});
    Options of_group = options;
    of_group.geometric_stiffness = Stiffens();
    of_group.two_friction_directions &= !SweepsAsBullet(settings);
    // what is swept in double precision is not rounded to floats before
    if (PathOf(ForGroup(settings, options, info, 0, 1)) == Path::kReference)
      of_group.contacts = ContactForm::kRows;
    fast->Read(group, info, LimitsOf(ByIterations(settings, options), group.joints), of_group,
               settings.substeps, &threads);
  }
  if (fast->problem().bodies.empty()) {
    fast->Rest();
    report = {};
    report.stop = StopReason::kConverged;
    report.elapsed = Passed(start, Now());
    solved_fast = true;
    return true;
  }
  const bool recording = BeginRecording(fast->problem(), fast->impulses());
  const nanoseconds built = Now();
  Settings of_group = ForGroup(settings, options, info, fast->most_sweeps(), group.units_per_metre);
  SetTimeLeft(&of_group.budget);
  solver.settings() = of_group;
  solver.Solve(fast->problem(), fast->impulses(), fast->velocities(), &report);
  const nanoseconds solved = Now();
  if (report.ok() && !fast->FitsBullet()) report.status = Status::kOverflow;
  solved_fast = report.ok();

  if (solved_fast) {
    const SpanClock clock(settings.tuning.spans, 0, {SpanKind::kWrite});
    if (Stiffens()) {
      const SpanClock tension(settings.tuning.spans, 0, {SpanKind::kTension});
      fast->Learn(info, report);
    }
    fast->Write(info, solver.mean_velocities());
    const nanoseconds write = Passed(solved, Now());
    SetAside(write, &write_time);
    finish_time = {};
    times = {Passed(start, built), Passed(built, solved), write};
  }
  if (recording) recorder->End(of_group, report);
  if (!solved_fast) return false;
  // 0 is the number that Bullet gives the first body
  self->Analyse(group, group.bodies.empty() ? -2 : 0);
  return true;
}

void ConstraintSolver::Analyse(const Group& group, int first_companion) {
  const double residual = impl_->report.residual_max;
  m_leastSquaresResidual = static_cast<btScalar>(residual * residual);
  m_analyticsData.m_numSolverCalls++;
  m_analyticsData.m_numIterationsUsed = impl_->report.sweeps;
  m_analyticsData.m_islandId = first_companion;
  m_analyticsData.m_numBodies = static_cast<int>(group.bodies.size());
  m_analyticsData.m_numContactManifolds = static_cast<int>(group.manifolds.size());
  m_analyticsData.m_remainingLeastSquaresResidual = m_leastSquaresResidual;
}

btScalar ConstraintSolver::solveGroupCacheFriendlyIterations(
    btCollisionObject** bodies, int num_bodies, btPersistentManifold** manifolds, int num_manifolds,
    btTypedConstraint** constraints, int num_constraints, const btContactSolverInfo& info,
    btIDebugDraw* debug_drawer) {
  const RowPools pools{&m_tmpSolverBodyPool, &m_tmpSolverNonContactConstraintPool,
                       &m_tmpSolverContactConstraintPool, &m_tmpSolverContactFrictionConstraintPool,
                       &m_tmpSolverContactRollingFrictionConstraintPool};
  const std::span joints{constraints, static_cast<size_t>(num_constraints)};
  impl_->rows.Read(pools, info, LimitsOf(ByIterations(impl_->settings, impl_->options), joints));
  if (m_tmpSolverBodyPool.size() == 0) {
    impl_->report = {};
    impl_->report.stop = StopReason::kConverged;
    impl_->report.elapsed = Passed(impl_->start, impl_->Now());
    return 0;
  }

  if (!impl_->AcceptSettings()) {
    impl_->fell_back = true;
    return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
        bodies, num_bodies, manifolds, num_manifolds, constraints, num_constraints, info,
        debug_drawer);
  }
  Settings settings =
      ForGroup(impl_->settings, impl_->options, info, m_maxOverrideNumSolverIterations,
               UnitsFor(impl_->settings, {bodies, static_cast<size_t>(num_bodies)}));
  settings.substeps = 1;  // Bullet moves the bodies
  settings.relax = false;
  if (SweepsAsBullet(settings)) settings.tuning.lifted_friction = detail::LiftedFriction::kHold;
  const bool recording =
      impl_->BeginRecording(impl_->rows.problem(), {.rows = impl_->rows.impulses()});
  impl_->SetTimeLeft(&settings.budget);
  impl_->solver_of_rows.settings() = settings;
  impl_->solver_of_rows.Solve(impl_->rows.problem(), impl_->rows.impulses(),
                              impl_->rows.velocities(), &impl_->report);
  if (impl_->report.ok() && !impl_->rows.FitsBullet()) impl_->report.status = Status::kOverflow;
  if (recording) impl_->recorder->End(settings, impl_->report);
  if (!impl_->report.ok()) {
    impl_->fell_back = true;
    return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
        bodies, num_bodies, manifolds, num_manifolds, constraints, num_constraints, info,
        debug_drawer);
  }
  const nanoseconds solved = impl_->Now();
  impl_->rows.Write(pools);
  solveGroupCacheFriendlySplitImpulseIterations(bodies, num_bodies, manifolds, num_manifolds,
                                                constraints, num_constraints, info, debug_drawer);
  SetAside(Passed(solved, impl_->Now()), &impl_->write_time);

  const Group group{{bodies, static_cast<size_t>(num_bodies)},
                    {manifolds, static_cast<size_t>(num_manifolds)},
                    {constraints, static_cast<size_t>(num_constraints)}};
  Analyse(group, num_bodies > 0 ? bodies[0]->getCompanionId() : -2);
  return 0;
}

btScalar ConstraintSolver::solveGroupCacheFriendlyFinish(btCollisionObject** bodies, int num_bodies,
                                                         const btContactSolverInfo& info) {
  const nanoseconds start = impl_->Now();
  const btScalar result =
      btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyFinish(bodies, num_bodies, info);
  SetAside(Passed(start, impl_->Now()), &impl_->finish_time);
  return result;
}

}  // namespace CAIRN_BULLET_PRECISION
}  // namespace cairn::bullet
