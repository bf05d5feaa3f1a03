// SPDX-License-Identifier: MIT
// Worlds of the core: each of five worlds under seven settings, and matrices by every method.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "cairn/lcp/solver.h"
#include "verify/answers.h"
#include "verify/plain_world.h"

namespace cairn::verify {
namespace {

using Eigen::Vector3d;

void AddBox(double mass, const Vector3d& half, const Vector3d& position, PlainWorld* world) {
  world->things.push_back({.mass = mass, .half = half, .position = position});
}

/// Boxes whose masses grow upwards, each a little beside the one below.
void BuildTower(PlainWorld* world) {
  for (int i = 0; i < 12; ++i) {
    AddBox(1 + i * i / 4.0, {0.5, 0.5, 0.5}, {0.01 * (i % 3), 0.5 + i, 0.005 * (i % 2)}, world);
  }
}

void BuildWall(PlainWorld* world) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      AddBox(2, {0.98, 0.5, 0.5}, {2.0 * column + row % 2, 0.5 + row, 0}, world);
    }
  }
}

/// Light links that hang on the world, and a heavy box at the end.
void BuildChain(PlainWorld* world) {
  for (int i = 0; i < 20; ++i) {
    AddBox(i == 19 ? 100 : 1, {0.25, 0.05, 0.05}, {0.25 + 0.5 * i, 12, 0}, world);
    world->pins.push_back(
        {i, i - 1, {-0.25, 0, 0}, i == 0 ? Vector3d(0, 12, 0) : Vector3d(0.25, 0, 0)});
  }
}

/// Planks that hang together by two pins each, which is one more than they need, under crates.
void BuildBridge(PlainWorld* world) {
  constexpr int kPlanks = 16;
  for (int i = 0; i < kPlanks; ++i) {
    const double x = 0.5 + i;
    AddBox(1, {0.48, 0.05, 0.75}, {x, 5, 0}, world);
    for (const double z : {-0.7, 0.7}) {
      const Vector3d end = i == 0 ? Vector3d(0, 5, z) : Vector3d(0.5, 0, z);
      world->pins.push_back({i, i - 1, {-0.5, 0, z}, end});
    }
  }
  for (const double z : {-0.7, 0.7}) {
    world->pins.push_back({kPlanks - 1, -1, {0.5, 0, z}, {kPlanks, 5, z}});
  }
  for (int i = 0; i < 5; ++i) AddBox(20, {0.4, 0.4, 0.4}, {2.2 + 2.9 * i, 5.5, 0}, world);
}

/// Balls that fall on each other.
void BuildBalls(int layers, PlainWorld* world) {
  for (int i = 0; i < 25 * layers; ++i) {
    const int layer = i / 25, x = i % 5, z = i / 5 % 5;
    const Vector3d position(0.9 * x + 0.07 * (layer % 3), 0.5 + 1.01 * layer, 0.9 * z + 0.05 * x);
    world->things.push_back(
        {.mass = 1.0 + i % 4, .position = position, .radius = 0.4 + 0.02 * (i % 5)});
  }
}

struct Kind {
  const char* name;
  void (*build)(PlainWorld* world);
};
constexpr Kind kKinds[] = {
    {"tower", BuildTower},
    {"wall", BuildWall},
    {"chain", BuildChain},
    {"bridge", BuildBridge},
    {"balls", [](PlainWorld* world) { BuildBalls(6, world); }},
};

std::vector<std::pair<std::string, Settings>> AllSettings() {
  Settings sweeps{.method = Method::kPgs, .max_sweeps = 10};
  Settings steps{.max_sweeps = 15, .tolerance = 0, .step_policy = StepPolicy::kAlways};
  Settings weighed{.max_sweeps = 10, .tolerance = 1e-4, .step_policy = StepPolicy::kWeighed};
  Settings work{.budget = Budget::Work(20000)};
  Settings reference{.path = Path::kReference, .max_sweeps = 20};
  std::vector<std::pair<std::string, Settings>> all = {{"defaults", {}}, {"sweeps", sweeps},
                                                       {"steps", steps}, {"weighed", weighed},
                                                       {"work", work},   {"reference", reference}};
  // chain and bridge are strained
  for (auto& [name, settings] : all) settings.geometric_stiffness = false;
  all.emplace_back("stiff", Settings{});
  return all;
}

Answer AnswerOf(std::string name, PlainWorld* world) {
  Answer answer{std::move(name), {}};
  Hash hash;
  for (int frame = 1; frame <= kFrames; ++frame) {
    world->Step();
    world->AddTo(&hash);
    if (frame % (kFrames / kMarks) == 0) answer.marks.push_back(hash.value());
  }
  return answer;
}

/// A membrane over an obstacle, on a square grid: the five-point Laplacian, bounded from below.
lcp::BoxedLcp Membrane(int side) {
  lcp::BoxedLcp problem;
  const int n = side * side;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 4.0 + 0.001 * (i % 7));
    if (i % side > 0) entries.emplace_back(i, i - 1, -1.0);
    if (i % side < side - 1) entries.emplace_back(i, i + 1, -1.0);
    if (i >= side) entries.emplace_back(i, i - side, -1.0);
    if (i + side < n) entries.emplace_back(i, i + side, -1.0);
  }
  problem.M.resize(n, n);
  problem.M.setFromTriplets(entries.begin(), entries.end());
  problem.q = Eigen::VectorXd::Constant(n, 0.02);
  problem.lo.resize(n);
  problem.hi = Eigen::VectorXd::Constant(n, 2.0);
  for (int i = 0; i < n; ++i) {
    const double x = (i % side) / (side - 1.0) - 0.5, y = (i / side) / (side - 1.0) - 0.5;
    problem.lo[i] = 0.3 - 2 * (x * x + y * y);
  }
  return problem;
}

Answer AnswerOf(std::string name, const lcp::Settings& settings) {
  Answer answer{std::move(name), {}};
  Hash hash;
  for (int mark = 1; mark <= kMarks; ++mark) {
    const lcp::BoxedLcp problem = Membrane(3 + 3 * mark);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.size());
    lcp::Solver solver(settings);
    const lcp::Report report = solver.Solve(problem, &x);
    for (const double number : x) hash.Add(number);
    hash.Add(report.sweeps);
    hash.Add(report.factorisations);
    answer.marks.push_back(hash.value());
  }
  return answer;
}

}  // namespace

std::vector<Answer> CoreAnswers() {
  std::vector<Answer> answers;
  for (const Kind& kind : kKinds) {
    for (const auto& [name, settings] : AllSettings()) {
      PlainWorld world(settings);
      kind.build(&world);
      answers.push_back(AnswerOf("core/" + std::string(kind.name) + "/" + name, &world));
    }
  }
  // enough rows for threads to share them
  PlainWorld heap(Settings{.max_sweeps = 10, .threads = 3});
  BuildBalls(20, &heap);
  answers.push_back(AnswerOf("core/heap/threads", &heap));

  using lcp::Method;
  for (const auto& [name, method] : {std::pair("pgs", Method::kPgs),
                                     {"psor", Method::kPsor},
                                     {"pgs-sm", Method::kPgsSm},
                                     {"literal", Method::kPgsSmLiteral},
                                     {"ipm", Method::kInteriorPoint}}) {
    const lcp::Settings settings{
        .method = method, .tolerance = 1e-6, .omega = method == Method::kPsor ? 1.5 : 1};
    answers.push_back(AnswerOf("matrix/" + std::string(name), settings));
  }
  return answers;
}

}  // namespace cairn::verify
