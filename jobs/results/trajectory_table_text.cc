// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/trajectory_table_text.h"

#include <utility>
#include <vector>

#include "jobs/results/csv.h"
#include "jobs/results/resource_json.h"
#include "jobs/results/table_json.h"

namespace jobs {
namespace {

constexpr std::size_t kRowsAtATime = 512;
constexpr std::size_t kValuesAtATime = 8192;

/// Rows of all channels, whose columns are read beside one another.
class CsvText final : public TrajectoryText {
 public:
  explicit CsvText(TrajectoryView view) : view_(std::move(view)), block_(view_.channels().size()) {
    for (std::size_t c = 0; c < block_.size(); ++c) columns_.push_back(view_.read_column(c));
  }

  bool append_next(std::string& to) override {
    if (!std::exchange(has_head_, true)) {
      append_csv_head(to, view_.channels());
      return true;
    }
    for (std::size_t c = 0; c < block_.size(); ++c) {
      block_[c].clear();
      columns_[c]->append_next(kRowsAtATime, block_[c]);
    }
    const std::size_t rows = block_.empty() ? 0 : block_.front().size();
    for (std::size_t row = 0; row < rows; ++row) append_csv_row(to, block_, row);
    return rows > 0;
  }

 private:
  TrajectoryView view_;
  std::vector<std::unique_ptr<ColumnCursor>> columns_;
  std::vector<std::vector<double>> block_;  ///< one a channel
  bool has_head_ = false;
};

/// Columns one after the other.
class JsonText final : public TrajectoryText {
 public:
  explicit JsonText(TrajectoryView view) : view_(std::move(view)) {}

  bool append_next(std::string& to) override {
    const auto& channels = view_.channels();
    if (channel_ > channels.size()) return false;
    if (!column_ && channel_ == 0) append_json_channels(to, channels);
    if (channel_ == channels.size()) {
      to += "\n}}\n";
      ++channel_;
      return true;
    }
    const bool first = !column_;
    if (first) begin_column(to);
    append_values(first, to);
    return true;
  }

 private:
  void begin_column(std::string& to) {
    (to += channel_ == 0 ? "\n" : ",\n") += text_of(view_.channels()[channel_].key) + ":[";
    column_ = view_.read_column(channel_);
  }

  /// Appends the next values of the column, and its end behind the last.
  void append_values(bool first, std::string& to) {
    values_.clear();
    column_->append_next(kValuesAtATime, values_);
    for (const double value : values_) {
      if (!std::exchange(first, false)) to += ',';
      append_json_number(to, value);
    }
    if (values_.size() < kValuesAtATime) {
      to += ']';
      column_.reset();
      ++channel_;
    }
  }

  TrajectoryView view_;
  std::size_t channel_ = 0;
  std::unique_ptr<ColumnCursor> column_;  ///< of the channel; null: it has not begun
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<TrajectoryText> csv_text(TrajectoryView view) {
  return std::make_unique<CsvText>(std::move(view));
}

std::unique_ptr<TrajectoryText> json_text(TrajectoryView view) {
  return std::make_unique<JsonText>(std::move(view));
}

}  // namespace jobs
