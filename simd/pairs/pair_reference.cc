// SPDX-License-Identifier: MIT
#include "simd/pairs/pair_reference.h"

#include <cmath>
#include <limits>

#include "simd/flush_denormals.h"

namespace cairn::simd {
namespace {

enum class Pass { kStart, kSweep, kMeasuredSweep, kFriction, kMeasure };

constexpr bool Measures(Pass pass) {
  return pass == Pass::kMeasuredSweep || pass == Pass::kMeasure;
}

// Maximum and minimum as x86 has them: the second operand if the two are equal or one is NaN; 0 for
// a bound that is too small for a normal float, which a copy would keep.
float Flushed(float x) {
  return std::fabs(x) < std::numeric_limits<float>::min() ? std::copysign(0.0f, x) : x;
}
float Max(float a, float b) { return Flushed(a > b ? a : b); }
float Min(float a, float b) { return Flushed(a < b ? a : b); }

/// What is true of the pair while its rows are worked on. v are the numbers that G multiplies: u of
/// both bodies, or for PairForm::kContact the relative linear velocity and both angular parts.
struct LaneState {
  float v[12];
  float before[3];  ///< relative linear velocity that the pair began with
  float c_a, c_b;
  /// G of the row before if what it changed was not pushed to v yet, and that change.
  const Line* changed;
  float change;
};

LaneState Gather(PairForm form, const Line* pair, const float* a, const float* b, int lane) {
  LaneState state;
  state.changed = nullptr;
  if (form != PairForm::kContact) {
    for (int i = 0; i < 3; ++i) {
      state.v[i] = a[i];
      state.v[3 + i] = a[4 + i];
      state.v[6 + i] = b[i];
      state.v[9 + i] = b[4 + i];
    }
    return state;
  }
  state.c_a = pair[0].lane[lane];
  state.c_b = pair[1].lane[lane];
  for (int i = 0; i < 3; ++i) {
    state.before[i] = state.v[i] = state.c_a * a[i] - state.c_b * b[i];
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
  for (int i = 0; i < 3; ++i) {
    const float moved = state.v[i] - state.before[i];
    a[i] = a[i] + state.c_a * moved;
    b[i] = b[i] - state.c_b * moved;
    a[4 + i] = state.v[3 + i];
    b[4 + i] = state.v[6 + i];
  }
}

/// G v from number @p first on, as a balanced tree.
float Sum(const Line* g, const float* v, int lane, int first, int count) {
  if (count == 1) return g[first].lane[lane] * v[first];
  return Sum(g, v, lane, first, count / 2) + Sum(g, v, lane, first + count / 2, count / 2);
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
  const float least = 0.0f - most;
  if (row.bound == RowBound::kFriction) return Min(Max(x, least), most);
  return Min(Max(x, Max(least, line[1].lane[lane])), Min(most, line[2].lane[lane]));
}

void PushChange(PairForm form, int lane, LaneState* state) {
  for (int i = 0; i < JacobianLines(form) && state->changed != nullptr; ++i) {
    state->v[i] = state->v[i] + state->changed[i].lane[lane] * state->change;
  }
  state->changed = nullptr;
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
    float target = line[n].lane[lane];
    const Line* bounds = line + n + 2;
    if (row.soft) target = target - (bounds++)->lane[lane] * old;
    const int head = n < 8 ? 4 : 8;
    const float tail = Sum(line, state->v, lane, head, n - head);
    const float step = line[n + 1].lane[lane];
    float inv_d = row.relaxed ? step / (bounds++)->lane[lane] : step;
    const float d_ratio = block.copies ? work.d_ratios[block.d_ratios + index].lane[lane] : 1;
    if (pass == Pass::kMeasure) inv_d = inv_d * d_ratio;
    const float factor = pass == Pass::kMeasure ? inv_d : step;
    const float product = Sum(line, state->v, lane, 0, head) + tail;
    float moved = old + factor * (target - product);
    if (state->changed != nullptr) {
      const float coupling = line[CouplingLine(block.form, row)].lane[lane];
      moved = moved - factor * coupling * state->change;
    }
    PushChange(block.form, lane, state);
    float now = Clamp(row, bounds, parent, moved, lane);
    change = now - old;
    if (work.hold_lifted && row.parent >= 0 && pass != Pass::kMeasure) {
      if (!(parent > 0)) change = 0;
      now = old + change;
    }
    if (Measures(pass)) {
      const float size = std::fabs(change), e = size / inv_d;
      float& most = (row.angular ? error->max_angular : error->max).lane[lane];
      most = Max(e, most);
      const float of_d = pass == Pass::kMeasuredSweep ? size * d_ratio : size;
      error->energy.lane[lane] = error->energy.lane[lane] + e * of_d;
    }
    if (pass == Pass::kMeasure) return;
    x[index].lane[lane] = now;
  }

  state->changed = line;
  state->change = change;
  if (pass == Pass::kStart) PushChange(block.form, lane, state);
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
    const bool sweeps = pass != Pass::kStart && pass != Pass::kMeasure;
    const bool passed_over = pass == Pass::kFriction && row.parent < 0;
    if (!passed_over && !(sweeps && work.sweep >= row.max_sweeps)) {
      Relax(pass, work, block, i, line, x, lane, &state, error);
    } else {
      PushChange(block.form, lane, &state);
    }
    line += RowLines(block.form, row);
  }
  PushChange(block.form, lane, &state);
  if (pass != Pass::kMeasure) Scatter(block.form, state, a, b);
}

void DoLanes(Pass pass, const PairWork& work, int block, int first, int count) {
  BlockError unused = {};
  BlockError* const error = Measures(pass) ? &work.errors[block] : &unused;
  for (int lane = first; lane < first + count; ++lane) {
    error->max.lane[lane] = error->max_angular.lane[lane] = error->energy.lane[lane] = 0;
    RunLane(pass, work, work.blocks[block], lane, error);
  }
}

/// function(copy, body, share) for the copies of some lanes, in their order.
template <class Function>
void ForCopies(const PairWork& work, int block, int first, int count, const Function& function) {
  const PairBlock& of = work.blocks[block];
  for (int lane = first; lane < first + count; ++lane) {
    for (const int slot : {of.a[lane], of.b[lane]}) {
      if (slot < work.first_copy) continue;
      const BodyCopy& copy = work.copies[slot - work.first_copy];
      for (int k = 0; k < 8; ++k) {
        function(&work.bodies[slot].u[k], &work.bodies[copy.slot].u[k], copy.share);
      }
    }
  }
}

template <Pass pass>
void Run(const PairWork& work) {
  const FlushDenormals flush;
  for (int i = 0; i < work.run_count; ++i) {
    const LaneRun& run = work.runs[i];
    const auto for_copies = [&](const auto& function) {
      if (run.copies) ForCopies(work, run.block, run.first, run.lanes, function);
    };
    for_copies([](float* copy, float* body, float share) { *copy = share * *body; });
    DoLanes(pass, work, run.block, run.first, run.lanes);
    for_copies([](float* copy, float* body, float share) { *copy = *copy - share * *body; });
    for_copies([](float* copy, float* body, float share) {
      *body = *body + share * *copy;
      *copy = 0;
    });
  }
}

void MeasureBlocks(const PairWork& work) {
  const FlushDenormals flush;
  for (int block = work.first_block; block < work.first_block + work.block_count; ++block) {
    const PairBlock& of = work.blocks[block];
    const auto for_copies = [&](const auto& function) {
      if (of.copies) ForCopies(work, block, 0, of.lanes, function);
    };
    for_copies([](float* copy, float* body, float share) { *copy = share * *body; });
    DoLanes(Pass::kMeasure, work, block, 0, of.lanes);
    for_copies([](float* copy, float*, float) { *copy = 0; });
  }
}

void Couple(const PairBlock& block, Line* lines) {
  const FlushDenormals flush;
  const Line* before = nullptr;
  Line* line = lines + PairLines(block.form);
  for (int i = 0; i < block.row_count; ++i) {
    Line& coupling = line[CouplingLine(block.form, block.rows[i])];
    for (int lane = 0; lane < kLanes; ++lane) {
      float sum = 0;
      for (int k = 0; k < JacobianLines(block.form) && before != nullptr; ++k) {
        sum = sum + line[k].lane[lane] * before[k].lane[lane];
      }
      coupling.lane[lane] = sum;
    }
    before = line;
    line += RowLines(block.form, block.rows[i]);
  }
}

}  // namespace

const PairKernels& ReferencePairKernels() {
  static constexpr PairKernels kKernels = {Couple,
                                           Run<Pass::kStart>,
                                           Run<Pass::kSweep>,
                                           Run<Pass::kMeasuredSweep>,
                                           Run<Pass::kFriction>,
                                           MeasureBlocks};
  return kKernels;
}

}  // namespace cairn::simd
