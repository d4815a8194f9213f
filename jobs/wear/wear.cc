// SPDX-License-Identifier: Apache-2.0
#include "jobs/wear/wear.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "engine/analysis/quantities.h"
#include "engine/clearance/worn_bore.h"
#include "jobs/base/errors.h"
#include "jobs/linkages/linkage_json.h"
#include "jobs/parameters/wear_depth.h"
#include "jobs/wear/pressed_arc.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kNever = std::numeric_limits<double>::infinity();

constexpr std::string_view kFirstRing = "_ring_1_sliding_work_j";

std::string key_of(const std::string& prefix, int ring) {
  return prefix + "ring_" + std::to_string(ring) + "_sliding_work";
}

/// The object of a joint in a description; a universal one has two bearings, of its first and second axis.
const json& joint_of(const json& joints, const std::string& name) {
  if (joints.contains(name)) return joints.at(name);
  return joints.at(name.substr(0, name.rfind('_')));
}

/// The channels of a ring: its sliding work, the same times the normal and, in a worn bore, times the
/// penetration.
struct RingChannels {
  const std::vector<double>& work;
  const std::vector<double>& work_x;
  const std::vector<double>& work_y;
  const std::vector<double>* work_penetration;
};

RingChannels ring_channels(const engine::Trajectory& run, const std::string& prefix, int ring, bool worn) {
  const std::string key = key_of(prefix, ring);
  const auto find = [&](const std::string& channel) -> const std::vector<double>& {
    const auto found = std::ranges::find(run.channels, channel, &engine::QuantityInfo::key);
    if (found == run.channels.end()) {
      throw WrongState("the job was computed by a program that did not keep " + channel);
    }
    return run.columns.at(static_cast<std::size_t>(found - run.channels.begin()));
  };
  return {find(key + "_j"), find(key + "_x_j"), find(key + "_y_j"),
          worn ? &find(key + "_penetration_j_m") : nullptr};
}

/// The joints whose journals slide in a bore. @throws WrongState without one
std::vector<std::string> list_joints_with_bore(const std::vector<std::string>& kept) {
  std::vector<std::string> joints;
  for (const std::string& channel : kept)
    if (channel.ends_with(kFirstRing))
      joints.push_back(channel.substr(0, channel.size() - kFirstRing.size()));
  if (joints.empty())
    throw WrongState("no joint of this job has a journal that slides in a bore with clearance");
  return joints;
}

/// Sliding work in each sector. @param arc  where a worn bore is pressed; null: in the direction of the
/// contact
std::vector<double> gather(const RingChannels& ring, std::size_t sectors, PressedArc* arc) {
  std::vector<double> work(sectors, 0.0);
  for (std::size_t k = 1; k < ring.work.size(); ++k) {
    const double more = ring.work[k] - ring.work[k - 1];
    if (!(more > 0.0)) continue;
    const double angle = std::atan2(ring.work_y[k] - ring.work_y[k - 1], ring.work_x[k] - ring.work_x[k - 1]);
    if (arc) {
      arc->add(more, angle, ((*ring.work_penetration)[k] - (*ring.work_penetration)[k - 1]) / more, work);
      continue;
    }
    const double part = (angle < 0.0 ? angle + kTurn : angle) / kTurn;
    work[std::min(static_cast<std::size_t>(part * static_cast<double>(sectors)), sectors - 1)] += more;
  }
  return work;
}

void check_wear_query(const WearQuery& query, double clearance_mm) {
  if (!(clearance_mm > 0.0)) throw WrongState("the joint of this job has no clearance, and does not slide");
  if (query.worn_clearance && !(*query.worn_clearance > clearance_mm)) {
    throw InvalidRequest(
        std::vector<Fault>{{"/worn_clearance_mm", "must be more than the clearance of the joint, " +
                                                      number_text(clearance_mm) + " mm"}});
  }
}

/// Maker of the map of one bearing, ring by ring.
class WearMapper {
 public:
  /// @param run  of two samples or more
  WearMapper(const WornBearing& bearing, const engine::Trajectory& run, const WearQuery& query)
      : bearing_(bearing),
        run_(run),
        query_(query),
        clearance_mm_(bearing.parameters.at("clearance_mm")),
        length_mm_(bearing.parameters.at("bearing_length_mm")),
        rings_(bearing.parameters.at("radial_levels")),
        sector_(kTurn / static_cast<double>(query.sectors)),
        area_(1e-6 * bearing.parameters.at("bearing_radius_mm").get<double>() * sector_ * length_mm_ /
              rings_),
        hours_((run.columns[0].back() - run.columns[0].front()) / 3600.0) {
    const json& parameters = bearing.parameters;
    if (parameters.contains(kWearKey))
      bore_.emplace(1e-3 * clearance_mm_, to_wear_depth(parameters.at(kWearKey)));
  }

  [[nodiscard]] int rings() const { return rings_; }

  void add_ring(int ring, ResultTable& table) const {
    const double position_mm =
        ring_position_mm(static_cast<std::size_t>(ring - 1), static_cast<std::size_t>(rings_), length_mm_);
    const std::vector<double> work = gather_work(ring);
    for (std::size_t s = 0; s < work.size(); ++s) {
      const double depth_um = 1e6 * query_.wear_coefficient * work[s] / area_;
      const double rate = depth_um / hours_;
      const double angle = (static_cast<double>(s) + 0.5) * sector_;
      const double life = calc_life(ring, angle, rate);
      table.rows.push_back(
          {ring, position_mm, angle, work[s], depth_um, rate, std::isfinite(life) ? json(life) : json()});
    }
  }

 private:
  [[nodiscard]] std::vector<double> gather_work(int ring) const {
    std::optional<PressedArc> arc;
    if (bore_) arc.emplace(*bore_, ring - 1, 1e-3 * clearance_mm_, query_.sectors);
    return gather(ring_channels(run_, bearing_.prefix, ring, bore_.has_value()), query_.sectors,
                  arc ? &*arc : nullptr);
  }

  /// Time until the clearance at an angle is the worn one, [h]. @param rate  of the wear there, [um/h]
  [[nodiscard]] double calc_life(int ring, double angle, double rate) const {
    if (!query_.worn_clearance) return kNever;
    const double worn_um = bore_ ? 1e6 * bore_->calc_depth(ring - 1, angle) : 0.0;
    return std::max(1e3 * (*query_.worn_clearance - clearance_mm_) - worn_um, 0.0) / rate;
  }

  const WornBearing& bearing_;
  const engine::Trajectory& run_;
  const WearQuery& query_;
  const double clearance_mm_, length_mm_;
  const int rings_;
  const double sector_;                   ///< angle, [rad]
  const double area_;                     ///< of a cell, [m^2]
  const double hours_;                    ///< of the run
  std::optional<engine::WornBore> bore_;  ///< empty: round
};

}  // namespace

WornBearing find_worn_bearing(const json& parameters, const std::vector<std::string>& kept,
                              const std::string& joint) {
  if (!describes_linkage(parameters)) {
    if (joint.empty()) return {.prefix = "", .parameters = parameters};
    throw InvalidRequest(std::vector<Fault>{{"/joint", "belongs to described linkages: leave it out"}});
  }
  const std::vector<std::string> joints = list_joints_with_bore(kept);
  const std::string& name = joint.empty() ? joints.front() : joint;
  if (std::ranges::find(joints, name) == joints.end())
    throw InvalidRequest(
        std::vector<Fault>{{"/joint", "must be one of " + json(joints).dump() + ", the joints with a bore"}});
  WornBearing bearing{.prefix = name + "_", .parameters = parameters};
  bearing.parameters.update(joint_of(parameters.at("linkage").at("joints"), name).at("clearance"));
  return bearing;
}

std::vector<std::string> wear_channels(const WornBearing& bearing) {
  std::vector<std::string> channels;
  const bool worn = bearing.parameters.contains(kWearKey);
  for (int ring = 1; ring <= bearing.parameters.at("radial_levels").get<int>(); ++ring) {
    const std::string key = key_of(bearing.prefix, ring);
    for (const char* const part : {"_j", "_x_j", "_y_j"}) channels.push_back(key + part);
    if (worn) channels.push_back(key + "_penetration_j_m");
  }
  return channels;
}

double ring_position_mm(std::size_t ring, std::size_t rings, double length_mm) {
  return rings == 1 ? 0.0 : length_mm * (static_cast<double>(ring) / static_cast<double>(rings - 1) - 0.5);
}

ResultTable make_wear_map(const WornBearing& bearing, const engine::Trajectory& run, const WearQuery& query) {
  check_wear_query(query, bearing.parameters.at("clearance_mm"));
  if (run.columns.at(0).size() < 2) throw WrongState("a wear map needs two samples or more");
  ResultTable table{
      .columns = {"ring", "position_mm", "angle_rad", "sliding_work_j", "depth_um", "rate_um_h", "life_h"},
      .rows = {},
      .ended = true};
  const WearMapper mapper(bearing, run, query);
  for (int ring = 1; ring <= mapper.rings(); ++ring) mapper.add_ring(ring, table);
  return table;
}

}  // namespace jobs
