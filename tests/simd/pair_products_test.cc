// SPDX-License-Identifier: MIT
// Products with G against sums written out from the rows of a block.
#include "simd/pairs/pair_products.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pair_blocks.h"

namespace cairn::simd {
namespace {

using test::PairScene;
using test::Random;

constexpr PairForm kForms[] = {PairForm::kJoint, PairForm::kContact, PairForm::kSingle};

/// A block of rows of all kinds, with vectors to multiply.
template <class T>
struct Case {
  PairScene scene;
  std::vector<LineOf<T>> rows, weights;
  LineOf<T> v[kPairLines];

  Case(PairForm form, unsigned seed, float unused = 0) {
    Random random(seed);
    test::SceneSpec spec{.blocks = {}, .unused = unused, .seed = seed};
    spec.blocks.push_back({form, test::RandomRows(12, &random), 1 + random.Index(kLanes)});
    scene = test::RandomScene(spec);
    scene.blocks[0].rows = scene.shapes[0].data();
    const size_t count = block().row_count;
    rows.resize(count);
    weights.resize(count);
    const auto fill = [&random](LineOf<T>* line) {
      for (T& number : line->lane) number = static_cast<T>(random.Uniform(-1, 1));
    };
    for (auto& line : rows) fill(&line);
    for (auto& line : weights) fill(&line);
    for (auto& line : v) fill(&line);
  }

  const PairBlock& block() const { return scene.blocks[0]; }
  const Line* lines() const { return scene.data.data() + block().data; }
  int sides() const { return block().form == PairForm::kSingle ? 6 : 12; }

  /// G of one row of one lane, in full.
  std::array<double, 12> G(int row, int lane) {
    std::array<double, 12> g{};
    const Line* const from = scene.View(0, row).g;
    const auto at = [&](int k) { return static_cast<double>(from[k].lane[lane]); };
    if (block().form != PairForm::kContact) {
      for (int k = 0; k < sides(); ++k) g[k] = at(k);
      return g;
    }
    const Line* const pair = scene.PairOf(0);
    for (int k = 0; k < 3; ++k) {
      g[k] = static_cast<double>(pair[0].lane[lane]) * at(k);
      g[3 + k] = at(3 + k);
      g[6 + k] = -static_cast<double>(pair[1].lane[lane]) * at(k);
      g[9 + k] = at(6 + k);
    }
    return g;
  }
};

template <class T>
constexpr double kTolerance = 100 * static_cast<double>(std::numeric_limits<T>::epsilon());

template <class T>
void ExpectProducts(Target target, PairForm form, unsigned seed) {
  Case<T> c(form, seed);
  const PairProducts<T>& products = PairProductsFor<T>(target);
  std::vector<LineOf<T>> rows(c.rows.size());
  LineOf<T> v[kPairLines];
  products.multiply(c.block(), c.lines(), c.v, rows.data());
  products.multiply_transposed(c.block(), c.lines(), c.rows.data(), v);
  for (int lane = 0; lane < c.block().lanes; ++lane) {
    std::array<double, 12> sums{};
    for (int i = 0; i < c.block().row_count; ++i) {
      const auto g = c.G(i, lane);
      double product = 0;
      for (int k = 0; k < c.sides(); ++k) {
        product += g[k] * static_cast<double>(c.v[k].lane[lane]);
        sums[k] += g[k] * static_cast<double>(c.rows[i].lane[lane]);
      }
      EXPECT_NEAR(rows[i].lane[lane], product, 12 * kTolerance<T>);
    }
    for (int k = 0; k < c.sides(); ++k) EXPECT_NEAR(v[k].lane[lane], sums[k], 12 * kTolerance<T>);
  }
}

template <class T>
void ExpectGram(Target target, PairForm form, unsigned seed) {
  Case<T> c(form, seed);
  LineOf<T> gram[kGramLines];
  PairProductsFor<T>(target).weighted_gram(c.block(), c.lines(), c.weights.data(), gram);
  for (int lane = 0; lane < c.block().lanes; ++lane) {
    double full[12][12] = {};
    for (int i = 0; i < c.block().row_count; ++i) {
      const auto g = c.G(i, lane);
      const double weight = static_cast<double>(c.weights[i].lane[lane]);
      for (int r = 0; r < 12; ++r) {
        for (int k = 0; k < 12; ++k) full[r][k] += weight * g[r] * g[k];
      }
    }
    const LineOf<T>* line = gram;
    const auto expect = [&](double value) {
      EXPECT_NEAR((line++)->lane[lane], value, 12 * kTolerance<T>);
    };
    for (int k = 0; k < 6; ++k) {
      for (int r = k; r < 6; ++r) expect(full[r][k]);
    }
    if (form == PairForm::kSingle) continue;
    for (int k = 0; k < 6; ++k) {
      for (int r = 0; r < 6; ++r) expect(full[r][6 + k]);
    }
    for (int k = 0; k < 6; ++k) {
      for (int r = k; r < 6; ++r) expect(full[6 + r][6 + k]);
    }
  }
}

class PairProductsOf : public testing::TestWithParam<Target> {};

INSTANTIATE_TEST_SUITE_P(Every, PairProductsOf, testing::ValuesIn(SupportedTargets()),
                         [](const auto& target) { return std::string(TargetName(target.param)); });

TEST_P(PairProductsOf, AreThoseOfTheRows) {
  for (const PairForm form : kForms) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      SCOPED_TRACE(seed);
      ExpectProducts<float>(GetParam(), form, seed);
      ExpectProducts<double>(GetParam(), form, seed);
      ExpectGram<float>(GetParam(), form, seed);
      ExpectGram<double>(GetParam(), form, seed);
    }
  }
}

/// All results in lanes that are used, one after the other.
template <class T>
std::vector<T> Everything(Target target, PairForm form, unsigned seed, float unused) {
  Case<T> c(form, seed, unused);
  const PairProducts<T>& products = PairProductsFor<T>(target);
  std::vector<LineOf<T>> lines(c.rows.size() + kPairLines + kGramLines);
  LineOf<T>* const v = lines.data() + c.rows.size();
  products.multiply(c.block(), c.lines(), c.v, lines.data());
  products.multiply_transposed(c.block(), c.lines(), c.rows.data(), v);
  products.weighted_gram(c.block(), c.lines(), c.weights.data(), v + kPairLines);
  std::vector<T> numbers;
  for (const auto& line : lines) {
    numbers.insert(numbers.end(), line.lane, line.lane + c.block().lanes);
  }
  return numbers;
}

template <class T>
bool SameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST_P(PairProductsOf, HaveTheBitsOfTheScalarTargetWhateverIsInUnusedLanes) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (const PairForm form : kForms) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
      EXPECT_TRUE(SameBits(Everything<float>(GetParam(), form, seed, kNaN),
                           Everything<float>(Target::kScalar, form, seed, 0)));
      EXPECT_TRUE(SameBits(Everything<double>(GetParam(), form, seed, kNaN),
                           Everything<double>(Target::kScalar, form, seed, 0)));
    }
  }
}

}  // namespace
}  // namespace cairn::simd
