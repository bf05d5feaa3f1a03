// SPDX-License-Identifier: MIT
#include "tests/fuzz/runs.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

namespace cairn::test {
namespace {

constexpr int kMostFindings = 10;

int FromEnvironment(const char* name, int otherwise) {
  const char* const asked = std::getenv(name);
  return asked != nullptr ? std::atoi(asked) : otherwise;
}

}  // namespace

void RunRandom(FuzzTarget target, int runs, int most_bytes) {
  const int first = FromEnvironment("CAIRN_FUZZ_SEED", 0);
  const int last = first + FromEnvironment("CAIRN_FUZZ_RUNS", runs);
  int findings = 0;
  for (int seed = first; seed < last && findings < kMostFindings; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::vector<std::uint8_t> bytes(random() % static_cast<unsigned>(most_bytes));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const std::string broken = target(bytes);
    findings += !broken.empty();
    EXPECT_EQ(broken, "") << "seed " << seed;
  }
}

void RunCorpus(FuzzTarget target, const std::string& name) {
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

}  // namespace cairn::test
