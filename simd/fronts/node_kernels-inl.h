// SPDX-License-Identifier: MIT
// Elimination of nodes with few neighbours, lane by lane. Compiled once per target.
#if defined(CAIRN_SIMD_NODE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_NODE_KERNELS_INL_H_
#undef CAIRN_SIMD_NODE_KERNELS_INL_H_
#else
#define CAIRN_SIMD_NODE_KERNELS_INL_H_
#endif

#include <limits>

#include <hwy/highway.h>

#include "simd/fronts/node_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace nodes {
namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes as fit a register.
template <class T>
using Lanes = hn::CappedTag<T, kLanes>;
template <class T>
using V = hn::Vec<Lanes<T>>;
template <class T>
constexpr int kWidth = static_cast<int>(hn::MaxLanes(Lanes<T>()));

constexpr int kRows = kNodeRows;

/// Place of a number of the lower triangle, column by column.
constexpr int Lower(int row, int column) {
  return column * kRows - column * (column - 1) / 2 + row - column;
}

template <class T>
HWY_INLINE V<T> At(const LineOf<T>& line, int lane) {
  return hn::Load(Lanes<T>(), line.lane + lane);
}
template <class T>
HWY_INLINE void Put(V<T> v, LineOf<T>* line, int lane) {
  hn::Store(v, Lanes<T>(), line->lane + lane);
}

/// function(lane) for as many lanes at a time as fit a register, as far as they are in use.
template <class T, class Function>
HWY_INLINE void ForLanes(int lanes, const Function& function) {
  for (int lane = 0; lane < lanes; lane += kWidth<T>) function(lane);
}

template <class T>
void ReadTriangles(const NodeLanes& nodes, const T* blocks, LineOf<T>* to) {
  for (int l = 0; l < nodes.lanes; ++l) {
    const T* const from = blocks + nodes.diagonal[l];
    for (int c = 0, at = 0; c < kRows; ++c) {
      for (int r = c; r < kRows; ++r) to[at++].lane[l] = from[kRows * c + r];
    }
  }
}

/// Rows of the neighbour, columns of the node.
template <class T>
void ReadSquares(const NodeLanes::Neighbour& neighbour, int lanes, const T* blocks, LineOf<T>* to) {
  for (int l = 0; l < lanes; ++l) {
    const T* const from = blocks + neighbour.block[l];
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
template <class T>
HWY_NOINLINE void FactorTriangle(const LineOf<T>* floors, int lane, LineOf<T>* triangle,
                                 LineOf<T>* failed) {
  const Lanes<T> d;
  const V<T> one = hn::Set(d, T{1}), most = hn::Set(d, std::numeric_limits<T>::max());
  V<T> c[kRows][kRows], inverses[kRows], good = one;
  HWY_UNROLL(6)
  for (int k = 0; k < kRows; ++k) {
    HWY_UNROLL(6)
    for (int i = k; i < kRows; ++i) c[k][i] = At<T>(triangle[Lower(i, k)], lane);
  }
  HWY_UNROLL(6)
  for (int k = 0; k < kRows; ++k) {
    // neither holds for what is not a number
    const auto fits = hn::And(hn::Gt(c[k][k], At<T>(floors[k], lane)), hn::Le(c[k][k], most));
    good = hn::IfThenElseZero(fits, good);
    inverses[k] = hn::Div(one, c[k][k]);
    HWY_UNROLL(6)
    for (int j = k + 1; j < kRows; ++j) {
      const V<T> scaled = hn::Mul(c[k][j], inverses[k]);
      HWY_UNROLL(6)
      for (int i = j; i < kRows; ++i) c[j][i] = hn::Sub(c[j][i], hn::Mul(c[k][i], scaled));
    }
  }
  HWY_UNROLL(6)
  for (int k = 0; k < kRows; ++k) {
    const V<T> inverse_root = hn::Sqrt(inverses[k]);
    Put<T>(inverse_root, &triangle[Lower(k, k)], lane);
    HWY_UNROLL(6)
    for (int i = k + 1; i < kRows; ++i) {
      Put<T>(hn::Mul(c[k][i], inverse_root), &triangle[Lower(i, k)], lane);
    }
  }
  Put<T>(hn::Sub(one, good), failed, lane);
}

/// The square from the right with the inverse of the transpose of the factor, in some lanes.
template <class T>
HWY_NOINLINE void SolveSquare(const LineOf<T>* factor, int lane, LineOf<T>* square) {
  for (int c = 0; c < kRows; ++c) {
    V<T> column[kRows];
    HWY_UNROLL(6)
    for (int r = 0; r < kRows; ++r) column[r] = At<T>(square[kRows * c + r], lane);
    for (int k = 0; k < c; ++k) {
      const V<T> l = At<T>(factor[Lower(c, k)], lane);
      HWY_UNROLL(6)
      for (int r = 0; r < kRows; ++r) {
        column[r] = hn::Sub(column[r], hn::Mul(At<T>(square[kRows * k + r], lane), l));
      }
    }
    const V<T> inverse = At<T>(factor[Lower(c, c)], lane);
    HWY_UNROLL(6)
    for (int r = 0; r < kRows; ++r) {
      Put<T>(hn::Mul(column[r], inverse), &square[kRows * c + r], lane);
    }
  }
}

/// Column @p c of  rows columns',  from row @p first on.
template <class T, int first>
HWY_INLINE void MultiplyColumn(const LineOf<T>* rows, const LineOf<T>* columns, int c, int lane,
                               LineOf<T>* product) {
  V<T> sum[kRows - first];
  HWY_UNROLL(6)
  for (int r = 0; r < kRows - first; ++r) sum[r] = hn::Zero(Lanes<T>());
  for (int k = 0; k < kRows; ++k) {
    const V<T> number = At<T>(columns[kRows * k + c], lane);
    HWY_UNROLL(6)
    for (int r = 0; r < kRows - first; ++r) {
      sum[r] = hn::Add(sum[r], hn::Mul(At<T>(rows[kRows * k + first + r], lane), number));
    }
  }
  HWY_UNROLL(6)
  for (int r = 0; r < kRows - first; ++r) Put<T>(sum[r], &product[r], lane);
}

template <class T>
HWY_NOINLINE void MultiplyToTriangle(const LineOf<T>* rows, int lane, LineOf<T>* product) {
  MultiplyColumn<T, 0>(rows, rows, 0, lane, product + Lower(0, 0));
  MultiplyColumn<T, 1>(rows, rows, 1, lane, product + Lower(1, 1));
  MultiplyColumn<T, 2>(rows, rows, 2, lane, product + Lower(2, 2));
  MultiplyColumn<T, 3>(rows, rows, 3, lane, product + Lower(3, 3));
  MultiplyColumn<T, 4>(rows, rows, 4, lane, product + Lower(4, 4));
  MultiplyColumn<T, 5>(rows, rows, 5, lane, product + Lower(5, 5));
}

template <class T>
HWY_NOINLINE void MultiplyToSquare(const LineOf<T>* rows, const LineOf<T>* columns, int lane,
                                   LineOf<T>* product) {
  for (int c = 0; c < kRows; ++c) {
    MultiplyColumn<T, 0>(rows, columns, c, lane, product + kRows * c);
  }
}

/// Lane by lane: a node that is a neighbour of some sees them in their order, whatever is between.
template <class T>
void SubtractTriangles(const NodeLanes& nodes, const LineOf<T> (*product)[kNodeTriangle],
                       T* blocks) {
  for (int l = 0; l < nodes.with[0]; ++l) {
    for (int i = 0; i < kMostNeighbours && l < nodes.with[i]; ++i) {
      T* const to = blocks + nodes.neighbours[i].diagonal[l];
      for (int c = 0, at = 0; c < kRows; ++c) {
        for (int r = c; r < kRows; ++r) to[kRows * c + r] -= product[i][at++].lane[l];
      }
    }
  }
}

template <class T>
bool Eliminate(const NodeLanes& nodes, const T* floors, T* blocks, NodeColumns<T>* columns) {
  LineOf<T> floor[kRows], failed, product[kMostNeighbours][kNodeTriangle], between[kNodeSquare];
  ReadTriangles(nodes, blocks, columns->factor);
  for (int l = 0; l < nodes.lanes; ++l) {
    for (int k = 0; k < kRows; ++k) floor[k].lane[l] = floors[kRows * nodes.node[l] + k];
  }
  ForLanes<T>(nodes.lanes,
              [&](int lane) HWY_ATTR { FactorTriangle<T>(floor, lane, columns->factor, &failed); });
  for (int l = 0; l < nodes.lanes; ++l) {
    if (failed.lane[l] != 0) return false;
  }
  for (int i = 0; i < kMostNeighbours; ++i) {
    const NodeLanes::Neighbour& neighbour = nodes.neighbours[i];
    LineOf<T>* const below = columns->below[i];
    ReadSquares(neighbour, nodes.with[i], blocks, below);
    ForLanes<T>(nodes.with[i], [&](int lane) HWY_ATTR {
      SolveSquare<T>(columns->factor, lane, below);
      MultiplyToTriangle<T>(below, lane, product[i]);
    });
  }
  SubtractTriangles(nodes, product, blocks);
  const int both = nodes.with[1];
  ForLanes<T>(both, [&](int lane) HWY_ATTR {
    MultiplyToSquare<T>(columns->below[0], columns->below[1], lane, between);
  });
  for (int l = 0; l < both; ++l) {
    T* const to = blocks + nodes.between[l];
    for (int k = 0; k < kNodeSquare; ++k) to[k] -= between[k].lane[l];
  }
  return true;
}

template <class T>
void ReadNodes(const std::int32_t* node, int lanes, const T* x, LineOf<T>* to) {
  for (int l = 0; l < lanes; ++l) {
    const T* const from = x + kRows * node[l];
    for (int k = 0; k < kRows; ++k) to[k].lane[l] = from[k];
  }
}

template <class T>
void SolveDown(const NodeLanes& nodes, NodeColumns<T>* columns, T* x) {
  LineOf<T>* const solved = columns->solved;
  ReadNodes(nodes.node, nodes.lanes, x, solved);
  ForLanes<T>(nodes.lanes, [&](int lane) HWY_ATTR {
    for (int c = 0; c < kRows; ++c) {
      V<T> y = At<T>(solved[c], lane);
      for (int k = 0; k < c; ++k) {
        y = hn::Sub(y, hn::Mul(At<T>(columns->factor[Lower(c, k)], lane), At<T>(solved[k], lane)));
      }
      Put<T>(hn::Mul(y, At<T>(columns->factor[Lower(c, c)], lane)), &solved[c], lane);
    }
  });
  LineOf<T> product[kMostNeighbours][kRows];
  for (int i = 0; i < kMostNeighbours; ++i) {
    ForLanes<T>(nodes.with[i], [&](int lane) HWY_ATTR {
      for (int r = 0; r < kRows; ++r) {
        V<T> sum = hn::Zero(Lanes<T>());
        for (int k = 0; k < kRows; ++k) {
          sum = hn::Add(
              sum, hn::Mul(At<T>(columns->below[i][kRows * k + r], lane), At<T>(solved[k], lane)));
        }
        Put<T>(sum, &product[i][r], lane);
      }
    });
  }
  for (int l = 0; l < nodes.with[0]; ++l) {
    for (int i = 0; i < kMostNeighbours && l < nodes.with[i]; ++i) {
      T* const to = x + kRows * nodes.neighbours[i].node[l];
      for (int k = 0; k < kRows; ++k) to[k] -= product[i][k].lane[l];
    }
  }
}

template <class T>
void SolveUp(const NodeLanes& nodes, const NodeColumns<T>& columns, T* x) {
  LineOf<T> y[kRows];
  ForLanes<T>(nodes.lanes, [&](int lane) HWY_ATTR {
    for (int k = 0; k < kRows; ++k) Put<T>(At<T>(columns.solved[k], lane), &y[k], lane);
  });
  for (int i = 0; i < kMostNeighbours; ++i) {
    LineOf<T> known[kRows];
    ReadNodes(nodes.neighbours[i].node, nodes.with[i], x, known);
    LineOf<T> product[kRows];
    ForLanes<T>(nodes.with[i], [&](int lane) HWY_ATTR {
      for (int c = 0; c < kRows; ++c) {
        V<T> sum = hn::Zero(Lanes<T>());
        for (int r = 0; r < kRows; ++r) {
          sum = hn::Add(
              sum, hn::Mul(At<T>(columns.below[i][kRows * c + r], lane), At<T>(known[r], lane)));
        }
        Put<T>(sum, &product[c], lane);
      }
    });
    for (int k = 0; k < kRows; ++k) {
      for (int l = 0; l < nodes.with[i]; ++l) y[k].lane[l] -= product[k].lane[l];
    }
  }
  ForLanes<T>(nodes.lanes, [&](int lane) HWY_ATTR {
    for (int c = kRows - 1; c >= 0; --c) {
      V<T> sum = At<T>(y[c], lane);
      for (int r = c + 1; r < kRows; ++r) {
        sum = hn::Sub(sum, hn::Mul(At<T>(columns.factor[Lower(r, c)], lane), At<T>(y[r], lane)));
      }
      Put<T>(hn::Mul(sum, At<T>(columns.factor[Lower(c, c)], lane)), &y[c], lane);
    }
  });
  for (int l = 0; l < nodes.lanes; ++l) {
    T* const to = x + kRows * nodes.node[l];
    for (int k = 0; k < kRows; ++k) to[k] = y[k].lane[l];
  }
}

template <class T>
constexpr NodeKernels<T> kKernels = {Eliminate<T>, SolveDown<T>, SolveUp<T>};

}  // namespace nodes
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
