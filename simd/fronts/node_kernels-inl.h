// SPDX-License-Identifier: MIT
// Elimination of nodes with few neighbours, lane by lane. Compiled once per target.
#if defined(CAIRN_SIMD_NODE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_NODE_KERNELS_INL_H_
#undef CAIRN_SIMD_NODE_KERNELS_INL_H_
#else
#define CAIRN_SIMD_NODE_KERNELS_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <limits>

#include <hwy/highway.h>

#include "simd/fronts/node_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace nodes {
namespace hn = hwy::HWY_NAMESPACE;

/// A number of each node, of at most @p most of them.
template <class T, int most>
struct alignas(std::min<std::size_t>(most * sizeof(T), 64)) NodeLine {
  using Number = T;
  static constexpr int kMost = most;
  T lane[most];
};

template <class L>
using Number = typename L::Number;
/// As many lanes as fit a register.
template <class L>
using Lanes = hn::CappedTag<Number<L>, L::kMost>;
template <class L>
using V = hn::Vec<Lanes<L>>;
template <class L>
constexpr int kWidth = static_cast<int>(hn::MaxLanes(Lanes<L>()));

constexpr int kRows = kNodeRows;

/// Place of a number of the lower triangle, column by column.
constexpr int Lower(int row, int column) {
  return column * kRows - column * (column - 1) / 2 + row - column;
}

template <class L>
HWY_INLINE V<L> At(const L& line, int lane) {
  return hn::Load(Lanes<L>(), line.lane + lane);
}
template <class L>
HWY_INLINE void Put(V<L> v, L* line, int lane) {
  hn::Store(v, Lanes<L>(), line->lane + lane);
}

/// Columns of the factor of the nodes of one NodeLanes.
template <class L>
struct Columns {
  L factor[kNodeTriangle];  ///< by column, 1 / L_kk on the diagonal
  L below[kMostNeighbours][kNodeSquare];
  L solved[kNodeRows];  ///< between solves down and up
};

/// function(lane) for as many lanes at a time as fit a register, as far as they are in use.
template <class L, class Function>
HWY_INLINE void ForLanes(int lanes, const Function& function) {
  for (int lane = 0; lane < lanes; lane += kWidth<L>) function(lane);
}

template <class L>
void ReadTriangles(const NodeLanes& nodes, const Number<L>* blocks, L* to) {
  for (int l = 0; l < nodes.lanes; ++l) {
    const Number<L>* const from = blocks + nodes.diagonal[l];
    for (int c = 0, at = 0; c < kRows; ++c) {
      for (int r = c; r < kRows; ++r) to[at++].lane[l] = from[kRows * c + r];
    }
  }
}

/// Rows of the neighbour, columns of the node.
template <class L>
void ReadSquares(const NodeLanes::Neighbour& neighbour, int lanes, const Number<L>* blocks, L* to) {
  for (int l = 0; l < lanes; ++l) {
    const Number<L>* const from = blocks + neighbour.block[l];
    if ((neighbour.turned >> l & 1) != 0) {
      for (int c = 0; c < kRows; ++c) {
        for (int r = 0; r < kRows; ++r) to[kRows * c + r].lane[l] = from[kRows * r + c];
      }
    } else {
      for (int k = 0; k < kNodeSquare; ++k) to[k].lane[l] = from[k];
    }
  }
}

/// The triangle := its factor, in some lanes. From one pivot to the next there is a division, but
/// no root. @p failed: 1 where a pivot is too small.
template <class L>
HWY_NOINLINE void FactorTriangle(const L* floors, int lane, L* triangle, L* failed) {
  const Lanes<L> d;
  const V<L> one = hn::Set(d, Number<L>{1}),
             most = hn::Set(d, std::numeric_limits<Number<L>>::max());
  V<L> c[kRows][kRows], inverses[kRows], good = one;
  HWY_UNROLL(6)
  for (int k = 0; k < kRows; ++k) {
    HWY_UNROLL(6)
    for (int i = k; i < kRows; ++i) c[k][i] = At(triangle[Lower(i, k)], lane);
  }
  HWY_UNROLL(6)
  for (int k = 0; k < kRows; ++k) {
    // neither holds for what is not a number
    const auto fits = hn::And(hn::Gt(c[k][k], At(floors[k], lane)), hn::Le(c[k][k], most));
    good = hn::IfThenElseZero(fits, good);
    inverses[k] = hn::Div(one, c[k][k]);
    HWY_UNROLL(6)
    for (int j = k + 1; j < kRows; ++j) {
      const V<L> scaled = hn::Mul(c[k][j], inverses[k]);
      HWY_UNROLL(6)
      for (int i = j; i < kRows; ++i) c[j][i] = hn::Sub(c[j][i], hn::Mul(c[k][i], scaled));
    }
  }
  HWY_UNROLL(6)
  for (int k = 0; k < kRows; ++k) {
    const V<L> inverse_root = hn::Sqrt(inverses[k]);
    Put(inverse_root, &triangle[Lower(k, k)], lane);
    HWY_UNROLL(6)
    for (int i = k + 1; i < kRows; ++i) {
      Put(hn::Mul(c[k][i], inverse_root), &triangle[Lower(i, k)], lane);
    }
  }
  Put(hn::Sub(one, good), failed, lane);
}

/// The square from the right with the inverse of the transpose of the factor, in some lanes.
template <class L>
HWY_NOINLINE void SolveSquare(const L* factor, int lane, L* square) {
  for (int c = 0; c < kRows; ++c) {
    V<L> column[kRows];
    HWY_UNROLL(6)
    for (int r = 0; r < kRows; ++r) column[r] = At(square[kRows * c + r], lane);
    for (int k = 0; k < c; ++k) {
      const V<L> l = At(factor[Lower(c, k)], lane);
      HWY_UNROLL(6)
      for (int r = 0; r < kRows; ++r) {
        column[r] = hn::Sub(column[r], hn::Mul(At(square[kRows * k + r], lane), l));
      }
    }
    const V<L> inverse = At(factor[Lower(c, c)], lane);
    HWY_UNROLL(6)
    for (int r = 0; r < kRows; ++r) {
      Put(hn::Mul(column[r], inverse), &square[kRows * c + r], lane);
    }
  }
}

/// Column @p c of  rows columns',  from row @p first on.
template <class L, int first>
HWY_INLINE void MultiplyColumn(const L* rows, const L* columns, int c, int lane, L* product) {
  V<L> sum[kRows - first];
  HWY_UNROLL(6)
  for (int r = 0; r < kRows - first; ++r) sum[r] = hn::Zero(Lanes<L>());
  for (int k = 0; k < kRows; ++k) {
    const V<L> number = At(columns[kRows * k + c], lane);
    HWY_UNROLL(6)
    for (int r = 0; r < kRows - first; ++r) {
      sum[r] = hn::Add(sum[r], hn::Mul(At(rows[kRows * k + first + r], lane), number));
    }
  }
  HWY_UNROLL(6)
  for (int r = 0; r < kRows - first; ++r) Put(sum[r], &product[r], lane);
}

template <class L>
HWY_NOINLINE void MultiplyToTriangle(const L* rows, int lane, L* product) {
  MultiplyColumn<L, 0>(rows, rows, 0, lane, product + Lower(0, 0));
  MultiplyColumn<L, 1>(rows, rows, 1, lane, product + Lower(1, 1));
  MultiplyColumn<L, 2>(rows, rows, 2, lane, product + Lower(2, 2));
  MultiplyColumn<L, 3>(rows, rows, 3, lane, product + Lower(3, 3));
  MultiplyColumn<L, 4>(rows, rows, 4, lane, product + Lower(4, 4));
  MultiplyColumn<L, 5>(rows, rows, 5, lane, product + Lower(5, 5));
}

template <class L>
HWY_NOINLINE void MultiplyToSquare(const L* rows, const L* columns, int lane, L* product) {
  for (int c = 0; c < kRows; ++c) {
    MultiplyColumn<L, 0>(rows, columns, c, lane, product + kRows * c);
  }
}

/// Lane by lane: a node that is a neighbour of some sees them in their order, whatever is between.
template <class L>
void SubtractTriangles(const NodeLanes& nodes, const L (*product)[kNodeTriangle],
                       Number<L>* blocks) {
  for (int l = 0; l < nodes.with[0]; ++l) {
    for (int i = 0; i < kMostNeighbours && l < nodes.with[i]; ++i) {
      Number<L>* const to = blocks + nodes.neighbours[i].diagonal[l];
      for (int c = 0, at = 0; c < kRows; ++c) {
        for (int r = c; r < kRows; ++r) to[kRows * c + r] -= product[i][at++].lane[l];
      }
    }
  }
}

template <class L>
bool Eliminate(const NodeLanes& nodes, const Number<L>* floors, Number<L>* blocks,
               Columns<L>* columns) {
  L floor[kRows], failed, product[kMostNeighbours][kNodeTriangle], between[kNodeSquare];
  ReadTriangles(nodes, blocks, columns->factor);
  for (int l = 0; l < nodes.lanes; ++l) {
    for (int k = 0; k < kRows; ++k) floor[k].lane[l] = floors[kRows * nodes.node[l] + k];
  }
  ForLanes<L>(nodes.lanes,
              [&](int lane) HWY_ATTR { FactorTriangle(floor, lane, columns->factor, &failed); });
  for (int l = 0; l < nodes.lanes; ++l) {
    if (failed.lane[l] != 0) return false;
  }
  for (int i = 0; i < kMostNeighbours; ++i) {
    const NodeLanes::Neighbour& neighbour = nodes.neighbours[i];
    L* const below = columns->below[i];
    ReadSquares(neighbour, nodes.with[i], blocks, below);
    ForLanes<L>(nodes.with[i], [&](int lane) HWY_ATTR {
      SolveSquare(columns->factor, lane, below);
      MultiplyToTriangle(below, lane, product[i]);
    });
  }
  SubtractTriangles(nodes, product, blocks);
  const int both = nodes.with[1];
  ForLanes<L>(both, [&](int lane) HWY_ATTR {
    MultiplyToSquare(columns->below[0], columns->below[1], lane, between);
  });
  for (int l = 0; l < both; ++l) {
    Number<L>* const to = blocks + nodes.between[l];
    for (int k = 0; k < kNodeSquare; ++k) to[k] -= between[k].lane[l];
  }
  return true;
}

template <class L>
void ReadNodes(const std::int32_t* node, int lanes, const Number<L>* x, L* to) {
  for (int l = 0; l < lanes; ++l) {
    const Number<L>* const from = x + kRows * node[l];
    for (int k = 0; k < kRows; ++k) to[k].lane[l] = from[k];
  }
}

template <class L>
void SolveDown(const NodeLanes& nodes, Columns<L>* columns, Number<L>* x) {
  L* const solved = columns->solved;
  ReadNodes(nodes.node, nodes.lanes, x, solved);
  ForLanes<L>(nodes.lanes, [&](int lane) HWY_ATTR {
    for (int c = 0; c < kRows; ++c) {
      V<L> y = At(solved[c], lane);
      for (int k = 0; k < c; ++k) {
        y = hn::Sub(y, hn::Mul(At(columns->factor[Lower(c, k)], lane), At(solved[k], lane)));
      }
      Put(hn::Mul(y, At(columns->factor[Lower(c, c)], lane)), &solved[c], lane);
    }
  });
  L product[kMostNeighbours][kRows];
  for (int i = 0; i < kMostNeighbours; ++i) {
    ForLanes<L>(nodes.with[i], [&](int lane) HWY_ATTR {
      for (int r = 0; r < kRows; ++r) {
        V<L> sum = hn::Zero(Lanes<L>());
        for (int k = 0; k < kRows; ++k) {
          sum = hn::Add(sum,
                        hn::Mul(At(columns->below[i][kRows * k + r], lane), At(solved[k], lane)));
        }
        Put(sum, &product[i][r], lane);
      }
    });
  }
  for (int l = 0; l < nodes.with[0]; ++l) {
    for (int i = 0; i < kMostNeighbours && l < nodes.with[i]; ++i) {
      Number<L>* const to = x + kRows * nodes.neighbours[i].node[l];
      for (int k = 0; k < kRows; ++k) to[k] -= product[i][k].lane[l];
    }
  }
}

template <class L>
void SolveUp(const NodeLanes& nodes, const Columns<L>& columns, Number<L>* x) {
  L y[kRows];
  ForLanes<L>(nodes.lanes, [&](int lane) HWY_ATTR {
    for (int k = 0; k < kRows; ++k) Put(At(columns.solved[k], lane), &y[k], lane);
  });
  for (int i = 0; i < kMostNeighbours; ++i) {
    L known[kRows];
    ReadNodes(nodes.neighbours[i].node, nodes.with[i], x, known);
    L product[kRows];
    ForLanes<L>(nodes.with[i], [&](int lane) HWY_ATTR {
      for (int c = 0; c < kRows; ++c) {
        V<L> sum = hn::Zero(Lanes<L>());
        for (int r = 0; r < kRows; ++r) {
          sum =
              hn::Add(sum, hn::Mul(At(columns.below[i][kRows * c + r], lane), At(known[r], lane)));
        }
        Put(sum, &product[c], lane);
      }
    });
    for (int k = 0; k < kRows; ++k) {
      for (int l = 0; l < nodes.with[i]; ++l) y[k].lane[l] -= product[k].lane[l];
    }
  }
  ForLanes<L>(nodes.lanes, [&](int lane) HWY_ATTR {
    for (int c = kRows - 1; c >= 0; --c) {
      V<L> sum = At(y[c], lane);
      for (int r = c + 1; r < kRows; ++r) {
        sum = hn::Sub(sum, hn::Mul(At(columns.factor[Lower(r, c)], lane), At(y[r], lane)));
      }
      Put(hn::Mul(sum, At(columns.factor[Lower(c, c)], lane)), &y[c], lane);
    }
  });
  for (int l = 0; l < nodes.lanes; ++l) {
    Number<L>* const to = x + kRows * nodes.node[l];
    for (int k = 0; k < kRows; ++k) to[k] = y[k].lane[l];
  }
}

/// Few nodes have short lines, so that a factor of them fits the first cache: calls
/// function(columns) with those that are wide enough.
template <class T, class Function>
HWY_INLINE auto InLines(const NodeLanes& nodes, T* columns, const Function& function) {
  using Few = Columns<NodeLine<T, kFewNodes>>;
  using Many = Columns<NodeLine<T, kLanes>>;
  static_assert(sizeof(Few) == sizeof(T) * kNodeLines * kFewNodes);
  static_assert(sizeof(Many) == sizeof(T) * kNodeLines * kLanes);
  T* const own = columns + nodes.columns;
  if (nodes.width() == kFewNodes) return function(reinterpret_cast<Few*>(own));
  return function(reinterpret_cast<Many*>(own));
}

template <class T>
bool EliminateInLines(const NodeLanes& nodes, const T* floors, T* blocks, T* columns) {
  return InLines(nodes, columns, [&](auto* own) { return Eliminate(nodes, floors, blocks, own); });
}
template <class T>
void SolveDownInLines(const NodeLanes& nodes, T* columns, T* x) {
  InLines(nodes, columns, [&](auto* own) { SolveDown(nodes, own, x); });
}
template <class T>
void SolveUpInLines(const NodeLanes& nodes, const T* columns, T* x) {
  InLines(nodes, const_cast<T*>(columns), [&](const auto* own) { SolveUp(nodes, *own, x); });
}

template <class T>
constexpr NodeKernels<T> kKernels = {EliminateInLines<T>, SolveDownInLines<T>, SolveUpInLines<T>};

}  // namespace nodes
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
