// SPDX-License-Identifier: Apache-2.0
// Files with random changes are read, or refused as the user's fault; nothing else happens.

#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "jobs/measurements/read_measurement_csv.h"
#include "jobs/measurements/read_measurement_json.h"
#include "jobs/measurements/read_measurement_npz.h"
#include "tests/jobs/measurements/measurement_support.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

/// Text with one to four bytes changed, removed or added, or a part cut out or doubled.
std::string mutated(std::string text, std::mt19937_64& random) {
  constexpr std::string_view kTokens = ",;\"\n\r\t.-+e0x nN\xff";
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random() % (end + 1)); };
  for (std::size_t changes = 1 + below(3); changes > 0 && !text.empty(); --changes) {
    const std::size_t at = below(text.size() - 1);
    const std::size_t length = std::min(below(12), text.size() - at);
    switch (random() % 6) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text[at] = kTokens[random() % kTokens.size()];
        break;
      case 2:
        text[at] = static_cast<char>(text[at] ^ (1 << (random() % 8)));
        break;
      case 3:
        text.erase(at, length);
        break;
      case 4:
        text.insert(at, text.substr(at, length));
        break;
      default:
        text.insert(at, 1, kTokens[random() % kTokens.size()]);
    }
  }
  return text;
}

void check_holds(const jobs::Measurement& measured) {
  ASSERT_FALSE(measured.runs.empty());
  for (const jobs::MeasuredRun& run : measured.runs) {
    ASSERT_GE(run.time_s.size(), 2U);
    for (std::size_t k = 1; k < run.time_s.size(); ++k) ASSERT_GT(run.time_s[k], run.time_s[k - 1]);
    ASSERT_EQ(run.columns.size(), measured.channels.size());
    for (const auto& column : run.columns) {
      ASSERT_EQ(column.size(), run.time_s.size());
      for (const double x : column) ASSERT_TRUE(std::isfinite(x));
    }
  }
}

using ReadFile = std::function<jobs::Measurement(const std::string&)>;

/// Reads mutations of a file. Both outcomes must have been met.
void try_mutations(const std::string& file, const ReadFile& read, int rounds) {
  std::mt19937_64 random(20240607);
  int good = 0;
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::string text = mutated(file, random);
    try {
      check_holds(read(text));
      ++good;
    } catch (const jobs::InvalidRequest& invalid) {
      ASSERT_FALSE(invalid.faults().empty());
      ++refused;
    }
  }
  EXPECT_GT(good, 0);
  EXPECT_GT(refused, rounds / 10);
}

TEST(MeasurementMutations, OfCsvAreReadOrRefused) {
  try_mutations(
      kMeasuredCsv, [](const auto& text) { return jobs::read_measurement_csv(text, {}); }, 5'000);
}

TEST(MeasurementMutations, OfNpzAreReadOrRefused) {
  for (const Packing packing : {Packing::kStored, Packing::kDeflated})
    try_mutations(
        measured_npz(packing), [](const auto& text) { return jobs::read_measurement_npz(text, {}); }, 5'000);
}

TEST(MeasurementMutations, OfJsonAreReadOrRefused) {
  const auto read = [](const std::string& text) {
    const auto request = nlohmann::ordered_json::parse(text, nullptr, false);
    if (request.is_discarded()) throw jobs::InvalidRequest(std::vector<jobs::Fault>{{"", "no JSON"}});
    return jobs::read_measurement_json(request);
  };
  try_mutations(kMeasuredJson, read, 5'000);
}

}  // namespace
}  // namespace jobs_tests
