// SPDX-License-Identifier: MIT
// Products with G, lane by lane: plain loops over the lanes of a line, which the compiler turns
// into vectors of each target. Compiled once per target.
#if defined(CAIRN_SIMD_PAIR_PRODUCTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CAIRN_SIMD_PAIR_PRODUCTS_INL_H_
#undef CAIRN_SIMD_PAIR_PRODUCTS_INL_H_
#else
#define CAIRN_SIMD_PAIR_PRODUCTS_INL_H_
#endif

#include <hwy/highway.h>

#include "simd/pair_products.h"

HWY_BEFORE_NAMESPACE();
namespace cairn::simd {
namespace HWY_NAMESPACE {
namespace products {

template <class T>
using Lanes = T[kLanes];

/// G of one row in full: twelve lines, or the first six of them.
template <class T>
struct FullRow {
  LineOf<T> g[kPairLines];
};

template <class T>
HWY_INLINE void Copy(const Line& from, LineOf<T>* to) {
  for (int l = 0; l < kLanes; ++l) to->lane[l] = static_cast<T>(from.lane[l]);
}

template <class T, PairForm form>
HWY_INLINE void Expand(const Line* pair, const Line* row, FullRow<T>* full) {
  if constexpr (form == PairForm::kContact) {
    // linear parts: s_a n and -s_b n
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < kLanes; ++l) {
        const T n = static_cast<T>(row[k].lane[l]);
        full->g[k].lane[l] = static_cast<T>(pair[0].lane[l]) * n;
        full->g[6 + k].lane[l] = -(static_cast<T>(pair[1].lane[l]) * n);
      }
      Copy<T>(row[3 + k], &full->g[3 + k]);
      Copy<T>(row[6 + k], &full->g[9 + k]);
    }
  } else {
    for (int k = 0; k < JacobianLines(form); ++k) Copy<T>(row[k], &full->g[k]);
  }
}

/// function(row, full) for every row.
template <class T, PairForm form, class Function>
HWY_INLINE void ForRows(const PairBlock& block, const Line* lines, const Function& function) {
  const Line* const pair = lines;
  lines += PairLines(form);
  FullRow<T> full;
  for (int i = 0; i < block.row_count; ++i) {
    Expand<T, form>(pair, lines, &full);
    function(i, full);
    lines += RowLines(form, block.rows[i]);
  }
}

constexpr int BodyLines(PairForm form) { return form == PairForm::kSingle ? 6 : kPairLines; }

template <class T, PairForm form>
HWY_NOINLINE void MultiplyForm(const PairBlock& block, const Line* lines, const LineOf<T>* v,
                               LineOf<T>* rows) {
  ForRows<T, form>(block, lines, [&](int i, const FullRow<T>& full) {
    Lanes<T> sum;
    for (int l = 0; l < kLanes; ++l) sum[l] = full.g[0].lane[l] * v[0].lane[l];
    for (int k = 1; k < BodyLines(form); ++k) {
      for (int l = 0; l < kLanes; ++l) sum[l] += full.g[k].lane[l] * v[k].lane[l];
    }
    for (int l = 0; l < kLanes; ++l) rows[i].lane[l] = sum[l];
  });
}

template <class T, PairForm form>
HWY_NOINLINE void MultiplyTransposedForm(const PairBlock& block, const Line* lines,
                                         const LineOf<T>* rows, LineOf<T>* v) {
  LineOf<T> sum[BodyLines(form)] = {};
  ForRows<T, form>(block, lines, [&](int i, const FullRow<T>& full) {
    for (int k = 0; k < BodyLines(form); ++k) {
      for (int l = 0; l < kLanes; ++l) sum[k].lane[l] += full.g[k].lane[l] * rows[i].lane[l];
    }
  });
  for (int k = 0; k < BodyLines(form); ++k) v[k] = sum[k];
}

/// Adds the products of numbers @p first to 5 of one side, times the weight, with one number of the
/// other.
template <class T>
HWY_INLINE void AddColumn(const LineOf<T>* weighted, const LineOf<T>& number, int first,
                          LineOf<T>* gram) {
  for (int k = first; k < 6; ++k) {
    for (int l = 0; l < kLanes; ++l) {
      gram[k - first].lane[l] += weighted[k].lane[l] * number.lane[l];
    }
  }
}

template <class T, PairForm form>
HWY_NOINLINE void WeightedGramForm(const PairBlock& block, const Line* lines,
                                   const LineOf<T>* weights, LineOf<T>* gram) {
  constexpr int kUsed = form == PairForm::kSingle ? kTriangleLines : kGramLines;
  for (int k = 0; k < kUsed; ++k) gram[k] = {};
  ForRows<T, form>(block, lines, [&](int i, const FullRow<T>& full) {
    LineOf<T> weighted[BodyLines(form)];
    for (int k = 0; k < BodyLines(form); ++k) {
      for (int l = 0; l < kLanes; ++l) {
        weighted[k].lane[l] = weights[i].lane[l] * full.g[k].lane[l];
      }
    }
    LineOf<T>* column = gram;
    for (int c = 0; c < 6; column += 6 - c, ++c) AddColumn<T>(weighted, full.g[c], c, column);
    if constexpr (form != PairForm::kSingle) {
      for (int c = 0; c < 6; column += 6, ++c) AddColumn<T>(weighted, full.g[6 + c], 0, column);
      for (int c = 0; c < 6; column += 6 - c, ++c) {
        AddColumn<T>(weighted + 6, full.g[6 + c], c, column);
      }
    }
  });
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
