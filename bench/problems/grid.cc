// SPDX-License-Identifier: MIT
#include "problems/grid.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace cairn::problems {
namespace {

/// Where a fine index lies between two coarse ones.
struct Span {
  int left = 0;       ///< Coarse index, -1 is the boundary.
  double weight = 0;  ///< Of left + 1, in [0, 1).
};

/// Whole numbers decide, so that points of both grids are met exactly.
std::vector<Span> Spans(int coarse, int fine) {
  std::vector<Span> spans;
  spans.reserve(fine);
  for (std::int64_t i = 1; i <= fine; ++i) {
    const std::int64_t place = i * (coarse + 1), left = place / (fine + 1);
    spans.push_back({.left = static_cast<int>(left) - 1,
                     .weight = static_cast<double>(place % (fine + 1)) / (fine + 1)});
  }
  return spans;
}

/// The weighted mean of up to four neighbours, and whether all of those inside are on a bound.
struct Gathered {
  double value = 0;
  bool at_lo = true, at_hi = true;
};

/// A solution on the coarse grid, and its box at the same points.
struct CoarseLevel {
  const Grid& grid;
  const Field& boundary;
  const Eigen::VectorXd& x;
  Eigen::VectorXd lo, hi;

  void Gather(int i, int j, double weight, Gathered* sum) const {
    if (weight == 0) return;
    const bool inside = i >= 0 && i < grid.nx && j >= 0 && j < grid.ny;
    if (!inside) {
      sum->value += weight * boundary(grid.x(i), grid.y(j));
      return;
    }
    const Eigen::Index row = grid.row(i, j);
    sum->value += weight * x[row];
    sum->at_lo = sum->at_lo && x[row] == lo[row];
    sum->at_hi = sum->at_hi && x[row] == hi[row];
  }

  Gathered At(const Span& a, const Span& b) const {
    Gathered sum;
    Gather(a.left, b.left, (1 - a.weight) * (1 - b.weight), &sum);
    Gather(a.left + 1, b.left, a.weight * (1 - b.weight), &sum);
    Gather(a.left, b.left + 1, (1 - a.weight) * b.weight, &sum);
    Gather(a.left + 1, b.left + 1, a.weight * b.weight, &sum);
    return sum;
  }
};

}  // namespace

Conductance Membrane(const Grid& grid, double boundary_weight) {
  const int nx = grid.nx, ny = grid.ny;
  const double east = grid.hy() / grid.hx(), north = grid.hx() / grid.hy();
  return {
      .east = [=](int i, int) { return i < 0 || i + 1 == nx ? boundary_weight * east : east; },
      .north = [=](int, int j) { return j < 0 || j + 1 == ny ? boundary_weight * north : north; }};
}

Eigen::SparseMatrix<double> FivePointMatrix(const Grid& grid, const Conductance& k) {
  const int nx = grid.nx, ny = grid.ny;
  const Eigen::Index edges = Eigen::Index{nx - 1} * ny + Eigen::Index{nx} * (ny - 1);
  Eigen::SparseMatrix<double> m(grid.size(), grid.size());
  m.reserve(grid.size() + 2 * edges);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const Eigen::Index row = grid.row(i, j);
      const double west = k.east(i - 1, j), east = k.east(i, j);
      const double south = k.north(i, j - 1), north = k.north(i, j);
      // Rows of a column in rising order, as insertBack() wants them.
      m.startVec(row);
      if (j > 0) m.insertBack(row - nx, row) = -south;
      if (i > 0) m.insertBack(row - 1, row) = -west;
      m.insertBack(row, row) = west + east + south + north;
      if (i + 1 < nx) m.insertBack(row + 1, row) = -east;
      if (j + 1 < ny) m.insertBack(row + nx, row) = -north;
    }
  }
  m.finalize();
  return m;
}

Eigen::VectorXd BoundaryLoad(const Grid& grid, const Conductance& k, const Field& g) {
  const int nx = grid.nx, ny = grid.ny;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(grid.size());
  for (int j = 0; j < ny; ++j) {
    load[grid.row(0, j)] -= k.east(-1, j) * g(grid.x(-1), grid.y(j));
    load[grid.row(nx - 1, j)] -= k.east(nx - 1, j) * g(grid.x(nx), grid.y(j));
  }
  for (int i = 0; i < nx; ++i) {
    load[grid.row(i, 0)] -= k.north(i, -1) * g(grid.x(i), grid.y(-1));
    load[grid.row(i, ny - 1)] -= k.north(i, ny - 1) * g(grid.x(i), grid.y(ny));
  }
  return load;
}

Eigen::VectorXd Sample(const Grid& grid, const Field& field) {
  Eigen::VectorXd values(grid.size());
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) values[grid.row(i, j)] = field(grid.x(i), grid.y(j));
  }
  return values;
}

Field Constant(double value) {
  return [value](double, double) { return value; };
}

Eigen::VectorXd Prolong(const Grid& coarse, const Grid& fine, const Box& box,
                        const Eigen::VectorXd& x) {
  const CoarseLevel level{.grid = coarse,
                          .boundary = box.boundary,
                          .x = x,
                          .lo = Sample(coarse, box.lo),
                          .hi = Sample(coarse, box.hi)};
  const std::vector<Span> columns = Spans(coarse.nx, fine.nx), lines = Spans(coarse.ny, fine.ny);
  Eigen::VectorXd start(fine.size());
  for (int j = 0; j < fine.ny; ++j) {
    for (int i = 0; i < fine.nx; ++i) {
      const Gathered sum = level.At(columns[i], lines[j]);
      const double lo = box.lo(fine.x(i), fine.y(j)), hi = box.hi(fine.x(i), fine.y(j));
      const double inside = std::clamp(sum.value, lo, hi);
      start[fine.row(i, j)] = sum.at_lo ? lo : sum.at_hi ? hi : inside;
    }
  }
  return start;
}

Answer ObjectiveAnswer(const BoxedLcp& lcp, double expected, double tolerance, std::string source) {
  struct Quadratic {
    Eigen::SparseMatrix<double> m;
    Eigen::VectorXd q;
  };
  // Shared: an Answer is copied with its problem.
  const auto f = std::make_shared<const Quadratic>(Quadratic{lcp.M, lcp.q});
  return {.name = "objective",
          .source = std::move(source),
          .expected = expected,
          .tolerance = tolerance,
          .measure = [f](const Eigen::VectorXd& x) { return 0.5 * x.dot(f->m * x) + f->q.dot(x); }};
}

std::string ShortestText(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace cairn::problems
