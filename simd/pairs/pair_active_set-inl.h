// SPDX-License-Identifier: MIT
// Laws of rows in a subspace step, lane by lane: plain loops over the lanes of a line, which the
// compiler turns into vectors of each target. Compiled once per target.
#if defined(CAIRN_SIMD_PAIR_ACTIVE_SET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_PAIR_ACTIVE_SET_INL_H_
#undef CAIRN_SIMD_PAIR_ACTIVE_SET_INL_H_
#else
#define CAIRN_SIMD_PAIR_ACTIVE_SET_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "simd/pairs/pair_active_set.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace active_sets {

/// line := what function(lane) gives. Through numbers of its own, which alias with nothing.
template <class T, int n, class LineT, class Function>
HWY_INLINE void Fill(LineT* line, const Function& function) {
  T all[n];
  for (int l = 0; l < n; ++l) all[l] = function(l);
  for (int l = 0; l < n; ++l) line->lane[l] = all[l];
}

/// The lines of one row; see RowLines().
struct RowView {
  const RowShape& shape;
  const Line* target;
  const Line* step;
  const Line* compliance = nullptr;  ///< if soft
  const Line* relaxation = nullptr;  ///< if relaxed
  const Line* bounds = nullptr;

  RowView(PairForm form, const RowShape& row, const Line* line)
      : shape(row), target(line + JacobianLines(form)), step(target + 1) {
    const Line* next = step + 1;
    if (row.soft) compliance = next++;
    if (row.relaxed) relaxation = next++;
    bounds = next;
  }
};

/// function(i, view) for every row, in their order: parents come before their friction.
template <class Function>
void ForRows(const PairBlock& block, const Line* lines, const Function& function) {
  lines += PairLines(block.form);
  for (int i = 0; i < block.row_count; ++i) {
    function(i, RowView(block.form, block.rows[i], lines));
    lines += RowLines(block.form, block.rows[i]);
  }
}

template <class T>
struct BoundLines {
  LineOf<T> lo, hi;
};

/// Of a row whose parent, if any, has the impulses @p parent.
template <class T, int n>
void FindBounds(const RowView& row, const LineOf<T>* parent, BoundLines<T>* bounds) {
  constexpr T kInf = std::numeric_limits<T>::infinity();
  const Line* const b = row.bounds;
  const auto set = [bounds](const auto& lo, const auto& hi) {
    Fill<T, n>(&bounds->lo, lo);
    Fill<T, n>(&bounds->hi, hi);
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
template <class T, int n>
class PredictedBounds {
 public:
  explicit PredictedBounds(const PairActiveSet<T>& set) : set_(set) {}

  void Find(const RowView& row, BoundLines<T>* bounds) {
    if (row.shape.parent < 0) return FindBounds<T, n>(row, nullptr, bounds);
    if (row.shape.parent != parent_) FindParent(row.shape.parent);
    FindBounds<T, n>(row, &parent_x_, bounds);
  }

 private:
  void FindParent(int parent) {
    parent_ = parent;
    const Line* lines = set_.lines + PairLines(set_.block.form);
    for (int i = 0; i < parent; ++i) lines += RowLines(set_.block.form, set_.block.rows[i]);
    BoundLines<T> own;
    FindBounds<T, n>(RowView(set_.block.form, set_.block.rows[parent], lines), nullptr, &own);
    for (int l = 0; l < n; ++l) {
      parent_x_.lane[l] = AtBound(set_.sides[parent].lane[l], set_.x[parent].lane[l],
                                  own.lo.lane[l], own.hi.lane[l]);
    }
  }

  const PairActiveSet<T>& set_;
  int parent_ = -1;
  LineOf<T> parent_x_;
};

template <class T, int n>
HWY_INLINE void FindInverseDiagonals(const RowView& row, LineOf<T>* inverse) {
  Fill<T, n>(inverse, [&](int l) { return static_cast<T>(row.step->lane[l]); });
  if (row.relaxation == nullptr) return;
  Fill<T, n>(inverse,
             [&](int l) { return inverse->lane[l] / static_cast<T>(row.relaxation->lane[l]); });
}

template <class T, int n>
HWY_INLINE void FindCompliances(const RowView& row, LineOf<T>* compliance) {
  if (row.shape.soft) {
    Fill<T, n>(compliance, [&](int l) { return static_cast<T>(row.compliance->lane[l]); });
  } else {
    Fill<T, n>(compliance, [](int) { return T{0}; });
  }
}

template <class T, int n>
void FindRelativeVelocities(const PairActiveSet<T>& set) {
  LineOf<T> compliance;
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    LineOf<T>* const w = &set.w[i];
    Fill<T, n>(w, [&](int l) { return w->lane[l] - static_cast<T>(row.target->lane[l]); });
    if (!row.shape.soft) return;
    FindCompliances<T, n>(row, &compliance);
    Fill<T, n>(w, [&](int l) { return w->lane[l] + compliance.lane[l] * set.x[i].lane[l]; });
  });
}

template <class T, int n>
void Predict(const PairActiveSet<T>& set) {
  PredictedBounds<T, n> predicted(set);
  BoundLines<T> bounds;
  LineOf<T> inverse;
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    predicted.Find(row, &bounds);
    FindInverseDiagonals<T, n>(row, &inverse);
    Fill<RowSide, n>(&set.sides[i], [&](int l) {
      const T lo = bounds.lo.lane[l], hi = bounds.hi.lane[l], near = set.lanes.tolerance.lane[l];
      const T natural = set.x[i].lane[l] - set.w[i].lane[l] * inverse.lane[l];
      const RowSide up = natural < hi - near ? RowSide::kFree : RowSide::kHi;
      const RowSide inside = natural > lo + near ? up : RowSide::kLo;
      return hi - lo > 2 * near ? inside : RowSide::kLo;
    });
  });
}

template <class T, int n>
void FindWeights(const PairActiveSet<T>& set) {
  LineOf<T> inverse, compliance;
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    const bool joint = row.shape.bound == RowBound::kFree;
    const LineOf<T>& eps = joint ? set.lanes.proximal_joints : set.lanes.proximal;
    FindInverseDiagonals<T, n>(row, &inverse);
    FindCompliances<T, n>(row, &compliance);
    Fill<T, n>(&set.weights[i], [&](int l) {
      const T weight =
          set.lanes.taken.lane[l] / (compliance.lane[l] + eps.lane[l] / inverse.lane[l]);
      return set.sides[i].lane[l] == RowSide::kFree ? weight : T{0};
    });
  });
}

template <class T, int n>
void Fix(const PairActiveSet<T>& set) {
  BoundLines<T> bounds;
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    if (row.shape.bound == RowBound::kFree) return;
    FindBounds<T, n>(row, row.shape.parent < 0 ? nullptr : set.x + row.shape.parent, &bounds);
    Fill<T, n>(&set.x[i], [&](int l) {
      const RowSide side = set.lanes.taken.lane[l] != 0 ? set.sides[i].lane[l] : RowSide::kFree;
      return AtBound(side, set.x[i].lane[l], bounds.lo.lane[l], bounds.hi.lane[l]);
    });
  });
}

template <class T, int n>
std::uint32_t RemoveViolated(const PairActiveSet<T>& set) {
  PredictedBounds<T, n> predicted(set);
  BoundLines<T> bounds;
  SideLine before;
  std::int32_t crossed[n] = {};
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    if (row.shape.bound == RowBound::kFree) return;
    predicted.Find(row, &bounds);
    before = set.sides[i];
    Fill<RowSide, n>(&set.sides[i], [&](int l) {
      const T now = set.x[i].lane[l], near = set.lanes.tolerance.lane[l];
      // what is not a number leaves, too
      const RowSide side = now > bounds.hi.lane[l] + near ? RowSide::kHi : RowSide::kFree;
      const RowSide left = now >= bounds.lo.lane[l] - near ? side : RowSide::kLo;
      const bool looked_at = before.lane[l] == RowSide::kFree && set.lanes.taken.lane[l] != 0;
      return looked_at ? left : before.lane[l];
    });
    for (int l = 0; l < n; ++l) crossed[l] |= set.sides[i].lane[l] != before.lane[l] ? 1 : 0;
  });
  std::uint32_t removed = 0;
  for (int l = 0; l < n; ++l) removed |= static_cast<std::uint32_t>(crossed[l]) << l;
  return removed;
}

template <class T, int n>
void FindJointWeights(const PairActiveSet<T>& set) {
  LineOf<T> inverse;
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    const bool condensed = row.shape.bound == RowBound::kFree && !row.shape.soft;
    if (!condensed) return Fill<T, n>(&set.weights[i], [](int) { return T{0}; });
    FindInverseDiagonals<T, n>(row, &inverse);
    Fill<T, n>(&set.weights[i], [&](int l) {
      const T weight =
          set.lanes.taken.lane[l] / (set.lanes.proximal_joints.lane[l] / inverse.lane[l]);
      return set.lanes.taken.lane[l] != 0 ? weight : T{0};
    });
  });
}

template <class T, int n>
void CopyWeighted(const PairActiveSet<T>& set) {
  for (int i = 0; i < set.block.row_count; ++i) {
    Fill<T, n>(&set.product[i],
               [&](int l) { return set.weights[i].lane[l] != 0 ? set.x[i].lane[l] : T{0}; });
  }
}

template <class T, int n>
void ClearWeighted(const PairActiveSet<T>& set) {
  for (int i = 0; i < set.block.row_count; ++i) {
    Fill<T, n>(&set.x[i],
               [&](int l) { return set.weights[i].lane[l] != 0 ? T{0} : set.x[i].lane[l]; });
  }
}

template <class T, int n>
LineOf<T> FindJointSpeeds(const PairActiveSet<T>& set) {
  LineOf<T> speeds = {}, inverse;
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    if (row.shape.bound != RowBound::kFree) return;
    FindInverseDiagonals<T, n>(row, &inverse);
    for (int l = 0; l < n; ++l) {
      const T speed = std::abs(set.x[i].lane[l]) / inverse.lane[l];
      speeds.lane[l] = std::max(speeds.lane[l], speed);
    }
  });
  return speeds;
}

template <class T, int n>
void Weigh(const PairActiveSet<T>& set) {
  for (int i = 0; i < set.block.row_count; ++i) {
    Fill<T, n>(&set.product[i],
               [&](int l) { return -(set.weights[i].lane[l] * set.w[i].lane[l]); });
  }
}

template <class T, int n>
void Advance(const PairActiveSet<T>& set) {
  for (int i = 0; i < set.block.row_count; ++i) {
    Fill<T, n>(&set.x[i], [&](int l) {
      const T w = set.w[i].lane[l] + set.product[i].lane[l];
      return set.x[i].lane[l] - set.weights[i].lane[l] * w;
    });
  }
}

template <class T, int n>
void Project(const PairActiveSet<T>& set) {
  BoundLines<T> bounds;
  ForRows(set.block, set.lines, [&](int i, const RowView& row) {
    if (row.shape.bound == RowBound::kFree) return;
    FindBounds<T, n>(row, row.shape.parent < 0 ? nullptr : set.x + row.shape.parent, &bounds);
    Fill<T, n>(&set.x[i], [&](int l) {
      return std::min(std::max(set.x[i].lane[l], bounds.lo.lane[l]), bounds.hi.lane[l]);
    });
  });
}

/// In few lanes where the block has no more: lone towers and hubs fill one of them.
constexpr int kFewLanes = 4;
template <class T, auto few, auto all>
auto InLanes(const PairActiveSet<T>& set) {
  return set.block.lanes <= kFewLanes ? few(set) : all(set);
}

template <class T>
constexpr ActiveSetKernels<T> kKernels = {
    InLanes<T, FindRelativeVelocities<T, kFewLanes>, FindRelativeVelocities<T, kLanes>>,
    InLanes<T, Predict<T, kFewLanes>, Predict<T, kLanes>>,
    InLanes<T, FindWeights<T, kFewLanes>, FindWeights<T, kLanes>>,
    InLanes<T, Fix<T, kFewLanes>, Fix<T, kLanes>>,
    InLanes<T, RemoveViolated<T, kFewLanes>, RemoveViolated<T, kLanes>>,
    InLanes<T, Weigh<T, kFewLanes>, Weigh<T, kLanes>>,
    InLanes<T, Advance<T, kFewLanes>, Advance<T, kLanes>>,
    InLanes<T, FindJointWeights<T, kFewLanes>, FindJointWeights<T, kLanes>>,
    InLanes<T, CopyWeighted<T, kFewLanes>, CopyWeighted<T, kLanes>>,
    InLanes<T, ClearWeighted<T, kFewLanes>, ClearWeighted<T, kLanes>>,
    InLanes<T, FindJointSpeeds<T, kFewLanes>, FindJointSpeeds<T, kLanes>>,
    InLanes<T, Project<T, kFewLanes>, Project<T, kLanes>>};

}  // namespace active_sets
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
