// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <list>
#include <optional>
#include <string>

#include "server/http/pending_connection.h"

namespace server {

/// Bounded queue of connections in which each peer has its turn, however many connections others have: fair
/// queueing by round robin.
class FairQueue {
 public:
  explicit FairQueue(std::size_t most) : most_(most) {}

  /// Adds a connection. Where the queue is full, the peer that has most of it loses its newest.
  /// @returns the connection that has no place any more, which may be this one
  /// @throws std::bad_alloc, and the connection is left as it is
  [[nodiscard]] std::optional<PendingConnection> add(PendingConnection& connection);

  /// The oldest connection of the peer whose turn it is. Empty if the queue is.
  [[nodiscard]] std::optional<PendingConnection> take();

  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Line {
    std::string peer;
    std::deque<PendingConnection> connections;  ///< oldest first; never empty
  };

  using Place = std::list<Line>::iterator;

  /// Appends a connection to the line of its peer. Throws as add() does.
  /// @param line  of its peer; the end if there is none
  void append(PendingConnection& connection, Place line);

  /// Adds a connection to a queue that is full, as add() does.
  /// @param line  of its peer; the end if there is none
  std::optional<PendingConnection> add_to_full(PendingConnection& connection, Place line);

  const std::size_t most_;
  std::size_t size_ = 0;
  std::list<Line> lines_;  ///< in the order of their turns
};

}  // namespace server
