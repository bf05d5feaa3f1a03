// SPDX-License-Identifier: MIT
#include "pack/locked_rows.h"

#include "problem/locked_axes.h"

namespace cairn {
namespace {

using simd::Line;
using simd::PairForm;

double SquaredNorm(const float* numbers) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += static_cast<double>(numbers[k]) * numbers[k];
  return sum;
}

/// |J|^2 of one side of a row, of what pushes and of what turns.
struct Sizes {
  double linear2, angular2;
};

/// One lane of a block.
class LockedLane {
 public:
  LockedLane(const BlockPacker& packer, int block, int lane)
      : packer_(packer),
        block_(packer.plan.blocks()[block]),
        pair_(packer.plan.pair(block, lane)),
        lane_(lane) {}

  bool any() const { return IsLocked(pair_.a) || IsLocked(pair_.b); }

  /// @p line: the first of the row
  void LeaveAlone(int row, Line* line) const {
    bool alone = LeaveSideAlone(row, pair_.a, FirstOfA(line), line + 3);
    if (pair_.b != kWorld)
      alone = LeaveSideAlone(row, pair_.b, FirstOfB(line), EndOf(line) - 3) || alone;
    if (alone) PutStep(block_.rows[row], line);
  }

 private:
  bool IsLocked(int body) const {
    return body != kWorld && HasLockedAxes(packer_.problem.bodies[body]);
  }
  /// Lines of what pushes a side, nullptr where both have them in common: nobody has locks there
  /// along which one is pushed.
  Line* FirstOfA(Line* line) const { return block_.form == PairForm::kContact ? nullptr : line; }
  Line* FirstOfB(Line* line) const {
    return block_.form == PairForm::kContact ? nullptr : line + 6;
  }
  Line* EndOf(Line* line) const { return line + simd::JacobianLines(block_.form); }

  bool LeaveSideAlone(int row, int body, Line* linear, Line* angular) const {
    if (!IsLocked(body)) return false;
    const Sizes sizes = SizesOf(row, body);
    if (linear == nullptr && sizes.linear2 > 0) return false;
    double g[6] = {};
    for (int k = 0; k < 3; ++k) {
      if (linear != nullptr) g[k] = linear[k].lane[lane_];
      g[3 + k] = angular[k].lane[lane_];
    }
    if (!IsLeftAlone(packer_.problem.bodies[body], sizes.linear2, sizes.angular2, g)) return false;
    for (int k = 0; k < 3; ++k) {
      if (linear != nullptr) linear[k].lane[lane_] = 0;
      angular[k].lane[lane_] = 0;
    }
    return true;
  }

  Sizes SizesOf(int row, int body) const {
    const ContactProblem& problem = packer_.problem;
    switch (pair_.source) {
      case RowSource::kManifold: {
        // directions and axes have length 1
        const Manifold& manifold = problem.manifolds[pair_.index];
        return {row < manifold.points * (1 + manifold.tangents) ? 1.0 : 0.0, 1};
      }
      case RowSource::kJoint: {
        const Joint& joint = problem.joints[pair_.index];
        const JointRow& of = problem.joint_rows[joint.first_row + row];
        const bool first = body == joint.body_a;
        return {SquaredNorm(first || joint.opposite ? of.linear_a : of.linear_b),
                SquaredNorm(first ? of.angular_a : of.angular_b)};
      }
      case RowSource::kRows:
        break;
    }
    const Row& of = problem.rows[packer_.plan.rows_of(pair_)[row]];
    const bool first = body == of.body_a;
    return {View(first ? of.linear_a : of.linear_b).squaredNorm(),
            View(first ? of.angular_a : of.angular_b).squaredNorm()};
  }

  /// Anew, for the G that is left.
  void PutStep(const simd::RowShape& shape, Line* line) const {
    Line* const behind = EndOf(line);
    float diagonal = shape.soft ? behind[2].lane[lane_] : 0;
    for (const Line* g = line; g != behind; ++g) diagonal += g->lane[lane_] * g->lane[lane_];
    const float relaxation = shape.relaxed ? behind[shape.soft ? 3 : 2].lane[lane_] : 1;
    if (!(diagonal > 0)) behind[0].lane[lane_] = 0;
    behind[1].lane[lane_] = diagonal > 0 ? relaxation / diagonal : 1;
  }

  const BlockPacker& packer_;
  const simd::PairBlock& block_;
  const Pair& pair_;
  const int lane_;
};

}  // namespace

void LeaveLockedAlone(const BlockPacker& packer, int index, BlockData* blocks) {
  const simd::PairBlock& block = packer.plan.blocks()[index];
  for (int lane = 0; lane < block.lanes; ++lane) {
    const LockedLane locked(packer, index, lane);
    if (!locked.any()) continue;
    Line* line = blocks->data.data() + block.data + simd::PairLines(block.form);
    for (int i = 0; i < block.row_count; ++i) {
      locked.LeaveAlone(i, line);
      line += simd::RowLines(block.form, block.rows[i]);
    }
  }
}

}  // namespace cairn
