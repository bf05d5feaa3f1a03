// SPDX-License-Identifier: MIT
#pragma once
#include "cairn/detail/cpp20.h"

#include <atomic>
#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

#include "cairn/memory.h"

namespace cairn {
namespace detail {

/// Of @p memory, or of operator new where that is nullptr. Throws std::bad_alloc.
void* TakeMemory(Memory* memory, std::size_t bytes, std::size_t alignment);
void GiveMemory(Memory* memory, void* what, std::size_t bytes, std::size_t alignment) noexcept;

/// What arrays and objects that are made on this thread take their memory from, as long as they
/// live; nullptr: operator new. Nobody else is told: it is set within calls of the library alone.
Memory* MemoryOfThread() noexcept;

/// Sets that, while it lives.
class MemoryScope {
 public:
  explicit MemoryScope(Memory* memory) noexcept;
  ~MemoryScope();
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  Memory* before_;
};

/// As std::pmr::polymorphic_allocator: a container keeps the memory that it was made with. Moved
/// into one of other memory, its elements are moved one by one.
template <class T>
class Allocator {
 public:
  using value_type = T;
  using propagate_on_container_swap = std::true_type;

  Allocator() noexcept : memory_(MemoryOfThread()) {}
  Allocator(Memory* memory) noexcept : memory_(memory) {}
  template <class Other>
  Allocator(const Allocator<Other>& other) noexcept : memory_(other.memory()) {}
  Allocator select_on_container_copy_construction() const noexcept { return {}; }

  /// @pre as many as fit the address space, which containers see to
  T* allocate(std::size_t count) {
    return static_cast<T*>(TakeMemory(memory_, count * sizeof(T), alignof(T)));
  }
  void deallocate(T* what, std::size_t count) noexcept {
    GiveMemory(memory_, what, count * sizeof(T), alignof(T));
  }

  Memory* memory() const noexcept { return memory_; }
  template <class Other>
  bool operator==(const Allocator<Other>& other) const noexcept {
    return memory_ == other.memory();
  }

 private:
  Memory* memory_;
};

/// Base of what is made by new, and is to lie in MemoryOfThread(). The memory is remembered in
/// front of it.
class Placed {
 public:
  static void* operator new(std::size_t bytes);
  static void* operator new(std::size_t bytes, std::align_val_t alignment);
  static void operator delete(void* what, std::size_t bytes) noexcept;
  static void operator delete(void* what, std::size_t bytes, std::align_val_t alignment) noexcept;
};

/// The functions of a Memory, as C has them too; allocate may return nullptr.
struct MemorySource {
  void* (*allocate)(std::size_t bytes, std::size_t alignment, void* context);
  void (*free)(void* memory, std::size_t bytes, std::size_t alignment, void* context);
  void* context;
};

/// Counts what is taken of a memory, and lies in it itself: until its owner is gone and the last
/// byte has come back, which may be later.
class Heap final : public Memory {
 public:
  class Owner {
   public:
    /// @p memory: nullptr is operator new
    explicit Owner(Memory* memory);
    explicit Owner(const MemorySource& source);
    Owner(Owner&& other) noexcept : heap_(other.heap_) { other.heap_ = nullptr; }
    Owner& operator=(Owner&&) = delete;
    ~Owner() {
      if (heap_ != nullptr) heap_->GiveBack(sizeof(Heap));
    }
    Heap* get() const { return heap_; }

   private:
    Heap* heap_;
  };

  void* Allocate(std::size_t bytes, std::size_t alignment) override;
  void Free(void* what, std::size_t bytes, std::size_t alignment) noexcept override;

  /// Now, and most at any time, its own included.
  std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }
  std::size_t most_bytes() const { return most_.load(std::memory_order_relaxed); }

 private:
  explicit Heap(const MemorySource& source) : source_(source) {}
  ~Heap() override = default;
  void GiveBack(std::size_t bytes) noexcept;

  const MemorySource source_;
  std::atomic<std::size_t> bytes_{sizeof(Heap)}, most_{sizeof(Heap)};
};

}  // namespace detail

/// A vector in the memory of what it belongs to: of a Solver, or of operator new.
template <class T>
using Array = std::vector<T, detail::Allocator<T>>;

}  // namespace cairn
