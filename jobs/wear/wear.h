// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/analysis/quantities.h"
#include "jobs/parameters/range.h"
#include "jobs/results/result_table.h"

namespace jobs {

inline constexpr Range kMapSectorsRange{.minimum = 4, .maximum = 720};
inline constexpr Range kWearCoefficientRange{
    .minimum = 0.0, .maximum = 1e-6, .lower = Bound::kExclusive};  ///< [m^2/N]

/// Bearing of a joint with clearance.
struct WornBearing {
  std::string prefix;         ///< of its channels
  nlohmann::json parameters;  ///< of the job, completed, with those of the joint in their place
};

/// @param parameters  of the job, completed
/// @param kept        channels of its run, of a described linkage
/// @param joint       of a described linkage; empty: the first one with a bore
/// @throws InvalidRequest ("/joint"); WrongState if no joint has clearance in a bore
[[nodiscard]] WornBearing find_worn_bearing(const nlohmann::json& parameters,
                                            const std::vector<std::string>& kept, const std::string& joint);

/// Query of a wear map.
struct WearQuery {
  double wear_coefficient = 1e-15;  ///< worn volume over normal force and sliding distance, [m^2/N]
  std::size_t sectors = 36;         ///< around the bore, in kMapSectorsRange
  std::optional<double> worn_clearance;  ///< clearance at the end of the bearing's life, [mm]
};

/// Place of a ring of the journal along it, from its middle.
/// @param ring  from 0 on
[[nodiscard]] double ring_position_mm(std::size_t ring, std::size_t rings, double length_mm);

/// The channels that a map is made of.
[[nodiscard]] std::vector<std::string> wear_channels(const WornBearing& bearing);

/// The depth that Archard's law wears off the bore along a run, k W / A in each cell of the bearing: a sector
/// of the circumference, and of the length the part that belongs to one ring of the journal. The wear between
/// two samples is put where the contact was on the mean; in a job with a worn bore, on the arc that was
/// pressed there (PressedArc). The depth is what this run adds.
///
/// Rows: ring, position_mm (of the ring along the journal), angle_rad (the sector's middle in the bearing
/// frame), sliding_work_j, depth_um, rate_um_h (if the run went on as it was), life_h (until the clearance
/// there is worn_clearance; null without it, or where it lasts for ever).
/// @param run  t_s and wear_channels(), two samples or more
/// @throws WrongState if the joint has no clearance, InvalidRequest ("/worn_clearance_mm") if that is not
/// above the joint's
[[nodiscard]] ResultTable make_wear_map(const WornBearing& bearing, const engine::Trajectory& run,
                                        const WearQuery& query);

}  // namespace jobs
