// SPDX-License-Identifier: MIT
// Passes over pair blocks, 4, 8 or 16 lanes at a time. Compiled once per target; pair_reference.cc
// is the specification, operation for operation.
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

enum class Pass { kStart, kSweep, kMeasuredSweep, kFriction, kMeasure };

constexpr bool Measures(Pass pass) {
  return pass == Pass::kMeasuredSweep || pass == Pass::kMeasure;
}

template <class W>
HWY_INLINE W Product(const Line& g, const W& v) {
  return Mul(LoadLine<W>(g), v);
}

// Sums of 2, 4 and 8 products as balanced trees: fewer steps from the velocities of one row to the
// impulse of the next than one sum after the other.
template <class W>
HWY_INLINE W Sum2(const Line* g, const W& v0, const W& v1) {
  return Add(Product(g[0], v0), Product(g[1], v1));
}
template <class W>
HWY_INLINE W Sum4(const Line* g, const W& v0, const W& v1, const W& v2, const W& v3) {
  return Add(Sum2(g, v0, v1), Sum2(g + 2, v2, v3));
}
template <class W>
HWY_INLINE void Apply(const Line* g, const W& change, Three<W>* v) {
  v->x = AddProduct(v->x, LoadLine<W>(g[0]), change);
  v->y = AddProduct(v->y, LoadLine<W>(g[1]), change);
  v->z = AddProduct(v->z, LoadLine<W>(g[2]), change);
}

/// The numbers that G of a form multiplies, from and to the bodies.
template <PairForm form, class W>
struct PairState;

template <class W>
struct PairState<PairForm::kSingle, W> {
  Three<W> linear, angular;

  HWY_INLINE void Gather(const PairWork& work, const PairBlock& block, const Line*) {
    linear = GatherBodies<W>(work.bodies, block.a, 0, block.lanes);
    angular = GatherBodies<W>(work.bodies, block.a, 1, block.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const PairBlock& block) const {
    ScatterBodies(linear, work.bodies, block.a, 0, block.lanes);
    ScatterBodies(angular, work.bodies, block.a, 1, block.lanes);
  }
  // G v = Head() + Tail()
  HWY_INLINE W Head(const Line* g) const {
    return Sum4(g, linear.x, linear.y, linear.z, angular.x);
  }
  HWY_INLINE W Tail(const Line* g) const { return Sum2(g + 4, angular.y, angular.z); }
  HWY_INLINE void Push(const Line* g, const W& change) {
    Apply(g, change, &linear);
    Apply(g + 3, change, &angular);
  }
};

template <class W>
struct PairState<PairForm::kJoint, W> {
  Three<W> linear_a, angular_a, linear_b, angular_b;

  HWY_INLINE void Gather(const PairWork& work, const PairBlock& block, const Line*) {
    linear_a = GatherBodies<W>(work.bodies, block.a, 0, block.lanes);
    angular_a = GatherBodies<W>(work.bodies, block.a, 1, block.lanes);
    linear_b = GatherBodies<W>(work.bodies, block.b, 0, block.lanes);
    angular_b = GatherBodies<W>(work.bodies, block.b, 1, block.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const PairBlock& block) const {
    ScatterBodies(linear_a, work.bodies, block.a, 0, block.lanes);
    ScatterBodies(angular_a, work.bodies, block.a, 1, block.lanes);
    ScatterBodies(linear_b, work.bodies, block.b, 0, block.lanes);
    ScatterBodies(angular_b, work.bodies, block.b, 1, block.lanes);
  }
  HWY_INLINE W Head(const Line* g) const {
    return Add(Sum4(g, linear_a.x, linear_a.y, linear_a.z, angular_a.x),
               Sum4(g + 4, angular_a.y, angular_a.z, linear_b.x, linear_b.y));
  }
  HWY_INLINE W Tail(const Line* g) const {
    return Sum4(g + 8, linear_b.z, angular_b.x, angular_b.y, angular_b.z);
  }
  HWY_INLINE void Push(const Line* g, const W& change) {
    Apply(g, change, &linear_a);
    Apply(g + 3, change, &angular_a);
    Apply(g + 6, change, &linear_b);
    Apply(g + 9, change, &angular_b);
  }
};

/// Both bodies see the same force, so that their relative linear velocity r = c_a u_a - c_b u_b is
/// enough to know while the rows of the pair are relaxed. What r changed by belongs to the bodies
/// by c_a and -c_b: c_a^2 + c_b^2 = 1.
template <class W>
struct PairState<PairForm::kContact, W> {
  Three<W> relative, angular_a, angular_b;

  HWY_INLINE void Gather(const PairWork& work, const PairBlock& block, const Line* pair) {
    const W c_a = LoadLine<W>(pair[0]), c_b = LoadLine<W>(pair[1]);
    const Three<W> a = GatherBodies<W>(work.bodies, block.a, 0, block.lanes);
    const Three<W> b = GatherBodies<W>(work.bodies, block.b, 0, block.lanes);
    relative = {Relative(c_a, c_b, a.x, b.x), Relative(c_a, c_b, a.y, b.y),
                Relative(c_a, c_b, a.z, b.z)};
    angular_a = GatherBodies<W>(work.bodies, block.a, 1, block.lanes);
    angular_b = GatherBodies<W>(work.bodies, block.b, 1, block.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const PairBlock& block) const {
    ScatterBodies(angular_a, work.bodies, block.a, 1, block.lanes);
    ScatterBodies(angular_b, work.bodies, block.b, 1, block.lanes);

    // gathered once more rather than kept: the registers are needed for the rows
    const Line* const pair = work.data + block.data;
    const W c_a = LoadLine<W>(pair[0]), c_b = LoadLine<W>(pair[1]);
    Three<W> a = GatherBodies<W>(work.bodies, block.a, 0, block.lanes);
    Three<W> b = GatherBodies<W>(work.bodies, block.b, 0, block.lanes);
    Share(c_a, c_b, relative.x, &a.x, &b.x);
    Share(c_a, c_b, relative.y, &a.y, &b.y);
    Share(c_a, c_b, relative.z, &a.z, &b.z);
    ScatterBodies(a, work.bodies, block.a, 0, block.lanes);
    ScatterBodies(b, work.bodies, block.b, 0, block.lanes);
  }
  HWY_INLINE static W Relative(const W& c_a, const W& c_b, const W& a, const W& b) {
    return Sub(Mul(c_a, a), Mul(c_b, b));
  }
  HWY_INLINE static void Share(const W& c_a, const W& c_b, const W& now, W* a, W* b) {
    const W moved = Sub(now, Relative(c_a, c_b, *a, *b));
    *a = AddProduct(*a, c_a, moved);
    *b = Sub(*b, Mul(c_b, moved));
  }
  HWY_INLINE W Head(const Line* g) const {
    return Add(Sum4(g, relative.x, relative.y, relative.z, angular_a.x),
               Sum4(g + 4, angular_a.y, angular_a.z, angular_b.x, angular_b.y));
  }
  HWY_INLINE W Tail(const Line* g) const { return Product(g[8], angular_b.z); }
  HWY_INLINE void Push(const Line* g, const W& change) {
    Apply(g, change, &relative);
    Apply(g + 3, change, &angular_a);
    Apply(g + 6, change, &angular_b);
  }
};

template <class W>
HWY_INLINE W Clamp(const RowShape& row, const Line* bounds, const Line* x_of_block, const W& x) {
  switch (row.bound) {
    case RowBound::kFree:
      return x;
    case RowBound::kPush:
      return Max(x, Zeros<W>());
    case RowBound::kOwn:
      return Min(Max(x, LoadLine<W>(bounds[0])), LoadLine<W>(bounds[1]));
    case RowBound::kFriction:
    case RowBound::kCutFriction:
      break;
  }
  // 0 - 0 is +0 on every target, -(0) is not
  const W most = Mul(LoadLine<W>(bounds[0]), Max(LoadLine<W>(x_of_block[row.parent]), Zeros<W>()));
  const W least = Sub(Zeros<W>(), most);
  if (row.bound == RowBound::kFriction) return Min(Max(x, least), most);
  return Min(Max(x, Max(least, LoadLine<W>(bounds[1]))), Min(most, LoadLine<W>(bounds[2])));
}

/// Largest and squared errors of the rows seen so far.
template <class W>
struct ErrorSums {
  W max, max_angular, energy;

  HWY_INLINE void Reset() { max = max_angular = energy = Zeros<W>(); }
  HWY_INLINE void Add(const RowShape& row, const W& change, const W& inv_d) {
    const W moved = Abs(change), e = Div(moved, inv_d);
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

template <PairForm form, Pass pass, class W>
HWY_INLINE void RelaxRow(const PairWork& work, const RowShape& row, const Line* line, Line* x_block,
                         Line* x_row, PairState<form, W>* state, ErrorSums<W>* errors) {
  constexpr int kTarget = JacobianLines(form), kStep = kTarget + 1;
  const W old = LoadLine<W>(*x_row);
  W target = LoadLine<W>(line[kTarget]);
  const Line* bounds = line + kStep + 1;
  if (row.soft) target = Sub(target, Mul(LoadLine<W>(*bounds++), old));

  const W step = LoadLine<W>(line[kStep]);
  W inv_d = step;
  if (row.relaxed) {
    const W relaxation = LoadLine<W>(*bounds++);
    if (Measures(pass)) inv_d = Div(step, relaxation);
  }
  // old + factor (target - G v); what does not depend on the row before is added first
  const W factor = pass == Pass::kMeasure ? inv_d : step;
  const W rest = Add(old, Mul(factor, Sub(target, state->Tail(line))));
  const W moved = Sub(rest, Mul(factor, state->Head(line)));
  W now = Clamp(row, bounds, x_block, moved);
  // what the bodies see is what becomes of the impulse, as a float has it
  W change = Sub(now, old);
  if (pass == Pass::kMeasure) return errors->Add(row, change, inv_d);

  if (work.hold_lifted && row.parent >= 0) {
    change = WherePositive(change, LoadLine<W>(x_block[row.parent]));
    now = Add(old, change);
  }
  if (pass == Pass::kMeasuredSweep) errors->Add(row, change, inv_d);
  StoreLine(now, x_row);
  state->Push(line, change);
}

/// A block on its way through the rows.
template <PairForm form, Pass pass, class W>
struct BlockState {
  const Line* line;
  Line* x;
  PairState<form, W> pair;
  ErrorSums<W> errors;

  HWY_INLINE void Begin(const PairWork& work, const PairBlock& block) {
    line = work.data + block.data;
    x = work.x + block.x;
    pair.Gather(work, block, line);
    line += PairLines(form);
    if (Measures(pass)) errors.Reset();
  }
  HWY_INLINE void DoRow(const PairWork& work, const RowShape& row, int i) {
    if constexpr (pass == Pass::kStart) {
      pair.Push(line, LoadLine<W>(x[i]));
    } else if (TakesPart(work, row)) {
      RelaxRow<form, pass>(work, row, line, x, x + i, &pair, &errors);
    }
    line += RowLines(form, row);
  }
  HWY_INLINE static bool TakesPart(const PairWork& work, const RowShape& row) {
    if (pass == Pass::kFriction && row.parent < 0) return false;
    return pass == Pass::kMeasure || work.sweep < row.max_sweeps;
  }
  HWY_INLINE void End(const PairWork& work, int at) const {
    if (pass != Pass::kMeasure) pair.Scatter(work, work.blocks[at]);
    if (Measures(pass)) errors.Store(work.errors + at);
  }
};

/// @p lanes: those of the block at least.
template <PairForm form, Pass pass, int lanes>
HWY_NOINLINE void RunBlock(const PairWork& work, int at) {
  const PairBlock& block = work.blocks[at];
  BlockState<form, pass, Wide<lanes>> state;
  state.Begin(work, block);
  for (int i = 0; i < block.row_count; ++i) state.DoRow(work, block.rows[i], i);
  state.End(work, at);
}

/// Two blocks, row by row: while a row waits for the one before it, the other block has work.
template <PairForm form, Pass pass>
HWY_NOINLINE void RunTwoBlocks(const PairWork& work, int at) {
  const PairBlock &block = work.blocks[at], &next = work.blocks[at + 1];
  BlockState<form, pass, Wide<kLanes>> first, second;
  first.Begin(work, block);
  second.Begin(work, next);
  for (int i = 0; i < block.row_count; ++i) {
    first.DoRow(work, block.rows[i], i);
    second.DoRow(work, block.rows[i], i);
  }
  first.End(work, at);
  second.End(work, at + 1);
}

inline bool HasFriction(const PairBlock& block) {
  for (int i = 0; i < block.row_count; ++i) {
    if (block.rows[i].parent >= 0) return true;
  }
  return false;
}

/// Registers that hold more than one block: a line is one of them.
constexpr bool kTwoAtOnce = Wide<kLanes>::kRegisters == 1;
/// From block @p at on, in registers as narrow as its lanes allow: small worlds have blocks with
/// few lanes, and a division of sixteen numbers takes four times as long as one of four. Returns
/// how many blocks were done.
template <PairForm form, Pass pass>
int RunSome(const PairWork& work, int at) {
  const PairBlock& block = work.blocks[at];
  if (pass == Pass::kFriction && !HasFriction(block)) return 1;
  if constexpr (kTwoAtOnce) {
    if (at + 1 < work.count && block.like_next) {
      RunTwoBlocks<form, pass>(work, at);
      return 2;
    }
  }
  if (block.lanes <= 4) {
    RunBlock<form, pass, 4>(work, at);
  } else if (block.lanes <= 8) {
    RunBlock<form, pass, 8>(work, at);
  } else {
    RunBlock<form, pass, kLanes>(work, at);
  }
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
                                      Run<Pass::kMeasuredSweep>, Run<Pass::kFriction>,
                                      Run<Pass::kMeasure>};

}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();
#endif

#endif
