// SPDX-License-Identifier: Apache-2.0
#include "jobs/base/large_buffer.h"

#include <new>

#include <sys/mman.h>

namespace jobs {

LargeBuffer::LargeBuffer(std::size_t size) : size_(size) {
  if (size == 0) return;
  void* const mapped = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  start_ = static_cast<char*>(mapped);
  static_cast<void>(::madvise(mapped, size, MADV_HUGEPAGE));  // a wish
}

LargeBuffer::~LargeBuffer() {
  if (start_ != nullptr) ::munmap(start_, size_);
}

}  // namespace jobs
