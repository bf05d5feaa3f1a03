// SPDX-License-Identifier: MIT
#include "cairn/solver.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "block_solver.h"
#include "budget.h"
#include "contact_expansion.h"
#include "cycle.h"
#include "islands.h"
#include "lcp_solver.h"
#include "pack.h"
#include "residual.h"
#include "validate.h"

namespace cairn {
namespace {

/// Which of two reasons says more about why the whole did not get further.
StopReason WorseOf(StopReason a, StopReason b) { return std::max(a, b); }

bool InBlocks(const ContactProblem& problem, const Settings& settings) {
  // joints and manifolds become blocks with the step length of Gauss-Seidel only
  const bool rows_only = problem.joints.empty() && problem.manifolds.empty();
  return (rows_only || OmegaOf(settings) == 1) && SweepsInFloats(settings);
}

BudgetMeter MeterOf(const Settings& settings, const ContactProblem& problem, WorkPrices* prices) {
  if (settings.replay != nullptr) return BudgetMeter(*settings.replay, prices);
  return BudgetMeter(settings.budget, static_cast<double>(AllRows(problem)), prices);
}

/// Adds up what was done on the islands.
void SumUp(Report* report) {
  report->stop = report->islands.empty() ? StopReason::kConverged : StopReason::kNotStarted;
  for (const IslandReport& island : report->islands) {
    Accumulate(island.residual, report);
    report->sweeps = std::max(report->sweeps, island.sweeps);
    report->factorisations += island.factorisations;
    report->steps_accepted += island.steps_accepted;
    report->steps_restored += island.steps_restored;
    report->guarded += island.guards.any() ? 1 : 0;
    report->stop = WorseOf(report->stop, island.stop);
  }
}

}  // namespace

bool SweepsInFloats(const Settings& settings) {
  // below this, floats cannot tell whether a row is close enough to its law [m/s]
  constexpr double kFinestTolerance = 1e-5;
  if (settings.order == SweepOrder::kAutomatic) {
    return settings.tolerance == 0 || settings.tolerance >= kFinestTolerance;
  }
  return settings.order == SweepOrder::kColoured;
}

struct Solver::Impl {
  void SolveInDouble(const ContactProblem& problem, BudgetMeter* meter, const Impulses& impulses,
                     std::span<Velocity> velocities, Report* report);
  /// Row by row in double precision, in the order of the problem: the reference.
  void SolveRows(const ContactProblem& problem, BudgetMeter* meter, std::span<double> impulses,
                 std::span<Velocity> velocities, Report* report);

  Settings settings;
  WorkPrices block_prices,
      row_prices{
          .sweep_ns = 20, .step_ns = 20, .finish_ns = 30, .least_step_ns = 8, .most_step_ns = 40};
  BlockSolver blocks;
  LcpSolver lcp;
  Observer observer;
};

void Solver::Impl::SolveInDouble(const ContactProblem& problem, BudgetMeter* meter,
                                 const Impulses& impulses, std::span<Velocity> velocities,
                                 Report* report) {
  if (problem.manifolds.empty() && problem.joints.empty()) {
    return SolveRows(problem, meter, impulses.rows, velocities, report);
  }
  ContactExpansion expansion(problem, impulses);
  SolveRows(expansion.problem(), meter, expansion.impulses(), velocities, report);
  expansion.Write(impulses);
}

void Solver::Impl::SolveRows(const ContactProblem& problem, BudgetMeter* meter,
                             std::span<double> impulses, std::span<Velocity> velocities,
                             Report* report) {
  // problem in
  const Packer packer(problem, settings);
  const std::vector<Island> islands = FindIslands(problem);
  std::vector<PackedIsland> packed;
  packed.reserve(islands.size());
  std::vector<IslandCycle> cycles;
  cycles.reserve(islands.size());
  for (const Island& island : islands) {
    packed.push_back(packer.Pack(island));
    cycles.emplace_back(packed.back(), Packer::Start(packed.back(), island, impulses), settings,
                        blocks.memories().Recall(problem, island.bodies));
  }

  // a leg for every island in turn, until all are done
  for (bool busy = true; busy;) {
    busy = false;
    for (IslandCycle& cycle : cycles) {
      if (cycle.done()) continue;
      cycle.Advance(meter);
      busy = true;
    }
  }

  // results back
  meter->Begin();
  packer.WriteFreeVelocities(velocities);
  report->island_of.assign(problem.bodies.size(), -1);
  for (size_t i = 0; i < islands.size(); ++i) {
    for (int body : islands[i].bodies) report->island_of[body] = static_cast<int>(i);
    const IslandState& state = cycles[i].state();
    for (size_t k = 0; k < state.x.size(); ++k) impulses[islands[i].rows[k]] = state.x[k];
    packer.WriteVelocities(islands[i], state, velocities);
    report->islands.push_back(cycles[i].Finish());
    report->islands.back().first_body = islands[i].bodies.empty() ? -1 : islands[i].bodies.front();
  }
}

Solver::Solver(const Settings& settings) : impl_(std::make_unique<Impl>()) {
  impl_->settings = settings;
}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

Settings& Solver::settings() { return impl_->settings; }
const Settings& Solver::settings() const { return impl_->settings; }

void Solver::Reset() {
  auto fresh = std::make_unique<Impl>();
  fresh->settings = impl_->settings;
  fresh->observer = std::move(impl_->observer);
  impl_ = std::move(fresh);
}

void Solver::Observe(Observer observer) { impl_->observer = std::move(observer); }

Report Solver::Solve(const BoxedLcp& problem, Eigen::VectorXd* x) {
  const Settings settings = impl_->settings;
  Report report;
  report.status = Validate(settings);
  return report.ok() ? impl_->lcp.Solve(problem, settings, impl_->observer, x) : report;
}

Report Solver::Solve(const MixedLcp& problem, Eigen::VectorXd* u, Eigen::VectorXd* v) {
  Report report = Validate(problem);
  const bool fit = u->size() == problem.a.size() && v->size() == problem.b.size();
  if (report.ok() && !fit) report.status = Status::kWrongSize;
  if (!report.ok()) return report;

  Eigen::VectorXd x(u->size() + v->size());
  x << *u, *v;
  report = Solve(ToBoxed(problem), &x);
  *u = x.head(u->size());
  *v = x.tail(v->size());
  return report;
}

Report Solver::Solve(const ContactProblem& problem, const Impulses& impulses,
                     std::span<Velocity> velocities) {
  Report report;
  Solve(problem, impulses, velocities, &report);
  return report;
}

void Solver::Solve(const ContactProblem& problem, const Impulses& impulses,
                   std::span<Velocity> velocities, Report* report) {
  // all but the memory of an earlier report
  std::vector<IslandReport> islands = std::move(report->islands);
  std::vector<int> island_of = std::move(report->island_of);
  Replay replay = std::move(report->replay);
  islands.clear();
  island_of.clear();
  *report = Report{};
  report->islands = std::move(islands);
  report->island_of = std::move(island_of);
  report->replay = std::move(replay);

  const Settings& settings = impl_->settings;
  report->status = Validate(settings);
  if (settings.method == Method::kPgsSmLiteral || settings.method == Method::kInteriorPoint) {
    report->status = Status::kBadSettings;
  }
  if (!report->ok()) return;
  const bool sizes = HasValidSizes(problem, impulses);
  if (problem.bodies.empty() || !sizes) {
    report->status = Validate(problem, impulses).status;
    return;
  }
  if (velocities.size() != problem.bodies.size()) report->status = Status::kWrongSize;
  if (!report->ok()) return;

  bool in_blocks = InBlocks(problem, settings);
  WorkPrices* const prices = in_blocks ? &impl_->block_prices : &impl_->row_prices;
  BudgetMeter meter = MeterOf(settings, problem, prices);
  meter.Record(&report->replay);
  if (in_blocks) {
    const PackResult result =
        impl_->blocks.Solve(problem, settings, &meter, impulses, velocities, report);
    in_blocks = result == PackResult::kDone;
  }
  if (!in_blocks) {
    const Report checked = Validate(problem, impulses);
    report->status = checked.status;
    report->bad_row = checked.bad_row;
    report->bad_body = checked.bad_body;
    report->bad_manifold = checked.bad_manifold;
    report->bad_joint = checked.bad_joint;
    if (!report->ok()) return;
    impl_->SolveInDouble(problem, &meter, impulses, velocities, report);
  }
  meter.ChargeFinish();
  SumUp(report);
  report->work = meter.work();
  report->elapsed = meter.elapsed();
  report->step_predicted = meter.steps_predicted();
  report->step_time = meter.steps_time();
  impl_->blocks.memories().EndFrame();
}

}  // namespace cairn
