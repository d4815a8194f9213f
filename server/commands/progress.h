// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "server/commands/terminal.h"

namespace server::commands {

/// Shows how far a sweep is: on a terminal a bar and the running jobs, drawn over themselves; plain lines
/// elsewhere. The bar is full only if every job has succeeded.
class ProgressView {
 public:
  enum class Form { kBar, kLines };

  ProgressView(std::ostream& out, Form form) : out_(out), form_(form) {}

  /// The view of standard error.
  [[nodiscard]] static ProgressView on_standard_error();

  [[nodiscard]] Form form() const { return form_; }

  /// Shows the state of a sweep; says nothing when there is nothing new to say.
  /// @param sweep    as GET /v1/sweeps/{id} shows it
  /// @param running  a line for each running job, below the bar as far as the terminal has room
  void show(const nlohmann::json& sweep, const std::vector<std::string>& running = {},
            const TerminalSize& size = terminal_size());

  /// Leaves the line of the bar, and takes the running jobs away.
  void finish();

 private:
  void draw(const std::vector<std::string>& lines);

  std::ostream& out_;
  Form form_;
  std::vector<std::string> shown_;  ///< lines of the terminal, or the last line
  std::size_t shown_ended_ = 0;     ///< jobs that had ended when it was written
};

/// "1 h 02 min", "3 min 20 s", "12 s".
[[nodiscard]] std::string format_duration(double seconds);

}  // namespace server::commands
