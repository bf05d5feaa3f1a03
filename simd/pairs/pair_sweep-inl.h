// SPDX-License-Identifier: MIT
// Passes over pairs, 4, 8 or 16 lanes at a time. Compiled once per target; pair_reference.cc
// is the specification, operation for operation.
#if defined(CAIRN_SIMD_PAIR_SWEEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_PAIR_SWEEP_INL_H_
#undef CAIRN_SIMD_PAIR_SWEEP_INL_H_
#else
#define CAIRN_SIMD_PAIR_SWEEP_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <span>

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
HWY_INLINE W Product(const float* g, const W& v) {
  return Mul(LoadLanes<W>(g), v);
}

// Sums of 2, 4 and 8 products as balanced trees: fewer steps than one sum after the other.
template <class W>
HWY_INLINE W Sum2(ConstFromLane g, const W& v0, const W& v1) {
  return Add(Product(g[0], v0), Product(g[1], v1));
}
template <class W>
HWY_INLINE W Sum4(ConstFromLane g, const W& v0, const W& v1, const W& v2, const W& v3) {
  return Add(Sum2(g, v0, v1), Sum2(g + 2, v2, v3));
}
template <class W>
HWY_INLINE void Apply(ConstFromLane g, const W& change, Three<W>* v) {
  v->x = AddProduct(v->x, LoadLanes<W>(g[0]), change);
  v->y = AddProduct(v->y, LoadLanes<W>(g[1]), change);
  v->z = AddProduct(v->z, LoadLanes<W>(g[2]), change);
}

/// Where a run is.
struct RunPlace {
  const std::int32_t *a, *b;  ///< slots of its lanes
  ConstFromLane pair;         ///< lines of the pair
  int lanes;
};

/// The numbers that G of a form multiplies, from and to the bodies.
template <PairForm form, class W>
struct PairState;

template <class W>
struct PairState<PairForm::kSingle, W> {
  Three<W> linear, angular;

  HWY_INLINE void Gather(const PairWork& work, const RunPlace& run) {
    linear = GatherBodies<W>(work.bodies, run.a, 0, run.lanes);
    angular = GatherBodies<W>(work.bodies, run.a, 1, run.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const RunPlace& run) const {
    ScatterBodies(linear, work.bodies, run.a, 0, run.lanes);
    ScatterBodies(angular, work.bodies, run.a, 1, run.lanes);
  }
  // G v = Head() + Tail()
  HWY_INLINE W Head(ConstFromLane g) const {
    return Sum4(g, linear.x, linear.y, linear.z, angular.x);
  }
  HWY_INLINE W Tail(ConstFromLane g) const { return Sum2(g + 4, angular.y, angular.z); }
  HWY_INLINE void Push(ConstFromLane g, const W& change) {
    Apply(g, change, &linear);
    Apply(g + 3, change, &angular);
  }
};

template <class W>
struct PairState<PairForm::kJoint, W> {
  Three<W> linear_a, angular_a, linear_b, angular_b;

  HWY_INLINE void Gather(const PairWork& work, const RunPlace& run) {
    linear_a = GatherBodies<W>(work.bodies, run.a, 0, run.lanes);
    angular_a = GatherBodies<W>(work.bodies, run.a, 1, run.lanes);
    linear_b = GatherBodies<W>(work.bodies, run.b, 0, run.lanes);
    angular_b = GatherBodies<W>(work.bodies, run.b, 1, run.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const RunPlace& run) const {
    ScatterBodies(linear_a, work.bodies, run.a, 0, run.lanes);
    ScatterBodies(angular_a, work.bodies, run.a, 1, run.lanes);
    ScatterBodies(linear_b, work.bodies, run.b, 0, run.lanes);
    ScatterBodies(angular_b, work.bodies, run.b, 1, run.lanes);
  }
  HWY_INLINE W Head(ConstFromLane g) const {
    return Add(Sum4(g, linear_a.x, linear_a.y, linear_a.z, angular_a.x),
               Sum4(g + 4, angular_a.y, angular_a.z, linear_b.x, linear_b.y));
  }
  HWY_INLINE W Tail(ConstFromLane g) const {
    return Sum4(g + 8, linear_b.z, angular_b.x, angular_b.y, angular_b.z);
  }
  HWY_INLINE void Push(ConstFromLane g, const W& change) {
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

  HWY_INLINE void Gather(const PairWork& work, const RunPlace& run) {
    const W c_a = LoadLanes<W>(run.pair[0]), c_b = LoadLanes<W>(run.pair[1]);
    const Three<W> a = GatherBodies<W>(work.bodies, run.a, 0, run.lanes);
    const Three<W> b = GatherBodies<W>(work.bodies, run.b, 0, run.lanes);
    relative = {Relative(c_a, c_b, a.x, b.x), Relative(c_a, c_b, a.y, b.y),
                Relative(c_a, c_b, a.z, b.z)};
    angular_a = GatherBodies<W>(work.bodies, run.a, 1, run.lanes);
    angular_b = GatherBodies<W>(work.bodies, run.b, 1, run.lanes);
  }
  HWY_INLINE void Scatter(const PairWork& work, const RunPlace& run) const {
    ScatterBodies(angular_a, work.bodies, run.a, 1, run.lanes);
    ScatterBodies(angular_b, work.bodies, run.b, 1, run.lanes);

    // gathered once more rather than kept: the registers are needed for the rows
    const W c_a = LoadLanes<W>(run.pair[0]), c_b = LoadLanes<W>(run.pair[1]);
    Three<W> a = GatherBodies<W>(work.bodies, run.a, 0, run.lanes);
    Three<W> b = GatherBodies<W>(work.bodies, run.b, 0, run.lanes);
    Share(c_a, c_b, relative.x, &a.x, &b.x);
    Share(c_a, c_b, relative.y, &a.y, &b.y);
    Share(c_a, c_b, relative.z, &a.z, &b.z);
    ScatterBodies(a, work.bodies, run.a, 0, run.lanes);
    ScatterBodies(b, work.bodies, run.b, 0, run.lanes);
  }
  HWY_INLINE static W Relative(const W& c_a, const W& c_b, const W& a, const W& b) {
    return Sub(Mul(c_a, a), Mul(c_b, b));
  }
  HWY_INLINE static void Share(const W& c_a, const W& c_b, const W& now, W* a, W* b) {
    const W moved = Sub(now, Relative(c_a, c_b, *a, *b));
    *a = AddProduct(*a, c_a, moved);
    *b = Sub(*b, Mul(c_b, moved));
  }
  HWY_INLINE W Head(ConstFromLane g) const {
    return Add(Sum4(g, relative.x, relative.y, relative.z, angular_a.x),
               Sum4(g + 4, angular_a.y, angular_a.z, angular_b.x, angular_b.y));
  }
  HWY_INLINE W Tail(ConstFromLane g) const { return Product(g[8], angular_b.z); }
  HWY_INLINE void Push(ConstFromLane g, const W& change) {
    Apply(g, change, &relative);
    Apply(g + 3, change, &angular_a);
    Apply(g + 6, change, &angular_b);
  }
};

/// Floats of the bounds of a row, by RowBound: a load instead of branches.
constexpr std::ptrdiff_t kBoundFloats[] = {
    kLanes * BoundLines(RowBound::kFree), kLanes* BoundLines(RowBound::kPush),
    kLanes* BoundLines(RowBound::kOwn), kLanes* BoundLines(RowBound::kFriction),
    kLanes* BoundLines(RowBound::kCutFriction)};

template <class W>
HWY_INLINE W Clamp(const RowShape& row, ConstFromLane bounds, FromLane x, const W& moved) {
  const RowBound bound = row.bound;
  switch (bound) {
    case RowBound::kFree:
      return moved;
    case RowBound::kPush:
      return Max(moved, Zeros<W>());
    case RowBound::kOwn:
      return Min(Max(moved, LoadLanes<W>(bounds[0])), LoadLanes<W>(bounds[1]));
    case RowBound::kFriction:
    case RowBound::kCutFriction:
      break;
  }
  // 0 - 0 is +0 on every target, -(0) is not
  const W most = Mul(LoadLanes<W>(bounds[0]), Max(LoadLanes<W>(x[row.parent]), Zeros<W>()));
  const W least = Sub(Zeros<W>(), most);
  if (bound == RowBound::kFriction) return Min(Max(moved, least), most);
  return Min(Max(moved, Max(least, LoadLanes<W>(bounds[1]))), Min(most, LoadLanes<W>(bounds[2])));
}

/// Largest and squared errors of the rows seen so far.
template <class W>
struct ErrorSums {
  W max, max_angular, energy;

  HWY_INLINE void Reset() { max = max_angular = energy = Zeros<W>(); }
  /// @p moved: by impulses; @p of_d: the same, as whole bodies would have moved them
  HWY_INLINE void Add(const RowShape& row, const W& moved, const W& inv_d, const W& of_d) {
    const W e = Div(moved, inv_d);
    if (row.angular) {
      max_angular = Max(e, max_angular);
    } else {
      max = Max(e, max);
    }
    energy = AddProduct(energy, e, of_d);
  }
  /// Lanes of the runs that follow, too: theirs come later.
  HWY_INLINE void Store(int first, BlockError* error) const {
    StoreLanes(max, error->max.lane + first);
    StoreLanes(max_angular, error->max_angular.lane + first);
    StoreLanes(energy, error->energy.lane + first);
  }
};

/// A run on its way through the rows. What a row changed is pushed to the bodies when the next one
/// has read them: that one takes it into account by its coupling, and waits less.
/// @tparam copies  its block has some: errors are measured by whole bodies
template <PairForm form, Pass pass, class W, bool copies>
struct RunState {
  /// Registers that are shorter than a line may hold lanes of other runs beside those of this one.
  static constexpr bool kShared = W::kLaneCount < kLanes;
  using Own = typename FirstLanesFor<W>::Type;

  RunPlace place;
  ConstFromLane line;  ///< of the next row
  FromLane x;          ///< of the first row
  Own own;
  PairState<form, W> pair;
  ErrorSums<W> errors;
  const float* d_ratio = nullptr;  ///< of the next row, in blocks with copies
  ConstFromLane changed = {};      ///< the row before, if its change was not pushed yet
  W change_before;

  HWY_INLINE RunState(const PairWork& work, const LaneRun& run) : own(run.lanes) {
    const PairBlock& block = work.blocks[run.block];
    line = {work.data[block.data].lane + run.first};
    place = {block.a + run.first, block.b + run.first, line, run.lanes};
    x = {work.x[block.x].lane + run.first};
    pair.Gather(work, place);
    line += PairLines(form);
    if (Measures(pass)) {
      errors.Reset();
      if (copies) d_ratio = work.d_ratios[block.d_ratios].lane + run.first;
    }
  }
  /// @p x_row: its impulses
  HWY_INLINE void DoRow(const PairWork& work, const RowShape& row, float* x_row) {
    if (pass != Pass::kStart && TakesPart(work, row)) return Relax(work, row, x_row);
    if constexpr (pass == Pass::kStart) {
      pair.Push(line, LoadLanes<W>(x_row));
    } else {
      PushChange();
    }
    line += RowLines(form, row);
    if (copies) d_ratio += kLanes;
  }
  HWY_INLINE void PushChange() {
    if (changed.lane == nullptr) return;
    pair.Push(changed, change_before);
    changed = {};
  }
  HWY_INLINE W NextRatio() {
    const W ratio = LoadLanes<W>(d_ratio);
    d_ratio += kLanes;
    return ratio;
  }
  HWY_INLINE static bool TakesPart(const PairWork& work, const RowShape& row) {
    if (pass == Pass::kFriction && row.parent < 0) return false;
    return pass == Pass::kMeasure || work.sweep < row.max_sweeps;
  }
  HWY_INLINE void Relax(const PairWork& work, const RowShape& row, float* x_row) {
    constexpr int kTarget = JacobianLines(form), kStep = kTarget + 1;
    const W old = LoadLanes<W>(x_row);
    W target = LoadLanes<W>(line[kTarget]);
    ConstFromLane bounds = line + (kStep + 1);
    if (row.soft) {
      target = Sub(target, Mul(LoadLanes<W>(bounds[0]), old));
      bounds += 1;
    }

    const W step = LoadLanes<W>(line[kStep]);
    W inv_d = step;
    if (row.relaxed) {
      if (Measures(pass)) inv_d = Div(step, LoadLanes<W>(bounds[0]));
      bounds += 1;
    }
    if (copies && pass == Pass::kMeasure) inv_d = Mul(inv_d, NextRatio());
    // old + factor (target - G v)
    const W factor = pass == Pass::kMeasure ? inv_d : step;
    const W error = Sub(target, Add(pair.Head(line), pair.Tail(line)));
    W moved = Add(old, Mul(factor, error));
    const ConstFromLane end = {bounds.lane + kBoundFloats[static_cast<int>(row.bound)]};
    if (pass != Pass::kMeasure && changed.lane != nullptr) {
      // the coupling comes after the bounds
      moved = Sub(moved, Mul(Mul(factor, LoadLanes<W>(end[0])), change_before));
      pair.Push(changed, change_before);
    }
    W now = Clamp(row, bounds, x, moved);
    // what the bodies see is what becomes of the impulse, as a float has it
    W change = Sub(now, old);
    if (pass != Pass::kMeasure && work.hold_lifted && row.parent >= 0) {
      change = WherePositive(change, LoadLanes<W>(x[row.parent]));
      now = Add(old, change);
    }
    if (Measures(pass)) {
      const W size = Abs(change);
      W of_d = size;
      if (copies && pass == Pass::kMeasuredSweep) of_d = Mul(size, NextRatio());
      errors.Add(row, size, inv_d, of_d);
    }
    if (pass != Pass::kMeasure) {
      StoreLanes(kShared ? own.Choose(now, old) : now, x_row);
      changed = line;
      change_before = change;
    }
    line = end + 1;
  }
  HWY_INLINE void End(const PairWork& work, const LaneRun& run) {
    PushChange();
    if (pass != Pass::kMeasure) pair.Scatter(work, place);
    if (Measures(pass)) errors.Store(run.first, work.errors + run.block);
  }
};

HWY_INLINE std::span<const RowShape> RowsOf(const PairBlock& block) {
  return {block.rows, static_cast<std::size_t>(block.row_count)};
}

/// @p width: WidthOf() its lanes at least.
template <PairForm form, Pass pass, int width, bool copies>
HWY_NOINLINE void DoRun(const PairWork& work, const LaneRun& run) {
  RunState<form, pass, Wide<width>, copies> state(work, run);
  float* x = state.x[0];
  for (const RowShape& row : RowsOf(work.blocks[run.block])) {
    state.DoRow(work, row, x);
    x += kLanes;
  }
  state.End(work, run);
}

/// Two runs, row by row: while a row waits for the one before it, the other run has work.
/// @pre neither has copies
template <PairForm form, Pass pass>
HWY_NOINLINE void DoTwoRuns(const PairWork& work, const LaneRun& run, const LaneRun& next) {
  RunState<form, pass, Wide<kLanes>, false> first(work, run), second(work, next);
  float *x_first = first.x[0], *x_second = second.x[0];
  for (const RowShape& row : RowsOf(work.blocks[run.block])) {
    first.DoRow(work, row, x_first);
    second.DoRow(work, row, x_second);
    x_first += kLanes;
    x_second += kLanes;
  }
  first.End(work, run);
  second.End(work, next);
}

inline bool HasFriction(const PairBlock& block) {
  for (int i = 0; i < block.row_count; ++i) {
    if (block.rows[i].parent >= 0) return true;
  }
  return false;
}

/// Registers that hold more than one run: a line is one of them.
constexpr bool kTwoAtOnce = Wide<kLanes>::kRegisters == 1;

template <PairForm form, Pass pass, bool copies>
HWY_INLINE void DoOne(const PairWork& work, const LaneRun& run) {
  switch (WidthOf(run.lanes)) {
    case 4:
      return DoRun<form, pass, 4, copies>(work, run);
    case 8:
      return DoRun<form, pass, 8, copies>(work, run);
    default:
      return DoRun<form, pass, kLanes, copies>(work, run);
  }
}

/// The first of some runs, or the first two if they are @p alike. Returns how many were done.
template <PairForm form, Pass pass>
int DoSome(const PairWork& work, const LaneRun& run, const LaneRun* alike) {
  const PairBlock& block = work.blocks[run.block];
  if (pass == Pass::kFriction && !HasFriction(block)) return 1;
  if constexpr (kTwoAtOnce) {
    if (alike != nullptr) {
      DoTwoRuns<form, pass>(work, run, *alike);
      return 2;
    }
  }
  if constexpr (Measures(pass)) {
    if (block.copies) {
      DoOne<form, pass, true>(work, run);
      return 1;
    }
  }
  DoOne<form, pass, false>(work, run);
  return 1;
}

template <Pass pass>
int DoSome(const PairWork& work, const LaneRun& run, const LaneRun* alike) {
  switch (work.blocks[run.block].form) {
    case PairForm::kJoint:
      return DoSome<PairForm::kJoint, pass>(work, run, alike);
    case PairForm::kContact:
      return DoSome<PairForm::kContact, pass>(work, run, alike);
    case PairForm::kSingle:
      return DoSome<PairForm::kSingle, pass>(work, run, alike);
  }
  return 1;
}

/// function(copy, body, share) for the copies of a run, in the order of lanes.
template <class Function>
HWY_INLINE void ForCopies(const PairWork& work, const LaneRun& run, const Function& function) {
  const PairBlock& block = work.blocks[run.block];
  for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
    for (const std::int32_t* const of : {block.a, block.b}) {
      if (of[lane] < work.first_copy) continue;
      const BodyCopy& copy = work.copies[of[lane] - work.first_copy];
      function(work.bodies[of[lane]].u, work.bodies[copy.slot].u, copy.share);
    }
  }
}

using FourTag = hn::FixedTag<float, 4>;

HWY_NOINLINE void FillCopies(const PairWork& work, const LaneRun& run) {
  ForCopies(work, run, [](float* copy, const float* body, float share) HWY_ATTR {
    const FourTag d;
    for (int k = 0; k < 8; k += 4) {
      hn::Store(hn::Mul(hn::Set(d, share), hn::Load(d, body + k)), d, copy + k);
    }
  });
}

HWY_NOINLINE void ClearCopies(const PairWork& work, const LaneRun& run) {
  ForCopies(work, run, [](float* copy, const float*, float) HWY_ATTR {
    const FourTag d;
    for (int k = 0; k < 8; k += 4) hn::Store(hn::Zero(d), d, copy + k);
  });
}

/// Adds to each body what its copies changed by.
HWY_NOINLINE void AddCopies(const PairWork& work, const LaneRun& run) {
  // all changes before any body moves
  ForCopies(work, run, [](float* copy, const float* body, float share) HWY_ATTR {
    const FourTag d;
    for (int k = 0; k < 8; k += 4) {
      const auto before = hn::Mul(hn::Set(d, share), hn::Load(d, body + k));
      hn::Store(hn::Sub(hn::Load(d, copy + k), before), d, copy + k);
    }
  });
  ForCopies(work, run, [](const float* copy, float* body, float share) HWY_ATTR {
    const FourTag d;
    for (int k = 0; k < 8; k += 4) {
      const auto change = hn::Mul(hn::Set(d, share), hn::Load(d, copy + k));
      hn::Store(hn::Add(hn::Load(d, body + k), change), d, body + k);
    }
  });
  ClearCopies(work, run);
}

template <Pass pass>
void Run(const PairWork& work) {
  const FlushDenormals flush;
  for (int i = 0; i < work.run_count;) {
    const LaneRun& run = work.runs[i];
    const bool two = i + 1 < work.run_count && run.like_next;
    if (run.copies) FillCopies(work, run);
    i += DoSome<pass>(work, run, two ? &work.runs[i + 1] : nullptr);
    if (run.copies) AddCopies(work, run);
  }
}

/// Nothing moves: whatever bodies they share, all lanes of a block are looked at together.
void MeasureBlocks(const PairWork& work) {
  const FlushDenormals flush;
  const auto whole = [&work](int block) {
    const PairBlock& of = work.blocks[block];
    return LaneRun{block, 0, static_cast<std::int16_t>(of.lanes), false, of.copies};
  };
  const int end = work.first_block + work.block_count;
  for (int block = work.first_block; block < end;) {
    const LaneRun run = whole(block), next = block + 1 < end ? whole(block + 1) : LaneRun{};
    const bool two = block + 1 < end && work.blocks[block].form == work.blocks[block + 1].form &&
                     work.blocks[block].rows == work.blocks[block + 1].rows && !run.copies &&
                     !next.copies;
    if (run.copies) FillCopies(work, run);
    block += DoSome<Pass::kMeasure>(work, run, two ? &next : nullptr);
    if (run.copies) ClearCopies(work, run);
  }
}

template <PairForm form>
void Couple(const PairBlock& block, Line* lines) {
  using W = Wide<kLanes>;
  const Line* before = nullptr;
  Line* line = lines + PairLines(form);
  for (int i = 0; i < block.row_count; ++i) {
    W coupling = Zeros<W>();
    for (int k = 0; k < JacobianLines(form) && before != nullptr; ++k) {
      coupling = AddProduct(coupling, LoadLanes<W>(line[k].lane), LoadLanes<W>(before[k].lane));
    }
    StoreLanes(coupling, line[CouplingLine(form, block.rows[i])].lane);
    before = line;
    line += RowLines(form, block.rows[i]);
  }
}

void CoupleRows(const PairBlock& block, Line* lines) {
  const FlushDenormals flush;
  switch (block.form) {
    case PairForm::kJoint:
      return Couple<PairForm::kJoint>(block, lines);
    case PairForm::kContact:
      return Couple<PairForm::kContact>(block, lines);
    case PairForm::kSingle:
      return Couple<PairForm::kSingle>(block, lines);
  }
}

constexpr PairKernels kPairKernels = {CoupleRows,           Run<Pass::kStart>,
                                      Run<Pass::kSweep>,    Run<Pass::kMeasuredSweep>,
                                      Run<Pass::kFriction>, MeasureBlocks};

}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();
#endif

#endif
