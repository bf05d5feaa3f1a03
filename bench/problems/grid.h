// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "problems/problem.h"

namespace cairn::problems {

/// The interior points of a rectangle with known values on its boundary. Point (i, j), 0 <= i < nx
/// and 0 <= j < ny, is row i + nx j; indices -1, nx and ny are on the boundary. A line is a grid
/// with ny = 1 whose points no conductance joins to the north or the south.
struct Grid {
  int nx = 0, ny = 0;     ///< >= 1 each.
  double x0 = 0, y0 = 0;  ///< Lower left corner of the rectangle.
  double lx = 1, ly = 1;  ///< Its sides, > 0.

  double hx() const { return lx / (nx + 1); }
  double hy() const { return ly / (ny + 1); }
  /// Exact at both ends, so that a boundary is where it is meant to be.
  double x(int i) const { return x0 + lx * (i + 1) / (nx + 1); }
  double y(int j) const { return y0 + ly * (j + 1) / (ny + 1); }
  Eigen::Index row(int i, int j) const { return i + Eigen::Index{nx} * j; }
  Eigen::Index size() const { return Eigen::Index{nx} * ny; }
};

/// A function of the place, such as an obstacle.
using Field = std::function<double(double x, double y)>;

/// The sum of 1/2 k (u_a - u_b)^2 over all edges is the energy 1/2 u' M u of a grid.
struct Conductance {
  /// k of the edge from (i, j) to (i + 1, j), -1 <= i < nx; and to (i, j + 1), -1 <= j < ny. >= 0.
  std::function<double(int i, int j)> east, north;
};

/// A membrane under unit tension: hy / hx and hx / hy, times @p boundary_weight for the edges that
/// end on the boundary. 1 is the 5-point formula; 1/2 is what CUTEst's torsion and obstacle
/// problems have, whose energy sums over interior points only.
Conductance Membrane(const Grid& grid, double boundary_weight);

/// The 5-point matrix M, its columns filled in place: no list of entries is kept beside it.
Eigen::SparseMatrix<double> FivePointMatrix(const Grid& grid, const Conductance& k);

/// What a boundary value g adds to q: -k g for each edge that ends on the boundary.
Eigen::VectorXd BoundaryLoad(const Grid& grid, const Conductance& k, const Field& g);

/// The values of a field at the points of a grid.
Eigen::VectorXd Sample(const Grid& grid, const Field& field);

/// The bounds of a problem as fields, and its values on the boundary.
struct Box {
  Field lo, hi, boundary;
};
Field Constant(double value);

/// Bilinear interpolation of x from a coarser grid of the same rectangle; neither grid need contain
/// the other. A point lies exactly on a bound where all of its coarse neighbours that count (those
/// of positive weight inside the rectangle) lie exactly on that bound: the active set carries over.
/// All others are brought inside the box.
/// @pre x has coarse.size() values, each inside the box.
Eigen::VectorXd Prolong(const Grid& coarse, const Grid& fine, const Box& box,
                        const Eigen::VectorXd& x);

/// An answer: the objective 1/2 x' M x + q' x. Keeps a copy of M and q.
Answer ObjectiveAnswer(const BoxedLcp& lcp, double expected, double tolerance, std::string source);

/// The shortest digits that read back as the same number, for names: 0.1 is "0.1".
std::string ShortestText(double value);

}  // namespace cairn::problems
