// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "small/small.h"
#include "support/json_number.h"
#include "support/statistics.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

Json Numbers(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(Number(value));
  return list;
}

Json ToJson(const SmallResult& world, size_t index) {
  const SmallSolver& solver = world.solvers[index];
  Json failure = nullptr;
  if (solver.failure) {
    failure = {{"frame", solver.failure->frame}, {"reason", solver.failure->reason}};
  }
  return {{"solver", SmallSolvers()[index].label},
          {"failure", failure},
          {"hot_us", Number(solver.hot)},
          {"hot_of_bullet", Number(HotRatio(world, index))},
          {"cold_us", Number(solver.cold)},
          {"cold_of_bullet", Number(ColdRatio(world, index))},
          {"velocity_error_median_m_s", Number(Median(solver.errors))},
          {"velocity_error_of_bullet", Number(ErrorRatio(world, index))},
          {"velocity_errors_m_s", Numbers(solver.errors)}};
}

Json ToJson(const SmallResult& world) {
  Json solvers = Json::array();
  for (size_t i = 0; i < world.solvers.size(); ++i) solvers.push_back(ToJson(world, i));
  return {{"scene", world.name},
          {"size", world.size},
          {"bodies", world.bodies},
          {"joints", world.joints},
          {"contact_points", Number(world.points)},
          {"reference_residuals_m_s", Numbers(world.reference_residuals)},
          {"solvers", solvers}};
}

}  // namespace

std::string SmallToJson(const SmallOptions& options, std::span<const SmallResult> worlds,
                        const RunContext& context) {
  Json of_context = ToJson(context);
  of_context["run"] = ToJson(options.setup);
  of_context["run"].update({{"warmup_frames", options.warmup}});
  Json list = Json::array();
  for (const SmallResult& world : worlds) list.push_back(ToJson(world));
  const Json json = {{"context", of_context}, {"frames", options.frames}, {"worlds", list}};
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
