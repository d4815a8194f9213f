// SPDX-License-Identifier: Apache-2.0
#include "server/commands/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>

namespace server::commands {

namespace {

std::string bar(double progress) {
  constexpr std::size_t kWidth = 30;
  const auto full = static_cast<std::size_t>(std::clamp(progress, 0.0, 1.0) * kWidth);
  return "[" + std::string(full, '#') + std::string(kWidth - full, '.') + "]";
}

}  // namespace

void ProgressView::show(const nlohmann::json& sweep) {
  const auto& counts = sweep.at("counts");
  const auto count = [&](const char* state) { return counts.at(state).get<std::size_t>(); };
  const std::size_t ended = count("total") - count("queued") - count("running");
  const double progress = sweep.at("progress").get<double>();
  std::string text = std::to_string(ended) + " of " + std::to_string(count("total")) + " jobs";
  if (count("failed") > 0) text += ", " + std::to_string(count("failed")) + " failed";
  const auto& eta = sweep.at("eta_s");
  if (ended < count("total") && eta.is_number())
    text += ", about " + format_duration(eta.get<double>()) + " left";
  if (form_ == Form::kBar) {
    char percent[8];
    std::snprintf(percent, sizeof percent, "%3.0f %%", 100.0 * std::clamp(progress, 0.0, 1.0));
    text = bar(progress) + " " + percent + "  " + text;
    // Spaces over what a longer text has left.
    if (text != shown_) {
      out_ << '\r' << text << std::string(shown_.size() > text.size() ? shown_.size() - text.size() : 0, ' ')
           << std::flush;
    }
  } else if (shown_.empty() || ended != shown_ended_) {
    out_ << text << std::endl;
  }
  shown_ = text;
  shown_ended_ = ended;
}

void ProgressView::finish() {
  if (form_ == Form::kBar && !shown_.empty()) out_ << std::endl;
}

std::string format_duration(double seconds) {
  const long whole = std::lround(std::max(seconds, 0.0));
  char text[32];
  if (whole >= 3600) {
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  } else if (whole >= 60) {
    std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld s", whole);
  }
  return text;
}

}  // namespace server::commands
