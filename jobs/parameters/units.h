#pragma once

namespace jobs {

/// Lengths are given in mm where they are small, and kept in m.
inline constexpr double kMmPerM = 1000.0;

}  // namespace jobs
