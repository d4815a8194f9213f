// SPDX-License-Identifier: Apache-2.0
#include "jobs/requests/sampled_designs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "jobs/parameters/parameter_value.h"
#include "jobs/parameters/span.h"
#include "jobs/requests/axis.h"
#include "jobs/requests/parameters.h"
#include "jobs/statistics/effect_points.h"
#include "jobs/statistics/unit_points.h"

namespace jobs {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::uint64_t kDefaultSeed = 1;
/// Number that no count of points reaches.
constexpr std::uint64_t kEndless = std::numeric_limits<std::uint64_t>::max();

/// Adds the faults of both ends of a range. Returns whether there are none.
bool check_range(const std::string& path, const json& given, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const auto span = read_span(given, {}, pointer_of_axis(path), faults);
  if (!span) return false;
  for (const char* end : {"from", "to"}) {
    for (const Fault& fault : find_path_faults(path, given.at(end)))
      faults.push_back({pointer_of_axis(path) + "/" + end, fault.detail});
  }
  if (!(span->from < span->to)) faults.push_back({pointer_of_axis(path) + "/to", "must be more than from"});
  return faults.size() == before;
}

/// Number of different values of a parameter, at most kEndless. Adds the faults.
std::uint64_t count_levels(const std::string& path, const json& given, std::vector<Fault>& faults) {
  if (given.is_array() && !given.empty()) return given.size();
  if (!given.is_object() || !is_numeric(path)) {
    faults.push_back(
        {pointer_of_axis(path), is_numeric(path)
                                    ? "must be {\"from\", \"to\", \"scale\"}, or a list of one value or more"
                                    : "must be a list of one value or more"});
    return kEndless;
  }
  if (!check_range(path, given, faults) || !is_integer(path)) return kEndless;
  return static_cast<std::uint64_t>(given.at("to").get<double>() - given.at("from").get<double>()) + 1;
}

/// Number of different points, at most kEndless. Adds the faults.
std::uint64_t count_combinations(const ordered_json& over, std::vector<Fault>& faults) {
  std::uint64_t combinations = 1;
  for (const auto& [path, given] : over.items()) {
    if (__builtin_mul_overflow(combinations, count_levels(path, given, faults), &combinations))
      combinations = kEndless;
  }
  return combinations;
}

/// Value for a coordinate of the unit cube.
class Dimension {
 public:
  Dimension(const std::string& path, const json& given, std::vector<Fault>& faults)
      : integer_(is_integer(path)) {
    if (given.is_array()) {
      values_ = make_axis(path, given, pointer_of_axis(path), faults).values;
    } else {
      span_ = *read_span(given, {}, pointer_of_axis(path), faults);
    }
  }

  [[nodiscard]] json value_at(double u) const {
    if (!values_.empty()) return values_[index_at(u)];
    return integer_ ? json(static_cast<std::int64_t>(integer_at(u))) : json(number_at(u, span_.to));
  }

  /// Place of that value between the first, 0, and the last, 1.
  [[nodiscard]] double position_at(double u) const {
    if (values_.size() > 1) return static_cast<double>(index_at(u)) / static_cast<double>(values_.size() - 1);
    if (!values_.empty() || !integer_ || span_.from == span_.to) return u;
    const double value = integer_at(u);
    return span_.logarithmic ? std::log(value / span_.from) / std::log(span_.to / span_.from)
                             : (value - span_.from) / (span_.to - span_.from);
  }

 private:
  [[nodiscard]] std::size_t index_at(double u) const {
    return std::min(static_cast<std::size_t>(u * static_cast<double>(values_.size())), values_.size() - 1);
  }

  /// Rounding could lead beyond the end, by one bit.
  [[nodiscard]] double number_at(double u, double end) const {
    return std::min(span_.logarithmic ? geometric_between(span_.from, end, u) : std::lerp(span_.from, end, u),
                    end);
  }

  [[nodiscard]] double integer_at(double u) const {
    return std::min(std::floor(number_at(u, span_.to + 1.0)), span_.to);
  }

  bool integer_;
  std::vector<json> values_;  ///< of a list
  Span span_;                 ///< otherwise
};

DesignPoints stretch(const UnitPoints& unit_points, const ordered_json& over, std::vector<Fault>& faults) {
  std::vector<Dimension> dimensions;
  for (const auto& [path, given] : over.items()) dimensions.emplace_back(path, given, faults);
  DesignPoints points;
  points.reserve(unit_points.size());
  for (const auto& unit_point : unit_points) {
    points.emplace_back();
    for (std::size_t d = 0; d < dimensions.size(); ++d)
      points.back().push_back(dimensions[d].value_at(unit_point[d]));
  }
  return points;
}

std::optional<std::uint64_t> seed_of(const ordered_json& design) {
  return design.contains("seed") ? std::optional(design.at("seed").get<std::uint64_t>()) : std::nullopt;
}

void check_integer(const ordered_json& design, const char* key, const Range& range,
                   std::vector<Fault>& faults) {
  if (!design.contains(key)) return;
  if (std::string detail = describe_integer_fault(range, design.at(key)); !detail.empty())
    faults.push_back({std::string("/design/") + key, std::move(detail)});
}

/// Adds the faults of a design of blocks of points. @returns how many points it has, 0 if there are faults
/// @param key  of the number of blocks  @param more  points of a block beside one for each parameter
std::uint64_t count_blocks(const ordered_json& design, const char* key, std::uint64_t more,
                           std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  if (!design.contains(key)) faults.push_back({std::string("/design/") + key, "is missing"});
  check_integer(design, key, kBlocksRange, faults);
  check_integer(design, "seed", kSeedRange, faults);
  for (const auto& [path, given] : design.at("over").items()) (void)count_levels(path, given, faults);
  if (faults.size() != before) return 0;
  return design.at(key).get<std::uint64_t>() * (design.at("over").size() + more);
}

}  // namespace

std::uint64_t count_samples(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  if (!design.contains("count")) faults.push_back({"/design/count", "is missing"});
  check_integer(design, "count", kCountRange, faults);
  check_integer(design, "seed", kSeedRange, faults);
  const std::uint64_t combinations = count_combinations(design.at("over"), faults);
  if (faults.size() != before) return 0;
  const auto count = design.at("count").get<std::uint64_t>();
  if (count > combinations) {
    faults.push_back({"/design/count", "must be at most " + std::to_string(combinations) +
                                           ": the parameters have no more combinations"});
  }
  return count;
}

std::uint64_t count_morris(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  check_integer(design, "levels", kLevelsRange, faults);
  if (faults.size() == before && design.value("levels", kDefaultLevels) % 2 != 0)
    faults.push_back({"/design/levels", "must be even"});
  const std::uint64_t count = count_blocks(design, "trajectories", 1, faults);
  return faults.size() == before ? count : 0;
}

std::uint64_t count_saltelli(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  return count_blocks(design, "count", 2, faults);
}

UnitPoints effect_points_of(const ordered_json& design) {
  const std::size_t dimensions = design.at("over").size();
  const std::uint64_t seed = seed_of(design).value_or(kDefaultSeed);
  if (design.at("type") == "saltelli")
    return saltelli_points(design.at("count").get<std::size_t>(), dimensions, seed);
  return morris_points(design.at("trajectories").get<std::size_t>(), dimensions,
                       design.value("levels", kDefaultLevels), seed);
}

UnitPoints effect_positions_of(const ordered_json& design) {
  std::vector<Fault> none;  // of a design without faults
  std::vector<Dimension> dimensions;
  for (const auto& [path, given] : design.at("over").items()) dimensions.emplace_back(path, given, none);
  UnitPoints points = effect_points_of(design);
  for (auto& point : points)
    for (std::size_t d = 0; d < dimensions.size(); ++d) point[d] = dimensions[d].position_at(point[d]);
  return points;
}

DesignPoints make_morris(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  return stretch(effect_points_of(design), design.at("over"), faults);
}

DesignPoints make_saltelli(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  return stretch(effect_points_of(design), design.at("over"), faults);
}

DesignPoints make_latin_hypercube(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  const ordered_json& over = design.at("over");
  return stretch(latin_hypercube(design.at("count").get<std::size_t>(), over.size(),
                                 seed_of(design).value_or(kDefaultSeed)),
                 over, faults);
}

DesignPoints make_sobol(const ordered_json& design, const json&, std::vector<Fault>& faults) {
  const ordered_json& over = design.at("over");
  return stretch(sobol_points(design.at("count").get<std::size_t>(), over.size(), seed_of(design)), over,
                 faults);
}

}  // namespace jobs
