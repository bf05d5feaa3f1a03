// SPDX-License-Identifier: MIT
#include "pack/locked_rows.h"

#include <Eigen/Geometry>
#include <limits>

#include "cairn/detail/eigen.h"
#include "pack/manifold_pack.h"
#include "problem/locked_axes.h"
#include "simd/rows/contact_rows.h"

namespace cairn {
namespace {

using simd::Line;
using simd::PairForm;

double SquaredNorm(const float* numbers) {
  return Eigen::Map<const Eigen::Vector3f>(numbers).cast<double>().squaredNorm();
}

/// |J|^2 of one side of a row, of what pushes and of what turns.
struct Sizes {
  double linear2, angular2;
};

/// One lane of a block.
class LockedLane {
 public:
  LockedLane(const BlockPacker& packer, const BlockData& blocks, int block, int lane)
      : packer_(packer),
        blocks_(blocks),
        block_(packer.plan.blocks()[block]),
        pair_(packer.plan.pair(block, lane)),
        lane_(lane) {}

  bool any() const { return IsLocked(pair_.a) || IsLocked(pair_.b); }

  /// @p line: the first of the row
  void Apply(int row, Line* line) const {
    LockedSide both = ApplyToSide(row, pair_.a, FirstOfA(line), line + 3);
    if (pair_.b != kWorld) {
      const LockedSide b = ApplyToSide(row, pair_.b, FirstOfB(line), EndOf(line) - 3);
      both = {both.alone || b.alone, both.extra + b.extra};
    }
    if (both.alone || both.extra > 0) PutStep(block_.rows[row], both.extra, line);
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

  LockedSide ApplyToSide(int row, int body, Line* linear, Line* angular) const {
    if (!IsLocked(body)) return {false, 0};
    const Sizes sizes = SizesOf(row, body);
    if (linear == nullptr && sizes.linear2 > 0) return {false, 0};
    double g[6] = {};
    const double scale = packer_.ScaleOf(block_, lane_, pair_, body);
    for (int k = 0; k < 3; ++k) {
      if (linear != nullptr) g[k] = linear[k].lane[lane_] / scale;
      g[3 + k] = angular[k].lane[lane_] / scale;
    }
    LockedSide side = LookAtLocked(packer_.problem.bodies[body], sizes.linear2, sizes.angular2, g);
    side.extra *= scale * scale;
    for (int k = 0; side.alone && k < 3; ++k) {
      if (linear != nullptr) linear[k].lane[lane_] = 0;
      angular[k].lane[lane_] = 0;
    }
    return side;
  }

  Sizes SizesOf(int row, int body) const {
    const ContactProblem& problem = packer_.problem;
    switch (pair_.source) {
      case RowSource::kManifold: {
        const Manifold& manifold = problem.manifolds[pair_.index];
        // axes have length 1
        if (row >= manifold.points * (1 + manifold.tangents)) return {0, 1};
        return {DirectionOf(manifold, row).squaredNorm(), 1};
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

  /// Which way a row of a manifold pushes.
  Eigen::Vector3d DirectionOf(const Manifold& manifold, int row) const {
    const auto normal_of = [&](int point) -> Eigen::Vector3d {
      const ContactPoint& of = packer_.problem.points[manifold.first_point + point];
      return Eigen::Map<const Eigen::Vector3f>(of.normal).cast<double>();
    };
    const int friction = row - manifold.points;
    if (friction < 0) return normal_of(row);
    const int point = friction / manifold.tangents;
    const Line* const t1 =
        &blocks_.directions[DirectionsOf(block_) + size_t{simd::kDirectionLines} * point];
    const Eigen::Vector3d first(t1[0].lane[lane_], t1[1].lane[lane_], t1[2].lane[lane_]);
    if (friction % manifold.tangents == 0) return first;
    return first.cross(normal_of(point));
  }

  /// Anew, for the G that is left.
  void PutStep(const simd::RowShape& shape, double extra, Line* line) const {
    Line* const behind = EndOf(line);
    double diagonal = shape.soft ? behind[2].lane[lane_] : 0;
    for (const Line* g = line; g != behind; ++g) {
      diagonal += static_cast<double>(g->lane[lane_]) * g->lane[lane_];
    }
    const double relaxation = shape.relaxed ? behind[shape.soft ? 3 : 2].lane[lane_] : 1;
    const bool moves = diagonal >= std::numeric_limits<float>::min();
    if (!moves) behind[0].lane[lane_] = 0;
    behind[1].lane[lane_] = moves ? static_cast<float>(relaxation / (diagonal + extra)) : 1.0f;
  }

  const BlockPacker& packer_;
  const BlockData& blocks_;
  const simd::PairBlock& block_;
  const Pair& pair_;
  const int lane_;
};

}  // namespace

void ApplyLocks(const BlockPacker& packer, int index, BlockData* blocks) {
  const simd::PairBlock& block = packer.plan.blocks()[index];
  for (int lane = 0; lane < block.lanes; ++lane) {
    const LockedLane locked(packer, *blocks, index, lane);
    if (!locked.any()) continue;
    Line* line = blocks->data.data() + block.data + simd::PairLines(block.form);
    for (int i = 0; i < block.row_count; ++i) {
      locked.Apply(i, line);
      line += simd::RowLines(block.form, block.rows[i]);
    }
  }
}

}  // namespace cairn
