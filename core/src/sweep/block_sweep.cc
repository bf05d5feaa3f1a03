// SPDX-License-Identifier: MIT
#include "sweep/block_sweep.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace cairn {
namespace {

/// Energies are summed as whole numbers of this many bits, of which doubles hold the sum of eight
/// million exactly: in whatever order lanes come, an island has the same sum.
constexpr int kEnergyBits = 30;

/// Brings the largest number of a sum to that many bits.
double ScaleOf(double largest) {
  const bool scalable = largest > 0 && std::isfinite(largest);
  return scalable ? std::ldexp(1.0, kEnergyBits - 1 - std::ilogb(largest)) : 1;
}

}  // namespace

/// So many sweeps, or one measurement, as work in stages.
class BlockSweeps::Pass final : public StagedWork {
 public:
  enum class Kind { kSweeps, kWholeSweeps, kMeasure };

  /// @p price: of a row, in work units.
  Pass(const BlockSweeps& sweeps, Kind kind, std::span<const GroupSweeps> groups, int count,
       double price)
      : sweeps_(sweeps), kind_(kind), count_(count), price_(price), groups_(groups) {
    for (const GroupSweeps& group : groups) {
      if (group.active) made_ = group.sweeps;
    }
  }

  int stages() const override { return count_ * stages_of_sweep(); }
  int units(int) const override { return units_; }

  void Do(int stage, int unit) override {
    const Unit& of = plan().units()[StageOf(stage).first_unit + unit];
    if (!groups_[of.group].active) return;
    const int sweep = stage / stages_of_sweep();
    simd::PairWork work = sweeps_.frame_->WorkOn(of.first_block, of.blocks);
    work.sweep = groups_[of.group].sweeps + sweep;
    work.hold_lifted = sweeps_.settings_.tuning.lifted_friction == detail::LiftedFriction::kHold;
    const simd::PairKernels& kernels = sweeps_.frame_->kernels();
    const auto last = sweep == count_ - 1 ? kernels.measured_sweep : kernels.sweep;
    (kind_ == Kind::kMeasure ? kernels.measure : last)(work);
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
    const double left = must ? kInfinity : sweeps_.meter_->work_left();
    PlanStage(StageOf(stage), left);
    return true;
  }

  /// Charges the last stage. Returns how many sweeps are complete.
  int Finish() {
    ChargeLast();
    return stages_of_sweep() > 0 ? whole_stages_ / stages_of_sweep() : count_;
  }

 private:
  const Plan& plan() const { return sweeps_.frame_->plan(); }
  int stages_of_sweep() const { return static_cast<int>(plan().stages().size()); }
  const Stage& StageOf(int stage) const { return plan().stages()[stage % stages_of_sweep()]; }

  /// As many of its units as the work that is left allows, but one at least.
  void PlanStage(const Stage& stage, double left) {
    units_ = 0;
    rows_ = 0;
    for (; units_ < stage.units; ++units_) {
      const Unit& unit = plan().units()[stage.first_unit + units_];
      if (!groups_[unit.group].active) continue;
      if (rows_ > 0 && rows_ >= left) break;
      rows_ += unit.rows;
    }
    if (units_ == stage.units) ++whole_stages_;
  }

  void ChargeLast() {
    const double rows = static_cast<double>(std::exchange(rows_, 0));
    if (rows > 0 && price_ > 0) sweeps_.meter_->Charge(WorkKind::kSweep, price_ * rows);
  }

  const BlockSweeps& sweeps_;
  const Kind kind_;
  const int count_;
  const double price_;
  std::span<const GroupSweeps> groups_;
  int made_ = 0;           ///< sweeps before this pass
  int whole_stages_ = 0;   ///< planned so far
  int units_ = 0;          ///< of the present stage
  std::int64_t rows_ = 0;  ///< in them
};

bool BlockSweeps::Sweep(int count, std::span<GroupSweeps> groups) {
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

void BlockSweeps::Measure(std::span<const GroupSweeps> groups) {
  meter_->Begin();
  MeasureAt(kMeasureSweeps, groups);
}

void BlockSweeps::MeasureFree(std::span<const GroupSweeps> groups) { MeasureAt(0, groups); }

void BlockSweeps::MeasureAt(double price, std::span<const GroupSweeps> groups) {
  Pass pass(*this, Pass::Kind::kMeasure, groups, 1, price);
  crew_->Run(&pass);
  pass.Finish();
}

void BlockSweeps::ErrorsOfIslands(const Group& group, std::span<Residual> residuals) const {
  const Plan& plan = frame_->plan();
  const auto islands = plan.islands_of_groups().subspan(group.first_island, group.islands);
  if (islands.size() == 1 && !HasFewLanes(group)) {
    residuals[islands[0]] = ErrorOfGroup(group);
    return;
  }
  const std::span<double> scales = frame_->scales();
  for (int island : islands) residuals[island] = {};
  ForLanes(group, [&](const simd::BlockError& error, int block, int lane) {
    Residual& residual = residuals[plan.island_of(block, lane)];
    residual.max = std::max<double>(residual.max, error.max.lane[lane]);
    residual.max_angular = std::max<double>(residual.max_angular, error.max_angular.lane[lane]);
    residual.energy = std::max<double>(residual.energy, error.energy.lane[lane]);
  });
  for (int island : islands) {
    scales[island] = ScaleOf(residuals[island].energy);
    residuals[island].energy = 0;
  }
  ForLanes(group, [&](const simd::BlockError& error, int block, int lane) {
    const int island = plan.island_of(block, lane);
    residuals[island].energy +=
        simd::Rounded(static_cast<double>(error.energy.lane[lane]) * scales[island]);
  });
  for (int island : islands) {
    residuals[island].energy = std::sqrt(residuals[island].energy / scales[island]);
  }
}

bool BlockSweeps::HasFewLanes(const Group& group) const {
  int lanes = 0;
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    lanes += frame_->plan().blocks()[b].lanes;
    if (lanes > simd::kLanes) return false;
  }
  return true;
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
  const double scale = ScaleOf(largest_of(largest.energy));
  double sums[simd::kLanes] = {};
  kernels.add_energies(blocks, errors, group.blocks, scale, sums);
  const double whole = std::accumulate(sums, sums + simd::kLanes, 0.0);
  return {.max = largest_of(largest.max),
          .max_angular = largest_of(largest.max_angular),
          .energy = std::sqrt(whole / scale)};
}

template <class Function>
void BlockSweeps::ForLanes(const Group& group, const Function& function) const {
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    const simd::BlockError& error = frame_->errors()[b];
    const int lanes = frame_->plan().blocks()[b].lanes;
    for (int lane = 0; lane < lanes; ++lane) function(error, b, lane);
  }
}

}  // namespace cairn
