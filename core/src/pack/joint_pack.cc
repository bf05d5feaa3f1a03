// SPDX-License-Identifier: MIT
#include "pack/joint_pack.h"

#include <algorithm>
#include <cstddef>

#include "cairn/detail/prefetch.h"
#include "pack/numbers_of.h"

namespace cairn {
namespace {

using simd::WholeQuads;

// a row is floats, in the order that kernels read
static_assert(sizeof(JointRow) == simd::kJointNumbers * sizeof(float));
static_assert(offsetof(JointRow, target) == simd::kTarget * sizeof(float));
static_assert(offsetof(JointRow, angular_a) == simd::kAngularA * sizeof(float));
static_assert(offsetof(JointRow, compliance) == simd::kRowCompliance * sizeof(float));
static_assert(offsetof(JointRow, linear_b) == simd::kLinearB * sizeof(float));
static_assert(offsetof(JointRow, lo) == simd::kLo * sizeof(float));
static_assert(offsetof(JointRow, angular_b) == simd::kAngularB * sizeof(float));
static_assert(offsetof(JointRow, hi) == simd::kHi * sizeof(float));

const Joint& JointOf(const BlockPacker& packer, int block, int lane) {
  return packer.problem.joints[packer.plan.pair(block, lane).index];
}

/// The rows of a block, if there is such a block of joints.
void PrefetchRows(const BlockPacker& packer, int block) {
  if (block >= static_cast<int>(packer.plan.blocks().size())) return;
  if (packer.plan.pair(block, 0).source != RowSource::kJoint) return;
  for (int lane = 0; lane < packer.plan.blocks()[block].lanes; ++lane) {
    const Joint& joint = JointOf(packer, block, lane);
    Prefetch(&packer.problem.joint_rows[joint.first_row], joint.rows * sizeof(JointRow));
  }
}

/// Of a block of joints, ContactProblem::joint_errors; all else the kernel looks at.
bool ErrorsAreFinite(const BlockPacker& packer, int block) {
  const std::span<const float> errors = packer.problem.joint_errors;
  if (errors.empty()) return true;
  float zero = 0;
  for (int lane = 0; lane < packer.plan.blocks()[block].lanes; ++lane) {
    const Joint& joint = JointOf(packer, block, lane);
    for (int i = 0; i < joint.rows; ++i) zero += 0 * errors[joint.first_row + i];
  }
  return zero == 0;
}

}  // namespace

PackResult PackJoints(const BlockPacker& packer, int index, const Impulses& start,
                      BlockData* blocks) {
  PrefetchRows(packer, index + 1);
  const simd::PairBlock& block = packer.plan.blocks()[index];
  simd::JointLanes lanes{.form = block.form,
                         .rows = block.rows,
                         .row_count = block.row_count,
                         .lanes = WholeQuads(block.lanes)};
  SeenBodies bodies(packer, index);
  for (int lane = 0; lane < lanes.lanes; ++lane) {
    // unused lanes do what the first one does
    const int used = lane < block.lanes ? lane : 0;
    const Pair& pair = packer.plan.pair(index, used);
    const Joint& joint = packer.problem.joints[pair.index];
    lanes.a[lane] = bodies.Of(used, pair, joint.body_a);
    lanes.b[lane] = bodies.Of(used, pair, joint.body_b);
    lanes.second_moves[lane] = pair.a != joint.body_a;
    lanes.opposite[lane] = joint.opposite;
    lanes.damping[lane] = joint.damping;
    lanes.row[lane] = NumbersOf(packer.problem.joint_rows[joint.first_row]);
    lanes.start[lane] = &start.joint_rows[joint.first_row];
  }
  const bool fits =
      ErrorsAreFinite(packer, index) &&
      packer.pack_joints(lanes, blocks->data.data() + block.data, blocks->x.data() + block.x);
  return fits ? PackResult::kDone : PackResult::kOutOfRange;
}

void WriteJoints(const BlockPacker& packer, int index, const BlockData& blocks,
                 const Impulses& impulses) {
  const simd::PairBlock& block = packer.plan.blocks()[index];
  const simd::Line* const x = blocks.x.data() + block.x;
  for (int lane = 0; lane < block.lanes; ++lane) {
    const int first = JointOf(packer, index, lane).first_row;
    float* const to = &impulses.joint_rows[first];
    for (int i = 0; i < block.row_count; ++i) {
      to[i] = x[i].lane[lane];
      if (!HasOwnBounds(block.rows[i].bound)) continue;
      // see InsideOwnBounds()
      const JointRow& row = packer.problem.joint_rows[first + i];
      to[i] = std::min(std::max(to[i], row.lo), row.hi);
    }
  }
}

}  // namespace cairn
