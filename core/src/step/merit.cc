// SPDX-License-Identifier: MIT
#include "step/merit.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "runtime/in_parts.h"
#include "sweep/sum_scale.h"

namespace cairn {
namespace {

using simd::kLanes;

/// Of 1/2 |u|^2, what rounding may make of a state that is as good as none.
constexpr double kRounding = 1e-3;

/// Sums are of whole numbers of this many bits, so that their order does not matter.
constexpr int kSumBits = 36;

/// Where 0 is outside the bounds of a row, the bit of its lane.
std::uint32_t WithoutZero(const simd::RowShape& row, const simd::Line* bounds, int lanes) {
  if (row.bound != simd::RowBound::kOwn) return 0;
  std::uint32_t without = 0;
  for (int l = 0; l < lanes; ++l) {
    const bool zero = bounds[0].lane[l] <= 0 && bounds[1].lane[l] >= 0;
    without |= zero ? 0 : std::uint32_t{1} << l;
  }
  return without;
}

/// WithoutZero() of all rows of a block.
std::uint32_t WithoutZero(const simd::PairBlock& block, const BlockData& data) {
  std::uint32_t without = 0;
  const simd::Line* line = data.data.data() + block.data + simd::PairLines(block.form);
  for (const simd::RowShape& row : std::span(block.rows, block.row_count)) {
    const int laws = 2 + (row.soft ? 1 : 0) + (row.relaxed ? 1 : 0);
    without |= WithoutZero(row, line + simd::JacobianLines(block.form) + laws, block.lanes);
    line += simd::RowLines(block.form, row);
  }
  return without;
}

/// do_lane(lane) for each that is set in the mask.
template <class DoLane>
void ForLanes(std::uint32_t mask, const DoLane& do_lane) {
  for (; mask != 0; mask &= mask - 1) do_lane(std::countr_zero(mask));
}

void Multiply(float factor, float* number) { *number = factor == 0 ? 0 : factor * *number; }

void ScaleWhole(const Plan& plan, const Group& group, float factor, BlockData* blocks) {
  for (simd::Line& line : std::span(blocks->x).subspan(group.first_x, group.x_lines)) {
    for (float& x : line.lane) Multiply(factor, &x);
  }
  for (int slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
    if (plan.body_of_slot()[slot] == kWorld) continue;
    for (float& u : blocks->bodies[slot].u) Multiply(factor, &u);
  }
}

void ScaleShared(const Plan& plan, const Group& group, std::span<const float> factors,
                 BlockData* blocks) {
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    for (int l = 0; l < block.lanes; ++l) {
      const float factor = factors[plan.island_of(b, l)];
      if (factor == 1) continue;
      for (int k = 0; k < block.row_count; ++k) Multiply(factor, &blocks->x[block.x + k].lane[l]);
    }
  }
  for (int slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
    const int body = plan.body_of_slot()[slot];
    const float factor = body == kWorld ? 1 : factors[plan.island_of_body()[body]];
    if (factor == 1) continue;
    for (float& u : blocks->bodies[slot].u) Multiply(factor, &u);
  }
}

/// See IsTooViolent().
constexpr double kMostEnergy = 1000, kMostOfAll = 0.5;

}  // namespace

bool IsTooViolent(const Merit& before, const Merit& after, double mass, double error) {
  const double gain = before.value() - after.value();
  return gain > kMostEnergy * 0.5 * mass * error * error && gain > kMostOfAll * -after.value();
}

bool Merit::is_worse_than_none() const {
  return may_be_none && !(gain >= (0.5 - kRounding) * square);
}

double Merit::best_scale() const {
  const double scale = gain / square;
  return scale > 0 ? std::min(scale, 1.0) : 0;
}

bool IsGuarded(const Settings& settings) {
  return settings.method == Method::kPgsSm && settings.max_sweeps > 0 &&
         settings.tuning.lifted_friction == detail::LiftedFriction::kRelease;
}

void IslandMerits::Find(BlockFrame* frame, std::span<const GroupSweeps> groups) {
  const Plan& plan = frame->plan();
  if (merits_.size() < plan.islands().size()) {
    merits_.resize(plan.islands().size());
    scales_.resize(plan.islands().size());
  }
  const size_t lanes = plan.blocks().size() * kLanes;
  if (gains_.size() < lanes) gains_.resize(lanes);
  if (of_blocks_.size() < plan.blocks().size()) of_blocks_.resize(plan.blocks().size());
  const size_t squares = lanes + plan.body_of_slot().size();
  if (squares_.size() < squares) squares_.resize(squares);
  ForUnits(static_cast<int>(plan.units().size()), frame->crew(),
           [&](int i) {
             const Unit& unit = plan.units()[i];
             if (groups[unit.group].active) FindOfUnit(frame, unit);
           },
           {SpanKind::kGuard});
  ForUnits(static_cast<int>(groups.size()), frame->crew(),
           [&](int g) {
             if (groups[g].active) FindOfGroup(frame, plan.groups()[g]);
           },
           {SpanKind::kGuard});
}

void IslandMerits::FindOfUnit(BlockFrame* frame, const Unit& unit) {
  const Plan& plan = frame->plan();
  const BlockData& data = frame->blocks();
  const simd::LaneKernels& kernels = frame->lane_kernels();
  const Group& group = plan.groups()[unit.group];
  for (int b = unit.first_block; b < unit.first_block + unit.blocks; ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    const simd::RowsOfBlock some =
        kernels.find_gains(block, data.data.data() + block.data, data.x.data() + block.x,
                           gains_.data() + size_t{kLanes} * b,
                           SquaresOf(group) + size_t{kLanes} * (b - group.first_block));
    of_blocks_[b] = {some.bounded ? WithoutZero(block, data) : 0, some.soft};
  }
}

double* IslandMerits::SquaresOf(const Group& group) {
  return squares_.data() + size_t{kLanes} * group.first_block + group.first_slot;
}

void IslandMerits::FindOfGroup(BlockFrame* frame, const Group& group) {
  const Plan& plan = frame->plan();
  for (int i : plan.islands_in(group)) {
    merits_[i] = {};
  }
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    ForLanes(of_blocks_[b].without_zero,
             [&](int lane) { merits_[plan.island_of(b, lane)].may_be_none = false; });
  }
  frame->lane_kernels().find_squares(frame->blocks().bodies.data() + group.first_slot, group.slots,
                                     SquaresOf(group) + size_t{kLanes} * group.blocks);
  if (group.islands == 1) {
    AddWhole(frame->lane_kernels(), group, plan.islands_of_groups()[group.first_island]);
  } else {
    AddShared(plan, group);
  }
}

void IslandMerits::AddWhole(const simd::LaneKernels& kernels, const Group& group, int island) {
  const auto sum = [&](const double* numbers, int count) {
    const double scale = SumScale(kernels.find_most(numbers, count), kSumBits);
    return kernels.add_rounded(numbers, count, scale) / scale;
  };
  const int lanes = kLanes * group.blocks;
  merits_[island].gain = sum(gains_.data() + size_t{kLanes} * group.first_block, lanes);
  merits_[island].square = sum(SquaresOf(group), lanes + group.slots);
}

void IslandMerits::AddShared(const Plan& plan, const Group& group) {
  const auto islands = plan.islands_in(group);
  const size_t lanes = static_cast<size_t>(group.blocks) * kLanes;
  for (const int i : islands) {
    double most = 0, whole = 0;
    for (const int lane : plan.lanes_of(i)) most = std::max(most, std::abs(gains_[lane]));
    const double scale = SumScale(most, kSumBits);
    for (const int lane : plan.lanes_of(i)) whole += simd::Rounded(gains_[lane] * scale);
    merits_[i].gain = whole / scale;
  }
  const double* const squares = SquaresOf(group);
  // add(island, number) for all lanes that are soft, and for bodies
  const auto for_squares = [&](const auto& add) {
    for (int b = 0; b < group.blocks; ++b) {
      if (!of_blocks_[group.first_block + b].soft) continue;
      const int* const of_lane = plan.islands_of(group.first_block + b);
      const int used = plan.blocks()[group.first_block + b].lanes;
      for (int l = 0; l < used; ++l) add(of_lane[l], squares[static_cast<size_t>(b) * kLanes + l]);
    }
    for (int slot = 0; slot < group.slots; ++slot) {
      const int body = plan.body_of_slot()[group.first_slot + slot];
      if (body != kWorld) add(plan.island_of_body()[body], squares[lanes + slot]);
    }
  };
  for (const int i : islands) scales_[i] = 0;
  for_squares(
      [this](int island, double square) { scales_[island] = std::max(scales_[island], square); });
  for (const int i : islands) scales_[i] = SumScale(scales_[i], kSumBits);
  for_squares([this](int island, double square) {
    merits_[island].square += simd::Rounded(square * scales_[island]);
  });
  for (const int i : islands) merits_[i].square /= scales_[i];
}

void LeaveForced(const Plan& plan, const BlockData& blocks, std::span<float> factors) {
  for (const Group& group : plan.groups()) {
    const auto islands = plan.islands_in(group);
    const bool any = std::any_of(islands.begin(), islands.end(),
                                 [&](int island) { return factors[island] != 1; });
    for (int b = group.first_block; any && b < group.first_block + group.blocks; ++b) {
      ForLanes(WithoutZero(plan.blocks()[b], blocks),
               [&](int lane) { factors[plan.island_of(b, lane)] = 1; });
    }
  }
}

void ScaleIslands(const Plan& plan, std::span<const float> factors, BlockData* blocks) {
  for (const Group& group : plan.groups()) {
    const auto islands = plan.islands_in(group);
    if (group.islands == 1) {
      const float factor = factors[islands[0]];
      if (factor != 1) ScaleWhole(plan, group, factor, blocks);
    } else if (std::any_of(islands.begin(), islands.end(),
                           [&](int island) { return factors[island] != 1; })) {
      ScaleShared(plan, group, factors, blocks);
    }
  }
}

}  // namespace cairn
