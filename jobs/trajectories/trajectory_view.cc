// SPDX-License-Identifier: Apache-2.0
#include "jobs/trajectories/trajectory_view.h"

#include <algorithm>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/trajectories/decimate.h"

namespace jobs {
namespace {

constexpr std::size_t kSamplesAtATime = 4096;

/// Calls use(value) for each value of a column from its beginning, until that is false.
template <typename Use>
void visit(ColumnCursor& column, const Use& use) {
  std::vector<double> values;
  do {
    values.clear();
    column.append_next(kSamplesAtATime, values);
    for (const double value : values)
      if (!use(value)) return;
  } while (!values.empty());
}

/// Column of the samples between two, and of those only the ones that are kept.
class PartCursor final : public ColumnCursor {
 public:
  /// @param kept  of the samples from `begin` on; empty: all. Outlives this
  PartCursor(std::unique_ptr<ColumnCursor> all, std::size_t begin, std::size_t end,
             const std::vector<bool>& kept)
      : all_(std::move(all)), skip_(begin), end_(end - begin), kept_(kept) {}

  void append_next(std::size_t count, std::vector<double>& to) override {
    while (skip_ > 0) skip_ -= read(std::min(skip_, kSamplesAtATime));
    while (count > 0 && next_ < end_) {
      const std::size_t got = read(std::min({count, end_ - next_, kSamplesAtATime}));
      if (got == 0) return;
      for (const double value : values_) {
        if (!kept_.empty() && !kept_[next_++]) continue;
        if (kept_.empty()) ++next_;
        to.push_back(value);
        --count;
      }
    }
  }

 private:
  std::size_t read(std::size_t count) {
    values_.clear();
    all_->append_next(count, values_);
    return values_.size();
  }

  std::unique_ptr<ColumnCursor> all_;
  std::size_t skip_, end_;
  std::size_t next_ = 0;
  const std::vector<bool>& kept_;
  std::vector<double> values_;
};

std::string text_of_query(const TrajectoryQuery& query) {
  std::string text;
  for (const std::string& channel : query.channels) text += channel + ",";
  const auto add = [&](const char* name, const auto& value) {
    if (value) text += std::string(name) + std::to_string(std::bit_cast<std::uint64_t>(*value));
  };
  add(";from=", query.from);
  add(";to=", query.to);
  if (query.points) text += ";points=" + std::to_string(*query.points);
  return text;
}

}  // namespace

TrajectoryView::TrajectoryView(const StoredBytes& blob, TrajectoryQuery query)
    : query_(std::move(query)), packed_(blob) {
  check_query(query_, packed_.channels());
  packed_.select(wanted_channels(query_.channels));
  channels_ = packed_.channels();
  fingerprint_ = sha256_hex(text_of_query(query_) + "\n", packed_.checksums(blob));
}

void TrajectoryView::load(const StoredBytes& blob) {
  packed_.load(blob);
  end_ = packed_.samples();
  if (!channels_.empty()) cut_times();
  samples_ = end_ - begin_;
  if (query_.points && !channels_.empty() && samples_ > *query_.points) thin_out(*query_.points);
}

/// The time is the first channel, and grows.
void TrajectoryView::cut_times() {
  if (!query_.from && !query_.to) return;
  std::size_t before = 0;
  std::size_t until = 0;
  visit(*packed_.read_column(0), [&](double t) {
    if (query_.from && t < *query_.from) ++before;
    if (query_.to && t > *query_.to) return false;
    ++until;
    return true;
  });
  begin_ = before;
  end_ = std::max(before, until);
}

void TrajectoryView::thin_out(std::size_t points) {
  kept_.assign(samples_, false);
  kept_.front() = true;
  kept_.back() = true;
  for (const Stretch& stretch : stretches_of(samples_, channels_.size() - 1, points))
    if (channels_.size() == 1) kept_[stretch.begin] = true;  // the time alone
  for (std::size_t channel = 1; channel < channels_.size(); ++channel) keep_extremes(channel, points);
  samples_ = static_cast<std::size_t>(std::ranges::count(kept_, true));
}

void TrajectoryView::keep_extremes(std::size_t channel, std::size_t points) {
  const std::vector<bool> all;
  PartCursor column(packed_.read_column(channel), begin_, end_, all);
  std::vector<double> values;
  for (const Stretch& stretch : stretches_of(samples_, channels_.size() - 1, points)) {
    values.clear();
    column.append_next(stretch.end - stretch.begin, values);
    mark_extremes(values, stretch.begin, kept_);
  }
}

std::unique_ptr<ColumnCursor> TrajectoryView::read_column(std::size_t channel) const {
  return std::make_unique<PartCursor>(packed_.read_column(channel), begin_, end_, kept_);
}

engine::Trajectory TrajectoryView::read_all() const {
  engine::Trajectory trajectory{.channels = channels_, .columns = {}};
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    trajectory.columns.emplace_back().reserve(samples_);
    read_column(channel)->append_next(samples_, trajectory.columns.back());
  }
  return trajectory;
}

}  // namespace jobs
