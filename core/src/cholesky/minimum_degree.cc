// SPDX-License-Identifier: MIT
#include "cholesky/minimum_degree.h"

#include <Eigen/OrderingMethods>
#include <algorithm>

namespace cairn {

void MinimumDegreeOrder(const Eigen::SparseMatrix<double>& matrix, std::span<int> order) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> found;
  Eigen::AMDOrdering<int>()(matrix, found);
  std::copy(found.indices().begin(), found.indices().end(), order.begin());
}

}  // namespace cairn
