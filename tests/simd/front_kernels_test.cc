// SPDX-License-Identifier: MIT
// Dense fronts on every target: against textbook loops, and bit by bit.
#include "simd/fronts/front_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pair_blocks.h"

namespace cairn::simd {
namespace {

using test::Random;

constexpr int kPivots[] = {1, 2, 5, 6, 7, 12, 13, 18, 24, 30, 48, 54, 97, 150};
constexpr int kSizes[] = {0, 1, 6, 7, 12, 24, 42, 101, 210};

/// Memory of a front, with NaN where nobody may look.
template <class T>
struct Memory {
  Front<T> front;
  std::vector<T> panel, update, floors;

  Memory(int pivots, int size)
      : front{nullptr, nullptr, pivots, size},
        panel(static_cast<size_t>(front.panel_stride()) * pivots + kFrontMargin),
        update(static_cast<size_t>(front.update_stride()) * size + kFrontMargin, kNaN),
        floors(pivots, T(0)) {
    for (int j = 0; j < pivots; ++j) {
      for (int i = 0; i < j; ++i) Panel(i, j) = kNaN;
    }
  }
  Memory(const Memory&) = delete;

  Front<T> at() { return {panel.data(), update.data(), front.pivots, front.size}; }
  /// Of a row of the front, counted without padding.
  int RowInPanel(int row) const {
    return row < front.pivots ? row : row - front.pivots + front.below();
  }
  T& Panel(int row, int column) {
    return panel[static_cast<size_t>(column) * front.panel_stride() + RowInPanel(row)];
  }
  T& Update(int row, int column) {
    return update[static_cast<size_t>(column) * front.update_stride() + row];
  }

  static constexpr T kNaN = std::numeric_limits<T>::quiet_NaN();
};

/// A random diagonally dominant front.
template <class T>
void Fill(Memory<T>* memory, unsigned seed) {
  Random random(seed);
  const int pivots = memory->front.pivots, size = memory->front.size;
  for (int j = 0; j < pivots; ++j) {
    for (int i = j; i < pivots + size; ++i) {
      memory->Panel(i, j) = static_cast<T>(i == j ? pivots + size : random.Uniform(-1, 1));
    }
  }
}

/// Numbers in the update, as if the pivots were eliminated.
template <class T>
void FillUpdate(Memory<T>* memory, unsigned seed) {
  Random random(seed);
  for (int j = 0; j < memory->front.size; ++j) {
    for (int i = j; i < memory->front.size; ++i) {
      memory->Update(i, j) = static_cast<T>(random.Uniform(-1, 1));
    }
  }
}

/// What the kernels do, number by number: c - a_ik a_jk, k ascending, but where i, j and k are in
/// the same six rows c_ik (c_jk / c_kk) instead, with c as k finds it.
template <class T>
bool FactorByTheBook(Memory<T>* memory) {
  constexpr int kSquare = 6;
  const int pivots = memory->front.pivots, rows = pivots + memory->front.size;
  std::vector<T> inverses(pivots);
  std::vector<std::vector<T>> unscaled(rows, std::vector<T>(pivots));
  for (int j = 0; j < rows; ++j) {
    for (int i = j; i < rows; ++i) {
      T c = j < pivots ? memory->Panel(i, j) : T(0);
      const bool in_square = i < pivots && i / kSquare == j / kSquare;
      for (int k = 0; k < std::min(j, pivots); ++k) {
        T product = memory->Panel(i, k) * memory->Panel(j, k);
        if (in_square && k / kSquare == j / kSquare) {
          const T scaled = unscaled[j][k] * inverses[k];
          product = unscaled[i][k] * scaled;
        }
        c = c - product;
      }
      if (j >= pivots) {
        memory->Update(i - pivots, j - pivots) = c;
        continue;
      }
      unscaled[i][j] = c;
      if (i == j) {
        if (!(c > memory->floors[j])) return false;
        inverses[j] = T(1) / c;
        memory->Panel(j, j) = std::sqrt(inverses[j]);
      } else {
        memory->Panel(i, j) = c * memory->Panel(j, j);
      }
    }
  }
  return true;
}

template <class T>
bool SameBits(T a, T b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

template <class T>
testing::AssertionResult SameFactor(Memory<T>* a, Memory<T>* b) {
  const int pivots = a->front.pivots, rows = pivots + a->front.size;
  for (int j = 0; j < rows; ++j) {
    for (int i = j; i < rows; ++i) {
      const T x = j < pivots ? a->Panel(i, j) : a->Update(i - pivots, j - pivots);
      const T y = j < pivots ? b->Panel(i, j) : b->Update(i - pivots, j - pivots);
      if (!SameBits(x, y)) {
        return testing::AssertionFailure()
               << "row " << i << ", column " << j << ": " << x << " and " << y;
      }
    }
  }
  return testing::AssertionSuccess();
}

/// For every shape of a front.
template <class Function>
void ForFronts(const Function& function) {
  for (int pivots : kPivots) {
    for (int size : kSizes) {
      SCOPED_TRACE(testing::Message() << pivots << " pivots, " << size << " below");
      function(pivots, size);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
}

class FrontKernelsOf : public testing::TestWithParam<Target> {
 protected:
  template <class T>
  const FrontKernels<T>& kernels() const {
    return FrontKernelsFor<T>(GetParam());
  }

  template <class T>
  void ExpectFactorsByTheBook() {
    ForFronts([&](int pivots, int size) {
      Memory<T> expected(pivots, size), actual(pivots, size);
      Fill(&expected, 1);
      Fill(&actual, 1);
      ASSERT_TRUE(FactorByTheBook(&expected));
      ASSERT_TRUE(kernels<T>().factor(actual.at(), actual.floors.data()));
      ASSERT_TRUE(SameFactor(&actual, &expected));
    });
  }

  template <class T>
  void ExpectPartsMakeTheWhole() {
    constexpr int kPart = kFrontStep;
    ForFronts([&](int pivots, int size) {
      Memory<T> whole(pivots, size), parts(pivots, size);
      Fill(&whole, 2);
      Fill(&parts, 2);
      ASSERT_TRUE(kernels<T>().factor(whole.at(), whole.floors.data()));
      const int rows = whole.front.panel_stride();
      for (int begin = 0; begin < pivots; begin += kPart) {
        const int end = std::min(begin + kPart, pivots);
        ASSERT_TRUE(kernels<T>().factor_square(parts.at(), begin, end, parts.floors.data()));
        // the last rows first: they do not need each other
        for (int first = rows / kPart * kPart; first > -kPart; first -= kPart) {
          const int from = std::max(first, PaddedRows<T>(end));
          const int to = std::min(first + kPart, rows);
          if (from < to) kernels<T>().factor_rows(parts.at(), begin, end, from, to);
        }
      }
      for (int first = size / kPart * kPart; first >= 0; first -= kPart) {
        const int last = std::min(first + kPart, size);
        if (first < last) kernels<T>().update_rows(parts.at(), first, last);
      }
      ASSERT_TRUE(SameFactor(&parts, &whole));
    });
  }

  template <class T>
  void ExpectSolves() {
    ForFronts([&](int pivots, int size) {
      Memory<T> memory(pivots, size);
      Fill(&memory, 3);
      ASSERT_TRUE(kernels<T>().factor(memory.at(), memory.floors.data()));

      // x := L y, and the solve finds y; below the pivots it leaves what else was there
      Random random(4);
      const int rows = pivots + size;
      std::vector<double> y(rows), x(rows);
      for (double& value : y) value = random.Uniform(-1, 1);
      for (int i = 0; i < rows; ++i) {
        x[i] = i < pivots ? y[i] / memory.Panel(i, i) : y[i];
        for (int k = 0; k < std::min(i, pivots); ++k) x[i] += memory.Panel(i, k) * y[k];
      }
      std::vector<T> local(memory.front.panel_stride() + kFrontMargin, T(0));
      const auto at = [&](int row) -> T& { return local[memory.RowInPanel(row)]; };
      for (int i = 0; i < rows; ++i) at(i) = static_cast<T>(x[i]);
      kernels<T>().forward(memory.at(), local.data());
      // entries of L are below 1 / sqrt(rows), so errors of one rounding a column barely grow
      const double tolerance = 4 * rows * std::numeric_limits<T>::epsilon();
      for (int i = 0; i < rows; ++i) ASSERT_NEAR(at(i), y[i], tolerance) << i;

      // x := L' y for the pivots
      for (int k = 0; k < pivots; ++k) {
        double sum = y[k] / memory.Panel(k, k);
        for (int i = k + 1; i < rows; ++i) sum += memory.Panel(i, k) * y[i];
        at(k) = static_cast<T>(sum);
      }
      for (int i = pivots; i < rows; ++i) at(i) = static_cast<T>(y[i]);
      kernels<T>().backward(memory.at(), local.data());
      for (int i = 0; i < rows; ++i) ASSERT_NEAR(at(i), y[i], tolerance) << i;
    });
  }

  /// The scalar target is tested like the others, by the book.
  template <class T>
  void ExpectSolvesWithTheBitsOfScalarCode() {
    ForFronts([&](int pivots, int size) {
      Memory<T> memory(pivots, size);
      Fill(&memory, 5);
      ASSERT_TRUE(kernels<T>().factor(memory.at(), memory.floors.data()));
      std::vector<T> expected(memory.front.panel_stride() + kFrontMargin, T(0));
      Random random(6);
      for (int i = 0; i < pivots + size; ++i) {
        expected[memory.RowInPanel(i)] = static_cast<T>(random.Uniform(-1, 1));
      }
      std::vector<T> actual = expected;
      const FrontKernels<T>& scalar = FrontKernelsFor<T>(Target::kScalar);
      for (const auto solve : {&FrontKernels<T>::forward, &FrontKernels<T>::backward}) {
        (scalar.*solve)(memory.at(), expected.data());
        (kernels<T>().*solve)(memory.at(), actual.data());
        for (int i = 0; i < memory.front.panel_stride(); ++i) {
          ASSERT_TRUE(SameBits(actual[i], expected[i])) << i;
        }
      }
    });
  }

  template <class T>
  void ExpectRefusal(int bad, T entry) {
    for (int pivots : {1, 6, 7, 48, 60}) {
      if (bad >= pivots) continue;
      Memory<T> memory(pivots, 12);
      Fill(&memory, 7);
      memory.Panel(bad, bad) = entry;
      EXPECT_FALSE(kernels<T>().factor(memory.at(), memory.floors.data()))
          << pivots << " pivots, bad " << bad;
    }
  }

  template <class T>
  void ExpectAddsUpdates() {
    // rows of the child: two pivots of the parent, a gap, three more, then rows below in two runs
    const std::vector<RowRun> runs = {
        {0, 1, 2, true}, {2, 5, 3, true}, {5, 0, 4, false}, {9, 7, 2, false}};
    Memory<T> child(3, 11), parent(9, 10);
    Fill(&child, 8);
    FillUpdate(&child, 8);
    Fill(&parent, 9);
    FillUpdate(&parent, 9);
    Memory<T> expected(9, 10);
    Fill(&expected, 9);
    FillUpdate(&expected, 9);
    std::vector<int> rows;
    for (const RowRun& run : runs) {
      for (int k = 0; k < run.count; ++k) rows.push_back(run.to + k + (run.pivots ? 0 : 9));
    }
    ASSERT_EQ(rows.size(), 11u);
    for (int j = 0; j < 11; ++j) {
      for (int i = j; i < 11; ++i) {
        T& to = rows[j] < 9 ? expected.Panel(rows[i], rows[j])
                            : expected.Update(rows[i] - 9, rows[j] - 9);
        to += child.Update(i, j);
      }
    }
    kernels<T>().add_to_update(child.at(), runs, parent.at());
    kernels<T>().add_to_panel(child.at(), runs, parent.at());
    EXPECT_TRUE(SameFactor(&parent, &expected));
  }
};

std::string NameOf(const testing::TestParamInfo<Target>& target) {
  return std::string(TargetName(target.param));
}

INSTANTIATE_TEST_SUITE_P(Every, FrontKernelsOf, testing::ValuesIn(SupportedTargets()), NameOf);

TEST_P(FrontKernelsOf, FactorToTheBitAsTheBookDoes) {
  ExpectFactorsByTheBook<float>();
  ExpectFactorsByTheBook<double>();
}

TEST_P(FrontKernelsOf, MakeTheSameOfAFrontInParts) {
  ExpectPartsMakeTheWhole<float>();
  ExpectPartsMakeTheWhole<double>();
}

TEST_P(FrontKernelsOf, SolveForwardAndBackward) {
  ExpectSolves<float>();
  ExpectSolves<double>();
}

TEST_P(FrontKernelsOf, SolveToTheBitAsScalarCodeDoes) {
  ExpectSolvesWithTheBitsOfScalarCode<float>();
  ExpectSolvesWithTheBitsOfScalarCode<double>();
}

TEST_P(FrontKernelsOf, RefusePivotsThatAreNotPositiveOrNotFinite) {
  for (int bad : {0, 3, 5, 6, 47, 50}) {
    for (double entry : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()}) {
      ExpectRefusal(bad, static_cast<float>(entry));
      ExpectRefusal(bad, entry);
    }
  }
}

TEST_P(FrontKernelsOf, RefusePivotsThatAreNotAboveTheirFloor) {
  Memory<double> memory(2, 0);
  const auto factor = [&](double floor) {
    memory.Panel(0, 0) = 4;
    memory.Panel(1, 0) = 2;
    memory.Panel(1, 1) = 3;  // less 2^2 / 4 that is 2
    memory.floors = {0, floor};
    return kernels<double>().factor(memory.at(), memory.floors.data());
  };
  EXPECT_TRUE(factor(1.99));
  EXPECT_FALSE(factor(2));
}

TEST_P(FrontKernelsOf, AddWhatIsLeftOfAFrontToAnother) {
  ExpectAddsUpdates<float>();
  ExpectAddsUpdates<double>();
}

}  // namespace
}  // namespace cairn::simd
