// SPDX-License-Identifier: MIT
// A long life of a world in which everything comes and goes. CAIRN_LIFE_FRAMES and CAIRN_LIFE_SEED
// ask for another length and another life than these. A program of its own: it decides where
// Bullet's memory comes from.
#include <LinearMath/btAlignedAllocator.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "tests/bullet_adapter/life/life.h"
#include "tests/core/support/recycling.h"

namespace cairn::test {
namespace {

int FromEnvironment(const char* name, int otherwise) {
  const char* const value = std::getenv(name);
  return value == nullptr ? otherwise : std::stoi(value);
}

int Frames() { return FromEnvironment("CAIRN_LIFE_FRAMES", 3000); }
std::uint64_t Seed() { return static_cast<std::uint64_t>(FromEnvironment("CAIRN_LIFE_SEED", 1)); }

struct Lived {
  LifeFacts facts;
  std::uint64_t hash = 0;
  /// Most bytes in use in the second third, and in the last one.
  size_t bytes_before = 0, bytes_after = 0;
};

Lived Live(Recycling recycling, int frames) {
  SetRecycling(recycling);
  btAlignedAllocSetCustomAligned([](size_t size, int) { return TakeMemory(size); }, GiveMemory);
  WatchedSolver solver;
  Lived lived;
  {
    Life life(Seed(), &solver);
    for (int frame = 0; frame < frames; ++frame) {
      life.Frame();
      if (frame < frames / 3) continue;
      size_t* const most = frame < 2 * (frames / 3) ? &lived.bytes_before : &lived.bytes_after;
      *most = std::max(*most, BytesInUse());
    }
    lived.facts = life.facts();
    lived.hash = life.hash();
  }
  return lived;
}

void Record(const Lived& lived) {
  const LifeFacts& facts = lived.facts;
  const auto record = [](const char* name, double value) {
    testing::Test::RecordProperty(name, std::to_string(value));
  };
  record("bodies", facts.bodies_added);
  record("joints", facts.joints_added);
  record("broken", facts.joints_broken);
  record("sleepers", facts.sleepers);
  record("foreign_frames", facts.foreign_frames);
  record("speed", facts.speed);
  record("spin", facts.spin);
  record("energy", facts.energy);
  record("depth", facts.depth);
  record("bytes_before", static_cast<double>(lived.bytes_before));
  record("bytes_after", static_cast<double>(lived.bytes_after));
}

TEST(Life, StaysWithinItsBounds) {
  const Lived lived = Live(Recycling::kByTheSystem, Frames());
  Record(lived);
  const LifeFacts& facts = lived.facts;
  EXPECT_EQ(facts.not_finite, 0);
  EXPECT_EQ(facts.refusals, 0) << "frames that fell back though nothing asked for it";
  // Joints that are torn hurl bodies about, metres into the ground in one step: 11 in the worst of
  // twelve lives. What fell through for good would be at thousands.
  EXPECT_LT(facts.depth, 40);
  // everything that the life is for did happen
  EXPECT_GT(facts.bodies_removed, Frames() / 100);
  EXPECT_GT(facts.joints_removed, Frames() / 100);
  EXPECT_GT(facts.joints_broken, Frames() / 500);
  EXPECT_GT(facts.sleepers, 3);
  EXPECT_GT(facts.foreign_frames, 0);
}

TEST(Life, DoesNotDependOnAddresses) {
  const int frames = Frames();
  const std::uint64_t expected = Live(Recycling::kByTheSystem, frames).hash;
  EXPECT_EQ(Live(Recycling::kAtOnce, frames).hash, expected);
  EXPECT_EQ(Live(Recycling::kLate, frames).hash, expected);
}

/// The second life of the same seed needs what the first needed, so that it can only grow by what
/// is never given back; within a life the population goes up and down.
TEST(Life, LeavesNothingBehind) {
  const int frames = Frames();
  const Lived first = Live(Recycling::kByTheSystem, frames);
  Lived second = Live(Recycling::kByTheSystem, frames);
  const size_t between = BytesInUse();
  second = Live(Recycling::kByTheSystem, frames);
  EXPECT_LT(BytesInUse(), between + 16384);  // not with the number of frames
  // what is learnt and remembered is bounded by the largest world, not by the time
  EXPECT_LT(first.bytes_after, first.bytes_before * 5 / 4 + 65536);
  EXPECT_LT(second.bytes_after, second.bytes_before * 5 / 4 + 65536);
}

}  // namespace
}  // namespace cairn::test
