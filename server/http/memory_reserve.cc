// SPDX-License-Identifier: Apache-2.0
#include "server/http/memory_reserve.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <thread>

namespace server {

namespace {

// So large that the allocator gives it back to the system, where every thread can have it. Nothing is written
// to it.
constexpr std::size_t kReserveBytes = 8 << 20;
constexpr std::size_t kLargestSmallBytes = 1 << 20;
constexpr int kMostTries = 20;
constexpr std::chrono::milliseconds kPause{2};  // in which other threads may free something

std::atomic<void*> reserve = nullptr;
std::atomic<bool> kept = false;

/// @returns whether an allocation that has failed should be tried again
/// @param tries  so far
bool may_find_memory(std::size_t size, int tries) {
  if (!kept || size > kLargestSmallBytes || tries > kMostTries) return false;
  void* const block = reserve.exchange(nullptr);
  if (block == nullptr) std::this_thread::sleep_for(kPause);
  std::free(block);
  return true;
}

}  // namespace

void keep_memory_reserve() {
  kept = true;
  static_cast<void>(refill_memory_reserve());
}

bool refill_memory_reserve() {
  if (!kept || reserve != nullptr) return true;
  void* const block = std::malloc(kReserveBytes);
  if (block == nullptr) return false;
  void* nothing = nullptr;
  if (!reserve.compare_exchange_strong(nothing, block)) std::free(block);
  return true;
}

}  // namespace server

// A new-handler would not do: it is told neither the size nor how often this allocation has been tried.
void* operator new(std::size_t size) {
  for (int tries = 1;; ++tries) {
    if (void* const block = std::malloc(std::max<std::size_t>(size, 1))) return block;
    if (!server::may_find_memory(size, tries)) throw std::bad_alloc();
  }
}

// Whoever asks in this way has another one.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(std::max<std::size_t>(size, 1));
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { std::free(block); }
