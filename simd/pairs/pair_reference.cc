// SPDX-License-Identifier: MIT
#include "simd/pairs/pair_reference.h"

#include <cmath>

#include "simd/flush_denormals.h"

namespace cairn::simd {
namespace {

enum class Pass { kStart, kSweep, kMeasuredSweep, kMeasure };

// Maximum and minimum as x86 has them: the second operand if the two are equal or one is NaN.
float Max(float a, float b) { return a > b ? a : b; }
float Min(float a, float b) { return a < b ? a : b; }

/// What is true of the pair while its rows are worked on. v are the numbers that G multiplies: u of
/// both bodies, or for PairForm::kContact the relative linear velocity and both angular parts.
struct LaneState {
  float v[12];
  float before[3];  ///< relative linear velocity that the pair began with
  float s_a, s_b;
  float k = 1;  ///< what an impulse of 1 along n changes the relative velocity by
};

LaneState Gather(PairForm form, const Line* pair, const float* a, const float* b, int lane) {
  LaneState state;
  if (form != PairForm::kContact) {
    for (int i = 0; i < 3; ++i) {
      state.v[i] = a[i];
      state.v[3 + i] = a[4 + i];
      state.v[6 + i] = b[i];
      state.v[9 + i] = b[4 + i];
    }
    return state;
  }
  state.s_a = pair[0].lane[lane];
  state.s_b = pair[1].lane[lane];
  state.k = state.s_a * state.s_a + state.s_b * state.s_b;
  for (int i = 0; i < 3; ++i) {
    state.before[i] = state.v[i] = state.s_a * a[i] - state.s_b * b[i];
    state.v[3 + i] = a[4 + i];
    state.v[6 + i] = b[4 + i];
  }
  return state;
}

void Scatter(PairForm form, const LaneState& state, float* a, float* b) {
  if (form != PairForm::kContact) {
    for (int i = 0; i < 3; ++i) {
      a[i] = state.v[i];
      a[4 + i] = state.v[3 + i];
      if (form == PairForm::kSingle) continue;
      b[i] = state.v[6 + i];
      b[4 + i] = state.v[9 + i];
    }
    return;
  }
  const float share_a = state.s_a / state.k, share_b = state.s_b / state.k;
  for (int i = 0; i < 3; ++i) {
    const float moved = state.v[i] - state.before[i];
    a[i] = a[i] + share_a * moved;
    b[i] = b[i] - share_b * moved;
    a[4 + i] = state.v[3 + i];
    b[4 + i] = state.v[6 + i];
  }
}

/// G v - target, summed as a balanced tree.
float Sum(const Line* g, const float* v, float target, int lane, int first, int count) {
  if (count == 1) {
    const float product = g[first].lane[lane] * v[first];
    return first == 0 ? product - target : product;
  }
  int half = 1;
  while (2 * half < count) half *= 2;
  return Sum(g, v, target, lane, first, half) + Sum(g, v, target, lane, first + half, count - half);
}

float Clamp(const RowShape& row, const Line* line, float parent, float x, int lane) {
  switch (row.bound) {
    case RowBound::kFree:
      return x;
    case RowBound::kPush:
      return Max(x, 0.0f);
    case RowBound::kOwn:
      return Min(Max(x, line[0].lane[lane]), line[1].lane[lane]);
    case RowBound::kFriction:
    case RowBound::kCutFriction:
      break;
  }
  const float most = line[0].lane[lane] * Max(parent, 0.0f);
  if (row.bound == RowBound::kFriction) return Min(Max(x, -most), most);
  return Min(Max(x, Max(-most, line[1].lane[lane])), Min(most, line[2].lane[lane]));
}

/// One row of one lane. @p x: the first impulse of the block.
void Relax(Pass pass, const PairWork& work, const PairBlock& block, int index, const Line* line,
           Line* x, int lane, LaneState* state, BlockError* error) {
  const RowShape& row = block.rows[index];
  const int n = JacobianLines(block.form);
  const float old = x[index].lane[lane];
  const float parent = row.parent >= 0 ? x[row.parent].lane[lane] : 0;

  float change = old;
  if (pass != Pass::kStart) {
    float w = Sum(line, state->v, line[n].lane[lane], lane, 0, n);
    const Line* bounds = line + n + 2;
    if (row.soft) w = w + (bounds++)->lane[lane] * old;
    const float step = line[n + 1].lane[lane];
    const float inv_d = row.relaxed ? step / (bounds++)->lane[lane] : step;
    const float factor = pass == Pass::kMeasure ? inv_d : step;
    change = Clamp(row, bounds, parent, old - factor * w, lane) - old;
    const bool rests = work.hold_lifted && row.parent >= 0 && !(parent > 0);
    if (rests && pass != Pass::kMeasure) change = 0;
    if (pass != Pass::kSweep) {
      const float moved = std::fabs(change), e = moved / inv_d;
      float& most = (row.angular ? error->max_angular : error->max).lane[lane];
      most = Max(e, most);
      error->energy.lane[lane] = error->energy.lane[lane] + e * moved;
    }
    if (pass == Pass::kMeasure) return;
    x[index].lane[lane] = old + change;
  }

  const float linear = state->k * change;
  for (int i = 0; i < n; ++i) {
    const bool shared = block.form == PairForm::kContact && i < 3;
    state->v[i] = state->v[i] + line[i].lane[lane] * (shared ? linear : change);
  }
}

void RunLane(Pass pass, const PairWork& work, const PairBlock& block, int lane, BlockError* error) {
  const Line* line = work.data + block.data;
  Line* const x = work.x + block.x;
  float* const a = work.bodies[block.a[lane]].u;
  float* const b = work.bodies[block.b[lane]].u;
  LaneState state = Gather(block.form, line, a, b, lane);
  line += PairLines(block.form);
  for (int i = 0; i < block.row_count; ++i) {
    const RowShape& row = block.rows[i];
    const bool sweeps = pass == Pass::kSweep || pass == Pass::kMeasuredSweep;
    if (!(sweeps && work.sweep >= row.max_sweeps)) {
      Relax(pass, work, block, i, line, x, lane, &state, error);
    }
    line += RowLines(block.form, row);
  }
  if (pass != Pass::kMeasure) Scatter(block.form, state, a, b);
}

template <Pass pass>
void Run(const PairWork& work) {
  const FlushDenormals flush;
  BlockError unused;
  for (int i = 0; i < work.count; ++i) {
    const bool measures = pass == Pass::kMeasuredSweep || pass == Pass::kMeasure;
    BlockError* const error = measures ? &work.errors[i] : &unused;
    *error = {};
    for (int lane = 0; lane < work.blocks[i].lanes; ++lane) {
      RunLane(pass, work, work.blocks[i], lane, error);
    }
  }
}

}  // namespace

const PairKernels& ReferencePairKernels() {
  static constexpr PairKernels kKernels = {Run<Pass::kStart>, Run<Pass::kSweep>,
                                           Run<Pass::kMeasuredSweep>, Run<Pass::kMeasure>};
  return kKernels;
}

}  // namespace cairn::simd
