// SPDX-License-Identifier: Apache-2.0
#include "jobs/measurements/read_measurement_npz.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "jobs/measurements/check_measurement.h"
#include "jobs/measurements/npy_array.h"
#include "jobs/measurements/zip_archive.h"

namespace jobs {
namespace {

constexpr std::string_view kNpySuffix = ".npy";
/// Numbers, and room for the headers.
constexpr std::size_t kMostArchiveBytes = kMostMeasuredValues * sizeof(double) + (std::size_t{1} << 20U);

std::string array_place(const std::string& name) { return "array " + quoted_text(name); }

/// Names of arrays. @throws InvalidRequest if an entry is none
std::vector<std::string> array_names(const std::vector<ZipEntry>& entries) {
  std::vector<std::string> names;
  for (const ZipEntry& entry : entries) {
    if (!entry.name.ends_with(kNpySuffix))
      refuse_body("the archive holds " + quoted_text(entry.name) + ", no array");
    names.push_back(entry.name.substr(0, entry.name.size() - kNpySuffix.size()));
  }
  if (names.empty()) refuse_body("the archive holds no array");
  return names;
}

/// Without a time by its name the first array of an archive is none: its order is often that of the alphabet.
void check_has_time(const std::vector<std::string>& names, const ColumnQuery& query) {
  if (!query.time.empty()) return;
  for (const char* const time : {kTimeColumn, kTrajectoryTime})
    if (std::ranges::find(names, time) != names.end()) return;
  refuse_body("the archive has no array time_s; time=ARRAY in the query names the array of the time");
}

void add_gap_faults(const std::vector<double>& numbers, const std::string& name, std::vector<Fault>& faults) {
  for (std::size_t k = 0; k < numbers.size() && faults.size() < kMostFileFaults; ++k)
    if (!std::isfinite(numbers[k]))
      faults.push_back(
          {"", array_place(name) + ", element " + std::to_string(k) + ": is not finite; " + kNoGaps});
}

/// Reads an archive array by array.
class NpzReader {
 public:
  NpzReader(std::string_view archive, const ColumnQuery& query)
      : query_(query),
        entries_(read_zip_directory(archive, kMostArchiveBytes)),
        names_(array_names(entries_)) {}

  Measurement read() {
    check_has_time(names_, query_);
    ColumnChoice choice =
        choose_columns(names_, query_, [this](std::size_t i) { return array_place(names_[i]); });
    run_.parameters = choice.parameters;
    read_time(choice.time);
    for (const std::size_t column : choice.columns) read_channel(column);
    throw_if_any(std::move(faults_));
    return {.name = query_.name, .channels = std::move(choice.channels), .runs = {std::move(run_)}};
  }

 private:
  std::vector<double> read_array(std::size_t array) {
    std::vector<double> numbers = read_npy(unpack(entries_[array]), names_[array]);
    check_value_count(values_ += numbers.size());
    add_gap_faults(numbers, names_[array], faults_);
    return numbers;
  }

  void read_time(std::size_t array) {
    run_.time_s = read_array(array);
    if (!faults_.empty()) return;
    const std::string time = array_place(names_[array]);
    add_time_faults(
        run_.time_s,
        [&](std::size_t k, const std::string& text) {
          return Fault{"", time + ", element " + std::to_string(k) + ": " + text};
        },
        {"", time + " has " + std::to_string(run_.time_s.size()) + " samples; at least " +
                 std::to_string(kFewestMeasuredSamples) + " are needed"},
        faults_);
  }

  void read_channel(std::size_t array) {
    run_.columns.push_back(read_array(array));
    if (run_.columns.back().size() != run_.time_s.size())
      faults_.push_back({"", array_place(names_[array]) + " has " +
                                 std::to_string(run_.columns.back().size()) +
                                 " samples, but the time has " + std::to_string(run_.time_s.size())});
  }

  const ColumnQuery& query_;
  const std::vector<ZipEntry> entries_;
  const std::vector<std::string> names_;
  MeasuredRun run_;
  std::size_t values_ = 0;  ///< read so far
  std::vector<Fault> faults_;
};

}  // namespace

Measurement read_measurement_npz(std::string_view archive, const ColumnQuery& query) {
  return NpzReader(archive, query).read();
}

}  // namespace jobs
