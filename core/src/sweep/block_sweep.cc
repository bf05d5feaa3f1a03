// SPDX-License-Identifier: MIT
#include "sweep/block_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "sweep/sum_scale.h"

namespace cairn {
namespace {

/// Energies are summed as whole numbers of this many bits, of which doubles hold the sum of eight
/// million exactly: in whatever order lanes come, an island has the same sum.
constexpr int kEnergyBits = 30;

}  // namespace

/// So many sweeps, or one measurement, as work in stages: those of the plan under a budget, which
/// is looked at between them, and whole phases without one.
class BlockSweeps::Pass final : public StagedWork {
 public:
  enum class Kind { kSweeps, kWholeSweeps, kFriction, kMeasure };

  /// @p price: of a row, in work units.
  Pass(const BlockSweeps& sweeps, Kind kind, std::span<const GroupSweeps> groups, int count,
       double price)
      : sweeps_(sweeps),
        kind_(kind),
        count_(count),
        price_(price),
        groups_(groups),
        in_phases_(!sweeps.meter_->limited()) {
    for (const GroupSweeps& group : groups) {
      if (group.active) made_ = group.sweeps;
      all_active_ = all_active_ && group.active;
    }
  }

  int stages() const override { return count_ * stages_of_sweep(); }
  int units(int) const override { return pieces_; }

  void Do(int stage, int piece) override {
    const int sweep = stage / stages_of_sweep();
    if (phase_.units == pieces_) {
      const Unit& unit = plan().units()[phase_.first_unit + piece];
      return Work(sweep, unit.group, unit.first_block, unit.blocks);
    }
    const Unit& first = plan().units()[phase_.first_unit];
    const auto begin_of = [&](std::int64_t i) {
      return first.first_block + static_cast<int>(blocks_ * i / pieces_);
    };
    Work(sweep, first.group, begin_of(piece), begin_of(piece + 1) - begin_of(piece));
  }

  SpanLabel label(int stage) const override {
    const int part = stage % stages_of_sweep();
    if (kind_ == Kind::kMeasure) return {SpanKind::kMeasure, 0, part};
    return {SpanKind::kSweep, made_ + stage / stages_of_sweep(), part};
  }

  bool GoOn(int stage) override {
    ChargeLast();
    const int sweeps = made_ + stage / stages_of_sweep();
    const bool must = kind_ != Kind::kSweeps || sweeps < LeastSweeps(sweeps_.settings_);
    if (sweeps_.meter_->spent() && !must) return false;
    const int of_sweep = stage % stages_of_sweep();
    if (in_phases_) {
      PlanPhase(plan().phases()[of_sweep]);
    } else {
      PlanStage(of_sweep, must ? kInfinity : sweeps_.meter_->work_left());
    }
    return true;
  }

  /// Charges the last stage. Returns how many sweeps are complete.
  int Finish() {
    ChargeLast();
    return stages_of_sweep() > 0 ? whole_stages_ / stages_of_sweep() : count_;
  }

 private:
  const Plan& plan() const { return sweeps_.frame_->plan(); }
  int stages_of_sweep() const {
    return static_cast<int>(in_phases_ ? plan().phases().size() : plan().stages().size());
  }

  void Work(int sweep, int group, int first_block, int blocks) {
    if (!groups_[group].active) return;
    const simd::PairWork work =
        sweeps_.WorkOn(plan().groups()[group], first_block, blocks, groups_[group].sweeps + sweep);
    const simd::PairKernels& kernels = sweeps_.frame_->kernels();
    switch (kind_) {
      case Kind::kMeasure:
        return kernels.measure(work);
      case Kind::kFriction:
        return kernels.friction(work);
      case Kind::kSweeps:
      case Kind::kWholeSweeps:
        return (sweep == count_ - 1 ? kernels.measured_sweep : kernels.sweep)(work);
    }
  }

  /// As many of its units as the work that is left allows, but one at least.
  void PlanStage(int number, double left) {
    const Stage& stage = plan().stages()[number];
    phase_ = {.first_stage = number, .stages = 1, .first_unit = stage.first_unit};
    rows_ = 0;
    for (; phase_.units < stage.units; ++phase_.units) {
      const Unit& unit = plan().units()[stage.first_unit + phase_.units];
      if (!groups_[unit.group].active) continue;
      if (rows_ > 0 && rows_ >= left) break;
      rows_ += unit.rows;
    }
    pieces_ = phase_.units;
    if (phase_.units == stage.units) ++whole_stages_;
  }

  /// All of it, in as many pieces as threads can share. Blocks of a colour may be cut anywhere.
  void PlanPhase(const Phase& phase) {
    constexpr int kPiecesOfThread = 4;
    phase_ = phase;
    ++whole_stages_;
    pieces_ = phase.units;
    const Unit &first = plan().units()[phase.first_unit],
               &last = plan().units()[phase.first_unit + phase.units - 1];
    if (phase.units <= 1 || first.group != last.group) {
      if (!all_active_ && RowsOf(phase) == 0) pieces_ = 0;
      return;
    }
    if (!groups_[first.group].active) {
      pieces_ = 0;
      return;
    }
    blocks_ = last.first_block + last.blocks - first.first_block;
    const int wanted = kPiecesOfThread * sweeps_.crew_->threads();
    pieces_ = static_cast<int>(std::min<std::int64_t>(blocks_, std::max(1, wanted)));
    // equal numbers would be taken for units
    if (pieces_ == phase.units) phase_.units = -1;
  }

  /// Those of active groups.
  std::int64_t RowsOf(const Phase& phase) const {
    std::int64_t rows = 0;
    for (int i = 0; i < phase.stages; ++i) rows += RowsOf(plan().stages()[phase.first_stage + i]);
    return rows;
  }
  std::int64_t RowsOf(const Stage& stage) const {
    if (all_active_) return stage.rows;
    std::int64_t rows = 0;
    for (const Unit& unit : plan().units().subspan(stage.first_unit, stage.units)) {
      if (groups_[unit.group].active) rows += unit.rows;
    }
    return rows;
  }

  void ChargeLast() {
    const Phase phase = std::exchange(phase_, {});
    if (!in_phases_) return Charge(std::exchange(rows_, 0));
    // stage by stage, whatever was done at a time: the sum is the same
    for (int i = 0; i < phase.stages; ++i) Charge(RowsOf(plan().stages()[phase.first_stage + i]));
  }
  void Charge(std::int64_t rows) {
    if (rows == 0 || price_ <= 0) return;
    sweeps_.meter_->Charge(WorkKind::kSweep, price_ * static_cast<double>(rows));
  }

  const BlockSweeps& sweeps_;
  const Kind kind_;
  const int count_;
  const double price_;
  std::span<const GroupSweeps> groups_;
  const bool in_phases_;
  bool all_active_ = true;
  int made_ = 0;             ///< sweeps before this pass
  int whole_stages_ = 0;     ///< or phases, planned so far
  Phase phase_;              ///< what is being done
  int pieces_ = 0;           ///< of it
  std::int64_t blocks_ = 0;  ///< of it, where pieces are not units
  std::int64_t rows_ = 0;    ///< of it, under a budget
};

simd::PairWork BlockSweeps::WorkOn(const Group& group, int first_block, int blocks,
                                   int sweeps_made) const {
  simd::PairWork work = frame_->WorkOn(group, first_block, blocks);
  work.sweep = sweeps_made;
  work.hold_lifted = settings_.tuning.lifted_friction == detail::LiftedFriction::kHold;
  return work;
}

bool BlockSweeps::InOneGo() const { return crew_->alone() && !meter_->limited(); }

void BlockSweeps::GoOver(std::span<const GroupSweeps> groups, const Kernels& kernels) {
  const Plan& plan = frame_->plan();
  int made = 0;
  for (const GroupSweeps& group : groups) made = group.active ? group.sweeps : made;
  const SpanClock clock(crew_->recorder(), 0, {kernels.kind, made});
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!groups[g].active) continue;
    const Group& group = plan.groups()[g];
    simd::PairWork work = WorkOn(group, group.first_block, group.blocks, groups[g].sweeps);
    for (int k = 0; k < kernels.count; ++k, ++work.sweep) {
      (k == kernels.count - 1 ? kernels.last : kernels.others)(work);
    }
  }
}

void BlockSweeps::SweepGroup(int group, int sweeps_made) {
  const Group& of = frame_->plan().groups()[group];
  frame_->kernels().measured_sweep(WorkOn(of, of.first_block, of.blocks, sweeps_made));
}

void BlockSweeps::SweepInOneGo(int count, std::span<GroupSweeps> groups) {
  const simd::PairKernels& kernels = frame_->kernels();
  GoOver(groups, {SpanKind::kSweep, count, kernels.sweep, kernels.measured_sweep});
  double rows = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!groups[g].active) continue;
    groups[g].sweeps += count;
    rows += static_cast<double>(frame_->plan().groups()[g].rows);
  }
  meter_->Charge(WorkKind::kSweep, count * rows);
}

bool BlockSweeps::Sweep(int count, std::span<GroupSweeps> groups) {
  if (InOneGo()) {
    SweepInOneGo(count, groups);
    return true;
  }
  Pass pass(*this, Pass::Kind::kSweeps, groups, count, 1);
  return Run(&pass, groups) == count;
}

void BlockSweeps::SweepWhole(std::span<GroupSweeps> groups) {
  Pass pass(*this, Pass::Kind::kWholeSweeps, groups, 1, 1);
  Run(&pass, groups);
}

int BlockSweeps::Run(Pass* pass, std::span<GroupSweeps> groups) {
  meter_->Begin();
  crew_->Run(pass);
  const int made = pass->Finish();
  for (GroupSweeps& group : groups) {
    if (group.active) group.sweeps += made;
  }
  return made;
}

void BlockSweeps::SweepFriction(std::span<const GroupSweeps> groups) {
  if (InOneGo()) {
    const auto friction = frame_->kernels().friction;
    return GoOver(groups, {SpanKind::kSweep, 1, friction, friction});
  }
  Pass pass(*this, Pass::Kind::kFriction, groups, 1, 0);
  crew_->Run(&pass);
  pass.Finish();
}

void BlockSweeps::Measure(std::span<const GroupSweeps> groups) {
  meter_->Begin();
  MeasureAt(kMeasureSweeps, groups);
}

void BlockSweeps::MeasureFree(std::span<const GroupSweeps> groups) { MeasureAt(0, groups); }

void BlockSweeps::MeasureAt(double price, std::span<const GroupSweeps> groups) {
  if (price == 0 && InOneGo()) {
    const auto measure = frame_->kernels().measure;
    return GoOver(groups, {SpanKind::kMeasure, 1, measure, measure});
  }
  Pass pass(*this, Pass::Kind::kMeasure, groups, 1, price);
  crew_->Run(&pass);
  pass.Finish();
}

bool BlockSweeps::IsForAll(const Group& group) const {
  return group.islands == 1 && group.blocks >= kManyBlocks && crew_->threads() > 1;
}

Residual BlockSweeps::ErrorByAll(const Group& group) const {
  constexpr int kParts = 16;
  const simd::LaneKernels& kernels = frame_->lane_kernels();
  const auto for_parts = [&](const auto& function) {
    ForUnits(
        kParts, crew_,
        [&](int part) {
          const int begin = group.blocks * part / kParts, end = group.blocks * (part + 1) / kParts;
          const int first = group.first_block + begin;
          function(part, frame_->plan().blocks().data() + first, frame_->errors().data() + first,
                   end - begin);
        },
        kErrors);
  };
  std::array<simd::BlockError, kParts> largest = {};
  for_parts([&](int part, const simd::PairBlock* blocks, const simd::BlockError* errors,
                int count) { kernels.find_largest(blocks, errors, count, &largest[part]); });
  const auto largest_of = [&](simd::Line simd::BlockError::*line) {
    float most = 0;
    for (const simd::BlockError& error : largest) {
      for (const float lane : (error.*line).lane) most = std::max(most, lane);
    }
    return static_cast<double>(most);
  };
  const double scale = SumScale(largest_of(&simd::BlockError::energy), kEnergyBits);
  std::array<std::array<double, simd::kLanes>, kParts> sums = {};
  for_parts(
      [&](int part, const simd::PairBlock* blocks, const simd::BlockError* errors, int count) {
        kernels.add_energies(blocks, errors, count, scale, sums[part].data());
      });
  // whole numbers: in whatever order, the same sum
  double whole = 0;
  for (const auto& of_part : sums) whole = std::accumulate(of_part.begin(), of_part.end(), whole);
  return {.max = largest_of(&simd::BlockError::max),
          .max_angular = largest_of(&simd::BlockError::max_angular),
          .energy = std::sqrt(whole / scale)};
}

void BlockSweeps::ErrorsOfGroup(const Group& group, std::span<Residual> residuals) const {
  const Plan& plan = frame_->plan();
  const auto islands = plan.islands_in(group);
  if (islands.size() == 1) {
    residuals[islands[0]] = HasFewLanes(group) ? ErrorOfFewLanes(group) : ErrorOfGroup(group);
    return;
  }
  for (const int island : islands) residuals[island] = ErrorOfIsland(plan.lanes_of(island));
}

Residual BlockSweeps::ErrorOfIsland(std::span<const int> lanes) const {
  const simd::BlockError* const errors = frame_->errors().data();
  const auto energy_at = [errors](unsigned lane) {
    return errors[lane / simd::kLanes].energy.lane[lane % simd::kLanes];
  };
  float max = 0, max_angular = 0, energy = 0;
  for (const unsigned at : lanes) {
    const simd::BlockError& error = errors[at / simd::kLanes];
    max = std::max(max, error.max.lane[at % simd::kLanes]);
    max_angular = std::max(max_angular, error.max_angular.lane[at % simd::kLanes]);
    energy = std::max(energy, energy_at(at));
  }
  // a float has less than kEnergyBits
  if (lanes.size() == 1) return {max, max_angular, std::sqrt(double{energy_at(lanes[0])})};
  const double scale = SumScale(energy, kEnergyBits);
  double whole = 0;
  for (const unsigned at : lanes) {
    whole += simd::Rounded(static_cast<double>(energy_at(at)) * scale);
  }
  return {max, max_angular, std::sqrt(whole / scale)};
}

bool BlockSweeps::HasFewLanes(const Group& group) const {
  int lanes = 0;
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    lanes += frame_->plan().blocks()[b].lanes;
    if (lanes > simd::kLanes) return false;
  }
  return true;
}

Residual BlockSweeps::ErrorOfFewLanes(const Group& group) const {
  const std::span<const simd::PairBlock> blocks =
      frame_->plan().blocks().subspan(group.first_block, group.blocks);
  const simd::BlockError* const errors = frame_->errors().data() + group.first_block;
  float max = 0, max_angular = 0, energy = 0;
  for (size_t b = 0; b < blocks.size(); ++b) {
    for (int lane = 0; lane < blocks[b].lanes; ++lane) {
      max = std::max(max, errors[b].max.lane[lane]);
      max_angular = std::max(max_angular, errors[b].max_angular.lane[lane]);
      energy = std::max(energy, errors[b].energy.lane[lane]);
    }
  }
  const double scale = SumScale(energy, kEnergyBits);
  double whole = 0;
  for (size_t b = 0; b < blocks.size(); ++b) {
    for (int lane = 0; lane < blocks[b].lanes; ++lane) {
      whole += simd::Rounded(static_cast<double>(errors[b].energy.lane[lane]) * scale);
    }
  }
  return {.max = max, .max_angular = max_angular, .energy = std::sqrt(whole / scale)};
}

Residual BlockSweeps::ErrorOfGroup(const Group& group) const {
  const simd::LaneKernels& kernels = frame_->lane_kernels();
  const simd::PairBlock* const blocks = frame_->plan().blocks().data() + group.first_block;
  const simd::BlockError* const errors = frame_->errors().data() + group.first_block;
  simd::BlockError largest = {};
  kernels.find_largest(blocks, errors, group.blocks, &largest);
  const auto largest_of = [](const simd::Line& line) {
    return static_cast<double>(*std::max_element(line.lane, line.lane + simd::kLanes));
  };
  const double scale = SumScale(largest_of(largest.energy), kEnergyBits);
  double sums[simd::kLanes] = {};
  kernels.add_energies(blocks, errors, group.blocks, scale, sums);
  const double whole = std::accumulate(sums, sums + simd::kLanes, 0.0);
  return {.max = largest_of(largest.max),
          .max_angular = largest_of(largest.max_angular),
          .energy = std::sqrt(whole / scale)};
}

}  // namespace cairn
