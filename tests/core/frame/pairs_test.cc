// SPDX-License-Identifier: MIT
// Which rows share a lane: those of two bodies, in the order of the problem.
#include "plan/pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "cairn/detail/eigen.h"
#include "tests/core/support/block_problems.h"

namespace cairn {
namespace {

using simd::PairForm;
using simd::RowBound;
using simd::RowShape;
using test::Scene;
using testing::ElementsAre;

/// What a finder makes of a scene.
struct Found {
  ShapeTable shapes;
  PairList list;

  explicit Found(const Scene& scene, double omega = 1) { Add(scene, omega); }
  void Add(const Scene& scene, double omega = 1) {
    PairFinder finder;
    Crew crew(1);
    EXPECT_TRUE(finder.Find(test::KindsOf(scene, omega), {}, test::MovableOf(scene), &crew, &shapes,
                            &list));
  }
  std::vector<int> rows(int pair) const {
    const auto rows = list.rows_of(list.pairs[pair]);
    return {rows.begin(), rows.end()};
  }
};

/// Unit boxes that nothing joins yet.
Scene Boxes(int count) {
  Scene scene;
  for (int i = 0; i < count; ++i) {
    scene.bodies.push_back(test::Box(1, {1, 1, 1}));
    scene.positions.emplace_back(i, 0, 0);
  }
  return scene;
}

void AddTouch(Scene* scene, int a, int b) {
  const Eigen::Vector3d point(0.5, 0, 0);
  test::AddContact(scene, test::PointRow(*scene, a, b, point, Eigen::Vector3d::UnitX()), point,
                   0.5);
}

TEST(Pairs, HoldTheRowsOfTwoBodiesInTheOrderOfTheProblem) {
  const Found found(test::Tower(3));
  ASSERT_EQ(found.list.pairs.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const Pair& pair = found.list.pairs[i];
    EXPECT_EQ(pair.a, i);
    EXPECT_EQ(pair.b, i == 0 ? kWorld : i - 1);
    EXPECT_EQ(pair.form, i == 0 ? PairForm::kSingle : PairForm::kContact);
    EXPECT_TRUE(pair.contact);
    EXPECT_EQ(pair.rows, 12);
    for (int k = 0; k < 12; ++k) EXPECT_EQ(found.rows(i)[k], 12 * i + k);
  }
}

TEST(Pairs, TakeFrictionAlongThatComesFarBehindItsParent) {
  const Found found(test::NormalsFirst(test::Tower(3)));
  ASSERT_EQ(found.list.pairs.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    std::vector<int> expected;
    for (int k = 0; k < 4; ++k) expected.push_back(4 * i + k);
    for (int k = 0; k < 8; ++k) expected.push_back(12 + 8 * i + k);
    EXPECT_EQ(found.rows(i), expected);
    const auto shape = found.shapes.rows(found.list.pairs[i].shape);
    for (int k = 4; k < 12; ++k) EXPECT_EQ(shape[k].parent, (k - 4) / 2) << k;
  }
}

TEST(Pairs, OfAJointAndOfAContactOfTheSameBodiesAreApart) {
  Scene scene = Boxes(3);
  AddTouch(&scene, 0, 1);                      // rows 0 to 2
  test::AddPin(&scene, 0, 1, {0.5, 0, 0});     // 3 to 5
  test::AddPin(&scene, 2, kWorld, {2, 0, 0});  // 6 to 8
  AddTouch(&scene, 1, 0);                      // 9 to 11
  test::AddPin(&scene, 1, 0, {0.5, 0, 0});     // 12 to 14
  const Found found(scene);
  ASSERT_EQ(found.list.pairs.size(), 3u);
  EXPECT_THAT(found.rows(0), ElementsAre(0, 1, 2, 9, 10, 11));
  EXPECT_THAT(found.rows(1), ElementsAre(3, 4, 5, 12, 13, 14));
  EXPECT_THAT(found.rows(2), ElementsAre(6, 7, 8));
  EXPECT_TRUE(found.list.pairs[0].contact);
  EXPECT_FALSE(found.list.pairs[1].contact);
  EXPECT_FALSE(found.list.pairs[2].contact);
}

// A limit only pushes, as a contact does, but it is part of the hinge that it follows.
TEST(Pairs, OfAJointKeepTheLimitThatFollows) {
  Scene scene = Boxes(2);
  test::AddPin(&scene, 0, 1, {0.5, 0, 0});
  scene.rows.push_back(test::AngularRow(0, 1, {1, 0, 0}));
  scene.rows.back().lo = 0;
  const Found found(scene);
  ASSERT_EQ(found.list.pairs.size(), 1u);
  EXPECT_THAT(found.rows(0), ElementsAre(0, 1, 2, 3));
  EXPECT_FALSE(found.list.pairs[0].contact);
}

TEST(Pairs, AreTheSameWhicheverBodyIsNamedFirst) {
  Scene scene = Boxes(3);
  AddTouch(&scene, 1, 0);
  AddTouch(&scene, 0, 1);
  AddTouch(&scene, kWorld, 2);
  AddTouch(&scene, 2, kWorld);
  const Found found(scene);
  ASSERT_EQ(found.list.pairs.size(), 2u);
  EXPECT_EQ(found.list.pairs[0].a, 1);
  EXPECT_EQ(found.list.pairs[0].b, 0);
  EXPECT_EQ(found.list.pairs[1].a, 2) << "what moves comes first";
  EXPECT_EQ(found.list.pairs[1].b, kWorld);
  EXPECT_EQ(found.list.pairs[1].form, PairForm::kSingle);
  EXPECT_THAT(found.rows(1), ElementsAre(6, 7, 8, 9, 10, 11));
}

TEST(Pairs, OfOneShapeShareIt) {
  Found found(test::Tower(5));
  ASSERT_EQ(found.shapes.size(), 1);
  found.Add(test::Wall(3, 3));
  EXPECT_EQ(found.shapes.size(), 1) << "four contact points, too";
  found.Add(test::HangingChain(3, 1));
  EXPECT_EQ(found.shapes.size(), 2);
  for (const Pair& pair : found.list.pairs) EXPECT_EQ(pair.shape, 1);
  found.Add(test::Tower(2));
  EXPECT_EQ(found.shapes.size(), 2) << "known from before";
  for (const Pair& pair : found.list.pairs) EXPECT_EQ(pair.shape, 0);
}

// Of each point: a normal of 9 + 2 lines, and two friction rows of one more.
TEST(Pairs, HaveTheLinesOfTheirRows) {
  const Found found(test::Tower(1));
  const auto rows = found.shapes.rows(0);
  ASSERT_EQ(rows.size(), 12u);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(rows[i].bound, i % 3 == 0 ? RowBound::kPush : RowBound::kFriction);
    EXPECT_EQ(rows[i].parent, i % 3 == 0 ? -1 : i / 3 * 3);
    EXPECT_FALSE(rows[i].soft || rows[i].angular || rows[i].relaxed);
  }
  EXPECT_EQ(found.shapes.lines(PairForm::kContact, 0), 4 * (12 + 13 + 13));
  EXPECT_EQ(found.shapes.lines(PairForm::kSingle, 0), 4 * (9 + 10 + 10));
}

TEST(Pairs, CountStaticBodiesAsTheWorld) {
  Scene scene = Boxes(3);
  scene.bodies[1] = Body{};
  AddTouch(&scene, 1, 0);
  AddTouch(&scene, 0, kWorld);
  AddTouch(&scene, 2, 1);
  const Found found(scene);
  ASSERT_EQ(found.list.pairs.size(), 2u);
  EXPECT_EQ(found.list.pairs[0].a, 0);
  EXPECT_EQ(found.list.pairs[0].b, kWorld);
  EXPECT_THAT(found.rows(0), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(found.list.pairs[1].a, 2);
  EXPECT_EQ(found.list.pairs[1].b, kWorld);
}

// It turns, so it moves; but its linear part does not, and the form for contacts divides by that.
TEST(Pairs, OfABodyThatOnlyTurnsAreNoContactForm) {
  Scene scene = Boxes(4);
  scene.bodies[1].inv_mass = 0;
  scene.bodies[3].linear_factor = {1, 0, 1};
  AddTouch(&scene, 0, 1);
  AddTouch(&scene, 0, 2);
  AddTouch(&scene, 0, 3);
  const Found found(scene);
  ASSERT_EQ(found.list.pairs.size(), 3u);
  EXPECT_EQ(found.list.pairs[0].b, 1);
  EXPECT_EQ(found.list.pairs[0].form, PairForm::kJoint);
  EXPECT_EQ(found.list.pairs[1].form, PairForm::kContact);
  EXPECT_EQ(found.list.pairs[2].form, PairForm::kJoint);
}

TEST(Pairs, WhoseRowsDoNotPushOppositelyAreNoContactForm) {
  Scene scene = Boxes(2);
  AddTouch(&scene, 0, 1);
  View(scene.rows[1].linear_b) *= 2;
  EXPECT_EQ(Found(scene).list.pairs[0].form, PairForm::kJoint);
}

TEST(Pairs, OfRowsThatNothingMovesForBelongToTheWorld) {
  Scene scene = Boxes(3);
  scene.bodies[1] = scene.bodies[2] = Body{};
  AddTouch(&scene, 1, 2);
  AddTouch(&scene, 0, 1);
  scene.rows.push_back(test::PushRow(kWorld, kWorld, {0, 0, 1}));
  const Found found(scene);
  ASSERT_EQ(found.list.pairs.size(), 2u);
  EXPECT_EQ(found.list.pairs[0].a, kWorld);
  EXPECT_EQ(found.list.pairs[0].b, kWorld);
  EXPECT_EQ(found.list.pairs[0].form, PairForm::kSingle);
  EXPECT_THAT(found.rows(0), ElementsAre(0, 1, 2, 6));
}

TEST(Pairs, AreNotFoundWhereAParentMayNotBeOne) {
  Scene scene = Boxes(3);
  AddTouch(&scene, 0, 1);  // rows 0 to 2
  AddTouch(&scene, 0, 2);  // 3 to 5
  const auto found = [&scene](int parent) {
    scene.rows[4].parent = parent;
    PairFinder finder;
    ShapeTable shapes;
    PairList list;
    Crew crew(1);
    return finder.Find(test::KindsOf(scene, 1), {}, test::MovableOf(scene), &crew, &shapes, &list);
  };
  EXPECT_TRUE(found(3));
  EXPECT_FALSE(found(0)) << "other bodies";
  EXPECT_FALSE(found(4)) << "itself";
  EXPECT_FALSE(found(5)) << "a later one, which has one itself";
  EXPECT_FALSE(found(6)) << "there is none";
  EXPECT_FALSE(found(-2));
  scene.rows[5].parent = 4;
  EXPECT_FALSE(found(3)) << "a parent has none";
}

TEST(Pairs, HoldEveryRowOnceInOrderAndFrictionWithItsParent) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene scene = test::Heap({.bodies = 12, .contacts = 60, .pins = 10, .world_share = 0.3}, seed);
    scene.bodies[3] = scene.bodies[7] = Body{};
    scene = test::WithEveryLaw(scene, seed);
    if (seed % 2 == 0) scene = test::NormalsFirst(scene);
    const Found found(scene);
    std::vector<int> pair_of_row(scene.rows.size(), -1);
    int last_first = -1;
    for (int i = 0; i < static_cast<int>(found.list.pairs.size()); ++i) {
      const std::vector<int> rows = found.rows(i);
      EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
      EXPECT_GT(rows.front(), last_first);
      last_first = rows.front();
      for (int row : rows) {
        EXPECT_EQ(pair_of_row[row], -1);
        pair_of_row[row] = i;
      }
    }
    for (size_t row = 0; row < scene.rows.size(); ++row) {
      ASSERT_GE(pair_of_row[row], 0);
      if (scene.rows[row].parent == kNoRow) continue;
      EXPECT_EQ(pair_of_row[row], pair_of_row[scene.rows[row].parent]);
    }
  }
}

}  // namespace
}  // namespace cairn
