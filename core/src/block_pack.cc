// SPDX-License-Identifier: MIT
#include "block_pack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace cairn {
namespace {

using simd::kLanes;
using simd::Line;
using simd::PairForm;
using simd::RowBound;
using simd::RowShape;

/// Impulses beyond this are left to double precision.
constexpr double kMost = 1e18;

/// J of what is not there.
constexpr double kNothing[6] = {};

/// The two sides of a row are six numbers each, in the order of SourceRows.
static_assert(offsetof(Row, angular_a) == offsetof(Row, linear_a) + 3 * sizeof(double));
static_assert(offsetof(Row, angular_b) == offsetof(Row, linear_b) + 3 * sizeof(double));

/// The row still joins the bodies that it was planned for.
bool Joins(const Row& row, const Pair& pair, const MovableBodies& movable) {
  const auto is = [&movable](int body, int planned) {
    if (planned != kWorld) return body == planned;
    return body == kWorld ||
           (body >= 0 && body < static_cast<int>(movable.size()) && movable[body] == 0);
  };
  const bool same = row.body_a != row.body_b || row.body_a == kWorld;
  return same && ((is(row.body_a, pair.a) && is(row.body_b, pair.b)) ||
                  (is(row.body_b, pair.a) && is(row.body_a, pair.b)));
}

/// Its numbers may be used, apart from what its Jacobian and target show.
bool HasValidLaw(const Row& row) {
  return row.compliance >= 0 && row.relaxation > 0 && row.relaxation < 2 && row.friction >= 0 &&
         row.lo <= row.hi && row.lo < kInfinity && row.hi > -kInfinity &&
         (row.parent == kNoRow || (row.lo <= 0 && row.hi >= 0));
}

float Bound(double value) {
  constexpr double kMostFloat = std::numeric_limits<float>::max();
  if (value > kMostFloat) return std::numeric_limits<float>::infinity();
  if (value < -kMostFloat) return -std::numeric_limits<float>::infinity();
  return static_cast<float>(value);
}

/// @p b: the bounds of the row as the kernel has them.
float Clamp(RowBound bound, const float* b, float parent, float x) {
  switch (bound) {
    case RowBound::kFree:
      return x;
    case RowBound::kPush:
      return std::max(x, 0.0f);
    case RowBound::kOwn:
      return std::min(std::max(x, b[0]), b[1]);
    case RowBound::kFriction:
    case RowBound::kCutFriction:
      break;
  }
  const float most = b[0] * std::max(parent, 0.0f);
  if (bound == RowBound::kFriction) return std::min(std::max(x, -most), most);
  return std::min(std::max(x, std::max(-most, b[1])), std::min(most, b[2]));
}

void Put(const WhitenedBody& body, int lane, simd::BodyLines* lines) {
  for (int k = 0; k < 3; ++k) {
    lines->linear[k].lane[lane] = body.linear[k];
    lines->velocity[k].lane[lane] = body.free.linear[k];
    lines->velocity[3 + k].lane[lane] = body.free.angular[k];
  }
  for (int k = 0; k < 9; ++k) lines->angular[k].lane[lane] = body.angular.data()[k];
}

void Prefetch(const Row& row) {
  const char* const bytes = reinterpret_cast<const char*>(&row);
  for (size_t at = 0; at < sizeof(Row); at += 64) __builtin_prefetch(bytes + at);
}

/// Fills one block, row by row.
class OneBlock {
 public:
  OneBlock(const BlockPacker& packer, int index, BlockData* blocks)
      : packer_(packer),
        block_(packer.plan.blocks()[index]),
        line_(blocks->data.data() + block_.data),
        x_(blocks->x.data() + block_.x),
        a_{},
        b_{} {
    for (int lane = 0; lane < kLanes; ++lane) {
      source_.a[lane] = source_.b[lane] = kNothing;
      source_.target.lane[lane] = source_.compliance.lane[lane] = 0;
      source_.relaxation.lane[lane] = 1;
      if (lane < block_.lanes) pairs_[lane] = &packer.plan.pair(index, lane);
    }
  }

  PackResult Pack(std::span<const double> impulses) {
    PutBodies();
    for (int i = 0; i < block_.row_count; ++i) {
      const RowShape& shape = block_.rows[i];
      if (!ReadRows(i, shape)) return PackResult::kChanged;
      if (!packer_.pack_row(block_.form, source_, a_, b_, line_)) return PackResult::kOutOfRange;
      line_ += simd::JacobianLines(block_.form) + 2;
      PutLaw(shape);
      const PackResult result = PutImpulses(i, shape, impulses);
      if (result != PackResult::kDone) return result;
      line_ += simd::BoundLines(shape.bound);
    }
    return PackResult::kDone;
  }

 private:
  void PutBodies() {
    for (int lane = 0; lane < block_.lanes; ++lane) {
      const Pair& pair = *pairs_[lane];
      rows_[lane] = packer_.plan.rows_of(pair).data();
      Prefetch(packer_.problem.rows[rows_[lane][0]]);
      if (pair.a != kWorld) Put(packer_.bodies[pair.a], lane, &a_);
      if (pair.b != kWorld) Put(packer_.bodies[pair.b], lane, &b_);
    }
    if (block_.form != PairForm::kContact) return;
    for (int lane = 0; lane < kLanes; ++lane) {
      line_[0].lane[lane] = static_cast<float>(a_.linear[0].lane[lane]);
      line_[1].lane[lane] = static_cast<float>(b_.linear[0].lane[lane]);
    }
    line_ += simd::PairLines(block_.form);
  }

  /// Row @p i of every lane; false if one is not as planned.
  bool ReadRows(int i, const RowShape& shape) {
    bool as_planned = true;
    for (int lane = 0; lane < block_.lanes; ++lane) {
      const Row& row = packer_.problem.rows[rows_[lane][i]];
      if (i + 1 < block_.row_count) Prefetch(packer_.problem.rows[rows_[lane][i + 1]]);
      const Pair& pair = *pairs_[lane];
      const int parent = shape.parent >= 0 ? rows_[lane][shape.parent] : kNoRow;
      as_planned = as_planned && row.parent == parent && HasShape(row, packer_.omega, shape) &&
                   Joins(row, pair, packer_.movable) && HasValidLaw(row) &&
                   (block_.form != PairForm::kContact || ActsOpposite(row));

      const bool straight = row.body_a == pair.a;
      source_.a[lane] = (straight ? row.linear_a : row.linear_b).data();
      source_.b[lane] = (straight ? row.linear_b : row.linear_a).data();
      source_.target.lane[lane] = row.target;
      source_.compliance.lane[lane] = row.compliance;
      source_.relaxation.lane[lane] = packer_.omega * row.relaxation;
      bounds_.friction.lane[lane] = row.friction;
      bounds_.lo.lane[lane] = row.lo;
      bounds_.hi.lane[lane] = row.hi;
    }
    return as_planned;
  }

  void PutLaw(const RowShape& shape) {
    const auto put = [this](const simd::DoubleLine& from) {
      for (int lane = 0; lane < kLanes; ++lane) {
        line_->lane[lane] = static_cast<float>(from.lane[lane]);
      }
      ++line_;
    };
    if (shape.soft) put(source_.compliance);
    if (shape.relaxed) put(source_.relaxation);
  }

  PackResult PutImpulses(int i, const RowShape& shape, std::span<const double> impulses) {
    const bool own = shape.bound == RowBound::kOwn || shape.bound == RowBound::kCutFriction;
    for (int lane = 0; lane < block_.lanes; ++lane) {
      float bounds[3] = {};
      float* next = bounds;
      if (shape.parent >= 0) *next++ = Bound(bounds_.friction.lane[lane]);
      if (own) {
        *next++ = Bound(bounds_.lo.lane[lane]);
        *next++ = Bound(bounds_.hi.lane[lane]);
      }
      for (int k = 0; k < next - bounds; ++k) line_[k].lane[lane] = bounds[k];

      const double x = impulses[rows_[lane][i]];
      if (!(std::abs(x) <= kMost)) return PackResult::kOutOfRange;
      const float parent = shape.parent >= 0 ? x_[shape.parent].lane[lane] : 0;
      x_[i].lane[lane] = Clamp(shape.bound, bounds, parent, static_cast<float>(x));
    }
    return PackResult::kDone;
  }

  const BlockPacker& packer_;
  const simd::PairBlock& block_;
  Line* line_;  ///< next one to be filled
  Line* x_;
  const Pair* pairs_[kLanes] = {};
  const int* rows_[kLanes] = {};
  simd::BodyLines a_, b_;
  simd::SourceRows source_;
  struct {
    simd::DoubleLine friction, lo, hi;
  } bounds_;
};

template <class T>
void Grow(size_t size, std::vector<T>* values) {
  if (values->size() < size) values->resize(size);
}

}  // namespace

void BlockPacker::Reserve(BlockData* blocks) const {
  Grow(plan.data_lines(), &blocks->data);
  Grow(plan.x_lines(), &blocks->x);
  Grow(plan.body_of_slot().size(), &blocks->bodies);
}

PackResult BlockPacker::Pack(int first_block, int count, std::span<const double> impulses,
                             BlockData* blocks) const {
  for (int block = first_block; block < first_block + count; ++block) {
    const PackResult result = OneBlock(*this, block, blocks).Pack(impulses);
    if (result != PackResult::kDone) return result;
  }
  return PackResult::kDone;
}

void BlockPacker::WriteImpulses(int first_block, int count, const BlockData& blocks,
                                std::span<double> impulses) const {
  for (int i = first_block; i < first_block + count; ++i) {
    const simd::PairBlock& block = plan.blocks()[i];
    for (int lane = 0; lane < block.lanes; ++lane) {
      const std::span<const int> rows = plan.rows_of(plan.pair(i, lane));
      for (int k = 0; k < block.row_count; ++k) {
        impulses[rows[k]] = static_cast<double>(blocks.x[block.x + k].lane[lane]);
      }
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
