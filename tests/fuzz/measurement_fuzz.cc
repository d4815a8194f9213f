// SPDX-License-Identifier: Apache-2.0
// The bodies of POST /v1/measurements. The first byte says which: N of NPZ, J of JSON, else of CSV.

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/measurements/measurement_codec.h"
#include "jobs/measurements/read_measurement_csv.h"
#include "jobs/measurements/read_measurement_json.h"
#include "jobs/measurements/read_measurement_npz.h"
#include "server/messages/json_text.h"
#include "tests/fuzz/expect.h"

namespace {

jobs::Measurement read(char format, std::string_view body) {
  if (format == 'N') return jobs::read_measurement_npz(body, {});
  if (format == 'J') return jobs::read_measurement_json(server::parse_json(body));
  return jobs::read_measurement_csv(body, {});
}

bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::bit_cast<std::uint64_t>(a[k]) != std::bit_cast<std::uint64_t>(b[k])) return false;
  return true;
}

void check_run(const jobs::MeasuredRun& run, std::size_t channels) {
  fuzz::expect(run.time_s.size() >= jobs::kFewestMeasuredSamples, "a run has samples");
  for (std::size_t k = 1; k < run.time_s.size(); ++k)
    fuzz::expect(run.time_s[k] > run.time_s[k - 1], "the time increases");
  fuzz::expect(run.columns.size() == channels, "a run has a column for each channel");
  for (const std::vector<double>& column : run.columns) {
    fuzz::expect(column.size() == run.time_s.size(), "columns are as long as the time");
    for (const double value : column) fuzz::expect(std::isfinite(value), "values are finite");
  }
}

void check_stored(const jobs::Measurement& measurement) {
  const jobs::Measurement stored = jobs::unpack(jobs::pack(measurement));
  fuzz::expect(stored.runs.size() == measurement.runs.size(), "all runs are stored");
  for (std::size_t r = 0; r < stored.runs.size(); ++r) {
    const jobs::MeasuredRun &kept = stored.runs[r], &sent = measurement.runs[r];
    fuzz::expect(is_same(kept.time_s, sent.time_s), "times are stored as they were sent");
    for (std::size_t c = 0; c < sent.columns.size(); ++c)
      fuzz::expect(is_same(kept.columns[c], sent.columns[c]), "values are stored as they were sent");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view body(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const jobs::Measurement measurement = read(static_cast<char>(data[0]), body);
    fuzz::expect(!measurement.runs.empty(), "a measurement has a run");
    for (const jobs::MeasuredRun& run : measurement.runs) check_run(run, measurement.channels.size());
    check_stored(measurement);
  } catch (const server::BadJson&) {
  } catch (const jobs::InvalidRequest& invalid) {
    fuzz::expect(!invalid.faults().empty(), "a refusal names a fault");
    for (const jobs::Fault& fault : invalid.faults())
      fuzz::expect(!fault.detail.empty(), "a fault has a sentence");
  }
  return 0;
}
