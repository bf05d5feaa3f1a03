// SPDX-License-Identifier: MIT
#include "pgs/nncg.h"

#include <algorithm>
#include <utility>

#include "simd/flush_denormals.h"

namespace cairn {
namespace {

/// The arrays of a line or a body are apart: the compiler makes vector instructions of this.
template <int n>
inline void MoveNumbers(const float* __restrict beta, const float* __restrict keep,
                        float* __restrict now, float* __restrict last,
                        float* __restrict direction) {
  for (int i = 0; i < n; ++i) {
    const float moved = now[i] + beta[i] * direction[i];
    direction[i] = keep[i] * (moved - last[i]);
    now[i] = last[i] = moved;
  }
}

}  // namespace

/// Blocks of each unit of the plan, and the bodies of each group.
class Nncg::Pass final : public StagedWork {
 public:
  Pass(std::span<const GroupSweeps> groups, BlockFrame* frame, Nncg* nncg)
      : groups_(groups), plan_(frame->plan()), now_(frame->blocks()), nncg_(*nncg) {}

  int stages() const override { return 1; }
  int units(int) const override {
    return static_cast<int>(plan_.units().size() + plan_.groups().size());
  }
  /// The beginning of the sweep that follows.
  SpanLabel label(int) const override {
    int sweep = 0;
    for (const GroupSweeps& group : groups_) sweep = group.active ? group.sweeps : sweep;
    return {SpanKind::kSweep, sweep};
  }
  void Do(int, int unit) override {
    const int blocks = static_cast<int>(plan_.units().size());
    const int group = unit < blocks ? plan_.units()[unit].group : unit - blocks;
    if (!groups_[group].active) return;
    const simd::FlushDenormals flush;
    if (unit < blocks) {
      MoveImpulses(plan_.units()[unit]);
    } else {
      MoveBodies(plan_.groups()[group]);
    }
  }

 private:
  void MoveImpulses(const Unit& unit) {
    for (int b = unit.first_block; b < unit.first_block + unit.blocks; ++b) {
      const simd::PairBlock& block = plan_.blocks()[b];
      simd::Line beta = {}, keep = {};  // of unused lanes: nothing moves
      for (int l = 0; l < block.lanes; ++l) {
        const Way& way = nncg_.ways_[plan_.island_of(b, l)];
        beta.lane[l] = way.beta;
        keep.lane[l] = way.keep;
      }
      for (size_t i = block.x; i < block.x + static_cast<size_t>(block.row_count); ++i) {
        MoveNumbers<simd::kLanes>(beta.lane, keep.lane, now_.x[i].lane, nncg_.last_.x[i].lane,
                                  nncg_.direction_.x[i].lane);
      }
    }
  }

  void MoveBodies(const Group& group) {
    simd::BodyLane beta, keep;
    for (int slot = group.first_slot; slot < group.first_slot + group.slots; ++slot) {
      const int body = plan_.body_of_slot()[slot];
      if (body == kWorld) continue;
      const Way way = nncg_.ways_[plan_.island_of_body()[body]];
      std::fill_n(beta.u, 8, way.beta);
      std::fill_n(keep.u, 8, way.keep);
      MoveNumbers<8>(beta.u, keep.u, now_.bodies[slot].u, nncg_.last_.bodies[slot].u,
                     nncg_.direction_.bodies[slot].u);
    }
  }

  std::span<const GroupSweeps> groups_;
  const Plan& plan_;
  BlockData& now_;
  Nncg& nncg_;
};

void Nncg::Begin(const BlockFrame& frame) {
  ways_.assign(frame.plan().islands().size(), {});
  known_ = false;
  if (plan_number_ == frame.plan_number()) return;
  plan_number_ = frame.plan_number();
  FindEnds(frame.plan());
}

void Nncg::FindEnds(const Plan& plan) {
  constexpr int kAll = simd::RowShape{}.max_sweeps;
  ends_.clear();
  newest_end_.assign(plan.islands().size(), kAll);
  for (int b = 0; b < static_cast<int>(plan.blocks().size()); ++b) {
    const simd::PairBlock& block = plan.blocks()[b];
    int before = kAll;  // rows of a block mostly end together, as do those of an island
    for (const simd::RowShape& row : std::span(block.rows, block.row_count)) {
      if (std::exchange(before, row.max_sweeps) == row.max_sweeps || row.max_sweeps == kAll)
        continue;
      for (int l = 0; l < block.lanes; ++l) {
        const int island = plan.island_of(b, l);
        const int newest = std::exchange(newest_end_[island], row.max_sweeps);
        if (newest != row.max_sweeps) ends_.push_back({row.max_sweeps, island});
      }
    }
  }
  std::sort(ends_.begin(), ends_.end());
  ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
}

void Nncg::ForgetWhereRowsEnd(int sweeps) {
  for (const End& end : ends_) {
    if (end.sweeps == sweeps) Forget(end.island);
  }
}

void Nncg::Forget(int island) { ways_[island] = {}; }

void Nncg::ForgetAll() { std::fill(ways_.begin(), ways_.end(), Way{}); }

void Nncg::See(int island, double energy) {
  Way& way = ways_[island];
  const bool first = way.energy == 0;
  const double ratio = first ? 0 : energy / way.energy;
  const bool shrinks = ratio <= 1;
  way = {.beta = shrinks ? static_cast<float>(ratio * ratio) : 0,
         .keep = shrinks ? 1.0f : 0.0f,
         .energy = energy};
}

void Nncg::MoveOn(std::span<const GroupSweeps> groups, Crew* crew, BlockFrame* frame) {
  BlockData& now = frame->blocks();
  if (!known_) {
    // resize() would copy what is overwritten anyway
    last_.x.assign(now.x.begin(), now.x.end());
    last_.bodies.assign(now.bodies.begin(), now.bodies.end());
    direction_.x.assign(now.x.size(), {});
    direction_.bodies.assign(now.bodies.size(), {});
    known_ = true;
    return;
  }
  Pass pass(groups, frame, this);
  crew->Run(&pass);
}

}  // namespace cairn
