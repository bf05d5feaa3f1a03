// SPDX-License-Identifier: MIT
#include "tools/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "contestants/solver_registry.h"
#include "lcp/lcp_solvers.h"
#include "rows/row_solvers.h"
#include "run/scene_choice.h"
#include "solve/problem_choice.h"
#include "tools/solver_names.h"
#include "worlds/random_world.h"
#include "worlds/variants.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

Json SceneList(ListForm form) {
  Json json = Json::array();
  const auto add = [&](const bench::SceneInfo& scene) {
    if (form == ListForm::kText) {
      fmt::print("{:<14} {}; size {} ({} to {} {})\n", scene.name, scene.description,
                 scene.default_size, scene.min_size, scene.max_size, scene.size_means);
    }
    json.push_back({{"name", scene.name},
                    {"description", scene.description},
                    {"size_means", scene.size_means},
                    {"default_size", scene.default_size},
                    {"min_size", scene.min_size},
                    {"max_size", scene.max_size}});
  };
  for (const bench::SceneInfo& scene : bench::Scenes()) add(scene);
  add(bench::RandomScene::Info());
  return json;
}

Json ProblemList(ListForm form) {
  Json json = Json::array();
  for (const problems::Generator& generator : KnownGenerators()) {
    if (form == ListForm::kText) {
      fmt::print("{:<18} {}; size {} ({} to {} {})\n", generator.name, generator.help,
                 generator.size, generator.min_size, generator.max_size, generator.size_help);
    }
    Json parameters = Json::array();
    for (const problems::Parameter& parameter : generator.parameters) {
      if (form == ListForm::kText) {
        fmt::print("  {:<16} {}; {:g} ({:g} to {:g})\n", parameter.name, parameter.help,
                   parameter.value, parameter.min, parameter.max);
      }
      parameters.push_back({{"name", parameter.name},
                            {"description", parameter.help},
                            {"default", parameter.value},
                            {"min", parameter.min},
                            {"max", parameter.max}});
    }
    json.push_back({{"name", generator.name},
                    {"description", generator.help},
                    {"size_means", generator.size_help},
                    {"default_size", generator.size},
                    {"min_size", generator.min_size},
                    {"max_size", generator.max_size},
                    {"parameters", parameters}});
  }
  return json;
}

Json SolverList(ListForm form) {
  Json json = Json::array();
  const auto add = [&](const auto& solvers, SolverUser user, std::string_view command,
                       std::string_view takes) {
    for (const auto& solver : solvers) {
      const std::vector<std::string> aliases = Aliases(user, solver.name);
      if (form == ListForm::kText) {
        fmt::print("{:<21} {:<6} {:<13} {}{}\n", solver.name, command, takes, solver.description,
                   aliases.empty() ? "" : fmt::format("; also {}", fmt::join(aliases, ", ")));
      }
      json.push_back({{"name", solver.name},
                      {"aliases", aliases},
                      {"command", command},
                      {"takes", takes},
                      {"description", solver.description}});
    }
  };
  add(Solvers(), SolverUser::kRun, "run", "worlds");
  add(bench::CairnVariants(), SolverUser::kWorlds, "worlds", "random worlds");
  add(LcpSolvers(), SolverUser::kSolve, "solve", "matrices");
  add(RowSolvers(), SolverUser::kSolve, "solve", "frames");
  return json;
}

/// Text has been printed already.
void Print(const Json& json, ListForm form) {
  if (form == ListForm::kJson) fmt::print("{}\n", json.dump(1));
}

}  // namespace

void ListScenes(ListForm form) { Print(SceneList(form), form); }
void ListProblems(ListForm form) { Print(ProblemList(form), form); }
void ListSolvers(ListForm form) { Print(SolverList(form), form); }

void ListAll(ListForm form) {
  const std::tuple<const char*, const char*, Json (*)(ListForm)> lists[] = {
      {"scenes", "cairn run, cairn record", &SceneList},
      {"problems", "cairn solve", &ProblemList},
      {"solvers", "--solver", &SolverList}};
  Json all;
  for (const auto& [name, used_by, list] : lists) {
    if (form == ListForm::kText) {
      fmt::print("{}{}, for {}:\n", all.empty() ? "" : "\n", name, used_by);
    }
    all[name] = list(form);
  }
  Print(all, form);
}

}  // namespace cairn::cli
