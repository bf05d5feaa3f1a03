// SPDX-License-Identifier: MIT
#include "step/block_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cairn {
namespace {

using simd::kLanes;
using simd::Line;
using simd::LineOf;
using simd::RowBound;
using simd::RowShape;

/// The lines of one row; see simd::RowLines().
struct RowView {
  const RowShape& shape;
  const Line* target;
  const Line* step;
  const Line* compliance = nullptr;  ///< if soft
  const Line* relaxation = nullptr;  ///< if relaxed
  const Line* bounds = nullptr;

  RowView(simd::PairForm form, const RowShape& row, const Line* line)
      : shape(row), target(line + simd::JacobianLines(form)), step(target + 1) {
    const Line* next = step + 1;
    if (row.soft) compliance = next++;
    if (row.relaxed) relaxation = next++;
    bounds = next;
  }
  /// 1 / d
  template <class T>
  T InverseDiagonal(int lane) const {
    const T of_step = static_cast<T>(step->lane[lane]);
    return relaxation == nullptr ? of_step : of_step / static_cast<T>(relaxation->lane[lane]);
  }
};

/// function(i, view) for every row, in their order: parents come before their friction.
template <class Function>
void ForRows(const simd::PairBlock& block, const Line* lines, const Function& function) {
  lines += simd::PairLines(block.form);
  for (int i = 0; i < block.row_count; ++i) {
    function(i, RowView(block.form, block.rows[i], lines));
    lines += simd::RowLines(block.form, block.rows[i]);
  }
}

template <class T>
struct BoundLines {
  LineOf<T> lo, hi;
};

/// Of a row whose parent, if any, has the impulses @p parent.
template <class T>
void FindBounds(const RowView& row, const LineOf<T>* parent, BoundLines<T>* bounds) {
  constexpr T kInf = std::numeric_limits<T>::infinity();
  const Line* const b = row.bounds;
  const auto set = [bounds](const auto& lo, const auto& hi) {
    for (int l = 0; l < kLanes; ++l) bounds->lo.lane[l] = lo(l);
    for (int l = 0; l < kLanes; ++l) bounds->hi.lane[l] = hi(l);
  };
  const auto most = [b, parent](int l) {
    return static_cast<T>(b[0].lane[l]) * std::max(parent->lane[l], T{0});
  };
  switch (row.shape.bound) {
    case RowBound::kFree:
      return set([](int) { return -kInf; }, [](int) { return kInf; });
    case RowBound::kPush:
      return set([](int) { return T{0}; }, [](int) { return kInf; });
    case RowBound::kOwn:
      return set([b](int l) { return static_cast<T>(b[0].lane[l]); },
                 [b](int l) { return static_cast<T>(b[1].lane[l]); });
    case RowBound::kFriction:
      return set([&](int l) { return -most(l); }, most);
    case RowBound::kCutFriction:
      return set([&](int l) { return std::max(-most(l), static_cast<T>(b[1].lane[l])); },
                 [&](int l) { return std::min(most(l), static_cast<T>(b[2].lane[l])); });
  }
}

template <class T>
T AtBound(RowSide side, T x, T lo, T hi) {
  return side == RowSide::kFree ? x : side == RowSide::kLo ? lo : hi;
}

/// Bounds of rows in their order, while parents that are not free sit at their own bounds.
template <class T>
class PredictedBounds {
 public:
  explicit PredictedBounds(const BlockLaw<T>& law) : law_(law) {}

  void Find(const RowView& row, BoundLines<T>* bounds) {
    if (row.shape.parent < 0) return FindBounds<T>(row, nullptr, bounds);
    if (row.shape.parent != parent_) FindParent(row.shape.parent);
    FindBounds<T>(row, &parent_x_, bounds);
  }

 private:
  void FindParent(int parent) {
    parent_ = parent;
    const Line* lines = law_.lines + simd::PairLines(law_.block.form);
    for (int i = 0; i < parent; ++i) lines += simd::RowLines(law_.block.form, law_.block.rows[i]);
    BoundLines<T> own;
    FindBounds<T>(RowView(law_.block.form, law_.block.rows[parent], lines), nullptr, &own);
    for (int l = 0; l < kLanes; ++l) {
      parent_x_.lane[l] = AtBound(law_.sides[parent].lane[l], law_.x[parent].lane[l],
                                  own.lo.lane[l], own.hi.lane[l]);
    }
  }

  const BlockLaw<T>& law_;
  int parent_ = -1;
  LineOf<T> parent_x_;
};

}  // namespace

template <class T>
void BlockLaw<T>::FindSlack() const {
  ForRows(block, lines, [this](int i, const RowView& row) {
    for (int l = 0; l < kLanes; ++l) slack[i].lane[l] -= static_cast<T>(row.target->lane[l]);
    if (!row.shape.soft) return;
    for (int l = 0; l < kLanes; ++l) {
      slack[i].lane[l] += static_cast<T>(row.compliance->lane[l]) * x[i].lane[l];
    }
  });
}

template <class T>
void BlockLaw<T>::Predict() const {
  PredictedBounds<T> predicted(*this);
  BoundLines<T> bounds;
  ForRows(block, lines, [&](int i, const RowView& row) {
    predicted.Find(row, &bounds);
    for (int l = 0; l < kLanes; ++l) {
      const T lo = bounds.lo.lane[l], hi = bounds.hi.lane[l], near = lanes.tolerance.lane[l];
      const T natural = x[i].lane[l] - slack[i].lane[l] * row.InverseDiagonal<T>(l);
      const bool above = natural > lo + near, below = natural < hi - near;
      const RowSide inside = above ? (below ? RowSide::kFree : RowSide::kHi) : RowSide::kLo;
      sides[i].lane[l] = hi - lo > 2 * near ? inside : RowSide::kLo;
    }
  });
}

template <class T>
void BlockLaw<T>::FindWeights() const {
  ForRows(block, lines, [this](int i, const RowView& row) {
    const bool joint = row.shape.bound == RowBound::kFree;
    for (int l = 0; l < kLanes; ++l) {
      const T eps = joint ? lanes.proximal_joints.lane[l] : lanes.proximal.lane[l];
      const T soft = row.shape.soft ? static_cast<T>(row.compliance->lane[l]) : T{0};
      const T weight = lanes.taken.lane[l] / (soft + eps / row.InverseDiagonal<T>(l));
      weights[i].lane[l] = sides[i].lane[l] == RowSide::kFree ? weight : T{0};
    }
  });
}

template <class T>
void BlockLaw<T>::Fix() const {
  BoundLines<T> bounds;
  ForRows(block, lines, [&](int i, const RowView& row) {
    if (row.shape.bound == RowBound::kFree) return;
    FindBounds<T>(row, row.shape.parent < 0 ? nullptr : x + row.shape.parent, &bounds);
    for (int l = 0; l < kLanes; ++l) {
      const RowSide side = lanes.taken.lane[l] != 0 ? sides[i].lane[l] : RowSide::kFree;
      x[i].lane[l] = AtBound(side, x[i].lane[l], bounds.lo.lane[l], bounds.hi.lane[l]);
    }
  });
}

template <class T>
std::uint32_t BlockLaw<T>::RemoveViolated() const {
  PredictedBounds<T> predicted(*this);
  BoundLines<T> bounds;
  std::uint32_t removed = 0;
  ForRows(block, lines, [&](int i, const RowView& row) {
    if (row.shape.bound == RowBound::kFree) return;
    predicted.Find(row, &bounds);
    for (int l = 0; l < block.lanes; ++l) {
      RowSide& side = sides[i].lane[l];
      if (side != RowSide::kFree || lanes.taken.lane[l] == 0) continue;
      const T now = x[i].lane[l], near = lanes.tolerance.lane[l];
      // what is not a number leaves, too
      if (!(now >= bounds.lo.lane[l] - near)) {
        side = RowSide::kLo;
      } else if (now > bounds.hi.lane[l] + near) {
        side = RowSide::kHi;
      } else {
        continue;
      }
      removed |= std::uint32_t{1} << l;
    }
  });
  return removed;
}

template <class T>
void BlockLaw<T>::FindJointWeights() const {
  ForRows(block, lines, [&](int i, const RowView& row) {
    const bool condensed = row.shape.bound == RowBound::kFree && !row.shape.soft;
    for (int l = 0; l < kLanes; ++l) {
      const T eps = lanes.proximal_joints.lane[l];
      const T weight = lanes.taken.lane[l] / (eps / row.InverseDiagonal<T>(l));
      weights[i].lane[l] = condensed && lanes.taken.lane[l] != 0 ? weight : T{0};
    }
  });
}

template <class T>
void BlockLaw<T>::CopyWeighted(LineOf<T>* joints) const {
  for (int i = 0; i < block.row_count; ++i) {
    for (int l = 0; l < kLanes; ++l) {
      joints[i].lane[l] = weights[i].lane[l] != 0 ? x[i].lane[l] : T{0};
    }
  }
}

template <class T>
void BlockLaw<T>::ClearWeighted() const {
  for (int i = 0; i < block.row_count; ++i) {
    for (int l = 0; l < kLanes; ++l) {
      x[i].lane[l] = weights[i].lane[l] != 0 ? T{0} : x[i].lane[l];
    }
  }
}

template <class T>
LineOf<T> BlockLaw<T>::FindJointSpeeds() const {
  LineOf<T> speeds = {};
  ForRows(block, lines, [&](int i, const RowView& row) {
    if (row.shape.bound != RowBound::kFree) return;
    for (int l = 0; l < kLanes; ++l) {
      const T speed = std::abs(x[i].lane[l]) / row.InverseDiagonal<T>(l);
      speeds.lane[l] = std::max(speeds.lane[l], speed);
    }
  });
  return speeds;
}

template <class T>
void BlockLaw<T>::Project() const {
  BoundLines<T> bounds;
  ForRows(block, lines, [&](int i, const RowView& row) {
    if (row.shape.bound == RowBound::kFree) return;
    FindBounds<T>(row, row.shape.parent < 0 ? nullptr : x + row.shape.parent, &bounds);
    for (int l = 0; l < kLanes; ++l) {
      x[i].lane[l] = std::min(std::max(x[i].lane[l], bounds.lo.lane[l]), bounds.hi.lane[l]);
    }
  });
}

template struct BlockLaw<float>;
template struct BlockLaw<double>;

}  // namespace cairn
