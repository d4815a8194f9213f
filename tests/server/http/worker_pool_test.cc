// SPDX-License-Identifier: Apache-2.0
#include "server/http/worker_pool.h"

#include <sys/resource.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

using server::WorkerPool;

TEST(WorkerPool, RunsTasksInTheirOrder) {
  std::vector<int> done;
  {
    WorkerPool pool(1);
    for (int i = 0; i < 100; ++i) pool.add([&done, i] { done.push_back(i); });
  }
  ASSERT_EQ(done.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(WorkerPool, RunsAsManyAtATimeAsItHasThreads) {
  std::atomic<int> running = 0;
  WorkerPool pool(2);
  for (int i = 0; i < 2; ++i) {
    pool.add([&running] {
      ++running;
      running.notify_all();
      running.wait(1);  // for the other one
    });
  }
  pool.finish();
  EXPECT_EQ(running, 2);
}

/// In a process of its own, since it gives its address space up.
void start_without_memory() {
  const rlimit none{.rlim_cur = 1, .rlim_max = 1};
  ::setrlimit(RLIMIT_AS, &none);
  try {
    const WorkerPool pool(32);
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::_Exit(3);
  }
  std::_Exit(0);
}

TEST(WorkerPoolDeathTest, SaysWhyItHasNoThreads) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space of their own";
#endif
  EXPECT_EXIT(start_without_memory(), testing::ExitedWithCode(3), "no more than 0 of the 32 threads");
}

}  // namespace
