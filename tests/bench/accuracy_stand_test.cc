// SPDX-License-Identifier: MIT
#include "accuracy/stand/stand.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace cairn::accuracy {
namespace {

StandOptions Options(std::string_view scene, int seeds, int jobs = 1) {
  StandOptions options;
  options.scene = cli::ParseScene(scene);
  options.first = 3;
  options.seeds = seeds;
  options.jobs = jobs;
  options.seconds = 3;
  return options;
}

// Sixteen metres fall within three seconds with Bullet's ten iterations, see HeavyTop of the
// scenes.
TEST(Stand, SaysWhatFallsAndWhen) {
  const std::vector<StandRun> fallen =
      RunStand(Options("heavy-top", 2), ParseTensionSolvers("bullet-10").front());
  const std::vector<StandRun> standing =
      RunStand(Options("heavy-top", 2), ParseTensionSolvers("cairn").front());
  ASSERT_EQ(fallen.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(fallen[i].seed, 3u + i);
    ASSERT_TRUE(fallen[i].fell.has_value());
    EXPECT_GE(*fallen[i].fell, 1);
    EXPECT_LE(*fallen[i].fell, 3);
    EXPECT_GT(fallen[i].lost, 0.5);
    EXPECT_FALSE(standing[i].fell.has_value());
    EXPECT_LT(standing[i].lost, 0.1);
    EXPECT_GT(standing[i].lost, 0);
  }
}

TEST(Stand, DoesNotDependOnTheNumberOfJobs) {
  const TensionSolver solver = ParseTensionSolvers("cairn").front();
  const auto one = RunStand(Options("tower:5", 4), solver),
             two = RunStand(Options("tower:5", 4, 2), solver);
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].seed, two[i].seed);
    EXPECT_EQ(one[i].lost, two[i].lost);
    EXPECT_EQ(one[i].speed, two[i].speed);
  }
  EXPECT_NE(one[0].lost, one[1].lost) << "displaced by their seeds";
}

TEST(Stand, RestsAsDeepAsTheSlop) {
  const TensionSolver solver = ParseTensionSolvers("cairn").front();
  StandOptions options = Options("tower:5", 1);
  const StandRun bullets = RunStand(options, solver).front();
  options.slop = 0.002;
  const StandRun deep = RunStand(options, solver).front();
  EXPECT_NEAR(deep.lost - bullets.lost, 5 * 0.002, 0.002) << "one below each of the five boxes";
  options.erp = 0;
  const StandRun left = RunStand(options, solver).front();
  EXPECT_NE(left.lost, deep.lost) << "nothing takes depth away";
}

TEST(Stand, TellsHowFarATowerLeans) {
  const StandRun tower =
      RunStand(Options("tower:5", 1), ParseTensionSolvers("cairn").front()).front();
  const StandRun fallen =
      RunStand(Options("heavy-top", 1), ParseTensionSolvers("bullet-10").front()).front();
  EXPECT_GT(tower.sway, 0);
  EXPECT_LT(tower.sway, 0.02);
  EXPECT_GT(fallen.sway, 0.5) << "half a box, or it would stand";
}

TEST(Stand, WritesEveryRun) {
  const StandOptions options = Options("heavy-top", 2);
  const TensionSolver bullet = ParseTensionSolvers("bullet-10").front();
  const nlohmann::ordered_json json = ToJson({{bullet, RunStand(options, bullet)}}, options);
  EXPECT_EQ(json["scene"], "heavy-top");
  EXPECT_EQ(json["solvers"][0]["name"], "bullet-10");
  EXPECT_EQ(json["solvers"][0]["runs"].size(), 2u);
  EXPECT_EQ(json["solvers"][0]["runs"][1]["seed"], 4);
  EXPECT_TRUE(json["solvers"][0]["runs"][0].contains("fell_s"));
  EXPECT_GT(json["solvers"][0]["runs"][0]["sway_m"], 0);
  EXPECT_FALSE(json.contains("linear_slop_m")) << "Bullet's own";
  StandOptions set = options;
  set.slop = 0.001;
  set.erp = 0.1;
  const nlohmann::ordered_json other = ToJson({}, set);
  EXPECT_EQ(other["linear_slop_m"], 0.001);
  EXPECT_EQ(other["erp2"], 0.1);
}

}  // namespace
}  // namespace cairn::accuracy
