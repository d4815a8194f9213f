// SPDX-License-Identifier: Apache-2.0
#include "server/commands/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <ostream>

#include <unistd.h>

namespace server::commands {

namespace {

std::string bar(double part) {
  constexpr std::size_t kWidth = 30;
  const auto full = static_cast<std::size_t>(part * kWidth);
  char percent[8];
  std::snprintf(percent, sizeof percent, "%3d %%", static_cast<int>(100.0 * part));
  return "[" + std::string(full, '#') + std::string(kWidth - full, '.') + "] " + percent;
}

/// Numbers of a sweep's jobs.
struct Counts {
  explicit Counts(const nlohmann::json& counts)
      : total(counts.at("total")),
        ended(total - counts.at("queued").get<std::size_t>() - counts.at("running").get<std::size_t>()),
        succeeded(counts.at("succeeded")),
        failed(counts.at("failed")),
        cancelled(counts.at("cancelled")) {}

  /// Part of the jobs that has succeeded.
  [[nodiscard]] double part() const {
    return total == 0 ? 0.0 : static_cast<double>(succeeded) / static_cast<double>(total);
  }

  std::size_t total, ended, succeeded, failed, cancelled;
};

std::string describe(const Counts& counts, const nlohmann::json& sweep) {
  std::string text = std::to_string(counts.ended) + " of " + std::to_string(counts.total) + " jobs";
  if (counts.failed > 0) text += ", " + std::to_string(counts.failed) + " failed";
  if (counts.cancelled > 0) text += ", " + std::to_string(counts.cancelled) + " cancelled";
  const auto eta = sweep.value("eta_s", nlohmann::json());
  if (counts.ended < counts.total && eta.is_number())
    text += ", about " + format_duration(eta.get<double>()) + " left";
  return text;
}

/// The bar and as many of the running jobs as there is room for, below the line of the command.
std::vector<std::string> fit_into(const TerminalSize& size, const std::string& bar_line,
                                  const std::vector<std::string>& running) {
  constexpr std::size_t kMost = 10;
  std::vector<std::string> lines{clipped(bar_line, size.columns - 1)};
  const std::size_t room = std::min(kMost, size.rows > 2 ? size.rows - 2 : 0);
  for (std::size_t i = 0; i < std::min(room, running.size()); ++i)
    lines.push_back(clipped("  " + running[i], size.columns - 1));
  return lines;
}

}  // namespace

ProgressView ProgressView::on_standard_error() {
  return {std::cerr, isatty(STDERR_FILENO) != 0 ? Form::kBar : Form::kLines};
}

void ProgressView::show(const nlohmann::json& sweep, const std::vector<std::string>& running,
                        const TerminalSize& size) {
  const Counts counts(sweep.at("counts"));
  const std::string text = describe(counts, sweep);
  if (form_ == Form::kBar) {
    draw(fit_into(size, bar(counts.part()) + "  " + text, running));
  } else if (shown_.empty() || counts.ended != shown_ended_) {
    out_ << text << std::endl;
    shown_ = {text};
  }
  shown_ended_ = counts.ended;
}

void ProgressView::draw(const std::vector<std::string>& lines) {
  if (lines == shown_) return;
  out_ << '\r';
  if (shown_.size() > 1) out_ << "\x1b[" << shown_.size() - 1 << 'A';  // to the line of the bar
  for (std::size_t i = 0; i < lines.size(); ++i) out_ << (i == 0 ? "" : "\n") << lines[i] << "\x1b[K";
  out_ << "\x1b[J" << std::flush;  // clears what a longer text has left below
  shown_ = lines;
}

void ProgressView::finish() {
  if (form_ != Form::kBar || shown_.empty()) return;
  draw({shown_.front()});
  out_ << std::endl;
  shown_.clear();
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
