// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/analysis/quantities.h"
#include "server/commands/terminal.h"

namespace server::commands {

/// The slider's acceleration over time, cut into columns: between which values it moved in each. No spike is
/// lost, however short. Of a described linkage, what is drawn is the first acceleration that it has, from
/// sample to sample.
struct AccelerationBand {
  std::string title = "slider acceleration, m/s^2";
  double t_begin = 0.0, t_end = 0.0;      ///< [s]
  std::vector<double> least, most;        ///< one a column
};

/// @param columns  at most; fewer if the trajectory has fewer samples
/// @returns no columns for a trajectory without samples
[[nodiscard]] AccelerationBand calc_acceleration_band(const engine::Trajectory& trajectory,
                                                      std::size_t columns);

enum class Characters { kBraille, kAscii };

/// Number of columns that draw_for_terminal() can show in such a terminal.
[[nodiscard]] std::size_t plot_columns(const TerminalSize& size);

/// A picture of characters, its axes labelled; lines end in '\n'.
[[nodiscard]] std::string draw_for_terminal(const AccelerationBand& band, const TerminalSize& size,
                                            Characters characters);

/// Width of the picture that draw_svg() makes, in pixels: one a column.
inline constexpr std::size_t kSvgColumns = 800;

[[nodiscard]] std::string draw_svg(const AccelerationBand& band);

}  // namespace server::commands
