// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>

namespace cairn::simd {

// A lane is a pair of bodies with all its rows, a block is 16 lanes with rows that look alike, on
// every target: one register of AVX-512, two of AVX2, four of SSE4. Lanes of a block are relaxed
// together as far as they share no body, see LaneRun. Layout, padding and results do not depend on
// the CPU.
//
// Velocities are whitened (core/src/problem/whitening.h): u = G' x, so that one vector G per row
// serves as J and as M^-1 J'.

inline constexpr int kLanes = 16;
/// The first lanes, in fours, that hold so many.
inline constexpr int WholeQuads(int lanes) { return (lanes + 3) / 4 * 4; }

/// One number of every lane, a cache line.
struct alignas(64) Line {
  float lane[kLanes];
};

/// u of a body: linear x y z, 0, angular x y z, 0.
struct alignas(32) BodyLane {
  float u[8];
};

/// What one lane sees of a body that other lanes of its run move at the same time: a part of it,
/// with share^2 of its mass, as in Tonge, Benevolenski, Voroshilov 2012 (*Mass splitting for
/// jitter-free parallel rigid body simulation*). We split only what a run shares, and add up what
/// the parts changed by rather than take their mean: u stays G' x. As many parts as lanes share a
/// body make up no more than all of it, so that no run gains energy.
struct BodyCopy {
  std::int32_t slot;  ///< of the body
  float share;        ///< The lane sees u times this; a power of two.
};
/// The share of a body that so many lanes share: at most 1 / sqrt(lanes).
inline constexpr float ShareOfBody(int lanes) {
  return lanes <= 1 ? 1.0f : lanes <= 4 ? 0.5f : 0.25f;
}
static_assert(kLanes <= 16);

/// What the rows of a pair look like in memory. First come the lines of the pair, then the rows.
enum class PairForm : std::uint8_t {
  /// Any rows between two movable bodies. Row: G_a (6 lines), G_b (6).
  kJoint,
  /// Rows that act on the bodies with opposite forces. With s_a and s_b, the square roots of the
  /// inverse masses, not both 0, and r^2 = s_a^2 + s_b^2, pair: c_a = s_a / r, c_b = s_b / r. Row:
  /// r n, n being its direction, so that the linear parts are c_a r n and -c_b r n (3), the angular
  /// parts of G_a (3) and G_b (3).
  kContact,
  /// Rows between a body and what does not move. Row: G_a (6).
  kSingle,
};

/// The bounds of a row, and the lines they take.
enum class RowBound : std::uint8_t {
  kFree,         ///< None.
  kPush,         ///< [0, infinity), no lines.
  kOwn,          ///< lo, hi (2 lines).
  kFriction,     ///< +-coefficient max(0, x of the parent) (1 line).
  kCutFriction,  ///< The same inside lo, hi (3 lines).
};

/// What the rows of all lanes have in common.
struct RowShape {
  RowBound bound = RowBound::kFree;
  bool soft = false;         ///< Has compliance (1 line).
  bool relaxed = false;      ///< Has a step length other than 1 / d (1 line: its ratio to that).
  bool angular = false;      ///< Only turns: counts as [rad/s].
  std::int16_t parent = -1;  ///< Row of the lane that bounds friction.
  /// Takes part in that many sweeps of a Solve().
  std::int32_t max_sweeps = std::numeric_limits<std::int32_t>::max();

  friend bool operator==(const RowShape&, const RowShape&) = default;
};

/// Lines in front of the rows.
constexpr int PairLines(PairForm form) { return form == PairForm::kContact ? 2 : 0; }

/// Lines of G of a row.
constexpr int JacobianLines(PairForm form) {
  return form == PairForm::kJoint ? 12 : form == PairForm::kContact ? 9 : 6;
}

constexpr int BoundLines(RowBound bound) {
  switch (bound) {
    case RowBound::kFree:
    case RowBound::kPush:
      return 0;
    case RowBound::kOwn:
      return 2;
    case RowBound::kFriction:
      return 1;
    case RowBound::kCutFriction:
      return 3;
  }
  return 0;
}

/// Lines of a row: G, target, step > 0 (relaxation / d), compliance if soft, relaxation if relaxed,
/// bounds, coupling: G times that of the row before, 0 for the first row.
constexpr int RowLines(PairForm form, const RowShape& row) {
  return JacobianLines(form) + 3 + (row.soft ? 1 : 0) + (row.relaxed ? 1 : 0) +
         BoundLines(row.bound);
}
/// The coupling is the last of them.
constexpr int CouplingLine(PairForm form, const RowShape& row) { return RowLines(form, row) - 1; }

/// 16 pairs with rows that look alike. Lines of unused lanes may hold anything.
struct PairBlock {
  /// Slots of the bodies, or of copies, see PairWork::copies; unused lanes: 0, which holds zeros.
  std::int32_t a[kLanes];
  std::int32_t b[kLanes];  ///< Likewise; all 0 for kSingle.
  const RowShape* rows;
  std::int32_t row_count;
  std::int32_t lanes;      ///< In use: the first ones.
  std::uint32_t data;      ///< First line of the block in PairWork::data.
  std::uint32_t x;         ///< Its first line in PairWork::x, one for each row.
  std::uint32_t d_ratios;  ///< Likewise in PairWork::d_ratios, if it has copies.
  PairForm form;
  bool copies;  ///< Some of its slots are of copies.
};

/// Lanes of a block that share no body, or see copies of what they share: they are relaxed at a
/// time, in registers of WidthOf() lanes.
struct LaneRun {
  std::int32_t block;
  std::int16_t first;  ///< first + WidthOf(lanes) <= kLanes
  std::int16_t lanes;  ///< Above 8 the block has no other run.
  /// The next run has the same form and the same rows, and shares no body with this one, and both
  /// are all that their blocks have.
  bool like_next;
  bool copies;  ///< Some of its slots are of copies.
};

/// Lanes of the registers that so many lanes are relaxed in: small worlds have short runs, and a
/// division of sixteen numbers takes four times as long as one of four.
constexpr int WidthOf(int lanes) { return lanes <= 4 ? 4 : lanes <= 8 ? 8 : kLanes; }

/// How far the rows of a lane were from their laws; see Residual.
struct BlockError {
  Line max;          ///< [m/s]
  Line max_angular;  ///< [rad/s]
  Line energy;       ///< Sum of e_i^2 / d_i [J].
};

}  // namespace cairn::simd
