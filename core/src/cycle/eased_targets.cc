// SPDX-License-Identifier: MIT
#include "cycle/eased_targets.h"

#include "problem/joint_errors.h"

namespace cairn {

void EasedTargets::Ease(const CycleFrame& frame, int island, double share) {
  const Plan& plan = frame.plan();
  const Group& group = plan.groups()[plan.islands()[island].group];
  if (group.islands == 1) {
    for (int b = group.first_block; b < group.first_block + group.blocks; ++b) {
      for (int lane = 0; lane < plan.blocks()[b].lanes; ++lane) EaseLane(frame, b, lane, share);
    }
    return;
  }
  for (const int at : plan.lanes_of(island)) {
    EaseLane(frame, at / simd::kLanes, at % simd::kLanes, share);
  }
}

void EasedTargets::EaseLane(const CycleFrame& frame, int b, int lane, double share) {
  const simd::PairBlock& block = frame.plan().blocks()[b];
  const Pair& pair = frame.plan().pair(b, lane);
  if (pair.source != RowSource::kJoint) return;
  const Joint& joint = frame.problem.joints[pair.index];
  auto line = static_cast<std::uint32_t>(block.data + simd::PairLines(block.form));
  for (int i = 0; i < block.row_count; ++i) {
    const double error = ErrorOf(frame.problem, joint, i);
    if (block.rows[i].bound == simd::RowBound::kFree && error != 0) {
      const std::uint32_t at = line + simd::JacobianLines(block.form);
      float& target = frame.data()->data[at].lane[lane];
      eased_.push_back({at, lane, target});
      target = static_cast<float>(target - (1 - share) * error);
    }
    line += simd::RowLines(block.form, block.rows[i]);
  }
}

void EasedTargets::GiveBack(BlockData* blocks) {
  for (const Eased& eased : eased_) blocks->data[eased.line].lane[eased.lane] = eased.target;
  eased_.clear();
}

}  // namespace cairn
