// SPDX-License-Identifier: MIT
#include "cairn/solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

#include "cairn/detail/memory.h"
#include "cairn/detail/threads.h"
#include "cycle/block_solver.h"
#include "cycle/corrections.h"
#include "cycle/quiet_bodies.h"
#include "cycle/substeps.h"
#include "cycle/tension/tension.h"
#include "problem/contact_expansion.h"
#include "problem/islands.h"
#include "problem/relaxation.h"
#include "problem/validate.h"
#include "reference/island_cycle.h"
#include "reference/pack.h"
#include "report_sums.h"
#include "runtime/budget.h"

namespace cairn {
namespace {

bool InBlocks(const ContactProblem& problem, const Settings& settings) {
  // joints and manifolds become blocks with the step length of Gauss-Seidel only
  const bool rows_only = problem.joints.empty() && problem.manifolds.empty();
  return (rows_only || OmegaOf(settings) == 1) && PathOf(settings) == Path::kFast;
}

/// What the first of so many equal parts gets of the rest of a budget.
Budget ShareOf(const Budget& budget, const Report& spent, std::chrono::nanoseconds elapsed,
               int parts) {
  switch (budget.kind()) {
    case Budget::Kind::kTime:
      return Budget::Time(std::max(std::chrono::nanoseconds(0), budget.time() - elapsed) / parts);
    case Budget::Kind::kWork:
      return Budget::Work(std::max<std::int64_t>(0, budget.work() - spent.work) / parts);
    case Budget::Kind::kUnlimited:
      break;
  }
  return budget;
}

BudgetMeter MeterOf(const Settings& settings, const ContactProblem& problem, WorkPrices* prices) {
  if (settings.tuning.replay != nullptr) return BudgetMeter(*settings.tuning.replay, prices);
  return BudgetMeter(settings.budget, static_cast<double>(AllRows(problem)), prices,
                     settings.tuning.clock);
}

/// Wall clock since it was made.
class StopWatch {
 public:
  std::chrono::nanoseconds elapsed() const { return Clock::now() - begin_; }

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point begin_ = Clock::now();
};

/// False, and the report says why, if a setting is out of its range.
bool Accept(const Settings& settings, Report* report) {
  report->bad_setting = FindBadSetting(settings);
  if (report->bad_setting.name != nullptr) report->status = Status::kBadSettings;
  return report->ok();
}

}  // namespace

Path PathOf(const Settings& settings) {
  // below this, floats cannot tell whether a row is close enough to its law [m/s]
  constexpr double kFinestTolerance = 1e-5;
  if (settings.path != Path::kAuto) return settings.path;
  const bool fine = settings.tolerance > 0 && settings.tolerance < kFinestTolerance;
  return fine ? Path::kReference : Path::kFast;
}

namespace {

/// Where SolveRows() reads the start, and writes.
struct RowsOut {
  std::span<double> impulses;
  size_t floats;  ///< impulses from this one on end up in floats
  std::span<Velocity> velocities;
};

/// Whether a result may be written.
bool IsResult(const Packer& packer, const Island& island, const IslandState& state,
              const Residual& residual, size_t floats) {
  constexpr double kMostFloat = std::numeric_limits<float>::max();
  constexpr double kMostDouble = std::numeric_limits<double>::max();
  // comparisons with what is not a number are false
  bool fits = residual.energy <= kMostDouble;
  for (size_t k = 0; k < state.x.size(); ++k) {
    const bool is_float = static_cast<size_t>(island.rows[k]) >= floats;
    fits = fits && std::abs(state.x[k]) <= (is_float ? kMostFloat : kMostDouble);
  }
  return fits && packer.HasFiniteVelocities(island, state);
}

}  // namespace

struct Solver::Impl : detail::Placed {
  explicit Impl(detail::Heap::Owner owner) : heap(std::move(owner)) {}

  /// Throws away what an exception has left half done: a solver is new after one.
  class Attempt {
   public:
    explicit Attempt(Impl* impl) : impl_(impl) {
      if (impl->blocks == nullptr)
        impl->blocks = std::make_unique<BlockSolver>(&impl->threads.crew());
    }
    ~Attempt() {
      if (std::uncaught_exceptions() > exceptions_) impl_->Forget();
    }
    Attempt(const Attempt&) = delete;
    Attempt& operator=(const Attempt&) = delete;

   private:
    Impl* impl_;
    int exceptions_ = std::uncaught_exceptions();
  };

  /// Copies what was learnt; of both what can be found anew is forgotten.
  void CopyTo(Impl* other);
  /// What was learnt. The next Attempt makes it anew.
  void Forget() {
    blocks.reset();
    quiet.Forget();
    tension.Forget();
    block_prices = kBlockPrices;
    row_prices = kRowPrices;
  }
  /// See Solver::Solve().
  void Solve(const ContactProblem& problem, const Impulses& impulses,
             std::span<Velocity> velocities, Report* report);
  /// In one part, or the parts that settings ask for, each once more without what takes back errors
  /// if they ask for that. Both: @pre sizes fit
  void SolveAtOnce(const ContactProblem& problem, const Impulses& impulses,
                   std::span<Velocity> velocities, Report* report);
  void SolveInParts(const ContactProblem& problem, const Impulses& impulses,
                    std::span<Velocity> velocities, Report* report);
  /// False, and nothing is written, if the result is not finite.
  bool SolveInDouble(const ContactProblem& problem, BudgetMeter* meter, const Impulses& impulses,
                     std::span<Velocity> velocities, Report* report);
  /// Row by row in double precision, in the order of the problem: the reference. Likewise, or if
  /// impulses from row @p floats on are too large for a float.
  bool SolveRows(const ContactProblem& problem, BudgetMeter* meter, const RowsOut& out,
                 Report* report);

  static constexpr WorkPrices kRowPrices = {.sweep_ns = 20,
                                            .step_ns = 20,
                                            .finish_ns = 30,
                                            .least_step_ns = 8,
                                            .most_step_ns = 40,
                                            .unseen_rows = 256};

  detail::Heap::Owner heap;  ///< all of this lies in it, and itself
  Settings user_settings;
  Settings settings;  ///< those of the Solve() that runs
  static constexpr WorkPrices kBlockPrices = {.unseen_rows = 8192, .can_give_up_steps = true};

  WorkPrices block_prices = kBlockPrices, row_prices = kRowPrices;
  detail::Threads threads;
  Substeps substeps;
  QuietBodies quiet;
  Tension tension;
  Report part_report;
  bool in_parts = false;  ///< the last Solve() was, and succeeded
  std::unique_ptr<BlockSolver> blocks;
};
bool Solver::Impl::SolveInDouble(const ContactProblem& problem, BudgetMeter* meter,
                                 const Impulses& impulses, std::span<Velocity> velocities,
                                 Report* report) {
  if (problem.manifolds.empty() && problem.joints.empty()) {
    return SolveRows(problem, meter, {impulses.rows, impulses.rows.size(), velocities}, report);
  }
  ContactExpansion expansion(problem, impulses);
  const RowsOut out{expansion.impulses(), problem.rows.size(), velocities};
  const bool solved = SolveRows(expansion.problem(), meter, out, report);
  if (solved) expansion.Write(impulses);
  return solved;
}

bool Solver::Impl::SolveRows(const ContactProblem& problem, BudgetMeter* meter, const RowsOut& out,
                             Report* report) {
  // problem in
  const Packer packer(problem, settings);
  const Array<Island> islands = FindIslands(problem);
  Array<PackedIsland> packed;
  packed.reserve(islands.size());
  Array<IslandCycle> cycles;
  cycles.reserve(islands.size());
  for (const Island& island : islands) {
    packed.push_back(packer.Pack(island));
    cycles.emplace_back(packed.back(), Packer::Start(packed.back(), island, out.impulses), settings,
                        blocks->memories().Recall(problem, island.bodies));
  }

  // a round of every island in turn, until all are done
  for (bool busy = true; busy;) {
    busy = false;
    for (IslandCycle& cycle : cycles) {
      if (cycle.done()) continue;
      cycle.Advance(meter);
      busy = true;
    }
  }

  // results back, all or none
  meter->Begin();
  report->bad_body = packer.FirstNotFinite();
  bool fits = report->bad_body < 0;
  for (size_t i = 0; i < islands.size(); ++i) {
    IslandReport& island = report->islands.emplace_back(cycles[i].Finish());
    island.first_body = islands[i].bodies.empty() ? -1 : islands[i].bodies.front();
    if (!fits) continue;
    fits = IsResult(packer, islands[i], cycles[i].state(), island.residual, out.floats);
    if (!fits) report->bad_body = island.first_body;
  }
  if (!fits) return false;
  report->island_of.assign(problem.bodies.size(), -1);
  packer.WriteFreeVelocities(out.velocities);
  for (size_t i = 0; i < islands.size(); ++i) {
    for (int body : islands[i].bodies) report->island_of[body] = static_cast<int>(i);
    const IslandState& state = cycles[i].state();
    for (size_t k = 0; k < state.x.size(); ++k) out.impulses[islands[i].rows[k]] = state.x[k];
    packer.WriteVelocities(islands[i], state, out.velocities);
  }
  return true;
}

Solver::Solver(const Settings& settings, Memory* memory) {
  detail::Heap::Owner heap(memory);
  const detail::MemoryScope scope(heap.get());
  impl_ = std::make_unique<Impl>(std::move(heap));
  impl_->user_settings = settings;
}
Solver::~Solver() = default;
Solver::Solver(Solver&&) noexcept = default;
Solver& Solver::operator=(Solver&&) noexcept = default;

Settings& Solver::settings() { return impl_->user_settings; }
const Settings& Solver::settings() const { return impl_->user_settings; }

void Solver::Reset() { impl_->Forget(); }

void Solver::CopyStateTo(Solver* other) {
  if (other != this) impl_->CopyTo(other->impl_.get());
}

void Solver::Impl::CopyTo(Impl* other) {
  const auto copy = [this](Impl* to) {
    const detail::MemoryScope scope(to->heap.get());
    auto fresh = std::make_unique<BlockSolver>(&to->threads.crew());
    if (blocks != nullptr) fresh->memories() = blocks->memories();
    return fresh;
  };
  auto of_other = copy(other), of_this = copy(this);
  const detail::MemoryScope scope(other->heap.get());
  other->quiet = quiet;
  other->tension = tension;
  other->block_prices = block_prices;
  other->row_prices = row_prices;
  other->in_parts = false;
  other->blocks = std::move(of_other);
  blocks = std::move(of_this);
}

Report Solver::Solve(const ContactProblem& problem, std::span<double> impulses,
                     std::span<Velocity> velocities) {
  return Solve(problem, Impulses{.rows = impulses}, velocities);
}

void Solver::Solve(const ContactProblem& problem, std::span<double> impulses,
                   std::span<Velocity> velocities, Report* report) {
  Solve(problem, Impulses{.rows = impulses}, velocities, report);
}

std::size_t Solver::bytes() const { return impl_->heap.get()->bytes(); }
std::size_t Solver::most_bytes() const { return impl_->heap.get()->most_bytes(); }

detail::Threads& Solver::threads() { return impl_->threads; }

Report Solver::Solve(const ContactProblem& problem, const Impulses& impulses,
                     std::span<Velocity> velocities) {
  Report report;
  Solve(problem, impulses, velocities, &report);
  return report;
}

void Solver::Solve(const ContactProblem& problem, const Impulses& impulses,
                   std::span<Velocity> velocities, Report* report) {
  const StopWatch watch;
  const detail::MemoryScope scope(impl_->heap.get());
  impl_->Solve(problem, impulses, velocities, report);
  report->elapsed = watch.elapsed();
}

void Solver::Impl::Solve(const ContactProblem& problem, const Impulses& impulses,
                         std::span<Velocity> velocities, Report* report) {
  ForgetReport(report);
  in_parts = false;
  if (!Accept(user_settings, report)) return;
  settings = user_settings;
  if (!settings.steps) settings.k_sm = 0;
  if (problem.bodies.empty()) report->status = Status::kEmptyProblem;
  if (!report->ok()) return;
  report->bad_setting = FindBadSize(problem, impulses);
  if (report->bad_setting.name == nullptr && velocities.size() != problem.bodies.size()) {
    report->bad_setting = {"velocities.size()", static_cast<double>(velocities.size()),
                           "problem.bodies.size()"};
  }
  if (report->bad_setting.name != nullptr) report->status = Status::kWrongSize;
  if (report->ok() && !(problem.time_step >= 0 && problem.time_step < kInfinity)) {
    report->status = Status::kNotFinite;
    report->bad_setting = {"problem.time_step", problem.time_step, "at least 0, and finite"};
  }
  if (!report->ok()) return;
  const Attempt attempt(this);
  threads.Follow(settings.threads, settings.executor);
  // while helpers are here, whoever called them has said so
  if (!threads.crew().called()) threads.RecordTo(settings.tuning.spans);
  quiet.Reserve(problem.bodies.size());
  const ContactProblem stiff = tension.Stiffen(problem, settings);
  if (settings.substeps == 1 && !settings.relax) {
    SolveAtOnce(stiff, impulses, velocities, report);
  } else {
    SolveInParts(stiff, impulses, velocities, report);
  }
  if (!report->ok()) return;
  tension.Learn(problem, impulses, settings, *report);
  const auto means = in_parts ? substeps.means() : std::span<const Velocity>();
  const double quiet_speed = settings.tuning.quiet_speed;
  quiet.Tell(problem, velocities, means, {UnitOf(settings) * quiet_speed, quiet_speed}, &threads,
             report);
  const bool moves_on = !means.empty() && problem.motions.empty();
  TellCorrections(problem, moves_on ? means : velocities, &threads, report);
}

void Solver::Impl::SolveInParts(const ContactProblem& problem, const Impulses& impulses,
                                std::span<Velocity> velocities, Report* report) {
  const Clock* const clock = settings.tuning.clock;
  const auto begin = ReadClock(clock);
  CopyJudgement(Validate(problem, impulses), report);
  if (!report->ok()) return;
  const Budget whole = settings.budget;
  // of how many solves that are left, this is the first
  const auto solve_part = [&](int left) {
    const auto elapsed = whole.kind() == Budget::Kind::kTime ? ReadClock(clock) - begin
                                                             : std::chrono::nanoseconds(0);
    settings.budget = ShareOf(whole, *report, elapsed, left);
    ForgetReport(&part_report);
    SolveAtOnce(substeps.problem(), substeps.impulses(), substeps.velocities(), &part_report);
    if (part_report.ok()) return Add(part_report, report);
    // what is wrong came of numbers that were sound: they did not fit
    report->islands.clear();
    report->status = Status::kOverflow;
    report->bad_body = part_report.bad_body;
    report->stop = StopReason::kBrokeDown;
  };
  for (substeps.Begin(problem, impulses, settings.substeps); !substeps.done(); substeps.Advance()) {
    const bool relaxes =
        settings.relax && substeps.HasErrors(UnitOf(settings) * settings.tolerance);
    const int left = substeps.left() * (relaxes ? 2 : 1);
    solve_part(left);
    if (relaxes && report->ok()) {
      substeps.Relax();
      solve_part(left - 1);
    }
    if (!report->ok()) return;
  }
  substeps.Write(impulses, velocities);
  in_parts = true;
  SumUp(report);
}

std::span<const Velocity> Solver::mean_velocities() const {
  if (!impl_->in_parts) return {};
  return impl_->substeps.means();
}

void Solver::Impl::SolveAtOnce(const ContactProblem& problem, const Impulses& impulses,
                               std::span<Velocity> velocities, Report* report) {
  bool in_blocks = InBlocks(problem, settings);
  WorkPrices* const prices = in_blocks ? &block_prices : &row_prices;
  BudgetMeter meter = MeterOf(settings, problem, prices);
  meter.Record(&report->replay);
  if (in_blocks) {
    const PackResult result =
        blocks->Solve(problem, settings, &meter, impulses, velocities, report);
    in_blocks = result == PackResult::kDone;
  }
  if (!in_blocks) {
    CopyJudgement(Validate(problem, impulses), report);
    if (!report->ok()) return;
    if (!SolveInDouble(problem, &meter, impulses, velocities, report)) {
      report->islands.clear();
      report->status = Status::kOverflow;
      report->stop = StopReason::kBrokeDown;
      blocks->memories().EndFrame();
      return;
    }
  }
  report->path = in_blocks ? Path::kFast : Path::kReference;
  SumUp(report);
  if (!in_blocks || blocks->strained()) TellStrains(problem.bodies, settings.substeps, report);
  report->work = meter.work();
  report->step_predicted = meter.steps_predicted();
  report->step_time = meter.steps_time();
  blocks->memories().EndFrame();
  meter.ChargeFinish();
}

}  // namespace cairn
