// SPDX-License-Identifier: MIT
// Passes over pair blocks, sixteen lanes at a time. Compiled once per target; pair_reference.cc is
// the specification, operation for operation.
#if defined(CAIRN_SIMD_PAIR_SWEEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_PAIR_SWEEP_INL_H_
#undef CAIRN_SIMD_PAIR_SWEEP_INL_H_
#else
#define CAIRN_SIMD_PAIR_SWEEP_INL_H_
#endif

#include "simd/flush_denormals.h"
#include "simd/pairs/pair_sweep.h"
#include "simd/wide-inl.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {

enum class Pass { kStart, kSweep, kMeasuredSweep, kMeasure };

constexpr bool Measures(Pass pass) {
  return pass == Pass::kMeasuredSweep || pass == Pass::kMeasure;
}

HWY_INLINE Wide Product(const Line& g, const Wide& v) { return Mul(LoadLine(g), v); }

// Sums of 2, 4 and 8 products as balanced trees: fewer steps from the velocities of one row to the
// impulse of the next than one sum after the other.
HWY_INLINE Wide Sum2(const Line* g, const Wide& v0, const Wide& v1) {
  return Add(Product(g[0], v0), Product(g[1], v1));
}
HWY_INLINE Wide Sum4(const Line* g, const Wide& v0, const Wide& v1, const Wide& v2,
                     const Wide& v3) {
  return Add(Sum2(g, v0, v1), Sum2(g + 2, v2, v3));
}
/// The first four, less the target.
HWY_INLINE Wide First4(const Line* g, const Line& target, const Wide& v0, const Wide& v1,
                       const Wide& v2, const Wide& v3) {
  const Wide first = Sub(Product(g[0], v0), LoadLine(target));
  return Add(Add(first, Product(g[1], v1)), Sum2(g + 2, v2, v3));
}
HWY_INLINE void Apply(const Line* g, const Wide& change, Three<Wide>* v) {
  v->x = AddProduct(v->x, LoadLine(g[0]), change);
  v->y = AddProduct(v->y, LoadLine(g[1]), change);
  v->z = AddProduct(v->z, LoadLine(g[2]), change);
}

/// The numbers that G of a form multiplies, from and to the bodies.
template <PairForm form>
struct PairState;

template <>
struct PairState<PairForm::kSingle> {
  Three<Wide> linear, angular;

  HWY_INLINE void Gather(const PairWork& work, const PairBlock& block, const Line*) {
    linear = GatherAs<Wide>(work.bodies, block.a, 0, block.lanes);
    angular = GatherAs<Wide>(work.bodies, block.a, 1, block.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const PairBlock& block) const {
    ScatterAs(linear, work.bodies, block.a, 0, block.lanes);
    ScatterAs(angular, work.bodies, block.a, 1, block.lanes);
  }
  HWY_INLINE Wide Slack(const Line* g) const {
    return Add(First4(g, g[6], linear.x, linear.y, linear.z, angular.x),
               Sum2(g + 4, angular.y, angular.z));
  }
  HWY_INLINE void Push(const Line* g, const Wide& change) {
    Apply(g, change, &linear);
    Apply(g + 3, change, &angular);
  }
};

template <>
struct PairState<PairForm::kJoint> {
  Three<Wide> linear_a, angular_a, linear_b, angular_b;

  HWY_INLINE void Gather(const PairWork& work, const PairBlock& block, const Line*) {
    linear_a = GatherAs<Wide>(work.bodies, block.a, 0, block.lanes);
    angular_a = GatherAs<Wide>(work.bodies, block.a, 1, block.lanes);
    linear_b = GatherAs<Wide>(work.bodies, block.b, 0, block.lanes);
    angular_b = GatherAs<Wide>(work.bodies, block.b, 1, block.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const PairBlock& block) const {
    ScatterAs(linear_a, work.bodies, block.a, 0, block.lanes);
    ScatterAs(angular_a, work.bodies, block.a, 1, block.lanes);
    ScatterAs(linear_b, work.bodies, block.b, 0, block.lanes);
    ScatterAs(angular_b, work.bodies, block.b, 1, block.lanes);
  }
  HWY_INLINE Wide Slack(const Line* g) const {
    const Wide head = First4(g, g[12], linear_a.x, linear_a.y, linear_a.z, angular_a.x);
    const Wide middle = Sum4(g + 4, angular_a.y, angular_a.z, linear_b.x, linear_b.y);
    const Wide tail = Sum4(g + 8, linear_b.z, angular_b.x, angular_b.y, angular_b.z);
    return Add(Add(head, middle), tail);
  }
  HWY_INLINE void Push(const Line* g, const Wide& change) {
    Apply(g, change, &linear_a);
    Apply(g + 3, change, &angular_a);
    Apply(g + 6, change, &linear_b);
    Apply(g + 9, change, &angular_b);
  }
};

/// Both bodies see the same force, so that the relative linear velocity is enough to know while the
/// rows of the pair are relaxed; in the end the bodies share what it changed by.
template <>
struct PairState<PairForm::kContact> {
  Three<Wide> relative, angular_a, angular_b;
  Wide k;

  HWY_INLINE static Three<Wide> Relative(const PairWork& work, const PairBlock& block,
                                         const Wide& s_a, const Wide& s_b) {
    const Three<Wide> a = GatherAs<Wide>(work.bodies, block.a, 0, block.lanes);
    const Three<Wide> b = GatherAs<Wide>(work.bodies, block.b, 0, block.lanes);
    return {Sub(Mul(s_a, a.x), Mul(s_b, b.x)), Sub(Mul(s_a, a.y), Mul(s_b, b.y)),
            Sub(Mul(s_a, a.z), Mul(s_b, b.z))};
  }
  HWY_INLINE void Gather(const PairWork& work, const PairBlock& block, const Line* pair) {
    const Wide s_a = LoadLine(pair[0]), s_b = LoadLine(pair[1]);
    k = Add(Mul(s_a, s_a), Mul(s_b, s_b));
    relative = Relative(work, block, s_a, s_b);
    angular_a = GatherAs<Wide>(work.bodies, block.a, 1, block.lanes);
    angular_b = GatherAs<Wide>(work.bodies, block.b, 1, block.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const PairBlock& block) const {
    ScatterAs(angular_a, work.bodies, block.a, 1, block.lanes);
    ScatterAs(angular_b, work.bodies, block.b, 1, block.lanes);

    // gathered once more rather than kept: the registers are needed for the rows
    const Line* const pair = work.data + block.data;
    const Wide s_a = LoadLine(pair[0]), s_b = LoadLine(pair[1]);
    const Wide share_a = Div(s_a, k), share_b = Div(s_b, k);
    Three<Wide> a = GatherAs<Wide>(work.bodies, block.a, 0, block.lanes);
    Three<Wide> b = GatherAs<Wide>(work.bodies, block.b, 0, block.lanes);
    Share(s_a, s_b, share_a, share_b, relative.x, &a.x, &b.x);
    Share(s_a, s_b, share_a, share_b, relative.y, &a.y, &b.y);
    Share(s_a, s_b, share_a, share_b, relative.z, &a.z, &b.z);
    ScatterAs(a, work.bodies, block.a, 0, block.lanes);
    ScatterAs(b, work.bodies, block.b, 0, block.lanes);
  }
  HWY_INLINE static void Share(const Wide& s_a, const Wide& s_b, const Wide& share_a,
                               const Wide& share_b, const Wide& now, Wide* a, Wide* b) {
    const Wide moved = Sub(now, Sub(Mul(s_a, *a), Mul(s_b, *b)));
    *a = AddProduct(*a, share_a, moved);
    *b = Sub(*b, Mul(share_b, moved));
  }
  HWY_INLINE Wide Slack(const Line* g) const {
    const Wide head = First4(g, g[9], relative.x, relative.y, relative.z, angular_a.x);
    const Wide middle = Sum4(g + 4, angular_a.y, angular_a.z, angular_b.x, angular_b.y);
    return Add(Add(head, middle), Product(g[8], angular_b.z));
  }
  HWY_INLINE void Push(const Line* g, const Wide& change) {
    Apply(g, Mul(k, change), &relative);
    Apply(g + 3, change, &angular_a);
    Apply(g + 6, change, &angular_b);
  }
};

HWY_INLINE Wide Clamp(const RowShape& row, const Line* bounds, const Line* x_of_block,
                      const Wide& x) {
  switch (row.bound) {
    case RowBound::kFree:
      return x;
    case RowBound::kPush:
      return Max(x, SetAll(0));
    case RowBound::kOwn:
      return Min(Max(x, LoadLine(bounds[0])), LoadLine(bounds[1]));
    case RowBound::kFriction:
    case RowBound::kCutFriction:
      break;
  }
  const Wide most = Mul(LoadLine(bounds[0]), Max(LoadLine(x_of_block[row.parent]), SetAll(0)));
  if (row.bound == RowBound::kFriction) return Min(Max(x, Neg(most)), most);
  return Min(Max(x, Max(Neg(most), LoadLine(bounds[1]))), Min(most, LoadLine(bounds[2])));
}

/// Largest and squared errors of the rows seen so far.
struct ErrorSums {
  Wide max, max_angular, energy;

  HWY_INLINE void Reset() { max = max_angular = energy = SetAll(0); }
  HWY_INLINE void Add(const RowShape& row, const Wide& change, const Wide& inv_d) {
    const Wide moved = Abs(change), e = Div(moved, inv_d);
    if (row.angular) {
      max_angular = Max(e, max_angular);
    } else {
      max = Max(e, max);
    }
    energy = AddProduct(energy, e, moved);
  }
  HWY_INLINE void Store(BlockError* error) const {
    StoreLine(max, &error->max);
    StoreLine(max_angular, &error->max_angular);
    StoreLine(energy, &error->energy);
  }
};

template <PairForm form, Pass pass>
HWY_INLINE void RelaxRow(const PairWork& work, const RowShape& row, const Line* line, Line* x_block,
                         Line* x_row, PairState<form>* state, ErrorSums* errors) {
  constexpr int kTarget = JacobianLines(form), kStep = kTarget + 1;
  const Wide old = LoadLine(*x_row);
  Wide w = state->Slack(line);
  const Line* bounds = line + kStep + 1;
  if (row.soft) w = AddProduct(w, LoadLine(*bounds++), old);

  const Wide step = LoadLine(line[kStep]);
  Wide inv_d = step;
  if (row.relaxed) {
    const Wide relaxation = LoadLine(*bounds++);
    if (pass != Pass::kSweep) inv_d = Div(step, relaxation);
  }
  const Wide moved = Sub(old, Mul(pass == Pass::kMeasure ? inv_d : step, w));
  Wide change = Sub(Clamp(row, bounds, x_block, moved), old);
  if (pass == Pass::kMeasure) return errors->Add(row, change, inv_d);

  if (work.hold_lifted && row.parent >= 0) {
    change = WherePositive(change, LoadLine(x_block[row.parent]));
  }
  if (pass == Pass::kMeasuredSweep) errors->Add(row, change, inv_d);
  StoreLine(Add(old, change), x_row);
  state->Push(line, change);
}

/// A block on its way through the rows.
template <PairForm form, Pass pass>
struct BlockState {
  const Line* line;
  Line* x;
  PairState<form> pair;
  ErrorSums errors;

  HWY_INLINE void Begin(const PairWork& work, const PairBlock& block) {
    line = work.data + block.data;
    x = work.x + block.x;
    pair.Gather(work, block, line);
    line += PairLines(form);
    if (Measures(pass)) errors.Reset();
  }
  HWY_INLINE void DoRow(const PairWork& work, const RowShape& row, int i) {
    if constexpr (pass == Pass::kStart) {
      pair.Push(line, LoadLine(x[i]));
    } else if (pass == Pass::kMeasure || work.sweep < row.max_sweeps) {
      RelaxRow<form, pass>(work, row, line, x, x + i, &pair, &errors);
    }
    line += RowLines(form, row);
  }
  HWY_INLINE void End(const PairWork& work, int at) const {
    if (pass != Pass::kMeasure) pair.Scatter(work, work.blocks[at]);
    if (Measures(pass)) errors.Store(work.errors + at);
  }
};

template <PairForm form, Pass pass>
HWY_NOINLINE void RunBlock(const PairWork& work, int at) {
  const PairBlock& block = work.blocks[at];
  BlockState<form, pass> state;
  state.Begin(work, block);
  for (int i = 0; i < block.row_count; ++i) state.DoRow(work, block.rows[i], i);
  state.End(work, at);
}

/// Two blocks, row by row: while a row waits for the one before it, the other block has work.
template <PairForm form, Pass pass>
HWY_NOINLINE void RunTwoBlocks(const PairWork& work, int at) {
  const PairBlock &block = work.blocks[at], &next = work.blocks[at + 1];
  BlockState<form, pass> first, second;
  first.Begin(work, block);
  second.Begin(work, next);
  for (int i = 0; i < block.row_count; ++i) {
    first.DoRow(work, block.rows[i], i);
    second.DoRow(work, block.rows[i], i);
  }
  first.End(work, at);
  second.End(work, at + 1);
}

/// Registers that hold more than one block: a line is one of them.
constexpr bool kTwoAtOnce = kWidth == kLanes;

/// From block @p at on. Returns how many were done.
template <PairForm form, Pass pass>
int RunSome(const PairWork& work, int at) {
  if constexpr (kTwoAtOnce) {
    if (at + 1 < work.count && work.blocks[at].like_next) {
      RunTwoBlocks<form, pass>(work, at);
      return 2;
    }
  }
  RunBlock<form, pass>(work, at);
  return 1;
}

template <Pass pass>
void Run(const PairWork& work) {
  const FlushDenormals flush;
  for (int i = 0; i < work.count;) {
    switch (work.blocks[i].form) {
      case PairForm::kJoint:
        i += RunSome<PairForm::kJoint, pass>(work, i);
        break;
      case PairForm::kContact:
        i += RunSome<PairForm::kContact, pass>(work, i);
        break;
      case PairForm::kSingle:
        i += RunSome<PairForm::kSingle, pass>(work, i);
        break;
    }
  }
}

constexpr PairKernels kPairKernels = {Run<Pass::kStart>, Run<Pass::kSweep>,
                                      Run<Pass::kMeasuredSweep>, Run<Pass::kMeasure>};

}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();
#endif

#endif
