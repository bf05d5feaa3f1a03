// SPDX-License-Identifier: MIT
// What falls asleep in an engine starts from what it exerted when it wakes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "cairn/contacts.h"
#include "cairn/detail/eigen.h"
#include "cairn/joints.h"
#include "tests/core/engine/small_world.h"

namespace cairn {
namespace {

using test::LoadedBridge;
using test::SmallWorld;
using test::Thing;

Body Moving(std::uint64_t id) {
  return {.inv_mass = 1, .inv_inertia = Matrix3::Diagonal(1, 1, 1), .id = id};
}

Body Asleep(std::uint64_t id) { return {.id = id}; }

/// A body on the world, and a pair of bodies on each other.
struct Frame {
  Contacts contacts;
  Joints joints;
  double h = 0.01;

  void Begin(std::span<const Body> bodies) {
    contacts.Begin({bodies, h});
    joints.Begin({bodies, h});
  }
  /// Of the places of these bodies. Returns what both start from.
  std::pair<float, float> Add(int a, int b, std::uint64_t id) {
    const std::array points{TouchPoint{.depth = 0.01}};
    contacts.Add({.body_a = a, .body_b = b, .id = id}, points);
    joints.Add(BallJoint(), {.body = a}, {.body = b}, id);
    return {contacts.impulses().back().normal, joints.impulses().back()};
  }
  void Exert(float impulse) {
    for (ContactImpulse& each : contacts.impulses()) each.normal = impulse;
    for (float& each : joints.impulses()) each = impulse;
  }
};

using Start = std::pair<float, float>;

TEST(WakingPair, WithoutMassStartsFromWhatItExerted) {
  for (const bool added_while_asleep : {false, true}) {
    Frame frame;
    const std::array awake{Moving(1), Moving(2)}, asleep{Asleep(1), Asleep(2)};
    frame.Begin(awake);
    frame.Add(0, 1, 7);
    frame.Add(0, kWorld, 8);
    frame.Exert(3);
    for (int i = 0; i < 5; ++i) {
      frame.Begin(asleep);
      if (!added_while_asleep) continue;
      frame.Add(0, 1, 7);
      frame.Add(0, kWorld, 8);
      frame.Exert(0);
    }
    frame.h = 0.02;
    frame.Begin(awake);
    EXPECT_EQ(frame.Add(0, 1, 7), Start(6, 6)) << "in proportion to the step";
    EXPECT_EQ(frame.Add(0, kWorld, 8), Start(6, 6));
  }
}

TEST(WakingPair, ThatWasLeftOutStartsFromWhatItExerted) {
  Frame frame;
  const std::array awake{Moving(5), Moving(1), Moving(2)};
  const std::array others{Moving(5)};
  frame.Begin(awake);
  frame.Add(1, 2, 7);
  frame.Exert(3);
  for (int i = 0; i < 5; ++i) frame.Begin(others);
  const std::array elsewhere{Moving(2), Moving(5), Moving(1)};
  frame.Begin(elsewhere);
  EXPECT_EQ(frame.Add(2, 0, 7), Start(3, 3));
  frame.Exert(4);
  frame.Begin(elsewhere);
  EXPECT_EQ(frame.Add(2, 0, 7), Start(4, 4)) << "the last frame counts";
}

TEST(WakingPair, ThatMovedApartStartsFromNothing) {
  Frame frame;
  const std::array awake{Moving(1), Moving(2)};
  frame.Begin(awake);
  frame.Add(0, 1, 7);
  frame.Exert(3);
  frame.Begin(awake);
  frame.Begin(awake);
  EXPECT_EQ(frame.Add(0, 1, 7), Start(0, 0));

  // asleep, and apart when they wake
  frame.Exert(3);
  const std::array asleep{Asleep(1), Asleep(2)};
  frame.Begin(asleep);
  frame.Begin(awake);
  frame.Begin(awake);
  EXPECT_EQ(frame.Add(0, 1, 7), Start(0, 0));
}

TEST(WakingPair, IsKnownAmongManyThatSleep) {
  constexpr int kPairs = 300;
  Frame frame;
  std::vector<Body> awake, asleep;
  for (int i = 0; i < kPairs; ++i) {
    awake.push_back(Moving(static_cast<std::uint64_t>(i) + 1));
    asleep.push_back(Asleep(static_cast<std::uint64_t>(i) + 1));
  }
  frame.Begin(awake);
  for (int i = 0; i < kPairs; ++i) frame.Add(i, kWorld, static_cast<std::uint64_t>(i) + 1);
  for (int i = 0; i < kPairs; ++i) {
    frame.contacts.impulses()[i].normal = static_cast<float>(i + 1);
    for (int k = 0; k < 3; ++k) frame.joints.impulses()[3 * i + k] = static_cast<float>(i + 1);
  }
  frame.Begin(asleep);
  // one by one
  std::vector<Body> bodies = asleep;
  for (int i = kPairs - 1; i >= 0; --i) {
    bodies[i] = awake[i];
    frame.Begin(bodies);
    const float expected = static_cast<float>(i + 1);
    EXPECT_EQ(frame.Add(i, kWorld, static_cast<std::uint64_t>(i) + 1), Start(expected, expected));
    bodies[i] = asleep[i];
  }
}

TEST(WakingBridge, RestsAsItDidBefore) {
  LoadedBridge bridge;
  for (int i = 0; i < 1200; ++i) bridge.StepDamped();
  const std::vector<Thing> resting = bridge.world.things;
  for (int i = 0; i < 30; ++i) {
    for (Thing& thing : bridge.world.things) {
      thing.mass = 0;
      thing.velocity = {};
    }
    bridge.world.Step([](SmallWorld*) {});
  }
  for (size_t i = 0; i < resting.size(); ++i) bridge.world.things[i].mass = resting[i].mass;
  double fastest = 0;
  for (int i = 0; i < 60; ++i) {
    bridge.Step();
    fastest = std::max(fastest, bridge.Speed());
  }
  EXPECT_LE(fastest, 0.02);
}

}  // namespace
}  // namespace cairn
