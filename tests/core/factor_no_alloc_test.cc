// SPDX-License-Identifier: MIT
// A pattern that is analysed is factorised and solved with without allocating. A program of its
// own: it replaces operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "crew.h"
#include "factor_graphs.h"
#include "subspace/front_cholesky.h"

namespace {

std::atomic<long> allocations{0};

void* Allocate(std::size_t size, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
  return Allocate(size, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return Allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace cairn {
namespace {

template <class T>
void ExpectNoneAfterAnalysis() {
  for (const test::FactorGraph& graph : {test::GridGraph(7, 7, 6), test::TreeGraph(50, 1)}) {
    Crew crew(2);
    FrontCholesky<T> factor(simd::BestTarget());
    long before = allocations.load();
    factor.Analyse(graph.nodes, 6, graph.pairs);
    EXPECT_GT(allocations.load(), before) << "counts nothing";
    std::vector<T> x(6 * graph.nodes, T(1));
    crew.Call();

    before = allocations.load();
    bool fits = true;
    for (int repetition = 0; repetition < 3; ++repetition) {
      factor.SetZero();
      for (int node = 0; node < graph.nodes; ++node) {
        for (int k = 0; k < 6; ++k) factor.diagonal(node)[7 * k] = T(2);
      }
      fits = factor.Factorise() && factor.Factorise(&crew) && fits;
      factor.Solve(x);
    }
    const long after = allocations.load();
    crew.Dismiss();
    EXPECT_TRUE(fits);
    EXPECT_EQ(after, before);
  }
}

TEST(FactorNoAlloc, OfAPatternThatIsAnalysed) {
  ExpectNoneAfterAnalysis<float>();
  ExpectNoneAfterAnalysis<double>();
}

}  // namespace
}  // namespace cairn
