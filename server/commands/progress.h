// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>

#include <nlohmann/json.hpp>

namespace server::commands {

/// Shows how far a sweep is: a bar that is drawn over itself on a terminal, plain lines elsewhere.
class ProgressView {
 public:
  enum class Form { kBar, kLines };

  ProgressView(std::ostream& out, Form form) : out_(out), form_(form) {}

  /// Shows the state of a sweep; says nothing when there is nothing new to say.
  /// @param sweep  as GET /v1/sweeps/{id} shows it
  void show(const nlohmann::json& sweep);

  /// Leaves the line of the bar.
  void finish();

 private:
  std::ostream& out_;
  Form form_;
  std::string shown_;          ///< the text on the line of the bar, or of the last line
  std::size_t shown_ended_ = 0;  ///< jobs that had ended when it was written
};

/// "1 h 02 min", "3 min 20 s", "12 s".
[[nodiscard]] std::string format_duration(double seconds);

}  // namespace server::commands
