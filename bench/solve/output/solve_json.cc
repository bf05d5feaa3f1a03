// SPDX-License-Identifier: MIT
#include "solve/output/solve_output.h"

#include <chrono>
#include <optional>

#include "support/duration.h"
#include "support/json_number.h"
#include "support/phase_names.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

Json Settings(const SolveResult& result) {
  const LcpOptions& options = result.options;
  Json errors = Json::array();
  for (const double error : result.errors) errors.push_back(error);
  Json settings = {
      {"solvers", result.solvers},
      {"start", Name(result.start)},
      {"tolerance", options.tolerance},
      {"max_sweeps", Maybe(options.max_sweeps)},
      {"budget_ms", options.budget ? Json(Milliseconds(*options.budget)) : Json(nullptr)},
      {"order", Name(options.order)},
      {"threads", options.threads},
      {"k_gs", options.k_gs},
      {"k_sm", options.k_sm},
      {"active_tolerance", options.active_tolerance},
      {"omega", options.omega},
      {"repeat", result.repeat},
      {"clock", result.clock == SolverClock::kThreadCpu ? "thread cpu" : "wall"},
      {"errors", errors}};
  if (!result.any_frame()) return settings;
  const std::optional<std::chrono::nanoseconds> budget = result.row_options.budget;
  settings["frames"] = {{"tolerance_m_s", result.row_options.tolerance},
                        {"budget_ms", budget ? Json(Milliseconds(*budget)) : Json(nullptr)}};
  return settings;
}

Json ToJson(const LcpResidual& residual) {
  return {{"relative", Number(residual.relative)},
          {"max", Number(residual.max)},
          {"energy", Number(residual.energy)},
          {"natural", Number(residual.natural)},
          {"violation", Number(residual.violation)},
          {"complementarity", Number(residual.complementarity)},
          {"objective", Number(residual.objective)}};
}

Json ToJson(const LevelReached& level) {
  const auto& first = level.first;
  return {{"error", level.level},
          {"time_ms", first ? Number(first->time) : Json(nullptr)},
          {"sweeps", first ? Json(first->sweeps) : Json(nullptr)},
          {"factorisations", first ? Json(first->factorisations) : Json(nullptr)}};
}

Json ToJson(const HistoryPoint& point) {
  return {{"time_ms", Number(point.time)},
          {"sweeps", point.sweeps},
          {"factorisations", point.factorisations},
          {"error", Number(point.error)},
          {"error_energy", Number(point.energy_error)},
          {"residual", Number(point.residual)}};
}

Json ToJson(const RowFacts& facts) {
  return {{"frame", facts.frame},
          {"bodies", facts.bodies},
          {"joint_rows", facts.joint_rows},
          {"contact_points", facts.points},
          {"lifted_sweep_limit", facts.limited_sweeps},
          {"reference_spread", Number(facts.spread)}};
}

Json ToJson(const NestedGrid& grid) {
  return {{"size", grid.size},
          {"time_ms", Number(grid.time)},
          {"sweeps", grid.sweeps},
          {"factorisations", grid.factorisations}};
}

Json ToJson(const AnswerResult& answer) {
  return {{"name", answer.name},
          {"source", answer.source},
          {"value", Number(answer.value)},
          {"expected", answer.expected},
          {"difference", Number(answer.value - answer.expected)},
          {"tolerance", answer.tolerance},
          {"ok", answer.ok()}};
}

Json ToJson(const LcpSolverResult& solver);
Json ToJson(const ProblemResult& problem);

template <class Items>
Json List(const Items& items) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(ToJson(item));
  return list;
}

Json ToJson(const lcp::Phases& phases) {
  Json json = Json::object();
  for (const auto& [name, phase] : kPhases) json[name] = Milliseconds(phases.*phase);
  return json;
}

Json ToJson(const LcpSolverResult& solver) {
  return {{"solver", solver.label},
          {"solved", !solver.failure},
          {"failure", Maybe(solver.failure)},
          {"end", solver.stop},
          {"time_ms", Number(solver.time)},
          {"times_ms", solver.times},
          {"sweeps", solver.sweeps},
          {"factorisations", solver.factorisations},
          {"analyses", solver.analyses},
          {"factor_nonzeros", solver.factor_nonzeros},
          {"steps_accepted", solver.steps_accepted},
          {"steps_restored", solver.steps_restored},
          {"steps_solved", solver.steps_solved},
          {"residual", ToJson(solver.residual)},
          {"error", Number(solver.error)},
          {"error_energy", Number(solver.energy_error)},
          {"reached", List(solver.levels)},
          {"residual_reached", List(solver.residual_levels)},
          {"prepare_ms", Number(solver.prepare_time)},
          {"curve", solver.residual_levels.empty() ? Json::array() : List(solver.history)},
          {"phases_ms", ToJson(solver.phases)},
          {"nested_ms", Number(solver.nested_time)},
          {"nested", List(solver.nested)},
          {"answers", List(solver.answers)}};
}

Json ToJson(const ProblemResult& problem) {
  Json parameters = Json::object();
  for (const auto& [name, value] : problem.parameters) parameters[name] = value;
  constexpr const char* kTruths[] = {"none", "solution", "w", "best found", "converged reference"};
  return {{"problem", problem.name},
          {"source", problem.source},
          {"size", problem.generator_size == 0 ? Json(nullptr) : Json(problem.generator_size)},
          {"parameters", parameters},
          {"unit", problem.rows ? "m/s" : "relative"},
          {"recorded", problem.rows ? ToJson(*problem.rows) : Json(nullptr)},
          {"n", problem.size},
          {"nonzeros", problem.nonzeros},
          {"free_rows", problem.free_rows},
          {"steps", problem.steps},
          {"error_against", kTruths[static_cast<int>(problem.truth)]},
          {"reference_residual", Number(problem.best_residual)},
          {"solvers", List(problem.solvers)}};
}

}  // namespace

std::string ToJson(const SolveResult& result) {
  Json skipped = Json::array();
  for (const SkippedFolder& folder : result.skipped) {
    skipped.push_back({{"name", folder.name}, {"reason", folder.reason}});
  }
  Json unread = Json::array();
  for (const UnreadFile& file : result.unread) {
    unread.push_back({{"path", file.path}, {"reason", file.reason}});
  }
  const Json json = {
      {"schema_version", 1},          {"context", ToJson(static_cast<const RunContext&>(result))},
      {"settings", Settings(result)}, {"problems", List(result.problems)},
      {"skipped", skipped},           {"unread", unread}};
  return json.dump(1) + "\n";
}

}  // namespace cairn::cli
