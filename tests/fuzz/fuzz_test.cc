// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/fuzz/contact_game.h"
#include "tests/fuzz/runs.h"

namespace cairn::test {
namespace {

constexpr int kMostBytes = 3000;

TEST(Fuzz, ContactGamesKeepAllPromises) { RunRandom(&PlayContactGame, 1500, kMostBytes); }

TEST(Fuzz, MatricesKeepAllPromises) { RunRandom(&SolveMatrix, 6000, kMostBytes); }

TEST(Fuzz, ContactCorpusKeepsAllPromises) { RunCorpus(&PlayContactGame, "contact"); }

TEST(Fuzz, MatrixCorpusKeepsAllPromises) { RunCorpus(&SolveMatrix, "matrix"); }

}  // namespace
}  // namespace cairn::test
