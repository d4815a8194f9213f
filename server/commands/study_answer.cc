// SPDX-License-Identifier: Apache-2.0
#include "server/commands/study_answer.h"

#include <cstdio>
#include <sstream>
#include <string>

namespace server::commands {

namespace {

using nlohmann::json;

std::string short_number(const json& value, const char* otherwise) {
  if (!value.is_number()) return otherwise;
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value.get<double>());
  return text;
}

std::string list_values(const json& values) {
  std::string text;
  for (const auto& [name, value] : values.items())
    text += (text.empty() ? "" : ", ") + name + " = " + value.dump();
  return text;
}

/// One line a combination of the axes: the limit, and how it was found.
void add_limits_to(std::ostream& out, const json& search) {
  for (const json& limit : search.at("limits")) {
    json place = json::object();
    for (const json& axis : search.at("axes"))
      place[axis.get<std::string>()] = limit.at(axis.get<std::string>());
    out << search.at("parameter").get<std::string>();
    if (!limit.at("limit").is_null()) out << " <= " << short_number(limit.at("limit"), "?");
    if (!place.empty()) out << " at " << list_values(place);
    out << ": " << limit.at("verdict").get<std::string>();
    if (!limit.at("limit_beyond").is_null())
      out << ", beyond the bound at " << short_number(limit.at("limit_beyond"), "?");
    out << '\n';
  }
}

/// Wear that the bearing has reached.
void add_wear_to(std::ostream& out, const json& study) {
  if (study.at("cycles").empty()) return;
  const json& last = study.at("cycles").back();
  out << study.at("verdict").get<std::string>() << ": clearance "
      << short_number(last.at("clearance_mm"), "?") << " mm, deepest wear "
      << short_number(last.at("deepest_um"), "?") << " um after " << short_number(last.at("hours"), "?")
      << " h\n";
}

/// One line a candidate of the front, and how far it is to be trusted.
void add_front_to(std::ostream& out, const json& study) {
  const json& front = study.at("front");
  if (front.empty()) out << "no candidate is feasible\n";
  for (const json& candidate : front)
    out << list_values(candidate.at("metrics")) << " at " << list_values(candidate.at("values")) << '\n';
  if (study.at("best_repeats").is_null()) return;
  out << study.at("best_repeats") << " of " << study.at("starts").size()
      << " starts end within 1 % of the best value\n";
}

void add_signal_to(std::ostream& out, const json& signal) {
  for (const char* const use : {"fitted", "held_back"}) {
    const json& error = signal.at(use);
    if (error.is_null()) continue;
    out << signal.at("channel").get<std::string>() << " of run " << signal.at("run") << ", "
        << (use == std::string("fitted") ? "fitted" : "held back") << ": RMS "
        << short_number(error.at("rms"), "?") << ", peak " << short_number(error.at("predicted_peak"), "?")
        << " (measured " << short_number(error.at("measured_peak"), "?") << ")\n";
  }
}

/// One line a parameter: value, and how sure it is.
void add_values_to(std::ostream& out, const json& study) {
  for (const json& parameter : study.at("parameters")) {
    const bool has_range = !parameter.at("range").is_null();
    const bool has_profile = !parameter.at("profile").is_null();
    const json& interval = parameter.at(has_range ? "range" : has_profile ? "profile" : "linearised");
    out << parameter.at("path").get<std::string>() << " = " << short_number(parameter.at("value"), "?");
    if (!interval.is_null()) {
      out << (has_range ? ", range " : ", 95 % interval ") << short_number(interval.at("low"), "none")
          << " to " << short_number(interval.at("high"), "none");
    }
    out << '\n';
  }
  for (const json& signal : study.at("signals")) add_signal_to(out, signal);
  for (const json& remark : study.at("remarks")) out << remark.get<std::string>() << '\n';
}

}  // namespace

std::string answer_text(Kind kind, const json& study) {
  std::ostringstream out;
  if (kind == Kind::kSearch) add_limits_to(out, study);
  if (kind == Kind::kWearStudy) add_wear_to(out, study);
  if (kind == Kind::kOptimisation) add_front_to(out, study);
  if (kind == Kind::kFit) add_values_to(out, study);
  return out.str();
}

bool has_answer(Kind kind, const json& study) {
  return study.at("state") == "succeeded" && (kind != Kind::kOptimisation || !study.at("front").empty());
}

}  // namespace server::commands
