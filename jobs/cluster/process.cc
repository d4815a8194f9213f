// SPDX-License-Identifier: Apache-2.0
#include "jobs/cluster/process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace jobs::cluster {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kMostOutput = std::size_t{64} << 20U;

/// Both ends are closed with it, and neither is passed on to programs that are started meanwhile.
class Pipe {
 public:
  Pipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) ends_ = {-1, -1};
    ::fcntl(ends_[0], F_SETFL, O_NONBLOCK);
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] int out() const { return ends_[0]; }
  [[nodiscard]] int in() const { return ends_[1]; }
  void close_in() { close_end(1); }

  /// Takes what is there. False at the end.
  bool read_to(std::string& text) {
    std::array<char, 65536> bytes{};
    for (;;) {
      const ssize_t got = ::read(out(), bytes.data(), bytes.size());
      if (got < 0) return errno == EAGAIN || errno == EINTR;
      if (got == 0) return false;
      const std::size_t left = kMostOutput - text.size();
      text.append(bytes.data(), std::min(left, static_cast<std::size_t>(got)));
    }
  }

 private:
  void close_end(std::size_t which) {
    if (ends_.at(which) >= 0) ::close(ends_.at(which));
    ends_.at(which) = -1;
  }

  std::array<int, 2> ends_{};
};

/// Start of the child: no input, its output in our pipes, nothing else open, no signal blocked or ignored, a
/// group of its own.
class SpawnSettings {
 public:
  SpawnSettings(const Pipe& out, const Pipe& err) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions_, out.in(), STDOUT_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions_, err.in(), STDERR_FILENO);
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
    ::posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    ::sigemptyset(&none);
    ::sigfillset(&all);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setsigdefault(&attributes_, &all);
    ::posix_spawnattr_setpgroup(&attributes_, 0);
    ::posix_spawnattr_setflags(&attributes_,
                               POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  }
  ~SpawnSettings() {
    ::posix_spawnattr_destroy(&attributes_);
    ::posix_spawn_file_actions_destroy(&actions_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Waits for some time, or until there is output. @param out, err  -1: closed
void await_output(int out, int err, milliseconds wait) {
  if (out < 0 && err < 0) return std::this_thread::sleep_for(wait);
  std::array<pollfd, 2> ends{pollfd{.fd = out, .events = POLLIN, .revents = 0},
                             pollfd{.fd = err, .events = POLLIN, .revents = 0}};
  ::poll(ends.data(), ends.size(), static_cast<int>(wait.count()));
}

/// Ends a child and what it has started.
void kill_group(pid_t child) {
  ::kill(-child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

/// Reads until the child has ended: what it has started may keep the pipes open for longer.
void follow(pid_t child, Pipe& out, Pipe& err, Clock::time_point until, const std::stop_token& stop,
            ProcessOutcome& outcome) {
  bool out_open = true, err_open = true;
  int status = 0;
  for (milliseconds wait{1};; wait = std::min(2 * wait, milliseconds(50))) {
    await_output(out_open ? out.out() : -1, err_open ? err.out() : -1, wait);
    const bool ended = ::waitpid(child, &status, WNOHANG) == child;
    if (out_open) out_open = out.read_to(outcome.out);
    if (err_open) err_open = err.read_to(outcome.err);
    if (ended) break;
    if (Clock::now() < until && !stop.stop_requested()) continue;
    kill_group(child);
    outcome.end = stop.stop_requested() ? ProcessOutcome::End::kStopped : ProcessOutcome::End::kTimedOut;
    return;
  }
  outcome.end = ProcessOutcome::End::kExited;
  outcome.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// Starts a program whose output goes into the pipes.
/// @returns empty if it cannot be started; the problem says why
std::optional<pid_t> start_child(std::vector<std::string> words, const Pipe& out, const Pipe& err,
                                 std::string& problem) {
  std::vector<std::string> variables = cleaned_environment();
  const SpawnSettings settings(out, err);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, words.front().c_str(), &settings.actions_, &settings.attributes_,
                                   pointers_to(words).data(), pointers_to(variables).data());
  if (error == 0) return child;
  problem = words.front() + " cannot be started: " + std::strerror(error);
  return std::nullopt;
}

std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  const auto start = text.find_last_of('\n');
  return start == std::string::npos ? text : text.substr(start + 1);
}

}  // namespace

std::string ProcessOutcome::text() const {
  if (end == End::kNotStarted) return err;
  if (end == End::kTimedOut) return "it did not answer in time";
  if (end == End::kStopped) return "it was ended, as this program ends";
  const std::string words = last_line(err.empty() ? out : err);
  return words.empty() ? "it ended with exit code " + std::to_string(code) : words;
}

ProcessOutcome run_process(const std::vector<std::string>& arguments, milliseconds deadline,
                           const std::stop_token& stop) {
  ProcessOutcome outcome;
  Pipe out, err;
  const auto child = start_child(arguments, out, err, outcome.err);
  if (!child) return outcome;
  out.close_in();
  err.close_in();
  follow(*child, out, err, Clock::now() + deadline, stop, outcome);
  return outcome;
}

std::vector<std::string> cleaned_environment() {
  constexpr std::array<std::string_view, 9> kUnwanted{"SQUEUE_", "SBATCH_", "SLURM_",  "SCANCEL_", "SINFO_",
                                                      "SCONTROL_", "SALLOC_", "SACCT_", "RPSUP_"};
  std::vector<std::string> kept;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    bool unwanted = false;
    for (const std::string_view prefix : kUnwanted) unwanted |= text.starts_with(prefix);
    if (!unwanted || text.starts_with("SLURM_CONF=")) kept.emplace_back(text);
  }
  return kept;
}

std::vector<std::string> split_words(const std::string& line) {
  std::vector<std::string> words;
  bool inside = false;
  char quote = 0;
  for (const char c : line) {
    if (quote != 0 ? c == quote : c == '\'' || c == '"') {
      quote = quote != 0 ? '\0' : c;
      if (!inside) words.emplace_back();
      inside = true;
    } else if (quote == 0 && (c == ' ' || c == '\t')) {
      inside = false;
    } else {
      if (!inside) words.emplace_back();
      inside = true;
      words.back() += c;
    }
  }
  return words;
}

std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += "'\\''";
    else quoted += c;
  }
  return quoted + "'";
}

}  // namespace jobs::cluster
