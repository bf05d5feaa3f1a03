// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/fuzz/runs.h"
#include "tests/fuzz/world_game.h"

namespace cairn::test {
namespace {

constexpr int kMostBytes = 1500;

TEST(Fuzz, WorldsOfBulletKeepAllPromises) { RunRandom(&PlayWorld, 200, kMostBytes); }

TEST(Fuzz, WorldCorpusKeepsAllPromises) { RunCorpus(&PlayWorld, "world"); }

}  // namespace
}  // namespace cairn::test
