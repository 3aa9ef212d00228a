// SPDX-License-Identifier: Apache-2.0
// A file of its own: the compiler must not see through these into who calls them.
#include "test/host/core/failing_heap.hpp"

#include <cstdlib>
#include <new>

namespace {
thread_local long until_failure = -1;
}

void coupler::host::test::fail_allocation(long after) { until_failure = after; }

bool coupler::host::test::has_failed() {
  const bool failed = until_failure < 0;
  until_failure = -1;
  return failed;
}

void* operator new(std::size_t size) {
  if (until_failure >= 0 && until_failure-- == 0) throw std::bad_alloc();
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
/// The standard library deletes what it has from this one by the same delete: AddressSanitizer compares them.
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept { return std::malloc(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
