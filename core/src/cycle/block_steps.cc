// SPDX-License-Identifier: MIT
#include "cycle/block_steps.h"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

#include "cycle/tension/joint_arms.h"
#include "problem/body_name.h"

namespace cairn {
namespace {

// Relaxations of rows by kernels per piece of a step, fitted to timings of all scenes (AVX2, within
// a tenth). What a relaxation takes in steps is learnt on every machine: WorkPrices::step_ns.
struct StepPrices {
  double line;       ///< once, per line of impulses: reading, predicting, writing
  double line_pass;  ///< per line and factorisation: weights, assembly, a solve
  double refine;     ///< per line and further solve
  double flops;      ///< per multiply-add of a factorisation
  double entry;      ///< per entry of the factor and solve
  double body;       ///< per body and factorisation
};
constexpr StepPrices kFloatPrices = {110, 100, 65, 0.014, 1.9, 240};
constexpr StepPrices kDoublePrices = {230, 125, 80, 0.025, 2.2, 300};
/// The same as IslandMemory::kLeastSoftening with a budget, which mostly has more sweeps. Floats
/// know nothing of what is smaller.
constexpr double kLeastSofteningOfBudget = 1.0 / 32;
/// By what the first step of a frame is thought to divide the residual before one was measured,
/// as logarithms: medians over scenes of contacts, and over bridges and chains.
constexpr double kContactsCut = 2.4, kJointsCut = 6.4;
/// Per body and pair of bodies, where their graph is new.
constexpr double kAnalyse = 300;
/// Per row and factorisation, where there was none before; that of most scenes is 30 to 60.
constexpr double kUnknownRow = 40;

/// Reading a problem from its host, packing it, and writing it back, likewise: fitted to Bullet's
/// worlds.
constexpr double kSetUpIsland = 3000, kSetUpBody = 50, kSetUpRow = 18, kSetUpJointRow = 160;
/// A row of a sweep that is accelerated and measured, by how many lanes it relaxes at a time.
constexpr double kSweepLine = 30;
constexpr double SweepRow(int lanes) {
  const int width = simd::WidthOf(lanes);
  return width == 4 ? 12 : width == 8 ? 16 : kSweepLine;
}
/// Sequential impulses row by row, as Bullet 3.24 makes them: an iteration, and all before and
/// after; likewise fitted, and the share of that which an island without a step may take.
constexpr double kScalarSweepRow = 8, kScalarRow = 80, kScalarJointRow = 160;
constexpr double kShareOfScalar = 0.85;
/// What is heavier than what it hangs on by this much is a load. From 30 on random worlds take 4 %
/// more time where they change, and gape no less.
constexpr double kLoad = 100;

/// function(island, count) for lanes of one island that follow each other, of some of a block.
template <class Function>
void ForStretches(const Plan& plan, int block, int first, int lanes, const Function& function) {
  const int* const islands = plan.islands_of(block);
  for (int begin = first, end = first; begin < first + lanes; begin = end) {
    const int island = islands[begin];
    while (end < first + lanes && islands[end] == island) ++end;
    function(island, end - begin);
  }
}

/// That so many lanes fill, or begin to.
int LinesOf(int lanes) { return (lanes + simd::kLanes - 1) / simd::kLanes; }

}  // namespace

void BlockSteps::Begin(const CycleFrame& frame) {
  problem_ = &frame.problem;
  settings_ = &frame.settings;
  frame_ = frame.blocks;
  memories_ = frame.memories;
  meter_ = frame.meter;
  crew_ = frame.crew;
  asked_ = frame.asks_for_steps();
  if (!asked_ && !frame.accelerates()) return;
  const Plan& plan = frame.plan();
  memory_of_island_.assign(plan.islands().size(), nullptr);
  if (plan_number_ != frame_->plan_number()) ReadPlan();
  if (!asked_) return;
  islands_.assign(plan.islands().size(), {});
  islands_now_.assign(plan.islands().size(), {});
  work_.assign(plan.islands().size(), 0);
  given_up_.assign(plan.islands().size(), 0);
  limits_.assign(plan.islands().size(), settings_->k_sm);
  if (float_step_ == nullptr) {
    float_step_ = std::make_unique<BlockStep<float>>(frame_->target());
    double_step_ = std::make_unique<BlockStep<double>>(frame_->target());
  }
  strains_.clear();
  loaded_.clear();
  if (frame.weighs_steps()) FindPull();
}

void BlockSteps::FindPull() {
  FindLoaded();
  if (!frame_->strained()) return;
  const std::span<const int> island_of_body = frame_->plan().island_of_body();
  strains_.assign(frame_->plan().islands().size(), 0);
  for (size_t i = 0; i < problem_->bodies.size(); ++i) {
    const int island = island_of_body[i];
    if (island >= 0) strains_[island] = std::max(strains_[island], problem_->bodies[i].strain);
  }
}

void BlockSteps::FindLoaded() {
  const std::span<const int> island_of_body = frame_->plan().island_of_body();
  const auto look = [&](const auto& between) {
    if (between.body_a == kWorld || between.body_b == kWorld) return;
    const double a = problem_->bodies[between.body_a].inv_mass,
                 b = problem_->bodies[between.body_b].inv_mass;
    const int island = island_of_body[between.body_a];
    if (island < 0 || !(a > 0 && b > 0 && (a >= kLoad * b || b >= kLoad * a))) return;
    if (loaded_.empty()) loaded_.assign(frame_->plan().islands().size(), 0);
    loaded_[island] = 1;
  };
  for (const Joint& joint : problem_->joints) look(joint);
  for (const Row& row : problem_->rows) {
    if (row.parent == kNoRow && IsTwoSided(row.lo, row.hi)) look(row);
  }
}

void BlockSteps::ReadPlan() {
  plan_number_ = frame_->plan_number();
  ReadIslands();
  CountLines();
  for (int body = 0; body < static_cast<int>(problem_->bodies.size()); ++body) {
    const int island = frame_->plan().island_of_body()[body];
    if (island < 0) continue;
    set_up_[island] += kSetUpBody;
    keys_[island] = std::min(keys_[island], BodyNameOf(problem_->bodies[body], body));
  }
}

void BlockSteps::ReadIslands() {
  const Plan& plan = frame_->plan();
  keys_.assign(plan.islands().size(), ~std::uint64_t{0});
  one_direction_.assign(plan.islands().size(), 0);
  set_up_.assign(plan.islands().size(), kSetUpIsland);
  scalar_set_up_.assign(plan.islands().size(), 0);
  for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    const bool joints =
        std::any_of(block.rows, block.rows + block.row_count,
                    [](const simd::RowShape& row) { return row.bound == simd::RowBound::kFree; });
    const auto frictions = std::count_if(block.rows, block.rows + block.row_count,
                                         [](const simd::RowShape& row) { return row.parent >= 0; });
    const bool one_direction = frictions > 0 && 2 * frictions == block.row_count;
    ForStretches(plan, b, 0, block.lanes, [&](int island, int lanes) {
      if (one_direction) one_direction_[island] = 1;
      const int rows = lanes * block.row_count;
      set_up_[island] += rows * (joints ? kSetUpJointRow : kSetUpRow);
      scalar_set_up_[island] += rows * (joints ? kScalarJointRow : kScalarRow);
    });
  }
}

void BlockSteps::CountLines() {
  const Plan& plan = frame_->plan();
  sweeps_.assign(plan.islands().size(), 0);
  sweep_lines_.assign(plan.islands().size(), 0);
  // lanes of one colour and one shape, island by island
  alike_.assign(plan.islands().size(), {});
  const auto close = [this](int island) {
    const Alike& alike = alike_[island];
    for (int left = alike.lanes; left > 0; left -= simd::kLanes) {
      sweeps_[island] += alike.rows * SweepRow(std::min(left, simd::kLanes));
      sweep_lines_[island] += alike.rows;
    }
  };
  for (int r = 0; r < static_cast<int>(plan.runs().size()); ++r) {
    const simd::LaneRun& run = plan.runs()[r];
    const simd::PairBlock& block = plan.blocks()[run.block];
    const Alike here{plan.colour_of(r), block.rows, block.row_count, 0};
    ForStretches(plan, run.block, run.first, run.lanes, [&](int island, int lanes) {
      Alike& alike = alike_[island];
      if (alike.colour != here.colour || alike.shape != here.shape) {
        close(island);
        alike = here;
      }
      alike.lanes += lanes;
    });
  }
  for (int i = 0; i < static_cast<int>(plan.islands().size()); ++i) close(i);
  CountStepLines();
}

void BlockSteps::CountStepLines() {
  const Plan& plan = frame_->plan();
  step_lines_.assign(plan.islands().size(), 0);
  latest_shape_.assign(plan.islands().size(), -1);
  lanes_of_shapes_.clear();
  for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    ForStretches(plan, b, 0, block.lanes, [&](int island, int lanes) {
      int at = latest_shape_[island];
      while (at >= 0 && lanes_of_shapes_[at].shape != block.rows) at = lanes_of_shapes_[at].before;
      if (at < 0) {
        at = static_cast<int>(lanes_of_shapes_.size());
        lanes_of_shapes_.push_back({block.rows, 0, latest_shape_[island]});
        latest_shape_[island] = at;
      }
      // a line for each row of sixteen lanes, and of those that are left
      int& all = lanes_of_shapes_[at].lanes;
      const int before = LinesOf(all);
      all += lanes;
      step_lines_[island] += block.row_count * (LinesOf(all) - before);
    });
  }
}

void BlockSteps::FindMotions(double share, Array<IslandMotion>* motions) const {
  const Plan& plan = frame_->plan();
  motions->assign(plan.islands().size(), {});
  for (int i = 0; i < static_cast<int>(problem_->bodies.size()); ++i) {
    const int island = plan.island_of_body()[i];
    if (island < 0) continue;
    const WhitenedBody& whitened = frame_->bodies()[i];
    const float* const u = frame_->blocks().bodies[plan.slot_of_body()[i]].u;
    const Eigen::Vector3d velocity =
        SeenFreeVelocity(*problem_, whitened, i) +
        whitened.linear.cwiseProduct(share * Eigen::Vector3d(u[0], u[1], u[2]));
    const double square = velocity.squaredNorm(), inv_mass = problem_->bodies[i].inv_mass;
    IslandMotion& motion = (*motions)[island];
    motion.speed = std::max(motion.speed, std::sqrt(square));
    if (inv_mass > 0) motion.energy += 0.5 / inv_mass * square;
  }
}

void BlockSteps::FindBefore() {
  const Plan& plan = frame_->plan();
  masses_.assign(plan.islands().size(), 0);
  for (size_t i = 0; i < problem_->bodies.size(); ++i) {
    const int island = plan.island_of_body()[i];
    const double inv_mass = problem_->bodies[i].inv_mass;
    if (island >= 0 && inv_mass > 0) masses_[island] += 1 / inv_mass;
  }
  FindMotions(0, &before_);
  FindMotions(1, &after_);
  for (size_t i = 0; i < before_.size(); ++i) before_[i] = LargerOf(before_[i], after_[i]);
}

void BlockSteps::FindAfter() { FindMotions(1, &after_); }

double BlockSteps::SpinEnergy(int island, double share) const {
  const Plan& plan = frame_->plan();
  double energy = 0;
  for (int i = 0; i < static_cast<int>(problem_->bodies.size()); ++i) {
    if (plan.island_of_body()[i] != island) continue;
    const float* const u = frame_->blocks().bodies[plan.slot_of_body()[i]].u;
    const Eigen::Vector3d spin = WhitenedFreeSpin(*problem_, frame_->bodies()[i], i);
    energy += 0.5 * (spin + share * Eigen::Vector3d(u[3], u[4], u[5])).squaredNorm();
  }
  return energy;
}

double BlockSteps::SpeedOfUnmoved(int island) const {
  const Plan& plan = frame_->plan();
  const Group& group = plan.groups()[plan.islands()[island].group];
  double most = 0;
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    for (int lane = 0; lane < plan.blocks()[b].lanes; ++lane) {
      const Pair& pair = plan.pair(b, lane);
      if (pair.b != kWorld || plan.island_of_body()[pair.a] != island) continue;
      const int other = pair.row_a == pair.a ? pair.row_b : pair.row_a;
      if (other == kWorld) continue;
      const WhitenedBody& whitened = frame_->bodies()[other];
      most = std::max(most, SeenFreeVelocity(*problem_, whitened, other).squaredNorm());
    }
  }
  return std::sqrt(most);
}

IslandMemory* BlockSteps::MemoryOf(int island) {
  IslandMemory*& memory = memory_of_island_[island];
  if (memory == nullptr) {
    memory = memories_->Recall(keys_[island], frame_->plan().islands()[island].first_body);
    memory->odds().Expect(HasJoints(island) ? kJointsCut : kContactsCut);
  }
  return memory;
}

bool BlockSteps::Due(int island) { return MemoryOf(island)->Due(*settings_); }

template <class T>
BlockSystem<T>& BlockSteps::SystemOf(int group) {
  const Plan& plan = frame_->plan();
  const int first = plan.islands_of_groups()[plan.groups()[group].first_island];
  return MemoryOf(first)->block_system<T>(frame_->target());
}

template <class Function>
void BlockSteps::ForSystems(int group, std::span<const int> islands, const Function& function) {
  const Precisions precisions = PrecisionsOf(islands);
  if (precisions.some_double) function(SystemOf<double>(group));
  if (!precisions.all_double) function(SystemOf<float>(group));
}

double BlockSteps::Guess(int group, std::span<const int> islands) {
  bool known = true;
  ForSystems(group, islands, [&](const auto& system) {
    known = known && system.IsPreparedFor(frame_->plan_number(), group);
  });
  if (known) return 0;
  const Group& of = frame_->plan().groups()[group];
  double bodies = 0;
  for (int i : frame_->plan().islands_in(of)) {
    bodies += frame_->plan().islands()[i].bodies;
  }
  const Precisions precisions = PrecisionsOf(islands);
  const Unknown graph{static_cast<double>(of.x_lines), static_cast<double>(of.rows), bodies};
  const FactorSize& last = MemoryOf(islands[0])->factor_size();
  return (precisions.some_double ? GuessOf<double>(graph, last, 1) : 0) +
         (precisions.all_double ? 0 : GuessOf<float>(graph, last, 1));
}

template <class T>
double BlockSteps::GuessOf(const Unknown& graph, const FactorSize& last, int factorisations) const {
  if (last.bodies == 0) return factorisations * kUnknownRow * graph.rows;
  // Graphs change, but rarely what a body of them costs. One that is smaller by far has less to
  // fill in.
  const double bodies = graph.bodies / last.bodies;
  return PriceOf<T>({graph.lines, bodies * std::min(1.0, bodies) * last.flops,
                     bodies * last.nonzeros, graph.bodies},
                    factorisations);
}

BlockSteps::AnalysisPrice BlockSteps::PriceOfAnalysis(int group, std::span<const int> islands) {
  AnalysisPrice price;
  ForSystems(group, islands, [&](auto& system) {
    if (system.Recognise(frame_->plan(), frame_->plan_number(), group)) return;
    const double whole = kAnalyse * system.graph_size();
    price.whole += whole;
    price.of_step += whole / system.steps_of_analysis();
  });
  return price;
}

void BlockSteps::Analyse(int group, std::span<const int> islands) {
  ForSystems(group, islands, [&](auto& system) {
    if (system.Recognise(frame_->plan(), frame_->plan_number(), group)) return;
    meter_->Begin();
    system.Analyse(frame_->plan());
    meter_->Charge(WorkKind::kAnalysis, kAnalyse * system.graph_size());
  });
}

BlockSteps::Precisions BlockSteps::PrecisionsOf(std::span<const int> islands) const {
  const auto is_double = [this](int i) { return HasJoints(i); };
  const bool some = std::any_of(islands.begin(), islands.end(), is_double);
  return {some, some && std::all_of(islands.begin(), islands.end(), is_double)};
}

double BlockSteps::Price(int group, std::span<const int> islands, int factorisations) {
  const Precisions precisions = PrecisionsOf(islands);
  const bool condense = std::any_of(islands.begin(), islands.end(),
                                    [this](int i) { return MemoryOf(i)->condenses_joints(); });
  if (condense) ++factorisations;
  ForSystems(group, islands, [&](const auto& system) {
    MemoryOf(islands[0])->Remember({system.flops(), system.nonzeros(), 1.0 * system.nodes()});
  });
  return (precisions.some_double ? PriceOf<double>(group, factorisations) : 0) +
         (precisions.all_double ? 0 : PriceOf<float>(group, factorisations));
}

template <class T>
double BlockSteps::PriceOf(int group, int factorisations) {
  const BlockSystem<T>& system = SystemOf<T>(group);
  return PriceOf<T>({static_cast<double>(frame_->plan().groups()[group].x_lines), system.flops(),
                     system.nonzeros(), static_cast<double>(system.nodes())},
                    factorisations);
}

template <class T>
double BlockSteps::PriceOf(const SystemSize& size, int factorisations) const {
  const StepPrices& prices = std::is_same_v<T, double> ? kDoublePrices : kFloatPrices;
  const double factorise = prices.line_pass * size.lines + prices.flops * size.flops +
                           prices.entry * size.nonzeros + prices.body * size.nodes;
  const double refine = prices.refine * size.lines + prices.entry * size.nonzeros;
  return prices.line * size.lines + factorisations * factorise +
         (settings_->tuning.refinements - 1) * refine;
}

double BlockSteps::RestAlone(int island, int sweeps) const {
  return set_up_[island] + sweeps * sweeps_[island];
}

double BlockSteps::RestInWholeLines(int island, int sweeps) const {
  return set_up_[island] + kSweepLine * sweeps * sweep_lines_[island];
}

double BlockSteps::ScalarAlone(int island, int iterations) const {
  const double rows = frame_->plan().islands()[island].rows;
  return scalar_set_up_[island] + kScalarSweepRow * iterations * rows;
}

int BlockSteps::SweepsOfEffort(int island, int iterations) const {
  const double left = kShareOfScalar * ScalarAlone(island, iterations) - set_up_[island];
  const double sweeps = left / std::max(1.0, sweeps_[island]);
  const double most = std::min(2.0 * iterations, double{std::numeric_limits<int>::max()});
  return static_cast<int>(std::clamp<double>(sweeps, iterations, most));
}

double BlockSteps::PriceAlone(int group, int island, int factorisations, double most) {
  return HasJoints(island) ? PriceAloneOf<double>(group, island, factorisations, most)
                           : PriceAloneOf<float>(group, island, factorisations, most);
}

template <class T>
double BlockSteps::PriceAloneOf(int group, int island, int factorisations, double most) {
  const PlannedIsland& of = frame_->plan().islands()[island];
  BlockSystem<T>& system = SystemOf<T>(group);
  IslandMemory* const memory = MemoryOf(island);
  const double lines = step_lines_[island], bodies = of.bodies;
  const auto known = [&](double share) {
    const FactorSize own{share * system.flops(), share * system.nonzeros(), bodies};
    return std::pair(own, PriceOf<T>({lines, own.flops, own.nonzeros, bodies}, factorisations));
  };
  const auto unknown = [&] {
    // mostly there are about as many pairs as bodies
    const double analysis = 2 * kAnalyse * bodies / system.steps_of_analysis();
    const Unknown graph{lines, 1.0 * of.rows, bodies};
    return GuessOf<T>(graph, memory->factor_size(), factorisations) + analysis;
  };
  const bool alone = frame_->plan().groups()[group].islands == 1;
  if (alone && !system.IsPreparedFor(frame_->plan_number(), group)) {
    // whether its graph is known or not
    const double least = system.was_analysed() ? std::min(known(1).second, unknown()) : unknown();
    if (least > most) return least;
  }
  if (!system.Recognise(frame_->plan(), frame_->plan_number(), group)) return unknown();
  const auto [own, price] = known(bodies / system.nodes());
  memory->Remember(own);
  return price;
}

void BlockSteps::Take(int group, std::span<const int> islands) {
  TakeAs(group, islands, double_step_.get());
  TakeAs(group, islands, float_step_.get());
}

template <class T>
void BlockSteps::TakeAs(int group, std::span<const int> islands, BlockStep<T>* step) {
  const auto chosen = [this](int i) { return HasJoints(i) == std::is_same_v<T, double>; };
  if (std::none_of(islands.begin(), islands.end(), chosen)) return;
  for (int i : islands) {
    const StepSettings own = MemoryOf(i)->Step(*settings_);
    islands_now_[i] = {.taken = chosen(i),
                       .proximal = own.proximal,
                       .proximal_joints = own.proximal_joints,
                       .condense_joints = own.condense_joints,
                       .factorisations = limits_[i]};
  }
  // the time may be up since the step was planned, or while it is taken
  const bool too_late = meter_->out_of_time();
  bool given_up = too_late || meter_->ReplaysGivingUp();
  BlockSystem<T>& system = SystemOf<T>(group);
  meter_->Begin();
  const SpanClock clock(settings_->tuning.spans, 0, {SpanKind::kStep, group});
  int made = 1;
  if (!given_up) {
    Deadline deadline = meter_->StepDeadline();
    made = step->Take(frame_->plan(), group, settings_->tuning.refinements, &system, crew_,
                      &frame_->blocks(), islands_now_, &deadline);
    given_up = deadline.passed();
  }
  const double price = too_late ? 0 : PriceOf<T>(group, given_up ? 1 : made);
  if (!too_late) meter_->ChargeStep(price, given_up);
  if (!given_up) system.CountStep();
  double rows = 0;
  for (int i : islands) rows += chosen(i) ? frame_->plan().islands()[i].rows : 0;
  for (int i : islands) {
    if (chosen(i)) {
      islands_[i] = islands_now_[i];
      islands_[i].result.ToMetres(UnitOf(*settings_));
      if (!given_up) MemoryOf(i)->SawJoints(islands_[i].result);
      work_[i] = price * frame_->plan().islands()[i].rows / rows;
      given_up_[i] = given_up ? 1 : 0;
    }
    islands_now_[i].taken = false;
  }
}

void BlockSteps::Judge(int island, bool accepted) {
  if (accepted) {
    MemoryOf(island)->Accepted(meter_->limited() ? kLeastSofteningOfBudget
                                                 : IslandMemory::kLeastSoftening);
  } else {
    MemoryOf(island)->Restored();
  }
}

}  // namespace cairn
