// SPDX-License-Identifier: Apache-2.0
#include "server/http/worker_pool.h"

#include <sys/resource.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

using server::FairQueue;
using server::PendingConnection;
using server::WorkerPool;

PendingConnection connection_of(const std::string& peer, int number) {
  return {.socket = number, .received = {}, .peer = peer};
}

TEST(WorkerPool, ServesTheConnectionsOfAPeerInTheirOrder) {
  std::vector<int> served;
  {
    WorkerPool pool(1, 1000, [&served](const PendingConnection& connection) { served.push_back(connection.socket); });
    for (int i = 0; i < 100; ++i) {
      PendingConnection connection = connection_of("a", i);
      EXPECT_FALSE(pool.add(connection).has_value());
    }
  }
  ASSERT_EQ(served.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(served[static_cast<std::size_t>(i)], i);
}

TEST(WorkerPool, ServesAsManyAtATimeAsItHasThreads) {
  std::atomic<int> running = 0;
  WorkerPool pool(2, 10, [&running](const PendingConnection&) {
    ++running;
    running.notify_all();
    running.wait(1);  // for the other one
  });
  for (int i = 0; i < 2; ++i) {
    PendingConnection connection = connection_of("a", i);
    EXPECT_FALSE(pool.add(connection).has_value());
  }
  pool.finish();
  EXPECT_EQ(running, 2);
}

/// Sockets that a queue gives, in their order.
std::vector<int> taken_from(FairQueue& queue) {
  std::vector<int> sockets;
  while (const auto connection = queue.take()) sockets.push_back(connection->socket);
  return sockets;
}

TEST(FairQueue, GivesEachPeerItsTurn) {
  FairQueue queue(100);
  for (int i = 0; i < 5; ++i) {
    PendingConnection connection = connection_of("many", i);
    EXPECT_FALSE(queue.add(connection).has_value());
  }
  for (const auto& [peer, number] : {std::pair{"one", 10}, {"two", 20}, {"two", 21}}) {
    PendingConnection connection = connection_of(peer, number);
    EXPECT_FALSE(queue.add(connection).has_value());
  }
  EXPECT_EQ(queue.size(), 8U);
  EXPECT_EQ(taken_from(queue), (std::vector<int>{0, 10, 20, 1, 21, 2, 3, 4}));
  EXPECT_EQ(queue.size(), 0U);
}

TEST(FairQueue, TakesTheNewestOfThePeerThatHasMostWhereItIsFull) {
  FairQueue queue(4);
  for (int i = 0; i < 4; ++i) {
    PendingConnection connection = connection_of("many", i);
    EXPECT_FALSE(queue.add(connection).has_value());
  }
  const auto displaced_by = [&](const std::string& peer, int number) {
    PendingConnection connection = connection_of(peer, number);
    const auto displaced = queue.add(connection);
    return displaced ? displaced->socket : -1;
  };
  EXPECT_EQ(displaced_by("many", 4), 4) << "a peer does not displace itself";
  EXPECT_EQ(displaced_by("one", 10), 3);
  EXPECT_EQ(displaced_by("one", 11), 2);
  EXPECT_EQ(displaced_by("one", 12), 12) << "both have two";
  EXPECT_NE(displaced_by("two", 20), 20) << "a peer that has none yet displaces one of those";
  EXPECT_EQ(displaced_by("two", 21), 21);
  EXPECT_EQ(queue.size(), 4U);
}

/// In a process of its own, since it gives its address space up.
void start_without_memory() {
  const rlimit none{.rlim_cur = 1, .rlim_max = 1};
  ::setrlimit(RLIMIT_AS, &none);
  try {
    const WorkerPool pool(32, 1, [](const server::PendingConnection&) {});
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    std::_Exit(3);
  }
  std::_Exit(0);
}

/// In a process of its own, too: the name of a peer cannot be copied. The exit code is the number of
/// connections that the queue has afterwards.
void displace_without_memory() {
  FairQueue queue(3);
  for (int i = 0; i < 3; ++i) {
    PendingConnection connection = connection_of("many", i);
    EXPECT_FALSE(queue.add(connection).has_value());
  }
  PendingConnection large = connection_of(std::string(64 << 20, 'b'), 10);
  const rlimit none{.rlim_cur = 1, .rlim_max = 1};
  ::setrlimit(RLIMIT_AS, &none);
  try {
    static_cast<void>(queue.add(large));
    std::_Exit(10);
  } catch (const std::bad_alloc&) {
  }
  int left = 0;
  while (queue.take()) ++left;
  std::_Exit(large.socket == 10 ? left : 11);
}

TEST(FairQueueDeathTest, KeepsAllWhereThereIsNoMemoryForOneMore) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space of their own";
#endif
  EXPECT_EXIT(displace_without_memory(), testing::ExitedWithCode(3), "");
}

TEST(WorkerPoolDeathTest, SaysWhyItHasNoThreads) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need address space of their own";
#endif
  EXPECT_EXIT(start_without_memory(), testing::ExitedWithCode(3), "no more than 0 of the 32 threads");
}

}  // namespace
