// SPDX-License-Identifier: Apache-2.0
#include "own_new.hpp"

#include <cstdlib>
#include <new>

namespace gridmerge::test {

void fail_to_allocate() {
  if (const std::new_handler handler = std::get_new_handler()) handler();
  throw std::bad_alloc();
}

}  // namespace gridmerge::test

#if GRIDMERGE_OWN_NEW

// All of them, or a sanitizer's own serve beside them.

void* operator new(std::size_t size) {
  if (void* const memory = gridmerge::test::allocate(size)) return memory;
  gridmerge::test::fail_to_allocate();
}

void* operator new[](std::size_t size) {
  return operator new(size);
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return gridmerge::test::allocate(size);
}

void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return gridmerge::test::allocate(size);
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
