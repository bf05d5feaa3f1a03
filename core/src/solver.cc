// SPDX-License-Identifier: MIT
#include "cairn/solver.h"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

#include "budget.h"
#include "cycle.h"
#include "islands.h"
#include "lcp_solver.h"
#include "pack.h"
#include "residual.h"
#include "subspace/policy.h"
#include "validate.h"

namespace cairn {
namespace {

/// Frames an island may be absent before what was learnt about it is dropped.
constexpr int kForgetAfter = 120;
/// Keys of islands without names begin here.
constexpr std::uint64_t kUnnamed = std::uint64_t{1} << 63;

/// Writing the results back and measuring them costs about as much as this many sweeps.
constexpr double kFinishSweeps = 1.5;

/// Which of two reasons says more about why the whole did not get further.
StopReason WorseOf(StopReason a, StopReason b) { return std::max(a, b); }

}  // namespace

struct Solver::Impl {
  struct Remembered {
    IslandMemory memory;
    int last_frame = 0;
  };

  IslandMemory* Recall(const ContactProblem& problem, const Island& island);
  void Forget();

  Settings settings;
  std::unordered_map<std::uint64_t, Remembered> memories;
  WorkPrices prices;
  int frame = 1;
  LcpSolver lcp;
  Observer observer;
};

IslandMemory* Solver::Impl::Recall(const ContactProblem& problem, const Island& island) {
  // without names from the caller, the position of the first body has to do
  std::uint64_t key = ~std::uint64_t{0};
  for (int body : island.bodies) {
    const std::uint64_t id = problem.bodies[body].id;
    key = std::min(key, id != 0 ? id : kUnnamed + static_cast<std::uint64_t>(body));
  }
  // two islands of one name must not share a system: the second goes by another name
  const int place = island.bodies.empty() ? 0 : island.bodies.front() + 1;
  while (memories[key].last_frame == frame) {
    key = key * 6364136223846793005u + static_cast<std::uint64_t>(place);
  }
  Remembered& remembered = memories[key];
  remembered.last_frame = frame;
  return &remembered.memory;
}

void Solver::Impl::Forget() {
  std::erase_if(memories, [this](const auto& entry) {
    return entry.second.last_frame < frame - kForgetAfter;
  });
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

Report Solver::Solve(const ContactProblem& problem, std::span<double> impulses,
                     std::span<Velocity> velocities) {
  const Settings settings = impl_->settings;
  Report report;
  report.status = Validate(settings);
  if (settings.method == Method::kPgsSmLiteral || settings.method == Method::kInteriorPoint) {
    report.status = Status::kBadSettings;
  }
  if (!report.ok()) return report;
  const double units_after = kFinishSweeps * static_cast<double>(problem.rows.size());
  BudgetMeter meter(settings.budget, units_after, &impl_->prices);
  report = Validate(problem, impulses);
  if (report.ok() && velocities.size() != problem.bodies.size()) report.status = Status::kWrongSize;
  if (!report.ok()) return report;

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
                        impl_->Recall(problem, island));
  }

  // a leg for every island in turn, until all are done
  for (bool busy = true; busy;) {
    busy = false;
    for (IslandCycle& cycle : cycles) {
      if (cycle.done()) continue;
      cycle.Advance(&meter);
      busy = true;
    }
  }

  // results back
  packer.WriteFreeVelocities(velocities);
  report.stop = islands.empty() ? StopReason::kConverged : StopReason::kNotStarted;
  for (size_t i = 0; i < islands.size(); ++i) {
    const IslandState& state = cycles[i].state();
    for (size_t k = 0; k < state.x.size(); ++k) impulses[islands[i].rows[k]] = state.x[k];
    packer.AddVelocities(islands[i], state, velocities);

    IslandReport part = cycles[i].Finish();
    part.first_body = islands[i].bodies.empty() ? -1 : islands[i].bodies.front();
    Accumulate(part.residual, &report);
    report.sweeps = std::max(report.sweeps, part.sweeps);
    report.factorisations += part.factorisations;
    report.steps_accepted += part.steps_accepted;
    report.steps_restored += part.steps_restored;
    report.stop = WorseOf(report.stop, part.stop);
    report.islands.push_back(part);
  }
  report.work = meter.work();
  report.elapsed = meter.elapsed();
  ++impl_->frame;
  impl_->Forget();
  return report;
}

}  // namespace cairn
