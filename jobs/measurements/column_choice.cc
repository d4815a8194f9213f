// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/column_choice.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "jobs/measurements/check_measurement.h"
#include "jobs/measurements/sensor.h"
#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

/// Column and the channel that it is to be.
struct AskedColumn {
  std::string column, channel;
};

/// @param asked  "COLUMN:CHANNEL", or the name of both
AskedColumn split_asked(const std::string& asked) {
  const auto colon = asked.rfind(':');
  return {.column = asked.substr(0, colon),
          .channel = colon == std::string::npos ? asked : asked.substr(colon + 1)};
}

/// Chooses columns; a member function a step.
class ColumnChooser {
 public:
  ColumnChooser(std::span<const std::string> names, const ColumnQuery& query,
                const std::function<std::string(std::size_t)>& place)
      : names_(names), query_(query), place_(place) {}

  ColumnChoice choose() {
    if (std::string detail = describe_measurement_name_fault(query_.name); !detail.empty())
      faults_.push_back({"/name", std::move(detail)});
    check_names_differ();
    throw_if_any(faults_);
    choose_time();
    if (query_.channels.empty()) choose_all();
    else choose_asked();
    check_count();
    read_sensors();
    choice_.parameters = read_run_parameters(query_.parameters, "/parameters", faults_);
    throw_if_any(std::move(faults_));
    return std::move(choice_);
  }

 private:
  void check_names_differ() {
    if (names_.size() > kMostMeasuredColumns)
      refuse_body("has " + std::to_string(names_.size()) + " columns; at most " +
                  std::to_string(kMostMeasuredColumns) + " are allowed");
    std::set<std::string_view> met;
    for (std::size_t i = 0; i < names_.size(); ++i)
      if (!met.insert(names_[i]).second)
        faults_.push_back({"", place_(i) + ": another column has the same name"});
  }

  [[nodiscard]] std::optional<std::size_t> find(std::string_view name) const {
    const auto found = std::ranges::find(names_, name);
    return found == names_.end() ? std::nullopt
                                 : std::optional(static_cast<std::size_t>(found - names_.begin()));
  }

  [[nodiscard]] std::string unknown_column(std::string_view name) const {
    constexpr std::size_t kMostNamed = 20;
    std::string text = "there is no column " + quoted_text(name) + "; the file has ";
    for (std::size_t i = 0; i < std::min(kMostNamed, names_.size()); ++i)
      text += (i > 0 ? ", " : "") + quoted_text(names_[i]);
    return names_.size() > kMostNamed ? text + ", ..." : text;
  }

  void choose_time() {
    if (query_.time.empty()) {
      choice_.time = find(kTimeColumn).value_or(find(kTrajectoryTime).value_or(0));
    } else if (const auto asked = find(query_.time)) {
      choice_.time = *asked;
    } else {
      return faults_.push_back({"/time", unknown_column(query_.time)});
    }
    if (const std::string detail = describe_time_name_fault(names_[choice_.time]); !detail.empty())
      faults_.push_back({query_.time.empty() ? "" : "/time", place_(choice_.time) + ": " + detail});
  }

  /// Names that are not shown as they are, or that the query would split, cannot be asked for.
  [[nodiscard]] static std::string advise_on(const std::string& name) {
    return shown_text(name) == name && name.find(',') == std::string::npos
               ? "channels=" + name + ":CHANNEL in the query gives the column the name of a channel"
               : "give the column another name";
  }

  void choose_all() {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (i == choice_.time) continue;
      const std::string detail = describe_channel_name_fault(names_[i]);
      if (detail.empty()) add(i, names_[i]);
      else
        faults_.push_back({"", place_(i) + ": the name " + detail + "; " + advise_on(names_[i])});
    }
  }

  void choose_asked() {
    for (std::size_t k = 0; k < query_.channels.size(); ++k) {
      const std::string pointer = "/channels/" + std::to_string(k);
      const auto [column, channel] = split_asked(query_.channels[k]);
      const auto index = find(column);
      if (!index) faults_.push_back({pointer, unknown_column(column)});
      else if (*index == choice_.time) faults_.push_back({pointer, quoted_text(column) + " is the time"});
      if (const std::string detail = describe_channel_name_fault(channel); !detail.empty())
        faults_.push_back({pointer, quoted_text(channel) + " " + detail});
      else if (std::ranges::find(choice_.channels, channel, &MeasuredChannel::name) != choice_.channels.end())
        faults_.push_back({pointer, quoted_text(channel) + " stands twice"});
      else if (index) add(*index, channel);
    }
  }

  void add(std::size_t column, const std::string& channel) {
    choice_.columns.push_back(column);
    choice_.channels.push_back({.name = channel, .column = names_[column]});
  }

  void check_count() {
    if (!faults_.empty()) return;
    if (choice_.channels.empty())
      faults_.push_back({"", "there is no channel: the only column is the time, " +
                             shown_text(names_[choice_.time])});
    if (choice_.channels.size() > kMostMeasuredChannels)
      faults_.push_back(
          {"", "a measurement may have " + std::to_string(kMostMeasuredChannels) + " channels"});
  }

  void read_sensors() {
    if (!query_.sensors.is_object()) return faults_.push_back({"/sensors", "must be an object"});
    for (const auto& [name, sensor] : query_.sensors.items()) {
      const std::string pointer = "/sensors" + pointer_token(name);
      const auto channel = std::ranges::find(choice_.channels, name, &MeasuredChannel::name);
      if (channel == choice_.channels.end()) {
        faults_.push_back({pointer, "is no channel of this measurement"});
      } else if (!sensor.is_object()) {
        faults_.push_back({pointer, "must be an object"});
      } else {
        check_measured_keys(sensor, pointer, kSensorKeys, faults_);
        read_sensor(sensor, pointer, *channel, faults_);
      }
    }
  }

  std::span<const std::string> names_;
  const ColumnQuery& query_;
  const std::function<std::string(std::size_t)>& place_;
  ColumnChoice choice_;
  std::vector<Fault> faults_;
};

}  // namespace

ColumnChoice choose_columns(std::span<const std::string> names, const ColumnQuery& query,
                            const std::function<std::string(std::size_t)>& place) {
  return ColumnChooser(names, query, place).choose();
}

}  // namespace jobs
