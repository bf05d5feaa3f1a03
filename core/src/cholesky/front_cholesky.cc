// SPDX-License-Identifier: MIT
#include "cholesky/front_cholesky.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>

namespace cairn {
namespace {

/// Operations below which threads cost more than they save.
constexpr double kSerialFlops = 2e6;

}  // namespace

template <class T>
FrontCholesky<T>::FrontCholesky(simd::Target target) : kernels_(simd::FrontKernelsFor<T>(target)) {}

template <class T>
void FrontCholesky<T>::SetZero() {
  std::fill(values_.begin(), values_.end(), T(0));
}

template <class T>
simd::Front<T> FrontCholesky<T>::ShapeOf(int front) const {
  const Front& at = pattern_.fronts()[front];
  return {nullptr, nullptr, Scalars(at.pivots), Scalars(at.rows_end - at.rows_begin)};
}

template <class T>
simd::Front<T> FrontCholesky<T>::FrontAt(int front) {
  simd::Front<T> at = ShapeOf(front);
  at.panel = panels_.data() + places_[front].panel;
  at.update = updates_.data() + places_[front].update;
  return at;
}

template <class T>
template <int kNodeSize>
void FrontCholesky<T>::CopyBlocks(int front) {
  const auto at = FrontAt(front);
  const std::ptrdiff_t stride = at.panel_stride();
  const int size = kNodeSize > 0 ? kNodeSize : pattern_.node_size();
  for (int k = places_[front].blocks_begin; k < places_[front].blocks_end; ++k) {
    const T* const from = ValuesOf(k);
    T* const to = at.panel + blocks_[k].to;
    if (blocks_[k].transposed) {
      for (int j = 0; j < size; ++j) {
        for (int i = 0; i < size; ++i) to[j * stride + i] = from[i * size + j];
      }
    } else {
      for (int j = 0; j < size; ++j) {
        std::memcpy(to + j * stride, from + j * size, size * sizeof(T));
      }
    }
  }
}

template <class T>
void FrontCholesky<T>::Begin(int front) {
  const auto at = FrontAt(front);
  const std::ptrdiff_t stride = at.panel_stride();
  std::memset(at.panel, 0, stride * at.pivots * sizeof(T));
  if (pattern_.node_size() == 6) {
    CopyBlocks<6>(front);
  } else if (pattern_.node_size() == 1) {
    CopyBlocks<1>(front);
  } else {
    CopyBlocks<0>(front);
  }

  const Front& here = pattern_.fronts()[front];
  T* const floors = floors_.data() + Scalars(here.first);
  for (int k = 0; k < at.pivots; ++k) {
    // not above zero: not above the floor
    const T entry = at.panel[k * (stride + 1)];
    floors[k] = entry > 0 ? std::numeric_limits<T>::epsilon() * entry : 0;
  }
  for (int child : pattern_.children(here)) {
    kernels_.add_to_panel(FrontAt(child), RunsOf(child), at);
  }
}

template <class T>
void FrontCholesky<T>::End(int front) {
  for (int child : pattern_.children(pattern_.fronts()[front])) {
    kernels_.add_to_update(FrontAt(child), RunsOf(child), FrontAt(front));
  }
}

template <class T>
bool FrontCholesky<T>::FactorFront(int front) {
  Begin(front);
  const T* const floors = floors_.data() + Scalars(pattern_.fronts()[front].first);
  if (!kernels_.factor(FrontAt(front), floors)) return false;
  End(front);
  return true;
}

template <class T>
class FrontCholesky<T>::Stages final : public StagedWork {
 public:
  Stages(FrontCholesky* factor, Deadline* deadline) : factor_(*factor), deadline_(deadline) {}

  bool fits() const { return fits_.load(std::memory_order_relaxed); }
  int stages() const override { return static_cast<int>(factor_.stages_.size()); }
  int units(int stage) const override { return factor_.stages_[stage].units; }
  bool GoOn(int) override { return fits() && !Passes(deadline_); }
  SpanLabel label(int stage) const override {
    return {SpanKind::kFactorise, factor_.stages_[stage].front};
  }

  void Do(int stage, int unit) override {
    const Stage& now = factor_.stages_[stage];
    if (now.step == Step::kSubtrees) {
      for (int k = factor_.subtree_begin_[unit]; k < factor_.subtree_begin_[unit + 1]; ++k) {
        if (Passes(deadline_)) return;
        if (!factor_.FactorFront(factor_.subtree_fronts_[k])) return Fail();
      }
      return;
    }
    const auto front = factor_.FrontAt(now.front);
    const auto& kernels = factor_.kernels_;
    const T* const floors =
        factor_.floors_.data() + factor_.Scalars(factor_.pattern_.fronts()[now.front].first);
    const int first = simd::PaddedRows<T>(now.end) + unit * kRowsOfUnit;
    switch (now.step) {
      case Step::kSubtrees:
        break;
      case Step::kBegin:
        factor_.Begin(now.front);
        break;
      case Step::kSquare:
        if (!kernels.factor_square(front, now.begin, now.end, floors)) Fail();
        break;
      case Step::kRows:
        kernels.factor_rows(front, now.begin, now.end, first,
                            std::min(first + kRowsOfUnit, front.panel_stride()));
        break;
      case Step::kUpdate:
        kernels.update_rows(front, unit * kRowsOfUnit,
                            std::min((unit + 1) * kRowsOfUnit, front.size));
        break;
      case Step::kEnd:
        factor_.End(now.front);
        break;
    }
  }

 private:
  void Fail() { fits_.store(false, std::memory_order_relaxed); }

  FrontCholesky& factor_;
  Deadline* deadline_;
  std::atomic<bool> fits_ = true;
};

template <class T>
bool FrontCholesky<T>::Factorise(Crew* crew, Deadline* deadline) {
  if (crew != nullptr && !stages_.empty() && pattern_.flops() > kSerialFlops) {
    Stages work(this, deadline);
    crew->Run(&work);
    return work.fits();
  }
  for (int f = 0; f < static_cast<int>(places_.size()); ++f) {
    if (Passes(deadline)) return true;
    if (!FactorFront(f)) return false;
  }
  return true;
}

template <class T>
template <int kNodeSize>
class FrontCholesky<T>::Gather {
 public:
  explicit Gather(FrontCholesky* factor) : factor_(*factor) {}

  /// Numbers of the caller in the order of elimination, and back.
  void TakeAll(std::span<const T> x) const {
    ForNodes([&](int node, int place) { CopyNode(x.data() + node, ordered() + place); });
  }
  void GiveAll(std::span<T> x) const {
    ForNodes([&](int node, int place) { CopyNode(ordered() + place, x.data() + node); });
  }

  /// Those of the rows of a front into local memory, as its panel has them, and back.
  void Take(const Front& rows, const simd::Front<T>& front) const {
    const int first = factor_.Scalars(rows.first);
    std::copy(ordered() + first, ordered() + first + front.pivots, local());
    std::fill(local() + front.pivots, local() + front.below(), T(0));
    T* to = local() + front.below();
    for (int row : factor_.pattern_.rows(rows)) {
      CopyNode(ordered() + row * size(), to);
      to += size();
    }
    std::fill(to, local() + front.panel_stride(), T(0));
  }
  void GivePivots(const Front& rows, const simd::Front<T>& front) const {
    std::copy(local(), local() + front.pivots, ordered() + factor_.Scalars(rows.first));
  }
  void GiveRows(const Front& rows, const simd::Front<T>& front) const {
    const T* from = local() + front.below();
    for (int row : factor_.pattern_.rows(rows)) {
      CopyNode(from, ordered() + row * size());
      from += size();
    }
  }

 private:
  int size() const { return kNodeSize > 0 ? kNodeSize : factor_.pattern_.node_size(); }
  T* ordered() const { return factor_.ordered_.data(); }
  T* local() const { return factor_.local_.data(); }
  void CopyNode(const T* from, T* to) const { std::memcpy(to, from, size() * sizeof(T)); }
  template <class Function>
  void ForNodes(const Function& function) const {
    const auto position = factor_.pattern_.position();
    for (int node = 0; node < static_cast<int>(position.size()); ++node) {
      function(node * size(), position[node] * size());
    }
  }

  FrontCholesky& factor_;
};

template <class T>
template <int kNodeSize>
void FrontCholesky<T>::SolveNodes(std::span<T> x, Deadline* deadline) {
  const Gather<kNodeSize> gather(this);
  const auto fronts = pattern_.fronts();
  const int count = static_cast<int>(fronts.size());
  gather.TakeAll(x);
  for (int f = 0; f < count && !Passes(deadline, f); ++f) {
    const auto front = FrontAt(f);
    gather.Take(fronts[f], front);
    kernels_.forward(front, local_.data());
    gather.GivePivots(fronts[f], front);
    gather.GiveRows(fronts[f], front);
  }
  for (int f = count - 1; f >= 0 && !Passes(deadline, f); --f) {
    const auto front = FrontAt(f);
    gather.Take(fronts[f], front);
    kernels_.backward(front, local_.data());
    gather.GivePivots(fronts[f], front);
  }
  gather.GiveAll(x);
}

template <class T>
void FrontCholesky<T>::Solve(std::span<T> x, Deadline* deadline) {
  if (pattern_.node_size() == 6) return SolveNodes<6>(x, deadline);
  if (pattern_.node_size() == 1) return SolveNodes<1>(x, deadline);
  SolveNodes<0>(x, deadline);
}

template class FrontCholesky<float>;
template class FrontCholesky<double>;

}  // namespace cairn
