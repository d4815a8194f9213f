// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/check_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "jobs/measurements/channel_unit.h"
#include "jobs/measurements/measurement.h"
#include "jobs/parameters/range.h"
#include "jobs/requests/sweep_request.h"

namespace jobs {
namespace {

constexpr std::size_t kLongestChannelName = 200;  // bytes

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string describe_time_order(double time_s, double before_s) {
  return "the time must increase; " + readable_number(time_s) + " s follows " + readable_number(before_s) +
         " s";
}

}  // namespace

std::string describe_measurement_name_fault(const std::string& name) {
  return name.size() <= kLongestName
             ? ""
             : "must be a string of at most " + std::to_string(kLongestName) + " bytes";
}

std::string describe_channel_name_fault(std::string_view name) {
  if (name == kTimeColumn || name == kTrajectoryTime) return "is the name of the time, not of a channel";
  if (name.empty() || name.size() > kLongestChannelName || !std::ranges::all_of(name, is_name_character))
    return "is no name of a channel: letters, digits and _, at most " + std::to_string(kLongestChannelName);
  if (!find_unit(name)) return "must end in a unit, as slider_acceleration_m_s2 does";
  return "";
}

std::string shown_text(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  const auto is_inside = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xc0U) == 0x80U;
  };
  std::size_t end = std::min(text.size(), kLongest);
  while (end > 0 && end < text.size() && is_inside(end)) --end;
  std::string shown(text.substr(0, end));
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  return end < text.size() ? shown + "..." : shown;
}

std::string quoted_text(std::string_view text) { return "\"" + shown_text(text) + "\""; }

std::string describe_time_name_fault(std::string_view name) {
  constexpr std::array<std::string_view, 5> kOtherTimes{"_ms", "_us", "_ns", "_min", "_h"};
  const bool is_other = std::ranges::any_of(
      kOtherTimes, [name](std::string_view end) { return name.ends_with(end); });
  return is_other || find_unit(name).value_or("s") != "s" ? "the time must be in seconds, as in time_s" : "";
}

void add_time_faults(std::span<const double> time_s,
                     const std::function<Fault(std::size_t, const std::string&)>& fault_at,
                     const Fault& fault_of_all, std::vector<Fault>& faults) {
  if (time_s.size() < kFewestMeasuredSamples) faults.push_back(fault_of_all);
  for (std::size_t k = 1; k < time_s.size(); ++k) {
    const double step = time_s[k] - time_s[k - 1];
    const bool is_resolved = std::isfinite(time_s[k] - time_s.front()) && std::isfinite(1.0 / step);
    if (step > 0.0 && is_resolved) continue;
    if (step > 0.0) {
      faults.push_back(fault_at(k, "the time is too far from or too near to the one before"));
      return;
    }
    faults.push_back(fault_at(k, describe_time_order(time_s[k], time_s[k - 1])));
    if (faults.size() >= kMostFileFaults) return;
  }
}

void throw_if_any(std::vector<Fault> faults) {
  if (!faults.empty()) throw InvalidRequest(std::move(faults));
}

void refuse_body(std::string detail) { throw InvalidRequest(std::vector<Fault>{{"", std::move(detail)}}); }

void check_value_count(std::size_t values) {
  if (values > kMostMeasuredValues)
    refuse_body("a measurement may have " + std::to_string(kMostMeasuredValues) +
                " numbers, times among them; this one has " + std::to_string(values));
}

}  // namespace jobs
