// SPDX-License-Identifier: MIT
#include "pack/block_pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cairn/detail/prefetch.h"
#include "pack/joint_pack.h"
#include "pack/locked_rows.h"
#include "pack/manifold_pack.h"
#include "pack/numbers_of.h"
#include "plan/row_kind.h"

namespace cairn {
namespace {

using simd::kLanes;
using simd::Line;
using simd::PairForm;
using simd::RowBound;
using simd::RowShape;

/// Impulses and friction coefficients beyond this are left to double precision.
constexpr double kMost = 1e12;

/// J of what is not there.
constexpr double kNothing[6] = {};

/// The row still joins the bodies that it was planned for.
bool Joins(const Row& row, const Pair& pair, const MovableBodies& movable) {
  const auto is = [&movable](int body, int planned) {
    if (planned != kWorld) return body == planned;
    return body == kWorld ||
           (body >= 0 && body < static_cast<int>(movable.size()) && movable[body] == kUnmoved);
  };
  const bool same = row.body_a != row.body_b || row.body_a == kWorld;
  return same && ((is(row.body_a, pair.a) && is(row.body_b, pair.b)) ||
                  (is(row.body_b, pair.a) && is(row.body_a, pair.b)));
}

float Bound(double value) {
  constexpr double kMostFloat = std::numeric_limits<float>::max();
  if (value > kMostFloat) return std::numeric_limits<float>::infinity();
  if (value < -kMostFloat) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(value);
}

/// x inside its bounds, all lanes; @p b: the bounds of the row as the kernel has them.
void Clamp(RowBound bound, const Line* b, const Line* parent, Line* x) {
  const auto clamp = [x](const auto& lo, const auto& hi) {
    for (int lane = 0; lane < kLanes; ++lane) {
      x->lane[lane] = std::min(std::max(x->lane[lane], lo(lane)), hi(lane));
    }
  };
  const auto most = [b, parent](int lane) {
    return b[0].lane[lane] * std::max(parent->lane[lane], 0.0f);
  };
  switch (bound) {
    case RowBound::kFree:
      return;
    case RowBound::kPush:
      for (float& number : x->lane) number = std::max(number, 0.0f);
      return;
    case RowBound::kOwn:
      return clamp([b](int lane) { return b[0].lane[lane]; },
                   [b](int lane) { return b[1].lane[lane]; });
    case RowBound::kFriction:
      return clamp([&](int lane) { return -most(lane); }, most);
    case RowBound::kCutFriction:
      return clamp([&](int lane) { return std::max(-most(lane), b[1].lane[lane]); },
                   [&](int lane) { return std::min(most(lane), b[2].lane[lane]); });
  }
}

/// Kernels add changes to impulses, and round both, so that what is small after what was large may
/// be outside by a unit of the large one.
double InsideOwnBounds(double x, const Row& row) { return std::min(std::max(x, row.lo), row.hi); }

/// @p scale: of R
void Put(const WhitenedBody& body, double scale, int lane, simd::BodyLines* lines) {
  for (int k = 0; k < 3; ++k) {
    lines->linear[k].lane[lane] = scale * body.linear[k];
    lines->velocity[k].lane[lane] = body.free.linear[k];
    lines->velocity[3 + k].lane[lane] = body.free.angular[k];
  }
  for (int k = 0; k < 9; ++k) lines->angular[k].lane[lane] = scale * body.angular.data()[k];
}

std::uint64_t Bits(double value) { return std::bit_cast<std::uint64_t>(value); }

/// The kind that most rows have, compared by its bits: checking every field of every row for itself
/// costs more than packing them.
class UsualKind {
 public:
  UsualKind(PairForm form, const RowShape& shape, double omega)
      : exists_(!shape.soft && !shape.relaxed && omega == 1 && shape.bound != RowBound::kOwn &&
                shape.bound != RowBound::kCutFriction),
        opposite_(form == PairForm::kContact),
        angular_(shape.angular),
        lo_(Bits(shape.bound == RowBound::kPush ? 0 : -kInfinity)),
        max_sweeps_(shape.max_sweeps) {}

  bool exists() const { return exists_; }
  /// The row has it, and acts between these bodies. False says nothing.
  bool Fits(const Row& row, const Pair& pair, int parent) const {
    const int integers = (row.body_a ^ pair.row_a) | (row.body_b ^ pair.row_b) |
                         (row.parent ^ parent) | (row.host.max_sweeps ^ max_sweeps_);
    const std::uint64_t numbers = (Bits(row.lo) ^ lo_) | (Bits(row.hi) ^ Bits(kInfinity)) |
                                  (Bits(row.relaxation) ^ Bits(1)) | Bits(row.compliance);
    const bool same = (static_cast<std::uint32_t>(integers) | numbers) == 0;
    // negative numbers and those that are not finite have larger bits
    return exists_ && same && Bits(row.friction) < Bits(kInfinity) && HasLinearPart(row);
  }

 private:
  bool HasLinearPart(const Row& row) const {
    const Vector3 &a = row.linear_a, &b = row.linear_b;
    const std::uint64_t any = Bits(a[0]) | Bits(a[1]) | Bits(a[2]);
    if (angular_) return ((any | Bits(b[0]) | Bits(b[1]) | Bits(b[2])) << 1) == 0;
    const std::uint64_t sum =
        (Bits(a[0]) ^ Bits(-b[0])) | (Bits(a[1]) ^ Bits(-b[1])) | (Bits(a[2]) ^ Bits(-b[2]));
    return (any << 1) != 0 && (!opposite_ || sum == 0);
  }

  bool exists_, opposite_, angular_;
  std::uint64_t lo_;
  int max_sweeps_;
};

/// Fills one block, row by row.
class OneBlock {
 public:
  OneBlock(const BlockPacker& packer, int index, BlockData* blocks)
      : packer_(packer),
        block_(packer.plan.blocks()[index]),
        line_(blocks->data.data() + block_.data),
        x_(blocks->x.data() + block_.x) {
    for (int lane = 0; lane < kLanes; ++lane) {
      source_.a[lane] = source_.b[lane] = kNothing;
      source_.target.lane[lane] = source_.compliance.lane[lane] = 0;
      source_.relaxation.lane[lane] = unit_.lane[lane] = 1;
      if (lane < block_.lanes) pairs_[lane] = &packer.plan.pair(index, lane);
    }
  }

  PackResult Pack(std::span<const double> impulses) {
    PutBodies();
    for (int i = 0; i < block_.row_count; ++i) {
      const RowShape& shape = block_.rows[i];
      if (!ReadRows(i, shape)) return PackResult::kStalePlan;
      if (!packer_.pack_row(block_.form, source_, a_, b_, line_)) return PackResult::kOutOfRange;
      line_ += simd::JacobianLines(block_.form) + 2;
      PutKind(shape);
      const PackResult result = PutImpulses(i, shape, impulses);
      if (result != PackResult::kDone) return result;
      line_ += simd::BoundLines(shape.bound) + 1;  // and the coupling
    }
    return PackResult::kDone;
  }

 private:
  void PutBodies() {
    const WhitenedBody no_body;
    for (int lane = 0; lane < block_.lanes; ++lane) {
      const Pair& pair = *pairs_[lane];
      rows_[lane] = packer_.plan.rows_of(pair).data();
      Prefetch(&packer_.problem.rows[rows_[lane][0]], sizeof(Row));
      const auto put = [&](int body, simd::BodyLines* lines) {
        Put(body != kWorld ? packer_.bodies[body] : no_body,
            packer_.ScaleOf(block_, lane, pair, body), lane, lines);
      };
      put(pair.a, &a_);
      if (block_.form != PairForm::kSingle) put(pair.b, &b_);
    }
    for (int lane = block_.lanes; lane < kLanes; ++lane) {
      Put(no_body, 1, lane, &a_);
      Put(no_body, 1, lane, &b_);
    }
    if (block_.form != PairForm::kContact) return;
    for (int lane = 0; lane < kLanes; ++lane) {
      const double s_a = a_.linear[0].lane[lane], s_b = b_.linear[0].lane[lane];
      const double r = std::sqrt(s_a * s_a + s_b * s_b);
      line_[0].lane[lane] = static_cast<float>(r > 0 ? s_a / r : 0);
      line_[1].lane[lane] = static_cast<float>(r > 0 ? s_b / r : 0);
    }
    line_ += simd::PairLines(block_.form);
  }

  /// Row @p i of every lane; false if one is not as planned.
  bool ReadRows(int i, const RowShape& shape) {
    const UsualKind usual(block_.form, shape, packer_.omega);
    const bool last = i + 1 == block_.row_count;
    bool as_planned = true;
    for (int lane = 0; lane < block_.lanes; ++lane) {
      const Row& row = packer_.problem.rows[rows_[lane][i]];
      if (!last) Prefetch(&packer_.problem.rows[rows_[lane][i + 1]], sizeof(Row));
      const Pair& pair = *pairs_[lane];
      const int parent = shape.parent >= 0 ? rows_[lane][shape.parent] : kNoRow;
      as_planned = as_planned && (usual.Fits(row, pair, parent) || Fits(row, pair, parent, shape));

      const bool straight = row.body_a == pair.a;
      source_.a[lane] = straight ? SideA(row) : SideB(row);
      source_.b[lane] = straight ? SideB(row) : SideA(row);
      source_.target.lane[lane] = row.target;
      if (block_.form == PairForm::kSingle) {
        source_.target.lane[lane] -= VelocityOfUnmoved(row.body_a, pair, SideA(row)) +
                                     VelocityOfUnmoved(row.body_b, pair, SideB(row));
      }
      bounds_.friction.lane[lane] = row.friction;
    }
    if (as_planned && !usual.exists()) ReadUnusual(i);
    return as_planned;
  }

  /// J v of one side of a row, if that is a body which rows cannot move, as a platform: to the
  /// kernel it is the world. @p side: its linear part, its angular part behind it
  double VelocityOfUnmoved(int body, const Pair& pair, const double* side) const {
    const bool is_body = body >= 0 && body < static_cast<int>(packer_.bodies.size());
    if (!is_body || body == pair.a) return 0;
    const Velocity& free = packer_.bodies[body].free;
    using Part = Eigen::Map<const Eigen::Vector3d>;
    return Part(side).dot(View(free.linear)) + Part(side + 3).dot(View(free.angular));
  }

  bool Fits(const Row& row, const Pair& pair, int parent, const RowShape& shape) const {
    return row.parent == parent && LikeParent(row) && HasShape(row, packer_.omega, shape) &&
           Joins(row, pair, packer_.movable) && HasValidKind(row) &&
           (block_.form != PairForm::kContact || ActsOpposite(row));
  }

  /// It names the bodies that its parent names. @pre the parent is the one that was planned for
  bool LikeParent(const Row& row) const {
    if (row.parent == kNoRow) return true;
    const Row& parent = packer_.problem.rows[row.parent];
    return (row.body_a == parent.body_a && row.body_b == parent.body_b) ||
           (row.body_a == parent.body_b && row.body_b == parent.body_a);
  }

  void ReadUnusual(int i) {
    for (int lane = 0; lane < block_.lanes; ++lane) {
      const Row& row = packer_.problem.rows[rows_[lane][i]];
      source_.compliance.lane[lane] = row.compliance;
      source_.relaxation.lane[lane] = packer_.omega * row.relaxation;
      bounds_.lo.lane[lane] = row.lo;
      bounds_.hi.lane[lane] = row.hi;
    }
    unusual_ = true;
  }

  void PutKind(const RowShape& shape) {
    if (!unusual_) return;
    const auto put = [this](const simd::DoubleLine& from) {
      for (int lane = 0; lane < kLanes; ++lane) {
        line_->lane[lane] = static_cast<float>(from.lane[lane]);
      }
      ++line_;
    };
    if (shape.soft) put(source_.compliance);
    if (shape.relaxed) put(source_.relaxation);
    // the next row is one without, unless it says so
    source_.compliance = {};
    source_.relaxation = unit_;
    unusual_ = false;
  }

  PackResult PutImpulses(int i, const RowShape& shape, std::span<const double> impulses) {
    Line* next = line_;
    const auto put = [this, &next](const simd::DoubleLine& from) {
      for (int lane = 0; lane < block_.lanes; ++lane) next->lane[lane] = Bound(from.lane[lane]);
      ++next;
    };
    if (shape.parent >= 0) put(bounds_.friction);
    if (shape.bound == RowBound::kOwn || shape.bound == RowBound::kCutFriction) {
      put(bounds_.lo);
      put(bounds_.hi);
    }

    bool in_range = true;
    for (int lane = 0; lane < block_.lanes; ++lane) {
      const double x = impulses[rows_[lane][i]];
      in_range = in_range && std::abs(x) <= kMost && bounds_.friction.lane[lane] <= kMost;
      x_[i].lane[lane] = static_cast<float>(x);
    }
    Clamp(shape.bound, line_, shape.parent >= 0 ? x_ + shape.parent : nullptr, x_ + i);
    return in_range ? PackResult::kDone : PackResult::kOutOfRange;
  }

  const BlockPacker& packer_;
  const simd::PairBlock& block_;
  Line* line_;  ///< next one to be filled
  Line* x_;
  const Pair* pairs_[kLanes] = {};
  const int* rows_[kLanes] = {};
  simd::BodyLines a_, b_;  ///< b_: unused for PairForm::kSingle
  simd::SourceRows source_;
  struct {
    simd::DoubleLine friction, lo, hi;
  } bounds_;
  simd::DoubleLine unit_;
  bool unusual_ = false;  ///< the row has more than the usual kind
};

}  // namespace

void BlockPacker::Reserve(BlockData* blocks) const {
  // not more than there is: some stages go over all of it
  blocks->data.resize(plan.data_lines());
  blocks->x.resize(plan.x_lines());
  if (!problem.manifolds.empty())
    blocks->directions.resize(2 * static_cast<size_t>(plan.x_lines()));
  blocks->bodies.resize(plan.slots());
  blocks->d_ratios.resize(plan.d_ratio_lines());
}

PackResult BlockPacker::Pack(int first_block, int count, const Impulses& impulses,
                             BlockData* blocks) const {
  for (int block = first_block; block < first_block + count; ++block) {
    const PackResult result = PackBlock(block, impulses, blocks);
    if (result != PackResult::kDone) return result;
    if (locked) ApplyLocks(*this, block, blocks);
    couple(plan.blocks()[block], blocks->data.data() + plan.blocks()[block].data);
    if (plan.blocks()[block].copies) FindRatios(plan.blocks()[block], blocks);
  }
  return PackResult::kDone;
}

/// Where copies add to d what whole bodies do not have.
void BlockPacker::FindRatios(const simd::PairBlock& block, BlockData* blocks) const {
  const Line* line = &blocks->data[block.data];
  // of the squares of G, by side and part: what is too much
  Line extra[4];
  const bool contact = block.form == PairForm::kContact;
  for (int lane = 0; lane < kLanes; ++lane) {
    const auto extra_of = [&](int slot) {
      const simd::BodyCopy* const copy = plan.copy_at(slot);
      return copy != nullptr ? 1 - copy->share * copy->share : 0.0f;
    };
    const float a = extra_of(block.a[lane]), b = extra_of(block.b[lane]);
    const float c_a = contact ? line[0].lane[lane] : 0, c_b = contact ? line[1].lane[lane] : 0;
    extra[0].lane[lane] = contact ? a * c_a * c_a + b * c_b * c_b : a;
    extra[1].lane[lane] = a;
    extra[2].lane[lane] = b;
    extra[3].lane[lane] = b;
  }
  line += simd::PairLines(block.form);
  for (int i = 0; i < block.row_count; ++i) {
    const RowShape& row = block.rows[i];
    const int numbers = simd::JacobianLines(block.form);
    Line sum = {};
    for (int k = 0; k < numbers; ++k) {
      for (int lane = 0; lane < kLanes; ++lane) {
        sum.lane[lane] += extra[k / 3].lane[lane] * line[k].lane[lane] * line[k].lane[lane];
      }
    }
    const Line& step = line[numbers + 1];
    const Line* const relaxation = row.relaxed ? &line[numbers + (row.soft ? 3 : 2)] : nullptr;
    Line& ratio = blocks->d_ratios[block.d_ratios + i];
    for (int lane = 0; lane < kLanes; ++lane) {
      // 1 / d, and so extra / d
      const float inv_d = step.lane[lane] / (relaxation != nullptr ? relaxation->lane[lane] : 1);
      ratio.lane[lane] = 1 / (1 - sum.lane[lane] * inv_d);
    }
    line += simd::RowLines(block.form, row);
  }
}

PackResult BlockPacker::PackBlock(int block, const Impulses& impulses, BlockData* blocks) const {
  switch (plan.pair(block, 0).source) {
    case RowSource::kRows:
      break;
    case RowSource::kJoint:
      return PackJoints(*this, block, impulses, blocks);
    case RowSource::kManifold:
      return PackManifolds(*this, block, impulses, blocks);
  }
  return OneBlock(*this, block, blocks).Pack(impulses.rows);
}

void BlockPacker::WriteImpulses(int first_block, int count, const BlockData& blocks,
                                const Impulses& impulses) const {
  for (int i = first_block; i < first_block + count; ++i) {
    switch (plan.pair(i, 0).source) {
      case RowSource::kRows:
        WriteRows(i, blocks, impulses);
        break;
      case RowSource::kJoint:
        WriteJoints(*this, i, blocks, impulses);
        break;
      case RowSource::kManifold:
        WriteManifolds(*this, i, blocks, impulses);
        break;
    }
  }
}

void BlockPacker::WriteRows(int index, const BlockData& blocks, const Impulses& impulses) const {
  const simd::PairBlock& block = plan.blocks()[index];
  for (int lane = 0; lane < block.lanes; ++lane) {
    const std::span<const int> rows = plan.rows_of(plan.pair(index, lane));
    for (int k = 0; k < block.row_count; ++k) {
      const double x = blocks.x[block.x + k].lane[lane];
      const bool may_be_outside = HasOwnBounds(block.rows[k].bound);
      impulses.rows[rows[k]] = may_be_outside ? InsideOwnBounds(x, problem.rows[rows[k]]) : x;
    }
  }
}

void BlockPacker::WriteVelocities(int first_body, int count, const BlockData& blocks,
                                  std::span<Velocity> velocities) const {
  for (int body = first_body; body < first_body + count; ++body) {
    const float* const u = blocks.bodies[plan.slot_of_body()[body]].u;
    velocities[body] = Unwhiten(bodies[body], Eigen::Vector3d(u[0], u[1], u[2]),
                                Eigen::Vector3d(u[4], u[5], u[6]));
  }
}

}  // namespace cairn
