// SPDX-License-Identifier: MIT
// Products with G, lane by lane. Compiled once per target.
#if defined(CAIRN_SIMD_PAIR_PRODUCTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_PAIR_PRODUCTS_INL_H_
#undef CAIRN_SIMD_PAIR_PRODUCTS_INL_H_
#else
#define CAIRN_SIMD_PAIR_PRODUCTS_INL_H_
#endif

#include <hwy/highway.h>

#include "simd/pairs/pair_products.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace products {

namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes as fit a register.
template <class T>
using LaneTag = hn::CappedTag<T, kLanes>;
template <class T>
using LaneVec = hn::Vec<LaneTag<T>>;

template <class T>
constexpr int Step() {
  return static_cast<int>(hn::MaxLanes(LaneTag<T>()));
}

HWY_INLINE LaneVec<float> LoadAs(LaneTag<float> d, const float* from) { return hn::Load(d, from); }
HWY_INLINE LaneVec<double> LoadAs(LaneTag<double> d, const float* from) {
  const hn::Rebind<float, LaneTag<double>> d_float;
  return hn::PromoteTo(d, hn::Load(d_float, from));
}

constexpr int BodyLines(PairForm form) { return form == PairForm::kSingle ? 6 : kPairLines; }

/// G of rows in full, with the bodies of their pair: numbers of some lanes, which begin at @p lane.
template <class T, PairForm form>
struct RowsInFull {
  LaneVec<T> c_a, c_b;
  int lane;

  HWY_INLINE RowsInFull(const Line* pair, int first) : lane(first) {
    if constexpr (form == PairForm::kContact) {
      c_a = LoadAs(LaneTag<T>(), pair[0].lane + lane);
      c_b = LoadAs(LaneTag<T>(), pair[1].lane + lane);
    } else {
      c_a = c_b = hn::Zero(LaneTag<T>());
    }
  }
  /// Number @p k of a row. See PairForm::kContact.
  template <int k>
  HWY_INLINE LaneVec<T> At(const Line* row) const {
    const LaneTag<T> d;
    if constexpr (form != PairForm::kContact) {
      return LoadAs(d, row[k].lane + lane);
    } else if constexpr (k < 3) {
      return hn::Mul(c_a, LoadAs(d, row[k].lane + lane));
    } else if constexpr (k < 6) {
      return LoadAs(d, row[k].lane + lane);
    } else if constexpr (k < 9) {
      return hn::Neg(hn::Mul(c_b, LoadAs(d, row[k - 6].lane + lane)));
    } else {
      return LoadAs(d, row[k - 3].lane + lane);
    }
  }
  /// function(number of a row, its place) for all of them, without an array: compilers would keep
  /// one in memory.
  template <int k = 0, class Function>
  HWY_INLINE void ForNumbers(const Line* row, const Function& function) const {
    if constexpr (k < BodyLines(form)) {
      function(At<k>(row), k);
      ForNumbers<k + 1>(row, function);
    }
  }
};

/// Sums that stay in registers: members, since compilers keep arrays in memory.
template <class T, int count>
struct Sums {
  LaneVec<T> first;
  Sums<T, count - 1> rest;

  HWY_INLINE void Clear() {
    first = hn::Zero(LaneTag<T>());
    rest.Clear();
  }
  HWY_INLINE void Load(const LineOf<T>* lines, int lane) {
    first = hn::Load(LaneTag<T>(), lines->lane + lane);
    rest.Load(lines + 1, lane);
  }
  HWY_INLINE void AddProducts(const LineOf<T>* lines, int lane, LaneVec<T> number) {
    first = hn::Add(first, hn::Mul(hn::Load(LaneTag<T>(), lines->lane + lane), number));
    rest.AddProducts(lines + 1, lane, number);
  }
  /// Number by number those of a row.
  template <PairForm form>
  HWY_INLINE void AddProducts(const RowsInFull<T, form>& rows, const Line* row, LaneVec<T> number) {
    first = hn::Add(first, hn::Mul(rows.template At<BodyLines(form) - count>(row), number));
    rest.AddProducts(rows, row, number);
  }
  HWY_INLINE void Store(LineOf<T>* lines, int lane) const {
    hn::Store(first, LaneTag<T>(), lines->lane + lane);
    rest.Store(lines + 1, lane);
  }
};
template <class T>
struct Sums<T, 0> {
  HWY_INLINE void Clear() {}
  HWY_INLINE void Load(const LineOf<T>*, int) {}
  HWY_INLINE void AddProducts(const LineOf<T>*, int, LaneVec<T>) {}
  template <PairForm form>
  HWY_INLINE void AddProducts(const RowsInFull<T, form>&, const Line*, LaneVec<T>) {}
  HWY_INLINE void Store(LineOf<T>*, int) const {}
};

/// function(lane) for as many lanes at a time as fit a register, as far as the block is filled.
template <class T, class Function>
HWY_INLINE void ForLanes(const PairBlock& block, const Function& function) {
  for (int lane = 0; lane < block.lanes; lane += Step<T>()) function(lane);
}

/// function(i, lines) for every row.
template <PairForm form, class Function>
HWY_INLINE void ForRows(const PairBlock& block, const Line* lines, const Function& function) {
  lines += PairLines(form);
  for (int i = 0; i < block.row_count; ++i) {
    function(i, lines);
    lines += RowLines(form, block.rows[i]);
  }
}

template <class T, PairForm form>
HWY_NOINLINE void MultiplyForm(const PairBlock& block, const Line* lines, const LineOf<T>* v,
                               LineOf<T>* rows) {
  const LaneTag<T> d;
  for (int i = 0; i < block.row_count; ++i) rows[i] = {};  // lanes that are not filled, too
  ForLanes<T>(block, [&](int lane) HWY_ATTR {
    const RowsInFull<T, form> in_full(lines, lane);
    ForRows<form>(block, lines, [&](int i, const Line* row) HWY_ATTR {
      LaneVec<T> sum = hn::Zero(d);
      in_full.ForNumbers(row, [&](LaneVec<T> g, int k) HWY_ATTR {
        const auto product = hn::Mul(g, hn::Load(d, v[k].lane + lane));
        sum = k == 0 ? product : hn::Add(sum, product);
      });
      hn::Store(sum, d, rows[i].lane + lane);
    });
  });
}

template <class T, PairForm form>
HWY_NOINLINE void MultiplyTransposedForm(const PairBlock& block, const Line* lines,
                                         const LineOf<T>* rows, LineOf<T>* v) {
  const LaneTag<T> d;
  ForLanes<T>(block, [&](int lane) HWY_ATTR {
    const RowsInFull<T, form> in_full(lines, lane);
    Sums<T, BodyLines(form)> sums;
    sums.Clear();
    ForRows<form>(block, lines, [&](int i, const Line* row) HWY_ATTR {
      sums.AddProducts(in_full, row, hn::Load(d, rows[i].lane + lane));
    });
    sums.Store(v, lane);
  });
}

/// Some rows, in full and with their weights.
template <class T, PairForm form>
struct SomeRows {
  static constexpr int kMost = 6;
  LineOf<T> g[kMost][BodyLines(form)], weighted[kMost][BodyLines(form)];
  int count = 0;
};

/// Adds to @p size lines of gram the products of numbers @p first and after, times the weight, with
/// number @p column of the same row. Sums stay in registers from row to row.
template <int size, class T, PairForm form>
HWY_INLINE void AddColumn(const SomeRows<T, form>& rows, int first, int column, int lane,
                          LineOf<T>* gram) {
  const LaneTag<T> d;
  Sums<T, size> sums;
  sums.Load(gram, lane);
  for (int i = 0; i < rows.count; ++i) {
    const auto number = hn::Load(d, rows.g[i][column].lane + lane);
    sums.AddProducts(rows.weighted[i] + first, lane, number);
  }
  sums.Store(gram, lane);
}

/// The lower triangle of numbers @p first to first + 5 with themselves.
template <class T, PairForm form>
HWY_INLINE void AddTriangle(const SomeRows<T, form>& rows, int first, int lane, LineOf<T>* gram) {
  AddColumn<6>(rows, first, first, lane, gram);
  AddColumn<5>(rows, first + 1, first + 1, lane, gram + 6);
  AddColumn<4>(rows, first + 2, first + 2, lane, gram + 11);
  AddColumn<3>(rows, first + 3, first + 3, lane, gram + 15);
  AddColumn<2>(rows, first + 4, first + 4, lane, gram + 18);
  AddColumn<1>(rows, first + 5, first + 5, lane, gram + 20);
}

template <class T, PairForm form>
HWY_INLINE void AddRows(const PairBlock& block, const SomeRows<T, form>& rows, LineOf<T>* gram) {
  ForLanes<T>(block, [&](int lane) HWY_ATTR {
    AddTriangle(rows, 0, lane, gram);
    if constexpr (form != PairForm::kSingle) {
      LineOf<T>* const square = gram + kTriangleLines;
      for (int c = 0; c < 6; ++c) AddColumn<6>(rows, 0, 6 + c, lane, square + 6 * c);
      AddTriangle(rows, 6, lane, square + kSquareLines);
    }
  });
}

template <class T, PairForm form>
HWY_NOINLINE void WeightedGramForm(const PairBlock& block, const Line* lines,
                                   const LineOf<T>* weights, LineOf<T>* gram) {
  constexpr int kUsed = form == PairForm::kSingle ? kTriangleLines : kGramLines;
  const LaneTag<T> d;
  ForLanes<T>(block, [&](int lane) HWY_ATTR {
    for (int k = 0; k < kUsed; ++k) hn::Store(hn::Zero(d), d, gram[k].lane + lane);
  });
  SomeRows<T, form> some;
  ForRows<form>(block, lines, [&](int i, const Line* row) HWY_ATTR {
    ForLanes<T>(block, [&](int lane) HWY_ATTR {
      const auto weight = hn::Load(d, weights[i].lane + lane);
      RowsInFull<T, form>(lines, lane).ForNumbers(row, [&](LaneVec<T> g, int k) HWY_ATTR {
        hn::Store(g, d, some.g[some.count][k].lane + lane);
        hn::Store(hn::Mul(weight, g), d, some.weighted[some.count][k].lane + lane);
      });
    });
    if (++some.count < SomeRows<T, form>::kMost) return;
    AddRows(block, some, gram);
    some.count = 0;
  });
  AddRows(block, some, gram);
}

template <class T>
void Multiply(const PairBlock& block, const Line* lines, const LineOf<T>* v, LineOf<T>* rows) {
  switch (block.form) {
    case PairForm::kJoint:
      return MultiplyForm<T, PairForm::kJoint>(block, lines, v, rows);
    case PairForm::kContact:
      return MultiplyForm<T, PairForm::kContact>(block, lines, v, rows);
    case PairForm::kSingle:
      return MultiplyForm<T, PairForm::kSingle>(block, lines, v, rows);
  }
}

template <class T>
void MultiplyTransposed(const PairBlock& block, const Line* lines, const LineOf<T>* rows,
                        LineOf<T>* v) {
  switch (block.form) {
    case PairForm::kJoint:
      return MultiplyTransposedForm<T, PairForm::kJoint>(block, lines, rows, v);
    case PairForm::kContact:
      return MultiplyTransposedForm<T, PairForm::kContact>(block, lines, rows, v);
    case PairForm::kSingle:
      return MultiplyTransposedForm<T, PairForm::kSingle>(block, lines, rows, v);
  }
}

template <class T>
void WeightedGram(const PairBlock& block, const Line* lines, const LineOf<T>* weights,
                  LineOf<T>* gram) {
  switch (block.form) {
    case PairForm::kJoint:
      return WeightedGramForm<T, PairForm::kJoint>(block, lines, weights, gram);
    case PairForm::kContact:
      return WeightedGramForm<T, PairForm::kContact>(block, lines, weights, gram);
    case PairForm::kSingle:
      return WeightedGramForm<T, PairForm::kSingle>(block, lines, weights, gram);
  }
}

template <class T>
constexpr PairProducts<T> kProducts = {Multiply<T>, MultiplyTransposed<T>, WeightedGram<T>};

}  // namespace products
}  // namespace HWY_NAMESPACE
}  // namespace cairn::simd
HWY_AFTER_NAMESPACE();

#endif
