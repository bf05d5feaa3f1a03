// SPDX-License-Identifier: MIT
#include "cli/list.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli/scene_choice.h"
#include "cli/solver_registry.h"

namespace cairn::cli {

void ListScenes(ListForm form) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const bench::SceneInfo& scene : bench::Scenes()) {
    if (form == ListForm::kText) {
      fmt::print("{:<10} {}; size {} ({} to {} {})\n", scene.name, scene.description,
                 scene.default_size, scene.min_size, scene.max_size, scene.size_means);
    }
    json.push_back({{"name", scene.name},
                    {"description", scene.description},
                    {"size_means", scene.size_means},
                    {"default_size", scene.default_size},
                    {"min_size", scene.min_size},
                    {"max_size", scene.max_size}});
  }
  if (form == ListForm::kJson) fmt::print("{}\n", json.dump(1));
}

void ListSolvers(ListForm form) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const SolverEntry& solver : Solvers()) {
    if (form == ListForm::kText) fmt::print("{:<16} {}\n", solver.name, solver.description);
    json.push_back({{"name", solver.name}, {"description", solver.description}});
  }
  if (form == ListForm::kJson) fmt::print("{}\n", json.dump(1));
}

}  // namespace cairn::cli
