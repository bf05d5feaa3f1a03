// SPDX-License-Identifier: MIT
#include "compare/run_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "run/result.h"
#include "support/failure.h"

namespace cairn::cli {
namespace {

using Json = nlohmann::ordered_json;

std::vector<double> Series(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list) {
    values.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                     : value.get<double>());
  }
  return values;
}

Repetitions AllSeries(const Json& repetitions, const char* name) {
  Repetitions all;
  for (const Json& repetition : repetitions) all.push_back(Series(repetition.at(name)));
  return all;
}

RecordedSolver ReadSolver(const Json& json) {
  RecordedSolver solver{.name = json.at("solver"),
                        .effort = json.at("effort"),
                        .failure = {},
                        .times = AllSeries(json.at("repetitions"), "time_ms"),
                        .residuals = AllSeries(json.at("repetitions"), "residual_m_s")};
  if (const Json& failure = json.at("failure"); !failure.is_null()) {
    solver.failure = fmt::format("at frame {}, {}", failure.at("frame").get<int>(),
                                 failure.at("reason").get<std::string>());
  }
  return solver;
}

/// Whether series have the same numbers of repetitions and frames, and nothing but what can be.
void CheckSeries(const RecordedScene& scene) {
  const auto fits = [&](const Repetitions& series) {
    if (series.size() != scene.arithmetic.size()) return false;
    for (size_t r = 0; r < series.size(); ++r) {
      if (series[r].size() != scene.arithmetic[r].size()) return false;
      if (std::any_of(series[r].begin(), series[r].end(), [](double x) { return x < 0; })) {
        return false;
      }
    }
    return true;
  };
  bool fine = !scene.arithmetic.empty() && fits(scene.arithmetic) && fits(scene.memory);
  for (const RecordedSolver& solver : scene.solvers) {
    fine = fine && (!solver.failure.empty() || (fits(solver.times) && fits(solver.residuals)));
  }
  if (!fine)
    throw std::invalid_argument("numbers of frames differ, or are negative, in " + scene.name);
}

RecordedScene ReadScene(const Json& json) {
  RecordedScene scene{.name = json.at("scene"),
                      .world = fmt::format("size {}, seed {}, {} bodies", json.at("size").dump(),
                                           json.at("seed").dump(), json.at("bodies").dump()),
                      .arithmetic = AllSeries(json.at("metronome"), "arithmetic_ms"),
                      .memory = AllSeries(json.at("metronome"), "memory_ms"),
                      .solvers = {}};
  for (const Json& solver : json.at("solvers")) scene.solvers.push_back(ReadSolver(solver));
  CheckSeries(scene);
  return scene;
}

std::string Words(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "none" : value.dump();
}

void ReadCircumstances(const Json& json, RunFile* file) {
  const Json& context = json.at("context");
  const Json &host = context.at("host"), &build = context.at("build"), &run = context.at("run");
  const Json& bullet = build.at("bullet");
  file->required = {{"CPU", Words(host.at("cpu"))},
                    {"cores", Words(host.at("cores"))},
                    {"build type", Words(build.at("build_type"))},
                    {"precision of Bullet", Words(bullet.at("precision"))},
                    {"frames", Words(json.at("frames"))},
                    {"warm-up frames", Words(run.at("warmup_frames"))},
                    {"budget [ms]", Words(json.at("budget_ms"))},
                    {"budget [units]", Words(json.value("budget_units", Json()))}};
  file->expected = {{"SIMD target", Words(host.at("simd_target"))},
                    {"threads of Cairn", Words(run.at("threads"))},
                    {"core pinned to", Words(run.at("pinned_to_core"))},
                    {"governor", Words(host.at("governor"))},
                    {"compiler", Words(build.at("compiler"))},
                    {"Bullet", Words(bullet.at("version")) + ", " + Words(bullet.at("library"))}};
}

Json Parse(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(path, error);
  if (is_folder) errno = EISDIR;  // which is opened, and cannot be read
  if (is_folder || !stream) {
    throw Failure(kUsage, fmt::format("cannot read '{}': {}", path, std::strerror(errno)));
  }
  Json json = Json::parse(stream, nullptr, false);
  if (json.is_discarded()) {
    throw Failure(kUsage, fmt::format("'{}' is not JSON, or was cut: write it again with cairn "
                                      "run --json",
                                      path));
  }
  return json;
}

void CheckVersion(const Json& json, const std::string& path) {
  const bool is_run = json.is_object() && json.contains("scenes");
  if (is_run && json.value("schema_version", Json()) == kRunSchema) return;
  if (!is_run) {
    throw Failure(
        kUsage,
        fmt::format("'{}' is JSON, but no result of cairn run SCENE --json (nor is that of cairn "
                    "run small)",
                    path));
  }
  throw Failure(kUsage, fmt::format("'{}' has schema_version {}, and this cairn reads {}: write it "
                                    "again with this cairn",
                                    path, Words(json.value("schema_version", Json())), kRunSchema));
}

}  // namespace

RunFile ReadRunFile(const std::string& path) {
  const Json json = Parse(path);
  CheckVersion(json, path);
  RunFile file;
  file.path = path;
  try {
    ReadCircumstances(json, &file);
    for (const Json& scene : json.at("scenes")) file.scenes.push_back(ReadScene(scene));
    if (file.scenes.empty()) throw std::invalid_argument("it has no scene");
  } catch (const std::exception& error) {
    throw Failure(
        kUsage, fmt::format("'{}' is no whole result of cairn run --json: {}", path, error.what()));
  }
  return file;
}

}  // namespace cairn::cli
