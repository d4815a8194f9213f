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

}  // namespace

Measurement read_measurement_npz(std::string_view archive, const ColumnQuery& query) {
  const std::vector<ZipEntry> entries = read_zip_directory(archive, kMostArchiveBytes);
  const std::vector<std::string> names = array_names(entries);
  check_has_time(names, query);
  ColumnChoice choice = choose_columns(names, query, [&](std::size_t i) { return array_place(names[i]); });
  std::vector<Fault> faults;
  std::size_t values = 0;
  const auto read = [&](std::size_t array) {
    std::vector<double> numbers = read_npy(unpack(entries[array]), names[array]);
    check_value_count(values += numbers.size());
    add_gap_faults(numbers, names[array], faults);
    return numbers;
  };
  MeasuredRun run;
  run.parameters = choice.parameters;
  run.time_s = read(choice.time);
  const std::string time = array_place(names[choice.time]);
  if (faults.empty())
    add_time_faults(
        run.time_s,
        [&](std::size_t k, const std::string& text) {
          return Fault{"", time + ", element " + std::to_string(k) + ": " + text};
        },
        {"", time + " has " + std::to_string(run.time_s.size()) + " samples; at least " +
                 std::to_string(kFewestMeasuredSamples) + " are needed"},
        faults);
  for (const std::size_t column : choice.columns) {
    run.columns.push_back(read(column));
    if (run.columns.back().size() != run.time_s.size())
      faults.push_back({"", array_place(names[column]) + " has " + std::to_string(run.columns.back().size()) +
                                " samples, but the time has " + std::to_string(run.time_s.size())});
  }
  throw_if_any(std::move(faults));
  return {.name = query.name, .channels = std::move(choice.channels), .runs = {std::move(run)}};
}

}  // namespace jobs
