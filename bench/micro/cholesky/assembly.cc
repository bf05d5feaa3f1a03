// SPDX-License-Identifier: MIT
#include "micro/cholesky/assembly.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "simd/target.h"

namespace cairn::micro {

double AssemblyFlops(const BodyMatrix& matrix) {
  constexpr double kTriangle = 21, kSquare = 36;  // entries of a block
  double flops = 0;
  for (const BodyRow& row : matrix.all_rows) {
    const int bodies = (row.a >= 0 ? 1 : 0) + (row.b >= 0 ? 1 : 0);
    flops += bodies * (2 * kTriangle + 6) + (bodies == 2 ? 2 * kSquare : 0);
  }
  return flops;
}

template <class T>
BlockAssembly<T>::BlockAssembly(const BodyMatrix& matrix) {
  std::vector<double> impulses = matrix.frame.impulses;
  if (frame_.Begin(matrix.frame.problem(), 1, {.rows = impulses}, &crew_) != PackResult::kDone) {
    std::abort();
  }
  const Plan& plan = frame_.plan();
  simd::LineOf<T> ones;
  for (T& lane : ones.lane) lane = 1;
  systems_.reserve(plan.groups().size());
  for (int g = 0; g < static_cast<int>(plan.groups().size()); ++g) {
    systems_.emplace_back(frame_.target());
    const bool known = systems_.back().Recognise(plan, frame_.plan_number(), g);
    if (!known) systems_.back().Analyse(plan);
    weights_.emplace_back(static_cast<size_t>(plan.groups()[g].x_lines), ones);
  }
}

template <class T>
bool BlockAssembly<T>::AssembleAndFactorise() {
  const Plan& plan = frame_.plan();
  bool done = true;
  for (size_t g = 0; g < systems_.size(); ++g) {
    done = systems_[g].Factorise(plan, plan.groups()[g], frame_.blocks(), weights_[g], &scratch_,
                                 &crew_) &&
           done;
  }
  return done;
}

template class BlockAssembly<float>;
template class BlockAssembly<double>;

EigenAssembly::EigenAssembly(const BodyMatrix& matrix, std::span<const int> position)
    : matrix_(matrix), position_(position.begin(), position.end()) {
  sparse_.resize(6 * matrix.bodies, 6 * matrix.bodies);
  FromTriplets();
  std::map<std::pair<int, int>, int> known;
  const auto place = [&](int row, int column) {
    const auto [at, is_new] = known.try_emplace({row, column}, static_cast<int>(places_.size()));
    if (is_new) places_.push_back(PlacesOf(row, column));
    return at->second;
  };
  for (const BodyRow& row : matrix.all_rows) {
    RowPlaces& places = row_places_.emplace_back();
    const int a = row.a < 0 ? -1 : position_[row.a], b = row.b < 0 ? -1 : position_[row.b];
    if (a >= 0) places.a = place(a, a);
    if (b >= 0) places.b = place(b, b);
    if (a < 0 || b < 0) continue;
    places.swapped = b < a;
    places.pair = place(std::min(a, b), std::max(a, b));
  }
}

EigenAssembly::Places EigenAssembly::PlacesOf(int row, int column) {
  Places places;
  for (int c = 0; c < 6; ++c) {
    places.column[c] = &sparse_.coeffRef(6 * row, 6 * column + c) - sparse_.valuePtr();
  }
  return places;
}

void EigenAssembly::FromTriplets() {
  triplets_.clear();
  for (int i = 0; i < 6 * matrix_.bodies; ++i) triplets_.emplace_back(i, i, 1.0);
  const auto add = [&](int i, const Vector6& g_i, int j, const Vector6& g_j) {
    for (int c = 0; c < 6; ++c) {
      const int last = i == j ? c : 5;
      for (int r = 0; r <= last; ++r) triplets_.emplace_back(6 * i + r, 6 * j + c, g_i[r] * g_j[c]);
    }
  };
  for (const BodyRow& row : matrix_.all_rows) {
    const int a = row.a < 0 ? -1 : position_[row.a], b = row.b < 0 ? -1 : position_[row.b];
    if (a >= 0) add(a, row.g_a, a, row.g_a);
    if (b >= 0) add(b, row.g_b, b, row.g_b);
    if (a < 0 || b < 0) continue;
    if (a < b) {
      add(a, row.g_a, b, row.g_b);
    } else {
      add(b, row.g_b, a, row.g_a);
    }
  }
  sparse_.setFromTriplets(triplets_.begin(), triplets_.end());
}

void EigenAssembly::IntoPattern() {
  double* const values = sparse_.valuePtr();
  std::fill(values, values + sparse_.nonZeros(), 0.0);
  for (int i = 0; i < 6 * matrix_.bodies; ++i) {
    values[sparse_.outerIndexPtr()[i + 1] - 1] = 1;  // rows ascend: the diagonal is the last
  }
  const auto add_triangle = [&](int place, const Vector6& g) {
    if (place < 0) return;
    for (int c = 0; c < 6; ++c) {
      Eigen::Map<Eigen::VectorXd>(values + places_[place].column[c], c + 1) += g[c] * g.head(c + 1);
    }
  };
  const auto add_square = [&](int place, const Vector6& rows, const Vector6& columns) {
    for (int c = 0; c < 6; ++c) {
      Eigen::Map<Vector6>(values + places_[place].column[c]) += columns[c] * rows;
    }
  };
  for (size_t i = 0; i < row_places_.size(); ++i) {
    const RowPlaces& at = row_places_[i];
    const BodyRow& row = matrix_.all_rows[i];
    add_triangle(at.a, row.g_a);
    add_triangle(at.b, row.g_b);
    if (at.pair < 0) continue;
    if (at.swapped) {
      add_square(at.pair, row.g_b, row.g_a);
    } else {
      add_square(at.pair, row.g_a, row.g_b);
    }
  }
}

}  // namespace cairn::micro
