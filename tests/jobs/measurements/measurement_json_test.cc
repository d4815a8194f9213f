// SPDX-License-Identifier: Apache-2.0
// Measurements from JSON, their packed samples, and their description.

#include <bit>
#include <cmath>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/measurements/measurement_codec.h"
#include "jobs/measurements/measurement_json.h"
#include "jobs/measurements/read_measurement_json.h"
#include "jobs/trajectories/trajectory_codec.h"
#include "tests/jobs/measurements/measurement_support.h"
#include "tests/jobs/request_support.h"

namespace jobs_tests {
namespace {

using jobs::Measurement;
using nlohmann::json;

/// First fault of the request with a change; "pointer detail".
std::string first_measurement_fault(const json& patch) {
  json request = json_of(kMeasuredJson);
  request = request.patch(patch);
  const auto faults =
      faults_of([&] { static_cast<void>(jobs::read_measurement_json(request_of(request.dump()))); });
  return faults.empty() ? "" : faults.front().pointer + " " + faults.front().detail;
}

json replaced(const char* path, const json& value) {
  return json::array({{{"op", "add"}, {"path", path}, {"value", value}}});
}

json removed(const char* path) { return json::array({{{"op", "remove"}, {"path", path}}}); }

TEST(MeasurementJson, ReadsRunsChannelsAndCorrections) {
  const Measurement measured = jobs::read_measurement_json(request_of(kMeasuredJson));
  EXPECT_EQ(measured.name, "bench");
  ASSERT_EQ(measured.channels.size(), 2U);
  EXPECT_EQ(measured.channels[0].column, "acc");
  EXPECT_EQ(measured.channels[0].sign, -1.0);
  EXPECT_EQ(measured.channels[0].gain, 2.0);
  EXPECT_EQ(measured.channels[0].offset, 0.5);
  EXPECT_EQ(measured.channels[0].delay_s, 1e-4);
  EXPECT_EQ(measured.channels[0].low_pass_hz, 500.0);
  EXPECT_EQ(measured.channels[1].column, "crank_torque_n_m");
  EXPECT_FALSE(measured.channels[1].low_pass_hz.has_value());
  ASSERT_EQ(measured.runs.size(), 2U);
  EXPECT_EQ(measured.runs[0].parameters.at("clearance_mm"), 0.25);
  EXPECT_EQ(measured.runs[0].columns[1], (std::vector<double>{-2, 1e-3, 4}));
  EXPECT_TRUE(measured.runs[1].parameters.empty());
}

struct MeasurementRefusal {
  json patch;
  const char* fault;
};

TEST(MeasurementJson, RefusesWithAPointer) {
  const MeasurementRefusal refusals[] = {
      {replaced("/runs/0/parameters/clearance_mm", -1),
       "/runs/0/parameters/clearance_mm must be a number in"},
      {replaced("/runs/1/parameters", {{"clearence_mm", 1}}),
       "/runs/1/parameters/clearence_mm unknown key; did you mean clearance_mm?"},
      {replaced("/runs/0/parameters", 1), "/runs/0/parameters must be an object"},
      {replaced("/runs/0/parameters/linkage", {{"bodies", 1}}), "/runs/0/parameters/"},
      {replaced("/names", 1), "/names unknown key; did you mean name?"},
      {replaced("/name", 1), "/name must be a string"},
      {replaced("/channels", json::array()), "/channels must be a list of 1 to 200 items"},
      {removed("/channels"), "/channels must be a list of 1 to 200 items"},
      {replaced("/channels/0", 1), "/channels/0 must be an object"},
      {replaced("/channels/0/unit", "N"), "/channels/0/unit unknown key"},
      {replaced("/channels/0/name", "acc"), "/channels/0/name \"acc\" must end in a unit"},
      {removed("/channels/0/name"), "/channels/0/name must be a string"},
      {replaced("/channels/0/name", "crank_torque_n_m"),
       "/channels/1/name \"crank_torque_n_m\" stands twice"},
      {replaced("/channels/0/sign", 2), "/channels/0/sign must be 1 or -1"},
      {replaced("/channels/0/gain", 0), "/channels/0/gain must be a number in (0, "},
      {replaced("/channels/0/offset", "a"), "/channels/0/offset must be a number"},
      {replaced("/channels/0/delay_s", nullptr), "/channels/0/delay_s must be a number"},
      {replaced("/channels/0/low_pass_hz", -5), "/channels/0/low_pass_hz must be a number in (0, "},
      {replaced("/runs", json::object()), "/runs must be a list of 1 to 1000 items"},
      {replaced("/runs/0", json::array()), "/runs/0 must be an object"},
      {replaced("/runs/0/speed", 1), "/runs/0/speed unknown key; allowed: parameters, time_s, values"},
      {removed("/runs/0/time_s"), "/runs/0/time_s must be a list of numbers"},
      {replaced("/runs/1/time_s", {1}), "/runs/1/time_s must be a list of 2 numbers or more"},
      {replaced("/runs/0/time_s/1", 0), "/runs/0/time_s/1 the time must increase; 0 s follows 0 s"},
      {json::array({{{"op", "replace"}, {"path", "/runs/0/time_s/1"}, {"value", "0,001"}}}),
       "/runs/0/time_s/1 must be a number"},
      {removed("/runs/0/values"), "/runs/0/values must be an object with a list of numbers for each channel"},
      {replaced("/runs/0/values/force_n", {1, 2}),
       "/runs/0/values/force_n is no channel of this measurement"},
      {removed("/runs/0/values/crank_torque_n_m"),
       "/runs/0/values/crank_torque_n_m must be a list of numbers"},
      {removed("/runs/0/values/crank_torque_n_m/0"),
       "/runs/0/values/crank_torque_n_m has 2 numbers, but time_s has 3"},
      {json::array({{{"op", "replace"}, {"path", "/runs/0/values/crank_torque_n_m/1"}, {"value", nullptr}}}),
       "/runs/0/values/crank_torque_n_m/1 must be a number; gaps (NaN, empty cells) are not allowed"},
  };
  for (const auto& [patch, fault] : refusals) {
    const std::string first = first_measurement_fault(patch);
    EXPECT_EQ(first.substr(0, std::string(fault).size()), fault) << patch;
  }
  EXPECT_EQ(faults_of([] { static_cast<void>(jobs::read_measurement_json(request_of("[]"))); }).size(), 1U);
}

// Times that are no numbers have no order, whose fault would be a second one.
TEST(MeasurementJson, NamesAFaultOfTheTimeOnce) {
  for (const json& times : {json{0, nullptr, 0.2}, json(), json{0.1, "0.2", 0.3}}) {
    json request = json_of(kMeasuredJson);
    request["runs"][0]["time_s"] = times;
    EXPECT_EQ(faults_of([&] { static_cast<void>(jobs::read_measurement_json(request_of(request.dump()))); }).size(), 1U)
        << times;
  }
}

TEST(MeasurementJson, DescribesSamplesByClosedForms) {
  Measurement measured;
  measured.channels = {{.name = "force_n", .column = "f"}};
  measured.runs.emplace_back();
  constexpr int kPeriods = 4, kSamplesOfAPeriod = 100;
  for (int k = 0; k < kPeriods * kSamplesOfAPeriod; ++k) {
    measured.runs[0].time_s.push_back(0.5 + 0.01 * k);
    if (k == 0) measured.runs[0].columns.emplace_back();
    measured.runs[0].columns[0].push_back(3.0 *
                                          std::sin(2.0 * 3.14159265358979323846 * k / kSamplesOfAPeriod));
  }
  const json described = jobs::measurement_json(measured);
  EXPECT_EQ(described.at("samples"), 400);
  EXPECT_NEAR(described.at("duration_s").get<double>(), 3.99, 1e-12);
  EXPECT_EQ(described.at("channels").at(0).at("unit"), "N");
  const json& run = described.at("runs").at(0);
  EXPECT_NEAR(run.at("sampling").at("rate_hz").get<double>(), 100.0, 1e-9);
  EXPECT_NEAR(run.at("sampling").at("least_step_s").get<double>(), 0.01, 1e-12);
  const json& force = run.at("statistics").at(0);
  EXPECT_NEAR(force.at("max").get<double>(), 3.0, 1e-12);
  EXPECT_NEAR(force.at("min").get<double>(), -3.0, 1e-12);
  // Over whole periods the mean of sin² is 1/2; rounding of 400 terms.
  EXPECT_NEAR(force.at("rms").get<double>(), 3.0 / std::sqrt(2.0), 1e-12);
}

TEST(MeasurementJson, KeepsLargeNumbersFiniteInTheirRms) {
  Measurement measured;
  measured.channels = {{.name = "force_n", .column = "f"}};
  measured.runs = {{.time_s = {0, 1}, .columns = {{1e200, 1e200}}}};
  EXPECT_EQ(jobs::measurement_json(measured).at("runs").at(0).at("statistics").at(0).at("rms"), 1e200);
}

TEST(MeasurementCodec, GivesTheSameBitsAgain) {
  Measurement measured = jobs::read_measurement_json(request_of(kMeasuredJson));
  std::mt19937_64 random(7);
  for (auto& run : measured.runs) {
    run.time_s = {-1.0};
    run.columns.assign(2, {0.1});
    for (int k = 0; k < 5000; ++k) {
      run.time_s.push_back(run.time_s.back() + 1e-3 * static_cast<double>(1 + random() % 1000));
      for (auto& column : run.columns)
        column.push_back(std::bit_cast<double>((random() & 0x3fffffffffffffffULL)));
    }
  }
  const std::string blob = jobs::encode_samples(measured);
  Measurement read = jobs::measurement_of(json_of(jobs::measurement_json(measured).dump()));
  jobs::decode_samples(blob, read);
  ASSERT_EQ(read.runs.size(), 2U);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(read.runs[r].time_s, measured.runs[r].time_s);
    EXPECT_EQ(read.runs[r].columns, measured.runs[r].columns);
    EXPECT_EQ(read.runs[r].parameters, measured.runs[r].parameters);
  }
  EXPECT_EQ(read.channels[0].low_pass_hz, 500.0);
  EXPECT_EQ(read.channels[0].sign, -1.0);
}

TEST(MeasurementCodec, RefusesDamagedBlobs) {
  const Measurement measured = jobs::read_measurement_json(request_of(kMeasuredJson));
  const std::string blob = jobs::encode_samples(measured);
  for (std::size_t size = 0; size < blob.size(); ++size) {
    Measurement read = jobs::measurement_of(jobs::measurement_json(measured));
    EXPECT_THROW(jobs::decode_samples(blob.substr(0, size), read), jobs::DamagedTrajectory) << size;
  }
}

}  // namespace
}  // namespace jobs_tests
