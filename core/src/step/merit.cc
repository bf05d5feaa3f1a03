// SPDX-License-Identifier: MIT
#include "step/merit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace cairn {
namespace {

using simd::kLanes;

/// Of 1/2 |u|^2, what rounding may make of a state that is as good as none.
constexpr double kRounding = 1e-3;

/// Sums are of whole numbers of this many bits, so that their order does not matter.
constexpr int kSumBits = 36;

double ScaleOf(double largest) {
  const bool scalable = largest > 0 && std::isfinite(largest);
  return scalable ? std::ldexp(1.0, kSumBits - 1 - std::ilogb(largest)) : 1;
}

double RoundedSigned(double number) {
  return number < 0 ? -simd::Rounded(-number) : simd::Rounded(number);
}

/// Where 0 is outside the bounds of a row, the bit of its lane.
std::uint32_t WithoutZero(const simd::RowShape& row, const simd::Line* bounds) {
  if (row.bound != simd::RowBound::kOwn) return 0;
  std::uint32_t without = 0;
  for (int l = 0; l < kLanes; ++l) {
    const bool zero = bounds[0].lane[l] <= 0 && bounds[1].lane[l] >= 0;
    without |= zero ? 0 : std::uint32_t{1} << l;
  }
  return without;
}

/// b'x and x'E x of a block, for each lane. Returns WithoutZero() of its rows.
std::uint32_t AddRows(const simd::PairBlock& block, const BlockData& data, double* gain,
                      double* square) {
  std::uint32_t without = 0;
  const simd::Line* line = data.data.data() + block.data + simd::PairLines(block.form);
  const simd::Line* const x = data.x.data() + block.x;
  for (int i = 0; i < block.row_count; ++i) {
    const simd::RowShape& row = block.rows[i];
    const simd::Line& target = line[simd::JacobianLines(block.form)];
    for (int l = 0; l < kLanes; ++l) {
      gain[l] += static_cast<double>(target.lane[l]) * static_cast<double>(x[i].lane[l]);
    }
    if (row.soft) {
      const simd::Line& soft = line[simd::JacobianLines(block.form) + 2];
      for (int l = 0; l < kLanes; ++l) {
        const double impulse = x[i].lane[l];
        square[l] += static_cast<double>(soft.lane[l]) * impulse * impulse;
      }
    }
    const int laws = 2 + (row.soft ? 1 : 0) + (row.relaxed ? 1 : 0);
    without |= WithoutZero(row, line + simd::JacobianLines(block.form) + laws);
    line += simd::RowLines(block.form, row);
  }
  return without;
}

double SquareOf(const simd::BodyLane& body) {
  double sum = 0;
  for (const float u : body.u) sum += static_cast<double>(u) * static_cast<double>(u);
  return sum;
}

template <class T>
void Scale(T factor, T* number) {
  *number = factor == 0 ? 0 : factor * *number;
}

}  // namespace

bool Merit::is_worse_than_none() const {
  return may_be_none && !(gain >= (0.5 - kRounding) * square);
}

double Merit::best_scale() const {
  const double scale = gain / square;
  return scale > 0 ? std::min(scale, 1.0) : 0;
}

bool IsGuarded(const Settings& settings) {
  return settings.method == Method::kPgsSm && settings.max_sweeps > 0 &&
         settings.lifted_friction == LiftedFriction::kRelease;
}

void IslandMerits::Find(BlockFrame* frame, std::span<const GroupSweeps> groups) {
  const Plan& plan = frame->plan();
  if (merits_.size() < plan.islands().size()) {
    merits_.resize(plan.islands().size());
    largest_.resize(plan.islands().size());
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].active) FindOfGroup(frame, plan.groups()[g]);
  }
}

void IslandMerits::FindOfGroup(BlockFrame* frame, const Group& group) {
  const Plan& plan = frame->plan();
  const BlockData& data = frame->blocks();
  parts_.clear();
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    double gain[kLanes] = {}, square[kLanes] = {};
    const std::uint32_t without = AddRows(block, data, gain, square);
    for (int l = 0; l < block.lanes; ++l) {
      const bool may_be_none = (without >> l & 1) == 0;
      parts_.push_back({plan.island_of(b, l), {square[l], gain[l], may_be_none}});
    }
  }
  for (int slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
    const int body = plan.body_of_slot()[slot];
    if (body == kWorld) continue;
    parts_.push_back({plan.island_of_body()[body], {.square = SquareOf(data.bodies[slot])}});
  }
  Add(plan, group);
}

void IslandMerits::Add(const Plan& plan, const Group& group) {
  const auto islands = plan.islands_of_groups().subspan(group.first_island, group.islands);
  for (int i : islands) merits_[i] = largest_[i] = {};
  for (const Part& part : parts_) {
    Merit& largest = largest_[part.island];
    largest.square = std::max(largest.square, part.merit.square);
    largest.gain = std::max(largest.gain, std::abs(part.merit.gain));
  }
  for (int i : islands) {
    largest_[i] = {.square = ScaleOf(largest_[i].square), .gain = ScaleOf(largest_[i].gain)};
  }
  for (const Part& part : parts_) {
    const Merit& scale = largest_[part.island];
    Merit& sum = merits_[part.island];
    sum.square += simd::Rounded(part.merit.square * scale.square);
    sum.gain += RoundedSigned(part.merit.gain * scale.gain);
    sum.may_be_none = sum.may_be_none && part.merit.may_be_none;
  }
  for (int i : islands) {
    merits_[i].square /= largest_[i].square;
    merits_[i].gain /= largest_[i].gain;
  }
}

void ScaleIsland(const Plan& plan, int island, double factor, BlockData* blocks) {
  const Group& group = plan.groups()[plan.islands()[island].group];
  const auto scale = static_cast<float>(factor);
  for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    for (int l = 0; l < block.lanes; ++l) {
      if (plan.island_of(b, l) != island) continue;
      for (int k = 0; k < block.row_count; ++k) Scale(scale, &blocks->x[block.x + k].lane[l]);
    }
  }
  for (int slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
    const int body = plan.body_of_slot()[slot];
    if (body == kWorld || plan.island_of_body()[body] != island) continue;
    for (float& u : blocks->bodies[slot].u) Scale(scale, &u);
  }
}

}  // namespace cairn
