// SPDX-License-Identifier: MIT
// Where the numbers of FrontCholesky lie, and how its work is divided.
#include "cairn/detail/memory.h"
#include "cholesky/front_cholesky.h"

#include <algorithm>

namespace cairn {
namespace {

/// A subtree is a unit of work up to this share of all operations.
constexpr double kSubtreeShare = 1.0 / 24;
/// Pivots of a stage above the subtrees.
constexpr int kPivotsOfStage = 2 * simd::kFrontStep;

/// Memory of the right size, without that of before and its copy beside it.
template <class Numbers>
void MakeRoom(std::size_t size, Numbers* numbers) {
  if (numbers->capacity() < size) {
    *numbers = Numbers();
    numbers->reserve(size);
  }
  numbers->resize(size);
}

std::size_t RoundToLine(std::size_t numbers) { return (numbers + 15) / 16 * 16; }

}  // namespace

/// Places in memory for things that come and go, found before there is memory.
template <class T>
class FrontCholesky<T>::Planner {
 public:
  explicit Planner(std::size_t begin) : end_(begin) {}

  std::size_t Take(std::size_t size) {
    for (auto hole = holes_.begin(); hole != holes_.end(); ++hole) {
      if (hole->size < size) continue;
      const std::size_t begin = hole->begin;
      hole->begin += size;
      hole->size -= size;
      if (hole->size == 0) holes_.erase(hole);
      return begin;
    }
    end_ += size;
    return end_ - size;
  }

  void Release(std::size_t begin, std::size_t size) {
    if (size == 0) return;
    const auto after = std::ranges::lower_bound(holes_, begin, {}, &Hole::begin);
    auto hole = holes_.insert(after, {begin, size});
    const auto next = hole + 1;
    if (next != holes_.end() && hole->begin + hole->size == next->begin) {
      hole->size += next->size;
      holes_.erase(next);
    }
    if (hole == holes_.begin()) return;
    const auto before = hole - 1;
    if (before->begin + before->size != hole->begin) return;
    before->size += hole->size;
    holes_.erase(hole);
  }

  std::size_t end() const { return end_; }

 private:
  struct Hole {
    std::size_t begin, size;
  };
  Array<Hole> holes_;  ///< ascending, never next to each other
  std::size_t end_;
};

template <class T>
void FrontCholesky<T>::Analyse(int nodes, int node_size, std::span<const NodePair> pairs,
                               std::span<const int> order, Workers workers) {
  pattern_.Analyse(nodes, node_size, pairs, order);
  places_.assign(pattern_.fronts().size(), {});
  PlaceBlocks(pairs);
  PlacePanels();
  FindRuns();
  stages_.clear();
  if (workers == Workers::kCrew) CutTree();
  const std::size_t updates = workers == Workers::kCrew ? PlaceUpdatesOfSubtrees() : PlaceUpdates();
  updates_.assign(updates + simd::kFrontMargin, 0);

  int longest = 0;
  for (int f = 0; f < static_cast<int>(places_.size()); ++f) {
    longest = std::max(longest, ShapeOf(f).panel_stride());
  }
  floors_.resize(Scalars(nodes));
  ordered_.resize(Scalars(nodes));
  local_.assign(longest + simd::kFrontMargin, 0);
}

/// Blocks lie in the order of the fronts that take them.
template <class T>
void FrontCholesky<T>::PlaceBlocks(std::span<const NodePair> pairs) {
  const int nodes = pattern_.nodes();
  const auto position = pattern_.position();
  // a node is a pair with itself
  const int count = nodes + static_cast<int>(pairs.size());
  const auto pair_at = [&](int k) { return k < nodes ? NodePair(k, k) : pairs[k - nodes]; };
  Array<int> next(places_.size() + 1, 0), front_of(count), order(count);
  for (int k = 0; k < count; ++k) {
    const auto [first, second] = pair_at(k);
    front_of[k] = pattern_.front_of()[std::min(position[first], position[second])];
    ++next[front_of[k] + 1];
  }
  for (std::size_t f = 0; f < places_.size(); ++f) {
    next[f + 1] += next[f];
    places_[f].blocks_begin = next[f];
    places_[f].blocks_end = next[f + 1];
  }
  for (int k = 0; k < count; ++k) order[next[front_of[k]]++] = k;

  const std::size_t numbers = static_cast<std::size_t>(pattern_.node_size()) * pattern_.node_size();
  blocks_.resize(count);
  block_of_.resize(count);
  Array<int> row_of(nodes);  // of the panel
  for (std::size_t f = 0; f < places_.size(); ++f) {
    const Front& at = pattern_.fronts()[f];
    const auto shape = ShapeOf(static_cast<int>(f));
    for (int k = 0; k < at.pivots; ++k) row_of[at.first + k] = Scalars(k);
    int row = shape.below();
    for (int node : pattern_.rows(at)) {
      row_of[node] = row;
      row += pattern_.node_size();
    }
    for (int b = places_[f].blocks_begin; b < places_[f].blocks_end; ++b) {
      const auto [first, second] = pair_at(order[b]);
      const int i = position[first], j = position[second];
      const std::ptrdiff_t column = Scalars(std::min(i, j) - at.first);
      blocks_[b].to = column * shape.panel_stride() + row_of[std::max(i, j)];
      blocks_[b].transposed = i < j;
      block_of_[order[b]] = b;
    }
  }
  values_.assign(numbers * blocks_.size(), 0);
}

template <class T>
void FrontCholesky<T>::PlacePanels() {
  std::size_t end = 0;
  for (int f = 0; f < static_cast<int>(places_.size()); ++f) {
    places_[f].panel = end;
    const auto front = ShapeOf(f);
    end += RoundToLine(static_cast<std::size_t>(front.panel_stride()) * front.pivots);
  }
  MakeRoom(end + simd::kFrontMargin, &panels_);
}

template <class T>
void FrontCholesky<T>::FindRuns() {
  runs_.clear();
  const auto fronts = pattern_.fronts();
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    places_[f].runs_begin = static_cast<int>(runs_.size());
    if (fronts[f].parent >= 0) {
      const Front& parent = fronts[fronts[f].parent];
      const auto rows = pattern_.rows(fronts[f]), to = pattern_.rows(parent);
      int below = 0;
      for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
        const bool pivot = rows[k] < parent.first + parent.pivots;
        while (!pivot && to[below] != rows[k]) ++below;
        const int target = Scalars(pivot ? rows[k] - parent.first : below);
        simd::RowRun* const last = k > 0 ? &runs_.back() : nullptr;
        if (last != nullptr && last->pivots == pivot && last->to + last->count == target) {
          last->count += pattern_.node_size();
        } else {
          runs_.push_back({Scalars(k), target, pattern_.node_size(), pivot});
        }
      }
    }
    places_[f].runs_end = static_cast<int>(runs_.size());
  }
}

/// Subtrees as large as fit a share of the work, small ones of different roots together. What is
/// above them comes after all of them.
template <class T>
void FrontCholesky<T>::FindSubtrees() {
  const auto fronts = pattern_.fronts();
  const int count = static_cast<int>(fronts.size());
  Array<double> work(count);
  double all = 0;
  for (int f = 0; f < count; ++f) {
    const double own = pattern_.flops(fronts[f]);
    all += own;
    work[f] += own;
    if (fronts[f].parent >= 0) work[fronts[f].parent] += work[f];
  }
  const double most = all * kSubtreeShare;

  subtree_of_.assign(count, -1);
  int subtrees = 0;
  double gathered = most;
  for (int f = count - 1; f >= 0; --f) {
    if (work[f] > most) continue;
    const int parent = fronts[f].parent;
    if (parent >= 0 && work[parent] <= most) {
      subtree_of_[f] = subtree_of_[parent];
      continue;
    }
    if (gathered + work[f] > most) {
      ++subtrees;
      gathered = 0;
    }
    gathered += work[f];
    subtree_of_[f] = subtrees - 1;
  }
  subtree_begin_.assign(subtrees + 1, 0);
}

template <class T>
void FrontCholesky<T>::CutTree() {
  FindSubtrees();
  const int count = static_cast<int>(subtree_of_.size());
  const int subtrees = static_cast<int>(subtree_begin_.size()) - 1;
  for (int subtree : subtree_of_) {
    if (subtree >= 0) ++subtree_begin_[subtree + 1];
  }
  for (int s = 0; s < subtrees; ++s) subtree_begin_[s + 1] += subtree_begin_[s];
  subtree_fronts_.resize(subtree_begin_.back());
  Array<int> next(subtree_begin_.begin(), subtree_begin_.end() - 1);
  stages_.assign(1, {Step::kSubtrees, -1, 0, 0, subtrees});
  for (int f = 0; f < count; ++f) {
    if (subtree_of_[f] >= 0) {
      subtree_fronts_[next[subtree_of_[f]]++] = f;
    } else {
      AddTopStages(f);
    }
  }
}

template <class T>
void FrontCholesky<T>::AddTopStages(int front) {
  stages_.push_back({Step::kBegin, front, 0, 0, 1});
  const auto at = ShapeOf(front);
  for (int begin = 0; begin < at.pivots; begin += kPivotsOfStage) {
    const int end = std::min(begin + kPivotsOfStage, at.pivots);
    stages_.push_back({Step::kSquare, front, begin, end, 1});
    const int below = at.panel_stride() - simd::PaddedRows<T>(end);
    if (below > 0) stages_.push_back({Step::kRows, front, begin, end, UnitsOf(below)});
  }
  if (at.size == 0) return;
  stages_.push_back({Step::kUpdate, front, 0, 0, UnitsOf(at.size)});
  stages_.push_back({Step::kEnd, front, 0, 0, 1});
}

template <class T>
std::size_t FrontCholesky<T>::UpdateSize(int front) const {
  const auto shape = ShapeOf(front);
  return RoundToLine(static_cast<std::size_t>(shape.update_stride()) * shape.size);
}

template <class T>
void FrontCholesky<T>::PlaceUpdate(int front, Planner* planner) {
  places_[front].update = planner->Take(UpdateSize(front));
  for (int child : pattern_.children(pattern_.fronts()[front])) {
    planner->Release(places_[child].update, UpdateSize(child));
  }
}

/// For fronts one after the other.
template <class T>
std::size_t FrontCholesky<T>::PlaceUpdates() {
  Planner planner(0);
  for (int f = 0; f < static_cast<int>(places_.size()); ++f) PlaceUpdate(f, &planner);
  return planner.end();
}

/// Subtrees have memory of their own; that of what they leave to the fronts above is shared.
template <class T>
std::size_t FrontCholesky<T>::PlaceUpdatesOfSubtrees() {
  const auto fronts = pattern_.fronts();
  const auto is_top = [&](int f) {
    return subtree_of_[f] < 0 || (fronts[f].parent >= 0 && subtree_of_[fronts[f].parent] < 0);
  };
  std::size_t end = 0;
  for (std::size_t s = 0; s + 1 < subtree_begin_.size(); ++s) {
    Planner own(end);
    for (int k = subtree_begin_[s]; k < subtree_begin_[s + 1]; ++k) {
      if (!is_top(subtree_fronts_[k])) PlaceUpdate(subtree_fronts_[k], &own);
    }
    end = own.end();
  }
  Planner top(end);
  for (int f = 0; f < static_cast<int>(fronts.size()); ++f) {
    if (is_top(f) && subtree_of_[f] >= 0) places_[f].update = top.Take(UpdateSize(f));
  }
  for (int f = 0; f < static_cast<int>(fronts.size()); ++f) {
    if (subtree_of_[f] < 0) PlaceUpdate(f, &top);
  }
  return top.end();
}

template class FrontCholesky<float>;
template class FrontCholesky<double>;

}  // namespace cairn
