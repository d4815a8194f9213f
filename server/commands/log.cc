// SPDX-License-Identifier: Apache-2.0
#include "server/commands/log.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

namespace server::commands {

namespace {

/// Stands for the message in the pattern of a line.
class EscapedMessage final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& line) override {
    const std::string text = escape_for_log({message.payload.data(), message.payload.size()});
    line.append(text.data(), text.data() + text.size());
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<EscapedMessage>();
  }
};

/// Sends the lines of the log to a queue.
class QueueSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit QueueSink(int descriptor) : lines_(descriptor) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (lost_ > 0) {
      const std::string text = std::to_string(lost_) + " lines of the log are lost: nobody read them";
      if (!add({message.time, {}, message.logger_name, spdlog::level::warn, text})) {
        ++lost_;
        return;
      }
      lost_ = 0;
    }
    if (!add(message)) ++lost_;
  }
  void flush_() override {}

 private:
  bool add(const spdlog::details::log_msg& message) {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    return lines_.add({line.data(), line.size()});
  }

  LineQueue lines_;
  std::size_t lost_ = 0;  ///< lines that found no room, and that the log has not told of
};

/// Writes as much of the lines as can be written, and waits for a reader that is slow.
void write_lines(int descriptor, std::string_view lines) {
  while (!lines.empty()) {
    const ssize_t written = ::write(descriptor, lines.data(), lines.size());
    if (written < 0 && errno != EINTR && errno != EAGAIN) return;  // gone for good, or a disk that is full
    if (written < 0 && errno == EAGAIN) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    lines.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
}

}  // namespace

struct LineQueue::State {
  explicit State(int out) : descriptor(out) {}

  const int descriptor;
  std::mutex mutex;  // guards the rest
  std::condition_variable changed;
  std::string queued;
  bool ending = false;
  bool ended = false;  ///< the thread has written everything
};

LineQueue::LineQueue(int descriptor) : state_(std::make_shared<State>(descriptor)) {
  std::thread([state = state_] { work(state); }).detach();
}

LineQueue::~LineQueue() {
  constexpr std::chrono::milliseconds kPatience{500};
  std::unique_lock lock(state_->mutex);
  state_->ending = true;
  state_->changed.notify_all();
  state_->changed.wait_for(lock, kPatience, [this] { return state_->ended; });
}

bool LineQueue::add(std::string_view line) {
  const std::lock_guard lock(state_->mutex);
  if (state_->queued.size() + line.size() > kMostBytes) return false;
  state_->queued.append(line);
  state_->changed.notify_all();
  return true;
}

void LineQueue::work(const std::shared_ptr<State>& state) {
  std::unique_lock lock(state->mutex);
  for (std::string lines;;) {
    state->changed.wait(lock, [&] { return state->ending || !state->queued.empty(); });
    if (state->queued.empty()) break;
    lines = std::exchange(state->queued, {});
    lock.unlock();
    write_lines(state->descriptor, lines);
    lock.lock();
  }
  state->ended = true;
  state->changed.notify_all();
}

Log::Log(const std::string& level) {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<EscapedMessage>('*').set_pattern("%Y-%m-%dT%H:%M:%S.%e%z %l %*");
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("rpsup", std::make_shared<QueueSink>(STDERR_FILENO)));
  spdlog::set_formatter(std::move(formatter));
  spdlog::set_level(spdlog::level::from_str(level));
  // By default the library writes to standard error, which may block.
  spdlog::set_error_handler([](const std::string&) {});
}

Log::~Log() { spdlog::set_default_logger(std::make_shared<spdlog::logger>("none")); }

std::string escape_for_log(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    if (c >= ' ' && c < '\x7f') {
      result += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    result += "\\x";
    result += kDigits[byte >> 4U];
    result += kDigits[byte & 15U];
  }
  return result;
}

}  // namespace server::commands
