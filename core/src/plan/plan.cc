// SPDX-License-Identifier: MIT
#include "plan/plan.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "cairn/detail/prefetch.h"
#include "runtime/in_parts.h"

namespace cairn {
namespace {

/// Rows that hold a point of one body to one of another.
constexpr int kHoldsPoint = 3;

/// Whether rows are of a joint that holds two bodies together: some row has no bounds, or, as of
/// one that breaks, all that hold a point have.
bool HoldsTogether(std::span<const simd::RowShape> rows) {
  const auto is_free = [](const auto& row) { return row.bound == simd::RowBound::kFree; };
  const auto is_bounded = [](const auto& row) {
    return row.bound == simd::RowBound::kOwn && !row.angular;
  };
  return std::any_of(rows.begin(), rows.end(), is_free) ||
         std::count_if(rows.begin(), rows.end(), is_bounded) >= kHoldsPoint;
}

using simd::kLanes;

/// Runs that a pair without a colour may still join.
constexpr int kOpenRuns = 8;

bool IsLarge(const PlannedIsland& island) { return island.rows > Group::kSharedRows; }

/// Bodies with pairs of so many colours of a kind are hubs: what has no colour waits for no lanes,
/// but is done by one thread. Pairs with them have one of the first colours or none.
constexpr int kHubOfSmall = 16, kHubOfLarge = 32, kColoursOfHub = 8;

/// As many runs one thread has at a time while a plan is made.
constexpr int kRunsOfPart = 64;

constexpr int kForms = 3;

/// What the rows of a pair look like in a block.
int KindOf(const Pair& pair) { return pair.shape * kForms + static_cast<int>(pair.form); }

}  // namespace

bool Plan::Make(const ContactProblem& problem, std::span<const RowKind> kinds,
                const MovableBodies& movable, Crew* crew) {
  const std::span<const Body> bodies = problem.bodies;
  if (!pair_finder_.Find(kinds, problem, movable, crew, &shapes_, &list_)) return false;
  colouring_.Recognise(bodies, list_.pairs, crew);
  // neither needs the other
  ForUnits(2, crew, [&](int half) {
    if (half == 0) return colouring_.Colour(list_.pairs);
    FindIslands(static_cast<int>(bodies.size()));
    FindGroups();
  });
  SortPairs(crew);
  ForUnits(3, crew, [&](int third) {
    if (third == 0) return GiveSlots(bodies.size());
    if (third == 1) return DraftAllRuns();
    colouring_.Prepare();
  });
  FillBlocks(crew);
  FindStages();
  return true;
}

void Plan::FindIslands(int bodies) {
  island_finder_.Start(bodies);
  for (const Pair& pair : list_.pairs) island_finder_.Join(pair.a, pair.b);
  islands_.assign(island_finder_.Number(), {});

  const Array<int>& island_of = island_finder_.island_of_body();
  for (int body = bodies - 1; body >= 0; --body) {
    if (island_of[body] < 0) continue;
    PlannedIsland& island = islands_[island_of[body]];
    island.first_body = body;
    ++island.bodies;
  }
  joints_of_shape_.clear();
  for (int shape = 0; shape < shapes_.size(); ++shape) {
    joints_of_shape_.push_back(HoldsTogether(shapes_.rows(shape)));
  }
  // pairs that nothing can move for are an island of their own, the last
  island_of_pair_.resize(list_.pairs.size());
  const int attached = static_cast<int>(islands_.size());
  // neighbours are mostly of the same: what one of them waits for is kept at hand
  int last = -1, rows = 0;
  bool joints = false;
  const auto add = [&] {
    if (last < 0) return;
    islands_[last].rows += std::exchange(rows, 0);
    islands_[last].joints |= std::exchange(joints, false);
  };
  for (size_t i = 0; i < list_.pairs.size(); ++i) {
    const Pair& pair = list_.pairs[i];
    const int island = pair.a == kWorld ? attached : island_of[pair.a];
    if (island == static_cast<int>(islands_.size())) islands_.emplace_back();
    if (island != last) add();
    last = island;
    rows += pair.rows;
    joints |= joints_of_shape_[pair.shape] != 0;
    island_of_pair_[i] = island;
  }
  add();
}

void Plan::FindGroups() {
  groups_.clear();
  islands_of_groups_.clear();
  const auto add = [this](int island, bool alone) {
    if (alone) groups_.push_back({.first_island = static_cast<int>(islands_of_groups_.size())});
    islands_[island].group = static_cast<int>(groups_.size()) - 1;
    ++groups_.back().islands;
    groups_.back().rows += islands_[island].rows;
    islands_of_groups_.push_back(island);
  };
  // large islands alone; of the small ones, how many groups they fill
  std::int64_t small = 0, count = 0;
  int room = 0;
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    const PlannedIsland& island = islands_[i];
    if (IsLarge(island)) add(i, true);
    if (IsLarge(island) || island.first_body < 0) continue;
    small += island.rows;
    if (island.rows > room) {
      ++count;
      room = Group::kSharedRows;
    }
    room -= island.rows;
  }
  // a share of the rows for each of them, and apart from what nothing can move for
  std::int64_t shares = 0, rows = 0;
  for (int i = 0; i < static_cast<int>(islands_.size()); ++i) {
    const PlannedIsland& island = islands_[i];
    if (IsLarge(island)) continue;
    const bool begins = rows * count >= small * shares || island.first_body < 0 ||
                        groups_.back().rows + island.rows > Group::kSharedRows;
    if (begins) ++shares;
    add(i, begins);
    rows += island.rows;
  }
}

int Plan::ColourOfPair(int i) const {
  const int colour = colouring_.colours()[i];
  if (Colour::PlaceOf(colour) < kColoursOfHub) return colour;
  const bool large = IsLarge(islands_[island_of_pair_[i]]);
  const bool of_hub = colouring_.IsOfHub(list_.pairs[i], large ? kHubOfLarge : kHubOfSmall);
  return of_hub ? Colour::Overflow(Colour::KindOf(colour)) : colour;
}

void Plan::SortPairs(Crew* crew) {
  const int pairs = static_cast<int>(list_.pairs.size());
  const std::span<PairKey> keys = pair_order_.Begin(pairs);
  InParts(pairs, kPairsOfPart, crew, [&](int first, int count) {
    for (int i = first; i < first + count; ++i) {
      const int colour = ColourOfPair(i);
      keys[i] = {.group = islands_[island_of_pair_[i]].group,
                 .colour = colour,
                 .shape = Colour::IsOverflow(colour) ? 0 : KindOf(list_.pairs[i])};
    }
  });
  pair_order_.End(colouring_.before(),
                  {.groups = static_cast<int>(groups_.size()),
                   .colours = Colour::kCount,
                   .shapes = shapes_.size() * kForms},
                  crew);
  keys_ = keys;
  order_.assign(pair_order_.order().begin(), pair_order_.order().end());
}

int Plan::SlotOf(int body) {
  int& slot = slot_of_body_[body];
  if (slot == 0) {
    slot = static_cast<int>(body_of_slot_.size());
    body_of_slot_.push_back(body);
  }
  return slot;
}

void Plan::GiveSlots(size_t bodies) {
  // by first use in a sweep: blocks that follow each other find their bodies close together
  slot_of_body_.assign(bodies, 0);
  body_of_slot_.assign(1, kWorld);
  for (Group& group : groups_) group.slots = 0;
  constexpr size_t kAhead = 8;
  for (size_t at = 0; at < order_.size(); ++at) {
    if (at + kAhead < order_.size()) Prefetch(&list_.pairs[order_[at + kAhead]], sizeof(Pair));
    const int i = order_[at];
    const Pair& pair = list_.pairs[i];
    const int before = static_cast<int>(body_of_slot_.size());
    if (pair.a != kWorld) SlotOf(pair.a);
    if (pair.b != kWorld) SlotOf(pair.b);
    if (pair.a == kWorld) body_of_slot_.push_back(kWorld);
    Group& group = groups_[keys_[i].group];
    if (group.slots == 0) group.first_slot = before;
    group.slots += static_cast<int>(body_of_slot_.size()) - before;
  }
}

/// Marks runs that are followed by one of the same colour, and so of other bodies, with the same
/// rows.
void Plan::FindAlike(const Group& group) {
  const auto whole = [this](const simd::LaneRun& run) {
    return run.lanes == blocks_[run.block].lanes;
  };
  for (int i = group.first_run; i + 1 < group.first_run + group.runs; ++i) {
    simd::LaneRun& run = runs_[i];
    const simd::LaneRun& next = runs_[i + 1];
    const simd::PairBlock &block = blocks_[run.block], &other = blocks_[next.block];
    const int colour = colour_of_run_[i];
    run.like_next = !Colour::IsOverflow(colour) && colour == colour_of_run_[i + 1] &&
                    block.form == other.form && block.rows == other.rows && whole(run) &&
                    whole(next);
  }
}

void Plan::AddBlock(int pair) {
  const Pair& of = list_.pairs[pair];
  simd::PairBlock& block = blocks_.emplace_back();
  block = {};
  block.rows = shapes_.rows(of.shape).data();
  block.row_count = of.rows;
  block.form = of.form;
  block.data = static_cast<std::uint32_t>(data_lines_);
  block.x = static_cast<std::uint32_t>(x_lines_);
  data_lines_ += simd::PairLines(of.form) + shapes_.lines(of.form, of.shape);
  x_lines_ += of.rows;
}

void Plan::FillLanes(const Draft& draft, const simd::LaneRun& run) {
  simd::PairBlock& block = blocks_[run.block];
  int copy = draft.first_copy;
  for (int i = 0; i < draft.lanes; ++i) {
    const int pair = draft.pairs[i], lane = run.first + i;
    const Pair& of = list_.pairs[pair];
    pair_of_lane_[run.block * kLanes + lane] = pair;
    island_of_lane_[run.block * kLanes + lane] = island_of_pair_[pair];
    block.a[lane] = of.a == kWorld ? draft.unmoved_slot + i : SlotIn(draft, of.a, &copy);
    block.b[lane] = of.b == kWorld ? 0 : SlotIn(draft, of.b, &copy);
  }
}

/// Lanes that a body is in. @pre it is none of those that are not there
int Plan::SharersOf(const Draft& draft, int body) const {
  const auto has = [&](int i) { return list_.pairs[i].a == body || list_.pairs[i].b == body; };
  return static_cast<int>(std::count_if(draft.pairs, draft.pairs + draft.lanes, has));
}

int Plan::CopiesOf(const Draft& draft) const {
  int copies = 0;
  for (const int i : std::span(draft.pairs, draft.lanes)) {
    for (const int body : {list_.pairs[i].a, list_.pairs[i].b}) {
      if (body != kWorld && SharersOf(draft, body) > 1) ++copies;
    }
  }
  return copies;
}

/// The slot of a body, or that of the next copy of a run.
int Plan::SlotIn(const Draft& draft, int body, int* copy) {
  const int sharers = draft.copies > 0 ? SharersOf(draft, body) : 1;
  if (sharers == 1) return slot_of_body_[body];
  copies_[*copy] = {slot_of_body_[body], simd::ShareOfBody(sharers)};
  return first_copy() + (*copy)++;
}

Plan::Draft& Plan::AddDraft(int pair) {
  Draft& draft = drafts_.emplace_back();
  draft.colour = keys_[pair].colour;
  return draft;
}

Plan::Draft* Plan::FindOpenDraft(int index, size_t first_draft) {
  const Pair& pair = list_.pairs[index];
  const size_t most = std::min<size_t>(drafts_.size() - first_draft, kOpenRuns);
  for (size_t at = drafts_.size() - most; at < drafts_.size(); ++at) {
    Draft& draft = drafts_[at];
    const bool alike = KindOf(list_.pairs[draft.pairs[0]]) == KindOf(pair);
    if (alike && draft.lanes < kLanes) return &draft;
  }
  return nullptr;
}

/// Those of one kind and group, island by island, each as if it were alone. Returns where they end.
size_t Plan::DraftOverflow(size_t i) {
  overflow_.clear();
  for (const PairKey key = keys_[order_[i]]; i < order_.size() && keys_[order_[i]] == key; ++i) {
    overflow_.push_back(order_[i]);
  }
  std::sort(overflow_.begin(), overflow_.end(), [this](int a, int b) {
    return std::pair(island_of_pair_[a], a) < std::pair(island_of_pair_[b], b);
  });
  int island = -1;
  const size_t first = drafts_.size();
  size_t first_draft = 0;
  for (const int pair : overflow_) {
    if (std::exchange(island, island_of_pair_[pair]) != island) first_draft = drafts_.size();
    Draft* const open = FindOpenDraft(pair, first_draft);
    Draft& draft = open != nullptr ? *open : AddDraft(pair);
    draft.pairs[draft.lanes++] = pair;
  }
  for (Draft& draft : std::span(drafts_).subspan(first)) draft.copies = CopiesOf(draft);
  return i;
}

/// Those of a group, whose pairs begin at @p i in their order, behind the others. Returns where
/// they end.
size_t Plan::DraftRuns(int group, size_t i) {
  const auto of_group = [&](size_t at) {
    return at < order_.size() && keys_[order_[at]].group == group;
  };
  // a run ends with its colour, its shape, or full
  PairKey key{.group = -1, .colour = 0, .shape = 0};
  while (of_group(i)) {
    const PairKey& next = keys_[order_[i]];
    if (Colour::IsOverflow(next.colour)) {
      i = DraftOverflow(i);
      continue;
    }
    const bool same = key == next && drafts_.back().lanes < kLanes;
    Draft& draft = same ? drafts_.back() : AddDraft(order_[i]);
    draft.pairs[draft.lanes++] = order_[i++];
    key = next;
  }
  return i;
}

/// The block that a run goes to. Small islands have few pairs of each colour: all passes but those
/// that relax rows have more to do at a time where colours share blocks.
int Plan::FindRoom(const Draft& draft, bool small) {
  int& open = open_blocks_[KindOf(list_.pairs[draft.pairs[0]])];
  const int width = simd::WidthOf(draft.lanes);
  if (small && open >= 0 && blocks_[open].lanes + width <= kLanes) return open;
  AddBlock(draft.pairs[0]);
  const int block = static_cast<int>(blocks_.size()) - 1;
  if (small && width < kLanes) open = block;
  return block;
}

void Plan::DraftAllRuns() {
  drafts_.clear();
  size_t i = 0;
  for (int g = 0; g < static_cast<int>(groups_.size()); ++g) {
    groups_[g].first_run = static_cast<int>(drafts_.size());
    i = DraftRuns(g, i);
    groups_[g].runs = static_cast<int>(drafts_.size()) - groups_[g].first_run;
  }
}

void Plan::PlaceRuns(const Group& group) {
  const bool small = group.rows <= Group::kSharedRows;
  open_blocks_.assign(static_cast<size_t>(shapes_.size()) * kForms, -1);
  int unmoved_slot = group.first_slot, copies = static_cast<int>(copies_.size());
  for (Draft& draft : std::span(drafts_).subspan(group.first_run, group.runs)) {
    const int block = FindRoom(draft, small);
    runs_.push_back({.block = block,
                     .first = static_cast<std::int16_t>(blocks_[block].lanes),
                     .lanes = static_cast<std::int16_t>(draft.lanes),
                     .like_next = false,
                     .copies = draft.copies > 0});
    colour_of_run_.push_back(draft.colour);
    blocks_[block].lanes += draft.lanes;
    draft.unmoved_slot = unmoved_slot;
    unmoved_slot += draft.lanes;
    if (draft.copies > 0 && !std::exchange(blocks_[block].copies, true)) {
      blocks_[block].d_ratios = static_cast<std::uint32_t>(d_ratio_lines_);
      d_ratio_lines_ += blocks_[block].row_count;
    }
    draft.first_copy = copies;
    copies += draft.copies;
  }
  copies_.resize(copies);
}

void Plan::FillBlocks(Crew* crew) {
  blocks_.clear();
  runs_.clear();
  pair_of_lane_.clear();
  island_of_lane_.clear();
  colour_of_run_.clear();
  copies_.clear();
  data_lines_ = x_lines_ = d_ratio_lines_ = 0;
  for (Group& group : groups_) {
    group.first_block = static_cast<int>(blocks_.size());
    group.first_x = x_lines_;
    PlaceRuns(group);
    group.blocks = static_cast<int>(blocks_.size()) - group.first_block;
    group.x_lines = x_lines_ - group.first_x;
    FindAlike(group);
  }
  pair_of_lane_.resize(blocks_.size() * kLanes, -1);
  island_of_lane_.resize(blocks_.size() * kLanes, -1);
  InParts(static_cast<int>(runs_.size()), kRunsOfPart, crew, [this](int first, int count) {
    for (int run = first; run < first + count; ++run) FillLanes(drafts_[run], runs_[run]);
  });
  ListLanes();
}

void Plan::ListLanes() {
  lanes_begin_.assign(islands_.size() + 1, 0);
  const auto shared = [this](const Group& group) {
    return std::span(island_of_lane_)
        .subspan(static_cast<size_t>(group.first_block) * kLanes,
                 group.islands > 1 ? static_cast<size_t>(group.blocks) * kLanes : 0);
  };
  for (const Group& group : groups_) {
    for (const int island : shared(group)) {
      if (island >= 0) ++lanes_begin_[island];
    }
  }
  // where they end, from which each lane takes one as they are put in their places backwards
  std::partial_sum(lanes_begin_.begin(), lanes_begin_.end(), lanes_begin_.begin());
  lanes_of_islands_.resize(lanes_begin_.back());
  for (const Group& group : groups_) {
    const auto lanes = shared(group);
    for (size_t l = lanes.size(); l-- > 0;) {
      if (lanes[l] < 0) continue;
      lanes_of_islands_[--lanes_begin_[lanes[l]]] =
          group.first_block * kLanes + static_cast<int>(l);
    }
  }
}

}  // namespace cairn
