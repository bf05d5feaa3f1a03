// SPDX-License-Identifier: MIT
// What the interface of C costs, by turns with C++. Towers are solved from the same impulses;
// frames are made by helpers of the same contacts and joints, and solved. Prints the median of
// each, and of their ratio.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "tests/c/c_problems.h"
#include "tests/c/helper_frames.h"

namespace cairn {
namespace {

double Median(std::vector<double> numbers) {
  std::nth_element(numbers.begin(), numbers.begin() + numbers.size() / 2, numbers.end());
  return numbers[numbers.size() / 2];
}

/// Towers of ten boxes side by side.
test::ManifoldScene Towers(int towers) {
  test::ManifoldScene scene;
  const test::ManifoldScene one = test::ManifoldTower(10);
  for (int t = 0; t < towers; ++t) {
    const int bodies = static_cast<int>(scene.bodies.size());
    for (Manifold manifold : one.manifolds) {
      manifold.body_a += bodies;
      if (manifold.body_b != kWorld) manifold.body_b += bodies;
      manifold.first_point += static_cast<int>(scene.points.size());
      scene.manifolds.push_back(manifold);
    }
    scene.bodies.insert(scene.bodies.end(), one.bodies.begin(), one.bodies.end());
    scene.points.insert(scene.points.end(), one.points.begin(), one.points.end());
  }
  scene.point_impulses.resize(scene.points.size());
  return scene;
}

template <class Function>
double Microseconds(const Function& function) {
  const auto begin = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin)
      .count();
}

int MeasureTowers(int towers, int sweeps) {
  test::ManifoldScene scene = Towers(towers);
  test::CScene rounded = test::ToC(&scene);
  test::ManifoldScene copy = scene;
  test::CScene c = test::ToC(&copy);
  Settings settings{.steps = false, .max_sweeps = sweeps, .tolerance = 0};
  CairnSettings c_settings = cairnDefaultSettings();
  c_settings.steps = false;
  c_settings.maxSweeps = sweeps;
  c_settings.tolerance = 0;
  Solver solver(settings);
  CairnSolver* c_solver = nullptr;
  if (cairnCreateSolver(cairnLayout(), &c_settings, &c_solver) != cairnOk) return 1;
  std::vector<Velocity> velocities(scene.bodies.size());
  std::vector<double> cpp, via_c, ratios;
  Report report;
  for (int i = 0; i < 1001; ++i) {
    std::fill(scene.point_impulses.begin(), scene.point_impulses.end(), ContactImpulse{});
    std::fill(copy.point_impulses.begin(), copy.point_impulses.end(), ContactImpulse{});
    cpp.push_back(Microseconds(
        [&] { solver.Solve(scene.problem(), scene.impulses(), velocities, &report); }));
    via_c.push_back(Microseconds([&] { cairnSolve(c_solver, &c.problem, &c.solution, nullptr); }));
    ratios.push_back(via_c.back() / cpp.back());
  }
  cairnDestroySolver(c_solver);
  std::printf("%5d bodies, %2d sweeps: C++ %8.1f us, C %8.1f us, C / C++ %.3f\n", 10 * towers,
              sweeps, Median(cpp), Median(via_c), Median(ratios));
  return 0;
}

/// What an engine gives to helpers in a frame: a touch of four points and a joint for each body.
struct HelperFrame {
  HelperFrame() {
    const std::vector<test::AnyJoint> kinds = test::AllKinds();
    for (int i = 0; i < test::RandomFrames::kBodies; ++i) {
      touches.push_back(random.NextTouch(i));
      points.push_back(random.NextPoints(touches.back(), 4));
      for (TouchPoint& point : points.back()) point.depth = 0.01;
      joints.push_back(kinds[i % 8].kind);  // those behind hold nothing, or are of other forms
      const int b = i == 0 ? kWorld : i - 1;
      sides.push_back({random.NextSide(i), random.NextSide(b)});
    }
    for (const Body& body : random.bodies) c_bodies.push_back(test::ToC(body, cairnDefaultBody()));
    for (const Touch& touch : touches) c_touches.push_back(test::ToC(touch));
    for (const std::vector<TouchPoint>& some : points) {
      for (const TouchPoint& point : some) c_points.push_back(test::ToC(point));
    }
    for (const JointKind& kind : joints) c_joints.push_back(test::ToC(kind));
    for (const auto& [a, b] : sides) c_sides.push_back({test::ToC(a), test::ToC(b)});
  }

  test::RandomFrames random{1};
  std::vector<Touch> touches;
  std::vector<std::vector<TouchPoint>> points;
  std::vector<JointKind> joints;
  std::vector<std::pair<JointSide, JointSide>> sides;
  std::vector<CairnBody> c_bodies;
  std::vector<CairnTouch> c_touches;
  std::vector<CairnTouchPoint> c_points;
  std::vector<CairnJointKind> c_joints;
  std::vector<std::pair<CairnJointSide, CairnJointSide>> c_sides;
};

int MeasureHelpers(int sweeps) {
  const HelperFrame frame;
  const std::vector<Body>& bodies = frame.random.bodies;
  const auto id = [](size_t i) { return static_cast<std::uint64_t>(i + 1); };
  Solver solver({.steps = false, .max_sweeps = sweeps, .tolerance = 0});
  CairnSettings settings = cairnDefaultSettings();
  settings.steps = false;
  settings.maxSweeps = sweeps;
  settings.tolerance = 0;
  CairnFrameSettings frame_settings = cairnDefaultFrameSettings();
  CairnSolver* c_solver = nullptr;
  CairnFrame* c_frame = nullptr;
  if (cairnCreateSolver(cairnLayout(), &settings, &c_solver) != cairnOk ||
      cairnCreateFrame(cairnHelperLayout(), &frame_settings, &c_frame) != cairnOk) {
    return 1;
  }
  Contacts contacts;
  Joints joints;
  std::vector<Velocity> velocities(bodies.size());
  std::vector<CairnVelocity> c_velocities(bodies.size());
  Report report;
  CairnStatus status = cairnOk;
  const auto in_cpp = [&] {
    const StepInput step{.bodies = bodies, .time_step = 1.0 / 60};
    contacts.Begin(step);
    joints.Begin(step);
    for (size_t i = 0; i < bodies.size(); ++i) contacts.Add(frame.touches[i], frame.points[i]);
    for (size_t i = 0; i < bodies.size(); ++i) {
      joints.Add(frame.joints[i], frame.sides[i].first, frame.sides[i].second, id(i));
    }
    solver.Solve(ProblemOf(step, contacts, joints), StartOf(&contacts, &joints), velocities,
                 &report);
  };
  const auto in_c = [&] {
    CairnStep step = cairnDefaultStep();
    step.bodies = frame.c_bodies.data();
    step.bodyCount = static_cast<std::int32_t>(frame.c_bodies.size());
    step.timeStep = 1.0 / 60;
    status = std::max(status, cairnBeginFrame(c_frame, &step));
    for (size_t i = 0; i < bodies.size(); ++i) {
      const CairnTouchPoint* points = &frame.c_points[4 * i];
      status = std::max(status, cairnAddTouch(c_frame, &frame.c_touches[i], points, 4));
    }
    for (size_t i = 0; i < bodies.size(); ++i) {
      const auto& [a, b] = frame.c_sides[i];
      status = std::max(status, cairnAddJoint(c_frame, &frame.c_joints[i], &a, &b, id(i), nullptr));
    }
    CairnProblem problem;
    CairnSolution solution;
    status = std::max(status, cairnFrameProblem(c_frame, &problem, &solution));
    solution.velocities = c_velocities.data();
    status = std::max(status, cairnSolve(c_solver, &problem, &solution, nullptr));
  };
  std::vector<double> cpp, via_c, ratios;
  for (int i = 0; i < 1001; ++i) {
    cpp.push_back(Microseconds(in_cpp));
    via_c.push_back(Microseconds(in_c));
    ratios.push_back(via_c.back() / cpp.back());
  }
  cairnDestroyFrame(c_frame);
  cairnDestroySolver(c_solver);
  std::printf("%5zu bodies, %2d sweeps, with helpers: C++ %5.1f us, C %5.1f us, C / C++ %.3f\n",
              bodies.size(), sweeps, Median(cpp), Median(via_c), Median(ratios));
  return status == cairnOk && report.ok() ? 0 : 1;
}

}  // namespace
}  // namespace cairn

int main() {
  int failed = 0;
  for (const int towers : {1, 10, 100}) {
    for (const int sweeps : {10, 30}) failed += cairn::MeasureTowers(towers, sweeps);
  }
  for (const int sweeps : {10, 30}) failed += cairn::MeasureHelpers(sweeps);
  return failed;
}
