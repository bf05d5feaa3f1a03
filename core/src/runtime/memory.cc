// SPDX-License-Identifier: MIT
#include "cairn/detail/memory.h"

#include <algorithm>
#include <utility>

namespace cairn::detail {
namespace {

constexpr std::size_t kPlain = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

thread_local constinit Memory* memory_of_thread = nullptr;

/// Room in front of an object, for the address of its memory.
std::size_t RoomInFront(std::size_t alignment) { return std::max(alignment, sizeof(Memory*)); }

void* New(std::size_t bytes, std::size_t alignment) {
  const std::size_t room = RoomInFront(alignment);
  Memory* const memory = memory_of_thread;
  char* const object = static_cast<char*>(TakeMemory(memory, room + bytes, alignment)) + room;
  new (object - sizeof(Memory*)) Memory*(memory);
  return object;
}

void Delete(void* what, std::size_t bytes, std::size_t alignment) noexcept {
  if (what == nullptr) return;
  const std::size_t room = RoomInFront(alignment);
  char* const object = static_cast<char*>(what);
  Memory* const memory = *std::launder(reinterpret_cast<Memory**>(object - sizeof(Memory*)));
  GiveMemory(memory, object - room, room + bytes, alignment);
}

/// Where MemorySource::context is a Memory, or nullptr.
void* AllocateFrom(std::size_t bytes, std::size_t alignment, void* memory) {
  return TakeMemory(static_cast<Memory*>(memory), bytes, alignment);
}
void FreeTo(void* what, std::size_t bytes, std::size_t alignment, void* memory) {
  GiveMemory(static_cast<Memory*>(memory), what, bytes, alignment);
}

void* Take(const MemorySource& source, std::size_t bytes, std::size_t alignment) {
  void* const what = source.allocate(bytes, alignment, source.context);
  if (what == nullptr) throw std::bad_alloc();
  return what;
}

}  // namespace

void* TakeMemory(Memory* memory, std::size_t bytes, std::size_t alignment) {
  if (memory == nullptr) {
    if (alignment <= kPlain) return ::operator new(bytes);
    return ::operator new(bytes, std::align_val_t(alignment));
  }
  void* what = nullptr;
  try {
    what = memory->Allocate(bytes, alignment);
  } catch (...) {
    // whatever a game throws, it means the same
  }
  if (what == nullptr) throw std::bad_alloc();
  return what;
}

void GiveMemory(Memory* memory, void* what, std::size_t bytes, std::size_t alignment) noexcept {
  if (memory != nullptr) return memory->Free(what, bytes, alignment);
  // without the size, which clang does not pass on unless it is told to
  if (alignment <= kPlain) return ::operator delete(what);
  ::operator delete(what, std::align_val_t(alignment));
}

Memory* MemoryOfThread() noexcept { return memory_of_thread; }

MemoryScope::MemoryScope(Memory* memory) noexcept
    : before_(std::exchange(memory_of_thread, memory)) {}
MemoryScope::~MemoryScope() { memory_of_thread = before_; }

void* Placed::operator new(std::size_t bytes) { return New(bytes, kPlain); }
void* Placed::operator new(std::size_t bytes, std::align_val_t alignment) {
  return New(bytes, static_cast<std::size_t>(alignment));
}
void Placed::operator delete(void* what, std::size_t bytes) noexcept {
  Delete(what, bytes, kPlain);
}
void Placed::operator delete(void* what, std::size_t bytes, std::align_val_t alignment) noexcept {
  Delete(what, bytes, static_cast<std::size_t>(alignment));
}

Heap::Owner::Owner(Memory* memory) : Owner(MemorySource{AllocateFrom, FreeTo, memory}) {}
Heap::Owner::Owner(const MemorySource& source)
    : heap_(new (Take(source, sizeof(Heap), alignof(Heap))) Heap(source)) {}

void* Heap::Allocate(std::size_t bytes, std::size_t alignment) {
  void* const what = Take(source_, bytes, alignment);
  const std::size_t now = bytes_.fetch_add(bytes, std::memory_order_relaxed) + bytes;
  std::size_t most = most_bytes();
  while (most < now && !most_.compare_exchange_weak(most, now, std::memory_order_relaxed)) continue;
  return what;
}

void Heap::Free(void* what, std::size_t bytes, std::size_t alignment) noexcept {
  source_.free(what, bytes, alignment, source_.context);
  GiveBack(bytes);
}

void Heap::GiveBack(std::size_t bytes) noexcept {
  if (bytes_.fetch_sub(bytes, std::memory_order_acq_rel) != bytes) return;
  const MemorySource source = source_;
  this->~Heap();
  source.free(this, sizeof(Heap), alignof(Heap), source.context);
}

}  // namespace cairn::detail
