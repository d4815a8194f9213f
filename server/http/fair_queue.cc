// SPDX-License-Identifier: Apache-2.0
#include "server/http/fair_queue.h"

#include <algorithm>
#include <utility>

namespace server {

std::optional<PendingConnection> FairQueue::add(PendingConnection& connection) {
  auto line = std::ranges::find(lines_, connection.peer, &Line::peer);
  if (size_ >= most_) return add_to_full(connection, line);
  append(connection, line);
  return std::nullopt;
}

void FairQueue::append(PendingConnection& connection, Place line) {
  if (line == lines_.end()) {
    lines_.push_back({.peer = connection.peer, .connections = {}});
    line = std::prev(lines_.end());
  }
  try {
    line->connections.push_back(std::move(connection));
  } catch (...) {
    if (line->connections.empty()) lines_.erase(line);
    throw;
  }
  ++size_;
}

std::optional<PendingConnection> FairQueue::add_to_full(PendingConnection& connection, Place line) {
  const auto longest = std::ranges::max_element(
      lines_, {}, [](const Line& each) { return each.connections.size(); });
  const std::size_t own = line == lines_.end() ? 0 : line->connections.size();
  if (longest == lines_.end() || own + 1 >= longest->connections.size()) return std::move(connection);
  append(connection, line);  // first, since there may be no memory for it
  std::optional<PendingConnection> displaced = std::move(longest->connections.back());
  longest->connections.pop_back();  // not its last: it had two more than this peer
  --size_;
  return displaced;
}

std::optional<PendingConnection> FairQueue::take() {
  if (lines_.empty()) return std::nullopt;
  Line& line = lines_.front();
  PendingConnection connection = std::move(line.connections.front());
  line.connections.pop_front();
  --size_;
  if (line.connections.empty()) lines_.pop_front();
  else lines_.splice(lines_.end(), lines_, lines_.begin());
  return connection;
}

}  // namespace server
