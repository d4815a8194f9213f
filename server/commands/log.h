// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace server::commands {

/// Lines on their way to a descriptor. A reader that is slow, or stopped, holds nobody up: one thread of its
/// own writes, and add() never waits.
class LineQueue {
 public:
  static constexpr std::size_t kMostBytes = 1024 * 1024;

  /// @param descriptor  stays the caller's, for as long as the process runs
  explicit LineQueue(int descriptor);
  ~LineQueue();  ///< writes queued lines within half a second, or not at all
  LineQueue(const LineQueue&) = delete;
  LineQueue& operator=(const LineQueue&) = delete;

  /// Queues a line, with its end. False if there is no room for it.
  [[nodiscard]] bool add(std::string_view line);

 private:
  struct State;
  static void work(const std::shared_ptr<State>& state);

  /// Shared with the thread, which a descriptor that nobody reads may keep for ever.
  std::shared_ptr<State> state_;
};

/// Log on standard error, since standard output holds the one line that scripts read, from construction to
/// destruction. A message is one line of it, whatever text of a user it holds: see escape_for_log(). Lines
/// that a LineQueue has no room for are counted, and the next line that finds room follows their number.
class Log {
 public:
  /// @param level  "debug", "info", "warning" or "error"
  explicit Log(const std::string& level);
  ~Log();  ///< see ~LineQueue()
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
};

/// The text with every byte that is no visible ASCII character or blank as \xNN: no line can be made up, and
/// no terminal can be told to do something, by a name or a path.
[[nodiscard]] std::string escape_for_log(std::string_view text);

}  // namespace server::commands
