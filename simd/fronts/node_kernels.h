// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "simd/pairs/pair_block.h"
#include "simd/pairs/pair_products.h"
#include "simd/target.h"

namespace cairn::simd {

/// Rows of a node: those of a body.
inline constexpr int kNodeRows = 6;
/// Lower triangle and square of such rows, in lines.
inline constexpr int kNodeTriangle = kNodeRows * (kNodeRows + 1) / 2;
inline constexpr int kNodeSquare = kNodeRows * kNodeRows;
/// Neighbours that a node has at most when it is eliminated.
inline constexpr int kMostNeighbours = 2;
/// So many nodes or less share lines of four numbers rather than of sixteen.
inline constexpr int kFewNodes = 4;
/// Lines of the columns of a factor: a triangle, the squares below it, and six between solves down
/// and up.
inline constexpr int kNodeLines = kNodeTriangle + kMostNeighbours * kNodeSquare + kNodeRows;

/// Nodes that are eliminated together, one in each lane: none is a neighbour of another. Those with
/// more neighbours come first. Blocks are of kNodeRows x kNodeRows numbers, column by column.
struct NodeLanes {
  int lanes = 0;                       ///< in use
  std::int32_t columns = 0;            ///< where their columns of the factor begin
  int with[kMostNeighbours] = {};      ///< of those, with at least one neighbour, with two
  std::int32_t diagonal[kLanes] = {};  ///< where the block of the node begins
  std::int32_t node[kLanes] = {};      ///< its number
  struct Neighbour {
    std::int32_t block[kLanes] = {};     ///< where the one between it and the node begins
    std::int32_t diagonal[kLanes] = {};  ///< and its own
    std::int32_t node[kLanes] = {};      ///< its number
    /// Lanes whose block has rows of the node and columns of the neighbour.
    std::uint32_t turned = 0;
  } neighbours[kMostNeighbours];
  /// Where the block of both neighbours begins: rows of the first, columns of the second.
  std::int32_t between[kLanes] = {};

  /// Numbers of a line.
  int width() const { return lanes <= kFewNodes ? kFewNodes : kLanes; }
  /// Behind their columns of the factor, where those of others may begin.
  std::int32_t columns_end() const {
    return columns + (kNodeLines * width() + kLanes - 1) / kLanes * kLanes;
  }
};

/// A block Cholesky factorisation of what has few neighbours. Each lane takes the same roundings
/// whatever is in others: same bits on every target.
template <class T>
struct NodeKernels {
  /// Eliminates them from @p blocks: their columns are written, and their neighbours' blocks are
  /// changed. @p columns: of all NodeLanes, from a cache line on. False if a pivot is not above its
  /// entry of @p floors, which are >= 0, six for a node, or not finite; all is spoilt then.
  bool (*eliminate)(const NodeLanes& nodes, const T* floors, T* blocks, T* columns);
  /// The lower triangle of the factor, and its transpose, six numbers of @p x for a node.
  void (*solve_down)(const NodeLanes& nodes, T* columns, T* x);
  void (*solve_up)(const NodeLanes& nodes, const T* columns, T* x);
};

/// @pre the CPU supports it
template <class T>
const NodeKernels<T>& NodeKernelsFor(Target target);
template <>
const NodeKernels<float>& NodeKernelsFor(Target target);
template <>
const NodeKernels<double>& NodeKernelsFor(Target target);

}  // namespace cairn::simd
