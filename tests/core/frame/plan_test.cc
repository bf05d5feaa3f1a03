// SPDX-License-Identifier: MIT
// The order of work: every row once, and nobody in the way of anybody.
#include "plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "tests/core/support/block_problems.h"
#include "tests/core/support/manifold_problems.h"

namespace cairn {
namespace {

using simd::kLanes;
using simd::LaneRun;
using simd::PairBlock;
using test::Scene;

/// Rows of a stage at most, but for the rest of a unit, and of that for the rest of a block.
constexpr int kStageRows = 8192;

struct Planned {
  Scene scene;
  Plan plan;

  explicit Planned(const Scene& of) : scene(of) { Make(); }
  void Make() { test::MakePlan(scene, 1, &plan); }
};

int KindOf(const Pair& pair) { return (pair.contact ? 2 : 0) + (pair.b == kWorld ? 1 : 0); }

void ExpectEveryRowInOneLane(const Planned& p) {
  std::vector<int> lanes(p.scene.rows.size());
  for (int b = 0; b < static_cast<int>(p.plan.blocks().size()); ++b) {
    const PairBlock& block = p.plan.blocks()[b];
    ASSERT_TRUE(block.lanes >= 1 && block.lanes <= kLanes);
    for (int lane = 0; lane < block.lanes; ++lane) {
      const auto rows = p.plan.rows_of(p.plan.pair(b, lane));
      EXPECT_EQ(static_cast<int>(rows.size()), block.row_count);
      for (int row : rows) ++lanes[row];
    }
  }
  for (int count : lanes) ASSERT_EQ(count, 1);
}

void ExpectSlotsOfTheirBodies(const Planned& p) {
  for (int b = 0; b < static_cast<int>(p.plan.blocks().size()); ++b) {
    const PairBlock& block = p.plan.blocks()[b];
    for (int lane = 0; lane < kLanes; ++lane) {
      if (lane >= block.lanes) {
        EXPECT_EQ(block.a[lane], 0);
        EXPECT_EQ(block.b[lane], 0);
        continue;
      }
      const Pair& pair = p.plan.pair(b, lane);
      EXPECT_NE(block.a[lane], 0) << "the first slot is read by all and written by none";
      const int slot_a = p.plan.own_slot(block.a[lane]), slot_b = p.plan.own_slot(block.b[lane]);
      EXPECT_EQ(p.plan.body_of_slot()[slot_a], pair.a);
      EXPECT_EQ(p.plan.body_of_slot()[slot_b], pair.b);
      if (pair.a != kWorld) {
        EXPECT_EQ(p.plan.slot_of_body()[pair.a], slot_a);
      }
      if (pair.b != kWorld) {
        EXPECT_EQ(p.plan.slot_of_body()[pair.b], slot_b);
      }
    }
  }
}

/// Slots of a run, world excluded: those of its bodies, each once.
void ExpectLanesOfARunApart(const Planned& p) {
  for (const LaneRun& run : p.plan.runs()) {
    std::set<int> slots;
    const PairBlock& block = p.plan.blocks()[run.block];
    for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
      EXPECT_TRUE(slots.insert(block.a[lane]).second);
      if (block.b[lane] != 0) {
        EXPECT_TRUE(slots.insert(block.b[lane]).second);
      }
    }
  }
}

/// Where lanes of a run share a body all of them see copies of it, of no more than its mass, and
/// each copy is seen once.
void ExpectCopiesOfWhatIsShared(const Planned& p) {
  std::set<int> seen;
  for (const LaneRun& run : p.plan.runs()) {
    std::map<int, std::vector<int>> slots;  // by body
    const PairBlock& block = p.plan.blocks()[run.block];
    for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
      const Pair& pair = p.plan.pair(run.block, lane);
      slots[pair.a].push_back(block.a[lane]);
      slots[pair.b].push_back(block.b[lane]);
    }
    slots.erase(kWorld);
    bool any = false;
    for (const auto& [body, of_body] : slots) {
      if (of_body.size() == 1) {
        EXPECT_EQ(of_body[0], p.plan.slot_of_body()[body]);
        continue;
      }
      any = true;
      double mass = 0;
      for (const int slot : of_body) {
        const simd::BodyCopy* const copy = p.plan.copy_at(slot);
        ASSERT_NE(copy, nullptr);
        EXPECT_TRUE(seen.insert(slot).second);
        EXPECT_EQ(copy->share, p.plan.copy_at(of_body[0])->share);
        mass += static_cast<double>(copy->share) * copy->share;
      }
      EXPECT_LE(mass, 1);
    }
    EXPECT_EQ(run.copies, any);
    EXPECT_TRUE(block.copies || !any);
  }
  EXPECT_EQ(seen.size(), p.plan.copies().size());
}

/// Runs of a block fill its lanes one after the other, in registers that leave those before alone.
void ExpectRunsToFillBlocks(const Planned& p) {
  std::vector<int> filled(p.plan.blocks().size());
  for (const Group& group : p.plan.groups()) {
    for (int r = group.first_run; r < group.first_run + group.runs; ++r) {
      const LaneRun& run = p.plan.runs()[r];
      EXPECT_TRUE(run.block >= group.first_block && run.block < group.first_block + group.blocks);
      EXPECT_GE(run.lanes, 1);
      EXPECT_EQ(run.first, filled[run.block]);
      EXPECT_LE(run.first + simd::WidthOf(run.lanes), kLanes);
      filled[run.block] += run.lanes;
      if (simd::WidthOf(run.lanes) == kLanes) {
        EXPECT_EQ(run.lanes, p.plan.blocks()[run.block].lanes);
      }
    }
  }
  for (size_t b = 0; b < filled.size(); ++b) EXPECT_EQ(filled[b], p.plan.blocks()[b].lanes);
}

void ExpectGroupsApart(const Planned& p) {
  int block = 0, x = 0, island = 0;
  std::set<int> slots;
  for (int g = 0; g < static_cast<int>(p.plan.groups().size()); ++g) {
    const Group& group = p.plan.groups()[g];
    EXPECT_EQ(group.first_block, block);
    EXPECT_EQ(group.first_x, x);
    EXPECT_EQ(group.first_island, island);
    block += group.blocks;
    x += group.x_lines;
    island += group.islands;
    for (int i = group.first_island; i < island; ++i) {
      EXPECT_EQ(p.plan.islands()[p.plan.islands_of_groups()[i]].group, g);
    }
    for (int s = 0; s < group.slots; ++s) EXPECT_TRUE(slots.insert(group.first_slot + s).second);
    for (int b = group.first_block; b < block; ++b) {
      const PairBlock& of = p.plan.blocks()[b];
      const int begin = static_cast<int>(of.x);
      EXPECT_TRUE(begin >= group.first_x && begin + of.row_count <= x);
      for (int lane = 0; lane < of.lanes; ++lane) {
        EXPECT_EQ(p.plan.islands()[p.plan.island_of(b, lane)].group, g);
        for (int slot : {of.a[lane], of.b[lane]}) {
          const int own = p.plan.own_slot(slot);
          const bool inside = own >= group.first_slot && own < group.first_slot + group.slots;
          EXPECT_TRUE(slot == 0 || inside);
        }
      }
    }
  }
  EXPECT_EQ(block, static_cast<int>(p.plan.blocks().size()));
  EXPECT_EQ(x, p.plan.x_lines());
  EXPECT_EQ(island, static_cast<int>(p.plan.islands().size()));
  EXPECT_EQ(slots.size() + 1, p.plan.body_of_slot().size());
}

/// Bodies that can move of all lanes of a unit.
std::set<int> BodiesOf(const Planned& p, const Unit& unit) {
  std::set<int> bodies;
  for (int b = unit.first_block; b < unit.first_block + unit.blocks; ++b) {
    for (int lane = 0; lane < p.plan.blocks()[b].lanes; ++lane) {
      const Pair& pair = p.plan.pair(b, lane);
      for (int body : {pair.a, pair.b}) {
        if (body != kWorld) bodies.insert(body);
      }
    }
  }
  return bodies;
}

void ExpectUnitsOfAStageApart(const Planned& p) {
  int unit = 0;
  std::vector<int> done(p.plan.blocks().size());
  for (const Stage& stage : p.plan.stages()) {
    EXPECT_EQ(stage.first_unit, unit);
    std::set<int> bodies;
    for (; unit < stage.first_unit + stage.units; ++unit) {
      const Unit& of = p.plan.units()[unit];
      int rows = 0;
      for (int b = of.first_block; b < of.first_block + of.blocks; ++b) {
        rows += p.plan.blocks()[b].lanes * p.plan.blocks()[b].row_count;
        ++done[b];
      }
      EXPECT_EQ(of.rows, rows);
      for (int body : BodiesOf(p, of)) EXPECT_TRUE(bodies.insert(body).second);
    }
  }
  EXPECT_EQ(unit, static_cast<int>(p.plan.units().size()));
  for (int count : done) EXPECT_EQ(count, 1);
}

/// Blocks of a group in stages keep their order, so that one thread and many do the same.
void ExpectBlocksOfAGroupInOrder(const Planned& p) {
  std::vector<int> last(p.plan.groups().size(), -1);
  for (const Unit& unit : p.plan.units()) {
    EXPECT_GT(unit.first_block, last[unit.group]);
    last[unit.group] = unit.first_block;
  }
}

/// Those that may be swept at once have the same rows, share no body and fill their blocks.
void ExpectRunsThatAreAlikeApart(const Planned& p) {
  for (size_t r = 0; r < p.plan.runs().size(); ++r) {
    const LaneRun& run = p.plan.runs()[r];
    if (!run.like_next) continue;
    ASSERT_LT(r + 1, p.plan.runs().size());
    const LaneRun& next = p.plan.runs()[r + 1];
    const PairBlock &block = p.plan.blocks()[run.block], &other = p.plan.blocks()[next.block];
    EXPECT_EQ(block.form, other.form);
    EXPECT_EQ(block.row_count, other.row_count);
    EXPECT_EQ(block.rows, other.rows);
    EXPECT_EQ(run.lanes, block.lanes);
    EXPECT_EQ(next.lanes, other.lanes);
    std::set<int> slots{0};
    for (const PairBlock* of : {&block, &other}) {
      for (int lane = 0; lane < of->lanes; ++lane) {
        EXPECT_TRUE(slots.insert(of->a[lane]).second);
        EXPECT_TRUE(of->b[lane] == 0 || slots.insert(of->b[lane]).second);
      }
    }
  }
}

void ExpectSound(const Planned& p) {
  ExpectEveryRowInOneLane(p);
  ExpectSlotsOfTheirBodies(p);
  ExpectLanesOfARunApart(p);
  ExpectCopiesOfWhatIsShared(p);
  ExpectRunsToFillBlocks(p);
  ExpectRunsThatAreAlikeApart(p);
  ExpectGroupsApart(p);
  ExpectUnitsOfAStageApart(p);
  ExpectBlocksOfAGroupInOrder(p);
}

TEST(Plan, IsSoundForScenesOfAllKinds) {
  for (const Scene& scene :
       {test::Tower(1), test::Tower(30), test::Wall(8, 8), test::Wall(20, 15), test::Plate(10),
        test::Plate(100), test::HangingChain(50, 1), test::NormalsFirst(test::Wall(6, 6))}) {
    ExpectSound(Planned(scene));
  }
}

TEST(Plan, FindsRunsThatAreAlike) {
  const Planned wall(test::Wall(20, 15)), tower(test::Tower(30));
  const auto alike = [](const Planned& p) {
    return std::ranges::count_if(p.plan.runs(), &LaneRun::like_next);
  };
  EXPECT_GT(alike(wall), 0);
  EXPECT_EQ(alike(tower), 0);  // of each kind and colour it has one run at the most
}

// A plate on twenty boxes: eight contacts with it have a colour of their own, twelve none.
TEST(Plan, LetsColoursOfSmallIslandsShareBlocks) {
  const Planned small(test::Plate(20)), large(test::Plate(200));
  ExpectSound(small);
  ExpectSound(large);
  EXPECT_GE(small.plan.runs().size(), 9u);
  EXPECT_LT(small.plan.blocks().size(), 6u);
  EXPECT_EQ(large.plan.runs().size(), large.plan.blocks().size());
}

// Pairs with the plate, and as many with the world, in full lanes but for a few.
TEST(Plan, LetsLanesShareAHub) {
  for (const int boxes : {50, 200, 1000}) {
    const Planned p(test::Plate(boxes));
    ExpectSound(p);
    EXPECT_LE(p.plan.runs().size(), 2 * (boxes / kLanes + 1) + 8u) << boxes;
    EXPECT_GE(p.plan.copies().size(), static_cast<size_t>(boxes - 8));
  }
}

// A large island whose bodies have many neighbours, but no hub: no thread waits for another.
TEST(Plan, SharesNoBodyOfALargeHeap) {
  const Planned p(test::Wall(60, 60));
  EXPECT_TRUE(p.plan.copies().empty());
}

TEST(Plan, IsSoundForRandomScenesThatChange) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Scene whole = test::WithEveryLaw(
        test::Heap({.bodies = 200, .contacts = 700, .pins = 60, .world_share = 0.3}, seed), seed);
    whole.bodies[5] = whole.bodies[50] = Body{};
    whole.rows.push_back(test::PushRow(5, 50, {1, 0, 0}));
    test::Game game(whole);
    Planned planned(game.Next().scene);
    for (int frame = 0; frame < 10; ++frame) {
      ExpectSound(planned);
      planned.scene = game.Next().scene;
      planned.Make();
    }
  }
}

bool SameBlock(const PairBlock& a, const PairBlock& b) {
  const std::span rows_a(a.rows, a.row_count), rows_b(b.rows, b.row_count);
  return a.form == b.form && a.data == b.data && a.x == b.x && a.lanes == b.lanes &&
         std::ranges::equal(rows_a, rows_b) && std::ranges::equal(a.a, b.a) &&
         std::ranges::equal(a.b, b.b);
}

bool SameRun(const LaneRun& a, const LaneRun& b) {
  return a.block == b.block && a.first == b.first && a.lanes == b.lanes &&
         a.like_next == b.like_next && a.copies == b.copies;
}

void ExpectSame(const Plan& a, const Plan& b) {
  ASSERT_TRUE(std::ranges::equal(a.blocks(), b.blocks(), SameBlock));
  ASSERT_TRUE(std::ranges::equal(a.runs(), b.runs(), SameRun));
  EXPECT_TRUE(std::ranges::equal(a.body_of_slot(), b.body_of_slot()));
  EXPECT_TRUE(std::ranges::equal(a.copies(), b.copies(), [](const auto& of_a, const auto& of_b) {
    return of_a.slot == of_b.slot && of_a.share == of_b.share;
  }));
  EXPECT_TRUE(std::ranges::equal(a.island_of_body(), b.island_of_body()));
  EXPECT_EQ(a.data_lines(), b.data_lines());
  EXPECT_EQ(a.stages().size(), b.stages().size());
  for (int block = 0; block < static_cast<int>(a.blocks().size()); ++block) {
    for (int lane = 0; lane < a.blocks()[block].lanes; ++lane) {
      const Pair &of_a = a.pair(block, lane), &of_b = b.pair(block, lane);
      ASSERT_TRUE(of_a.source == of_b.source && of_a.index == of_b.index);
      ASSERT_EQ(a.island_of(block, lane), b.island_of(block, lane));
    }
  }
}

// More pairs than one thread looks at at a time, in all parts of it; some bodies share a name, and
// some pairs have two joints.
TEST(Plan, OfManyPairsIsTheSameOnSeveralThreads) {
  test::ManifoldScene scene = test::RandomManifolds(4000, 12000, 5);
  test::AddJoints(5000, 6, &scene);
  scene.joints.insert(scene.joints.end(), scene.joints.begin(), scene.joints.begin() + 100);
  for (size_t i = 0; i < scene.bodies.size(); ++i) scene.bodies[i].id = 1 + i / 2;
  // too many for as many colours
  for (int i = 0; i < 900; ++i) scene.manifolds[13 * i].body_b = 7 + 1000 * (i % 3);
  MovableBodies movable;
  for (const Body& body : scene.bodies) movable.push_back(MobilityOf(body));
  test::Random random(7);
  Crew alone(1), several(4);
  Plan on_one, on_several;
  const auto begin_or_end = [&random](int most, auto* list) {
    for (int i = 0; i < most; ++i) {
      list->erase(list->begin() + random.Index(static_cast<int>(list->size())));
      const auto again = (*list)[random.Index(static_cast<int>(list->size()))];
      list->insert(list->begin() + random.Index(static_cast<int>(list->size())), again);
    }
  };
  for (const int events : {0, 1, 20, 3000, 0, 200}) {
    begin_or_end(events, &scene.manifolds);
    begin_or_end(events / 2, &scene.joints);
    ASSERT_TRUE(on_one.Make(scene.problem(), {}, movable, &alone));
    ASSERT_TRUE(on_several.Make(scene.problem(), {}, movable, &several));
    ExpectSame(on_one, on_several);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Plan, OfNothingIsEmpty) {
  Scene scene;
  scene.bodies.assign(3, test::PointMass(1));
  const Planned p(scene);
  ExpectSound(p);
  EXPECT_EQ(p.plan.blocks().size(), 0u);
  EXPECT_EQ(p.plan.stages().size(), 0u);
  EXPECT_EQ(p.plan.islands().size(), 0u);
}

TEST(Plan, OfOneRowIsOneLane) {
  Scene scene;
  scene.bodies.assign(3, test::PointMass(1));
  scene.rows.push_back(test::PushRow(2, 1, {0, 0, 1}));
  const Planned p(scene);
  ExpectSound(p);
  ASSERT_EQ(p.plan.blocks().size(), 1u);
  EXPECT_EQ(p.plan.blocks()[0].lanes, 1);
  EXPECT_EQ(p.plan.islands()[0].first_body, 1);
  EXPECT_EQ(p.plan.islands()[0].bodies, 2);
  EXPECT_EQ(p.plan.islands()[0].rows, 1);
  EXPECT_EQ(p.plan.slot_of_body()[0], 0);
}

TEST(Plan, OfAHundredThousandRowsIsSound) {
  const Planned p(test::Wall(100, 43));
  EXPECT_GT(p.scene.rows.size(), 100000u);
  ExpectSound(p);
  for (const Stage& stage : p.plan.stages()) {
    int rows = 0;
    for (int u = 0; u < stage.units; ++u) rows += p.plan.units()[stage.first_unit + u].rows;
    EXPECT_LT(rows, kStageRows + 1024 + kLanes * 12);
  }
}

// Two colours of joints and one of anchors: 64 chains of one anchor and five joints fill lanes.
TEST(Plan, FillsTheLanesOfBlocksWithSmallIslands) {
  const Planned p(test::Together(std::vector<Scene>(64, test::HangingChain(6, 1))));
  ExpectSound(p);
  EXPECT_EQ(p.plan.groups().size(), 1u);
  EXPECT_EQ(p.plan.islands().size(), 64u);
  EXPECT_EQ(p.plan.blocks().size(), 24u);
  for (const PairBlock& block : p.plan.blocks()) EXPECT_EQ(block.lanes, kLanes);
}

// A chain of n has 3 n rows, and a group 2,048 at most: a group of a few rows would fill no lanes.
TEST(Plan, ListsTheLanesOfIslandsThatShareAGroup) {
  const Planned p(test::Together({test::Tower(3), test::Wall(60, 60), test::HangingChain(4, 1)}));
  int listed = 0, used = 0;
  for (int i = 0; i < static_cast<int>(p.plan.islands().size()); ++i) {
    if (p.plan.groups()[p.plan.islands()[i].group].islands == 1) continue;
    const std::span<const int> lanes = p.plan.lanes_of(i);
    EXPECT_TRUE(std::is_sorted(lanes.begin(), lanes.end()));
    for (const int lane : lanes) EXPECT_EQ(p.plan.island_of(lane / kLanes, lane % kLanes), i);
    listed += static_cast<int>(lanes.size());
  }
  for (const Group& group : p.plan.groups()) {
    if (group.islands == 1) continue;
    for (const PairBlock& block : p.plan.blocks().subspan(group.first_block, group.blocks)) {
      used += block.lanes;
    }
  }
  EXPECT_GT(used, 0);
  EXPECT_EQ(listed, used);
}

TEST(Plan, KnowsWhichIslandsHaveJoints) {
  const Planned p(test::Together({test::Tower(3), test::HangingChain(4, 1)}));
  ASSERT_EQ(p.plan.islands().size(), 2u);
  EXPECT_FALSE(p.plan.islands()[0].joints);
  EXPECT_TRUE(p.plan.islands()[1].joints);
}

TEST(Plan, SharesSmallIslandsOutEvenly) {
  struct Case {
    int chains, length;
    size_t groups;
  };
  for (const Case& of : {Case{113, 6, 1}, Case{120, 6, 2}, Case{300, 6, 3}, Case{900, 6, 8},
                         Case{13, 100, 3}, Case{7, 300, 4}}) {
    const Planned p(
        test::Together(std::vector<Scene>(of.chains, test::HangingChain(of.length, 1))));
    ExpectSound(p);
    ASSERT_EQ(p.plan.groups().size(), of.groups) << of.chains;
    for (const Group& group : p.plan.groups()) {
      EXPECT_LE(group.rows, 2048);
      EXPECT_NEAR(group.islands, of.chains / static_cast<double>(of.groups), 1) << of.chains;
    }
  }
}

// Walls of 1,300 rows or so: two fit no group.
TEST(Plan, KeepsGroupsWithinALimitWhateverIslandsThereAre) {
  const Planned p(test::Together({test::Tower(3), test::Wall(8, 8), test::Tower(3),
                                  test::Wall(8, 8), test::Tower(3), test::Wall(8, 8)}));
  ExpectSound(p);
  for (const Group& group : p.plan.groups()) EXPECT_LE(group.rows, 2048);
  EXPECT_EQ(p.plan.groups().size(), 3u);
}

TEST(Plan, GivesALargeIslandAGroupOfItsOwn) {
  const Scene small = test::Tower(3), large = test::Wall(12, 12);
  const Planned p(test::Together({small, large, small}));
  ExpectSound(p);
  EXPECT_EQ(p.plan.groups().size(), 2u);
  EXPECT_EQ(p.plan.islands()[0].group, p.plan.islands()[2].group);
  EXPECT_NE(p.plan.islands()[0].group, p.plan.islands()[1].group);
}

TEST(Plan, SweepsJointsBeforeContactsAndTheWorldLast) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Planned p(
        test::Heap({.bodies = 100, .contacts = 250, .pins = 80, .world_share = 0.3}, seed));
    for (const Group& group : p.plan.groups()) {
      int kind = 0;
      for (const LaneRun& run : p.plan.runs().subspan(group.first_run, group.runs)) {
        for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
          EXPECT_GE(KindOf(p.plan.pair(run.block, lane)), kind);
          kind = KindOf(p.plan.pair(run.block, lane));
        }
      }
    }
  }
}

TEST(Plan, NumbersSlotsByTheirFirstUse) {
  const Planned p(test::Wall(15, 10));
  int newest = 0;
  for (const LaneRun& run : p.plan.runs()) {
    const PairBlock& block = p.plan.blocks()[run.block];
    for (int lane = run.first; lane < run.first + run.lanes; ++lane) {
      for (int slot : {block.a[lane], block.b[lane]}) {
        EXPECT_LE(slot, newest + 1);
        newest = std::max(newest, slot);
      }
    }
  }
  EXPECT_EQ(newest, 150);
}

// The budget is looked at between stages: no stage may be much longer than all others, whatever the
// scene. A plate under many boxes has one pair in a block beyond its first 32.
TEST(Plan, HasNoLongerStagesWhereThereAreNoColoursLeft) {
  const Planned p(test::Plate(1500));
  for (const Stage& stage : p.plan.stages()) {
    int rows = 0;
    for (int u = 0; u < stage.units; ++u) rows += p.plan.units()[stage.first_unit + u].rows;
    EXPECT_LT(rows, kStageRows + 1024 + kLanes * 12);
  }
}

}  // namespace
}  // namespace cairn
