#include "server/memory_reserve.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <thread>

namespace server {

namespace {

using Clock = std::chrono::steady_clock;

// So large that the allocator gives it back to the system, where every thread can have it. Nothing is written to it.
constexpr std::size_t kReserveBytes = 8 << 20;
constexpr int kMostTries = 20;
constexpr std::chrono::milliseconds kPause{2};  // in which other threads may free something
constexpr std::chrono::milliseconds kOneMoment{100};

std::atomic<void*> reserve = nullptr;
std::atomic<bool> kept = false;

/// Called by operator new each time it finds no memory; it tries again when this returns.
void find_memory() {
  if (void* const block = reserve.exchange(nullptr)) {
    std::free(block);
    return;
  }
  thread_local int tries = 0;
  thread_local Clock::time_point last;
  if (Clock::now() - last > kOneMoment) tries = 0;
  last = Clock::now();
  if (++tries > kMostTries) {
    tries = 0;
    throw std::bad_alloc();
  }
  std::this_thread::sleep_for(kPause);
}

}  // namespace

void keep_memory_reserve() {
  kept = true;
  static_cast<void>(refill_memory_reserve());
  std::set_new_handler(find_memory);
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
