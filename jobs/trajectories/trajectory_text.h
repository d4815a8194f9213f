// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "jobs/trajectories/trajectory_view.h"

namespace jobs {

/// Text, or bytes, of a trajectory in pieces of some hundred kilobytes.
class TrajectoryText {
 public:
  virtual ~TrajectoryText() = default;
  /// Appends the next piece. False if there is none left.
  virtual bool append_next(std::string& to) = 0;
};

/// The bytes of to_npz(). The view has been loaded.
/// @throws std::length_error if it does not fit into a zip archive of 4 GiB
[[nodiscard]] std::unique_ptr<TrajectoryText> npz_text(TrajectoryView view);

}  // namespace jobs
