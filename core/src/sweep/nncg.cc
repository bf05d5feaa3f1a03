// SPDX-License-Identifier: MIT
#include "sweep/nncg.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "runtime/in_parts.h"

namespace cairn {
namespace {

/// The island of what belongs to none, as in Plan::islands_of().
constexpr int kNone = -1;

}  // namespace

/// Blocks of each unit of the plan, and the bodies of each group.
class Nncg::Pass final : public StagedWork {
 public:
  Pass(std::span<const GroupSweeps> groups, BlockFrame* frame, Nncg* nncg)
      : groups_(groups), plan_(frame->plan()), frame_(frame), nncg_(*nncg) {}

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
    if (unit < blocks) {
      nncg_.MoveImpulses(plan_.units()[unit].first_block, plan_.units()[unit].blocks, frame_);
    } else {
      nncg_.MoveBodies(plan_.groups()[group], frame_);
    }
  }

  /// All of it at once, where nobody shares it.
  void DoAll(SpanRecorder* recorder) {
    const SpanClock clock(recorder, 0, recorder != nullptr ? label(0) : SpanLabel{});
    for (size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].active) nncg_.MoveGroupOn(plan_.groups()[g], frame_);
    }
  }

 private:
  std::span<const GroupSweeps> groups_;
  const Plan& plan_;
  BlockFrame* frame_;
  Nncg& nncg_;
};

void Nncg::Begin(const BlockFrame& frame) {
  now_.momenta.assign(frame.plan().islands().size() + 1, {});
  now_.energies.assign(frame.plan().islands().size(), 0);
  known_ = false;
  if (plan_number_ == frame.plan_number()) return;
  plan_number_ = frame.plan_number();
  ReadPlan(frame.plan());
}

void Nncg::ReadPlan(const Plan& plan) {
  FindEnds(plan);
  island_of_slot_.clear();
  for (int body : plan.body_of_slot()) {
    island_of_slot_.push_back(body == kWorld ? kNone : plan.island_of_body()[body]);
  }
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
        if (newest == row.max_sweeps) continue;
        ends_.push_back({plan.islands()[island].group, row.max_sweeps, island});
      }
    }
  }
  std::sort(ends_.begin(), ends_.end());
  ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
}

void Nncg::ForgetWhereRowsEnd(int group, int sweeps) {
  const auto [first, last] = std::equal_range(
      ends_.begin(), ends_.end(), End{group, sweeps, 0}, [](const End& a, const End& b) {
        return std::pair(a.group, a.sweeps) < std::pair(b.group, b.sweeps);
      });
  for (auto end = first; end != last; ++end) Forget(end->island);
}

void Nncg::Forget(int island) {
  MomentumOf(island) = {};
  now_.energies[island] = 0;
}

void Nncg::ForgetAll() {
  std::fill(now_.momenta.begin(), now_.momenta.end(), simd::Momentum{});
  std::fill(now_.energies.begin(), now_.energies.end(), 0);
}

void Nncg::Copy(const Plan& plan, const Group& group, const Course& from, Course* to) {
  const auto copy = [](const auto& some, int first, int count, auto* others) {
    if (others->size() < some.size()) others->resize(some.size());
    std::copy_n(some.begin() + first, count, others->begin() + first);
  };
  for (const int i : plan.islands_in(group)) {
    copy(from.momenta, i + 1, 1, &to->momenta);
    copy(from.energies, i, 1, &to->energies);
  }
  copy(from.last.x, group.first_x, group.x_lines, &to->last.x);
  copy(from.direction.x, group.first_x, group.x_lines, &to->direction.x);
  copy(from.last.bodies, group.first_slot, group.slots, &to->last.bodies);
  copy(from.direction.bodies, group.first_slot, group.slots, &to->direction.bodies);
}

void Nncg::Keep(const Plan& plan, const Group& group) {
  kept_known_ = known_;
  if (known_) Copy(plan, group, now_, &kept_);
}

void Nncg::GoBack(const Plan& plan, const Group& group) {
  if (kept_known_) return Copy(plan, group, kept_, &now_);
  for (const int i : plan.islands_in(group)) Forget(i);
}

void Nncg::See(int island, double energy) {
  const double before = std::exchange(now_.energies[island], energy);
  const double ratio = before == 0 ? 0 : energy / before;
  const bool shrinks = ratio <= 1;
  MomentumOf(island) = {.beta = shrinks ? static_cast<float>(ratio * ratio) : 0,
                        .keep = shrinks ? 1.0f : 0.0f};
}

void Nncg::Remember(const BlockData& now, Crew* crew) {
  constexpr int kLinesOfPart = 1024;
  // resize() alone would copy what is overwritten anyway
  const auto make_room = [](size_t size, auto* numbers) {
    if (numbers->size() < size) numbers->clear();
    numbers->resize(size);
  };
  const auto copy = [crew](const auto& from, auto* to, auto* cleared) {
    const auto part = [&](int first, int count) {
      std::copy_n(from.begin() + first, count, to->begin() + first);
      std::fill_n(cleared->begin() + first, count,
                  typename std::decay_t<decltype(from)>::value_type{});
    };
    InParts(static_cast<int>(from.size()), kLinesOfPart, crew, part, {SpanKind::kSweep, 0, -1});
  };
  make_room(now.x.size(), &now_.last.x);
  make_room(now.x.size(), &now_.direction.x);
  make_room(now.bodies.size(), &now_.last.bodies);
  make_room(now.bodies.size(), &now_.direction.bodies);
  copy(now.x, &now_.last.x, &now_.direction.x);
  copy(now.bodies, &now_.last.bodies, &now_.direction.bodies);
}

bool Nncg::StartsFrom(const BlockData& now, Crew* crew) {
  if (known_) return false;
  Remember(now, crew);
  known_ = true;
  return true;
}

void Nncg::MoveImpulses(int first_block, int blocks, BlockFrame* frame) {
  const Plan& plan = frame->plan();
  frame->lane_kernels().move_blocks(
      &MomentumOf(0), &plan.blocks()[first_block], plan.islands_of(first_block), blocks,
      {frame->blocks().x.data(), now_.last.x.data(), now_.direction.x.data()});
}

void Nncg::MoveBodies(const Group& group, BlockFrame* frame) {
  const auto of_group = [&](auto& bodies) { return bodies.data() + group.first_slot; };
  frame->lane_kernels().move_bodies(&MomentumOf(0), of_group(island_of_slot_), group.slots,
                                    {of_group(frame->blocks().bodies), of_group(now_.last.bodies),
                                     of_group(now_.direction.bodies)});
}

void Nncg::MoveGroupOn(const Group& group, BlockFrame* frame) {
  MoveImpulses(group.first_block, group.blocks, frame);
  MoveBodies(group, frame);
}

void Nncg::MoveOn(std::span<const GroupSweeps> groups, Crew* crew, BlockFrame* frame) {
  if (StartsFrom(frame->blocks(), crew)) return;
  Pass pass(groups, frame, this);
  if (crew->alone()) return pass.DoAll(crew->recorder());
  crew->Run(&pass);
}

}  // namespace cairn
