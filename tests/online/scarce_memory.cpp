// SPDX-License-Identifier: Apache-2.0
// The program's own operator new, which can be told to fail. Alignments beyond the usual one are the
// library's.
#include "scarce_memory.hpp"

#include <cstdlib>
#include <new>

namespace gridmerge::test {

std::atomic<std::size_t> scarce_from{0};

}  // namespace gridmerge::test

#if GRIDMERGE_OWN_NEW

namespace {

void* allocate(std::size_t size) noexcept {
  const std::size_t least = gridmerge::test::scarce_from;
  return least > 0 && size >= least ? nullptr : std::malloc(size > 0 ? size : 1);
}

}  // namespace

// All of them, or a sanitizer's own serve beside them.

void* operator new(std::size_t size) {
  void* memory = allocate(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* operator new[](std::size_t size) {
  return operator new(size);
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size);
}

void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return allocate(size);
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete[](void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}

void operator delete(void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}

void operator delete[](void* memory, const std::nothrow_t&) noexcept {
  std::free(memory);
}

#endif
