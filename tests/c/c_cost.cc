// SPDX-License-Identifier: MIT
// What the interface of C costs: towers solved by turns through C++ and through C, which start from
// the same impulses. Prints the median of each, and of their ratio.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/c/c_problems.h"

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

}  // namespace
}  // namespace cairn

int main() {
  int failed = 0;
  for (const int towers : {1, 10, 100}) {
    for (const int sweeps : {10, 30}) failed += cairn::MeasureTowers(towers, sweeps);
  }
  return failed;
}
