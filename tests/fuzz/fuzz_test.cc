// SPDX-License-Identifier: MIT
// What the fuzz targets do, without clang: random bytes from fixed seeds, and what fuzzers found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "tests/fuzz/contact_game.h"

namespace cairn::test {
namespace {

using Target = std::string (*)(std::span<const std::uint8_t>);

/// CAIRN_FUZZ_RUNS: so many instead of the few that a test makes.
int Runs(int few) {
  const char* const asked = std::getenv("CAIRN_FUZZ_RUNS");
  return asked != nullptr ? std::atoi(asked) : few;
}

int FirstSeed() {
  const char* const asked = std::getenv("CAIRN_FUZZ_SEED");
  return asked != nullptr ? std::atoi(asked) : 0;
}

void RunRandom(Target target, int runs) {
  int broken_runs = 0;
  for (int seed = FirstSeed(); seed < FirstSeed() + runs && broken_runs < 10; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::vector<std::uint8_t> bytes(random() % 3000);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const std::string broken = target(bytes);
    broken_runs += !broken.empty();
    EXPECT_EQ(broken, "") << "seed " << seed;
  }
}

void RunCorpus(Target target, const std::string& name) {
  int files = 0;
  const std::string folder = std::string(CAIRN_SOURCE_DIR) + "/tests/fuzz/corpus/" + name;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> text{std::istreambuf_iterator<char>(file), {}};
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    EXPECT_EQ(target(bytes), "") << entry.path();
    ++files;
  }
  EXPECT_GT(files, 0);
}

TEST(Fuzz, ContactGamesKeepAllPromises) { RunRandom(&PlayEverywhere, Runs(1500)); }

TEST(Fuzz, MatricesKeepAllPromises) { RunRandom(&SolveMatrix, Runs(6000)); }

TEST(Fuzz, ContactCorpusKeepsAllPromises) { RunCorpus(&PlayEverywhere, "contact"); }

TEST(Fuzz, MatrixCorpusKeepsAllPromises) { RunCorpus(&SolveMatrix, "matrix"); }

}  // namespace
}  // namespace cairn::test
