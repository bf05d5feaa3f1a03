// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "cairn/contact_problem.h"
#include "cairn/detail/memory.h"
#include "plan/plan.h"
#include "problem/whitening.h"
#include "simd/pairs/pair_block.h"
#include "simd/rows/contact_rows.h"
#include "simd/rows/joint_rows.h"
#include "simd/rows/row_pack.h"

namespace cairn {

/// Everything that kernels read and write, in floats: 50 bytes or so a row.
struct BlockData {
  Array<simd::Line> data;        ///< constant during a Solve(); see simd::PairForm
  Array<simd::Line> x;           ///< impulses
  Array<simd::Line> directions;  ///< of friction, where manifolds are; see manifold_pack
  Array<simd::BodyLane> bodies;  ///< u, by slot of the plan
  Array<simd::Line> d_ratios;    ///< constant; see simd::PairWork
};

/// What became of rows that were to be packed.
enum class PackResult {
  kDone,
  kStalePlan,   ///< a row is not as it was planned: to be planned again
  kInvalid,     ///< a number that no problem may have, or a row of no valid kind
  kOutOfRange,  ///< of a float, be it valid or not: Validate() tells
};

/// Whether rows are to stay inside numbers of the caller's.
inline bool HasOwnBounds(simd::RowBound bound) {
  return bound == simd::RowBound::kOwn || bound == simd::RowBound::kCutFriction;
}

/// A problem on its way into blocks, and back. Different blocks may be packed at the same time.
struct BlockPacker {
  const ContactProblem& problem;
  const Plan& plan;
  const MovableBodies& movable;
  std::span<const WhitenedBody> bodies;
  std::span<const simd::ContactBody> contact_bodies;  ///< if there are joints or manifolds
  bool locked;                                        ///< there are bodies with locked axes
  double omega;
  simd::RowPackKernel pack_row;
  simd::JointRowsKernel pack_joints;
  const simd::ContactKernels& contacts;
  void (*couple)(const simd::PairBlock& block, simd::Line* lines);

  /// A body as joints and contacts see it.
  const simd::ContactBody* contact_body(int body) const {
    static constexpr simd::ContactBody kNobody{};
    return body == kWorld ? &kNobody : &contact_bodies[body];
  }
  /// What R of a body is to be multiplied by where a lane sees a copy of it, else 1.
  float ScaleOf(const simd::PairBlock& block, int lane, const Pair& pair, int body) const {
    if (body == kWorld) return 1;
    const simd::BodyCopy* copy = nullptr;
    if (body == pair.a) copy = plan.copy_at(block.a[lane]);
    if (body == pair.b) copy = plan.copy_at(block.b[lane]);
    return copy != nullptr ? 1 / copy->share : 1;
  }

  /// Makes room.
  void Reserve(BlockData* blocks) const;
  /// Rows of so many blocks from the first on; x from the caller's impulses, brought inside their
  /// bounds.
  PackResult Pack(int first_block, int count, const Impulses& impulses, BlockData* blocks) const;
  /// Impulses of the caller from x.
  void WriteImpulses(int first_block, int count, const BlockData& blocks,
                     const Impulses& impulses) const;
  /// Velocities of so many bodies from the first on.
  void WriteVelocities(int first_body, int count, const BlockData& blocks,
                       std::span<Velocity> velocities) const;

 private:
  PackResult PackBlock(int block, const Impulses& impulses, BlockData* blocks) const;
  void WriteRows(int block, const BlockData& blocks, const Impulses& impulses) const;
  void FindRatios(const simd::PairBlock& block, BlockData* blocks) const;
};

/// The bodies of a block as joints and contacts see them, copies among them.
class SeenBodies {
 public:
  SeenBodies(const BlockPacker& packer, int block)
      : packer_(packer), block_(packer.plan.blocks()[block]) {}
  const simd::ContactBody* Of(int lane, const Pair& pair, int body) {
    const simd::ContactBody* const whole = packer_.contact_body(body);
    if (!block_.copies) return whole;
    const float scale = packer_.ScaleOf(block_, lane, pair, body);
    if (scale == 1) return whole;
    simd::ContactBody& copy = copies_[count_++];
    copy = *whole;
    for (float& number : copy.linear) number *= scale;
    for (float& number : copy.angular) number *= scale;
    return &copy;
  }

 private:
  const BlockPacker& packer_;
  const simd::PairBlock& block_;
  int count_ = 0;
  simd::ContactBody copies_[2 * simd::kLanes];
};

}  // namespace cairn
