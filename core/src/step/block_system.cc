// SPDX-License-Identifier: MIT
#include "step/block_system.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace cairn {
namespace {

using simd::kLanes;

/// A graph that was analysed for more pairs than there are is kept while there are this many of
/// them: what it wastes is less than a new analysis costs.
constexpr double kLeastShareOfPairs = 0.8;
/// Or no more than so many have gone, which small graphs do not notice.
constexpr double kFewPairs = 8;
/// Weight of the last analysis in the mean of steps that one serves.
constexpr double kNewestAnalysis = 0.5;

/// Bodies of a component that one thread factorises in lanes: of what is larger all threads do
/// parts.
constexpr int kMostInLanes = 1024;

/// Whether a graph of so many pairs serves for those that there are now.
bool Serves(double pairs, double now) {
  return kLeastShareOfPairs * pairs <= now || pairs - now <= kFewPairs;
}

}  // namespace

template <class T>
BlockSystem<T>::BlockSystem(simd::Target target)
    : products_(simd::PairProductsFor<T>(target)), lanes_(target), fronts_(target) {}

template <class T>
bool BlockSystem<T>::Recognise(const Plan& plan, int plan_number, int index) {
  if (IsFor(plan_number, index)) return prepared_;
  plan_number_ = plan_number;
  group_ = index;
  const Group& group = plan.groups()[index];
  FindBodies(plan, group);
  CountLanes(plan, group);
  prepared_ = bodies_now_ == bodies_ && FindLanes(plan, group);
  return prepared_;
}

template <class T>
void BlockSystem<T>::Analyse(const Plan& plan) {
  const Group& group = plan.groups()[group_];
  if (bodies_now_ != bodies_) pairs_.clear();
  if (!bodies_.empty()) {
    expected_steps_ += kNewestAnalysis * (std::max(1.0, steps_) - expected_steps_);
  }
  steps_ = 0;
  bodies_ = bodies_now_;
  FindPairs(plan, group);
  ShareOut();
  FindLanes(plan, group);
  prepared_ = true;
}

template <class T>
void BlockSystem<T>::ShareOut() {
  const Array<char> suits = NodesForLanes(nodes(), pairs_, kMostInLanes);
  places_.clear();
  in_lanes_ = 0;
  int in_fronts = 0;
  for (char lanes : suits) {
    places_.push_back({lanes != 0, lanes != 0 ? in_lanes_++ : in_fronts++});
  }
  // pairs ascend among those of lanes, too, and among those of fronts
  Array<NodePair> of_lanes, of_fronts;
  places_of_pairs_.clear();
  for (const auto& [a, b] : pairs_) {
    Array<NodePair>& pairs = places_[a].in_lanes ? of_lanes : of_fronts;
    places_of_pairs_.push_back({places_[a].in_lanes, static_cast<int>(pairs.size())});
    pairs.emplace_back(places_[a].index, places_[b].index);
  }
  lanes_.Analyse(in_lanes_, of_lanes);
  fronts_.Analyse(in_fronts, 6, of_fronts);
  of_lanes_.resize(static_cast<size_t>(6 * in_lanes_));
  of_fronts_.resize(static_cast<size_t>(6 * in_fronts));
}

template <class T>
void BlockSystem<T>::Solve(std::span<T> rhs, Deadline* deadline) {
  if (in_lanes_ == nodes()) return lanes_.Solve(rhs);
  if (in_lanes_ == 0) return fronts_.Solve(rhs, deadline);
  const auto exchange = [&](bool in) {
    for (int node = 0; node < nodes(); ++node) {
      const Place& place = places_[node];
      T* const of_node = (place.in_lanes ? of_lanes_ : of_fronts_).data() + 6 * place.index;
      T* const of_all = rhs.data() + 6 * node;
      std::copy_n(in ? of_all : of_node, 6, in ? of_node : of_all);
    }
  };
  exchange(true);
  lanes_.Solve(of_lanes_);
  fronts_.Solve(of_fronts_, deadline);
  exchange(false);
}

template <class T>
void BlockSystem<T>::FindBodies(const Plan& plan, const Group& group) {
  first_slot_ = group.first_slot;
  bodies_now_.clear();
  for (int body : plan.body_of_slot().subspan(group.first_slot, group.slots)) {
    if (body != kWorld) bodies_now_.push_back(body);
  }
  std::sort(bodies_now_.begin(), bodies_now_.end());
  node_of_slot_.assign(group.slots, -1);
  for (size_t node = 0; node < bodies_now_.size(); ++node) {
    const int slot = plan.slot_of_body()[bodies_now_[node]];
    node_of_slot_[slot - first_slot_] = static_cast<int>(node);
  }
}

template <class T>
void BlockSystem<T>::CountLanes(const Plan& plan, const Group& group) {
  joined_lanes_ = 0;
  for (const simd::PairBlock& block : plan.blocks().subspan(group.first_block, group.blocks)) {
    joined_lanes_ += block.form == simd::PairForm::kSingle ? 0 : block.lanes;
  }
}

template <class T>
NodePair BlockSystem<T>::PairOf(const Plan& plan, const simd::PairBlock& block, int lane) const {
  const int a = SeenAt(plan, block.a[lane]).node, b = SeenAt(plan, block.b[lane]).node;
  return a < b ? NodePair(a, b) : NodePair(b, a);
}

template <class T>
void BlockSystem<T>::FindPairs(const Plan& plan, const Group& group) {
  known_pairs_.swap(pairs_);
  pairs_.clear();
  for (const simd::PairBlock& block : plan.blocks().subspan(group.first_block, group.blocks)) {
    if (block.form == simd::PairForm::kSingle) continue;
    for (int lane = 0; lane < block.lanes; ++lane) pairs_.push_back(PairOf(plan, block, lane));
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());

  // what comes and goes keeps its place
  const double now = static_cast<double>(pairs_.size());
  all_pairs_.clear();
  std::set_union(pairs_.begin(), pairs_.end(), known_pairs_.begin(), known_pairs_.end(),
                 std::back_inserter(all_pairs_));
  if (Serves(static_cast<double>(all_pairs_.size()), now)) pairs_.swap(all_pairs_);

  first_pair_.assign(static_cast<size_t>(nodes()) + 1, 0);
  for (const NodePair& pair : pairs_) ++first_pair_[pair.first + 1];
  std::partial_sum(first_pair_.begin(), first_pair_.end(), first_pair_.begin());
}

template <class T>
bool BlockSystem<T>::FindLanes(const Plan& plan, const Group& group) {
  pair_of_lane_.assign(static_cast<size_t>(group.blocks) * kLanes, -1);
  size_t at = 0;
  for (const simd::PairBlock& block : plan.blocks().subspan(group.first_block, group.blocks)) {
    const bool joins = block.form != simd::PairForm::kSingle;
    for (int lane = 0; lane < block.lanes && joins; ++lane) {
      const NodePair pair = PairOf(plan, block, lane);
      const auto begin = pairs_.begin() + first_pair_[pair.first],
                 end = pairs_.begin() + first_pair_[pair.first + 1];
      const auto known = std::lower_bound(begin, end, pair);
      if (known == end || *known != pair) return false;
      pair_of_lane_[at + static_cast<size_t>(lane)] = static_cast<int>(known - pairs_.begin());
    }
    at += kLanes;
  }
  return Serves(static_cast<double>(pairs_.size()), joined_lanes_);
}

template <class T>
bool BlockSystem<T>::Factorise(const Plan& plan, const Group& group, const BlockData& blocks,
                               std::span<const simd::LineOf<T>> weights,
                               Array<simd::LineOf<T>>* scratch, Crew* crew, Deadline* deadline) {
  lanes_.SetZero();
  fronts_.SetZero();
  for (int node = 0; node < nodes(); ++node) {
    for (int k = 0; k < 6; ++k) diagonal(node)[7 * k] = 1;
  }
  const RunResults results(group, simd::kGramLines, scratch);
  const auto runs = plan.runs_of(group);
  for (size_t r = 0; r < runs.size() && !Passes(deadline, static_cast<int>(r)); ++r) {
    const simd::LaneRun& run = runs[r];
    const simd::PairBlock& block = plan.blocks()[run.block];
    simd::LineOf<T>* const gram = results.Of(run);
    if (run.first == 0) {
      const auto x = static_cast<size_t>(block.x - static_cast<std::uint32_t>(group.first_x));
      products_.weighted_gram(block, blocks.data.data() + block.data, weights.data() + x, gram);
    }
    const auto first_lane = static_cast<size_t>(run.block - group.first_block) * kLanes;
    for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
      AddLane(plan, block, lane, pair_of_lane_[first_lane + static_cast<size_t>(lane)], gram);
    }
  }
  const SpanClock clock(crew != nullptr ? crew->recorder() : nullptr, 0, {SpanKind::kFactorise});
  return lanes_.Factorise() && fronts_.Factorise(crew, deadline);
}

template <class T>
void BlockSystem<T>::AddLane(const Plan& plan, const simd::PairBlock& block, int lane, int pair,
                             const simd::LineOf<T>* gram) {
  const auto add_triangle = [&](const Seen& seen, const simd::LineOf<T>* lines) {
    if (seen.node < 0) return;
    const T share = seen.share * seen.share;
    T* const to = diagonal(seen.node);
    for (int c = 0; c < 6; ++c) {
      for (int r = c; r < 6; ++r) to[6 * c + r] += share * (lines++)->lane[lane];
    }
  };
  const Seen a = SeenAt(plan, block.a[lane]);
  add_triangle(a, gram);
  if (block.form == simd::PairForm::kSingle) return;
  const Seen b = SeenAt(plan, block.b[lane]);
  const simd::LineOf<T>* const square = gram + simd::kTriangleLines;
  add_triangle(b, square + simd::kSquareLines);

  // rows of a and columns of b, or turned round
  T* const to = upper(pair);
  const int row = a.node < b.node ? 1 : 6, column = a.node < b.node ? 6 : 1;
  const T share = a.share * b.share;
  for (int c = 0; c < 6; ++c) {
    for (int r = 0; r < 6; ++r) to[column * c + row * r] += share * square[6 * c + r].lane[lane];
  }
}

template class BlockSystem<float>;
template class BlockSystem<double>;

}  // namespace cairn
