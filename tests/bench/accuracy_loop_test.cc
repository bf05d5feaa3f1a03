// SPDX-License-Identifier: MIT
// cairn_accuracy in closed loop: runs that are stopped.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "accuracy/loop/loop.h"
#include "run/scene_choice.h"

namespace cairn::accuracy {
namespace {

cli::SceneChoice Scene(const char* name, int size) {
  const std::vector<std::string> names = {name};
  return cli::ParseScenes(names, std::to_string(size), 0).front();
}

TEST(Loop, StopsAfterARunAndKeepsWhatIsDone) {
  const LoopOptions options{.scenes = {Scene("heavy-top", 3), Scene("tower", 3)},
                            .frames = 4,
                            .seeds = 3,
                            .budgets = {std::chrono::milliseconds(1)}};
  int runs = 0;
  const auto loops = [&](int most) {
    runs = 0;
    return RunLoops(
        options, [](const std::string&) {}, [&] { return ++runs == most; });
  };
  const std::vector<LoopScene> three = loops(3);
  ASSERT_EQ(three.size(), 2u);
  EXPECT_EQ(three[0].seeds(), 2);
  EXPECT_EQ(three[1].seeds(), 1);
  EXPECT_EQ(three[0].Of(0, Kind::kSteps).name, "steps");
  EXPECT_EQ(three[0].bullet().name, "bullet-si");
  EXPECT_EQ(loops(1).size(), 1u);
  EXPECT_EQ(loops(100)[1].seeds(), 3);
  EXPECT_EQ(runs, 6);
}

}  // namespace
}  // namespace cairn::accuracy
