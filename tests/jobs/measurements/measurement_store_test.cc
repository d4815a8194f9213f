// SPDX-License-Identifier: Apache-2.0
// Measurements in a store, and by way of the service.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "jobs/base/errors.h"
#include "jobs/base/ids.h"
#include "jobs/measurements/read_measurement_csv.h"
#include "jobs/measurements/read_measurement_json.h"
#include "jobs/service.h"
#include "jobs/store/store.h"
#include "tests/jobs/measurements/measurement_support.h"
#include "tests/jobs/request_support.h"
#include "tests/jobs/service_support.h"
#include "tests/jobs/store/store_support.h"

namespace jobs_tests {
namespace {

jobs::Measurement sample_measurement() { return jobs::read_measurement_json(request_of(kMeasuredJson)); }

TEST(MeasurementStore, KeepsMeasurementsOverANewStart) {
  const TemporaryStore temporary;
  const jobs::Measurement measured = sample_measurement();
  std::string id;
  {
    jobs::Store store(temporary.file());
    id = store.measurements.add(jobs::pack(measured));
  }
  EXPECT_EQ(id.substr(0, 4), "mea_");
  jobs::Store store(temporary.file());
  const auto found = store.measurements.find(id).value();
  EXPECT_EQ(found.name, "bench");
  ASSERT_EQ(found.runs.size(), 2U);
  EXPECT_EQ(found.runs[0].parameters, measured.runs[0].parameters);
  EXPECT_EQ(found.runs[0].time_s, measured.runs[0].time_s);
  EXPECT_EQ(found.runs[0].columns, measured.runs[0].columns);
  EXPECT_EQ(found.runs[1].columns, measured.runs[1].columns);
  EXPECT_EQ(found.channels[0].offset, 0.5);
  EXPECT_FALSE(store.measurements.find("mea_none").has_value());
  EXPECT_TRUE(store.measurements.erase(id));
  EXPECT_FALSE(store.measurements.erase(id));
  EXPECT_FALSE(store.measurements.find(id).has_value());
}

TEST(MeasurementStore, KeepsWhatAStudyNeedsAndAddsNoStudyWithoutIt) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file());
  const std::string used = store.measurements.add(jobs::pack(sample_measurement()));
  const std::string other = store.measurements.add(jobs::pack(sample_measurement()));
  const auto add_fit = [&](const std::vector<std::string>& measurements) {
    nlohmann::json request;
    for (const std::string& id : measurements) request["measurements"].push_back({{"id", id}});
    return store.studies.add(jobs::kFitPrefix, stored_plan_of("{}"), "{}", request.dump(), 10, {},
                             measurements);
  };
  const std::string fit = add_fit({used});
  EXPECT_THROW((void)store.measurements.erase(used), jobs::WrongState);
  EXPECT_TRUE(store.measurements.find_row(used).has_value());
  EXPECT_TRUE(store.measurements.erase(other));
  EXPECT_EQ(pointers_of(faults_of([&] {
              (void)add_fit({used, other});
            })),
            std::vector<std::string>{"/measurements/1/id"});
  ASSERT_EQ(store.studies.list(jobs::kFitPrefix, "", "", 10).size(), 1U);
  EXPECT_EQ(store.studies.find(fit)->state, "running");
}

TEST(MeasurementStore, HasAQuota) {
  const TemporaryStore temporary;
  jobs::Store store(temporary.file(), {.most_bytes = 300'000});
  jobs::Measurement measured = sample_measurement();
  measured.runs.resize(1);
  auto& run = measured.runs[0];
  run.time_s.clear();
  run.columns.assign(2, {});
  for (int k = 0; k < 60'000; ++k) {  // sums of many terms have no short form
    run.time_s.push_back((k == 0 ? 0.0 : run.time_s.back()) + 1e-3 / (1 + k % 7));
    for (auto& column : run.columns) column.push_back(1.0 / (k + 3));
  }
  EXPECT_THROW(static_cast<void>(store.measurements.add(jobs::pack(measured))), jobs::StoreLimitReached);
  EXPECT_TRUE(store.measurements.list("", 10).empty());
}

TEST(MeasurementStore, TellsOfDamagedSamples) {
  const TemporaryStore temporary;
  std::string id;
  {
    jobs::Store store(temporary.file());
    id = store.measurements.add(jobs::pack(sample_measurement()));
  }
  execute_sql(temporary.file(), "UPDATE measurements SET data = substr(data, 1, 60)");
  jobs::Store store(temporary.file());
  EXPECT_THROW(static_cast<void>(store.measurements.find(id)), jobs::StorageError);
}

TEST(MeasurementService, ListsAndDescribesAndDeletes) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const auto first = service.submit_measurement(jobs::read_measurement_csv(kMeasuredCsv, {.name = "csv"}));
  const auto second = service.submit_measurement(sample_measurement());
  EXPECT_EQ(first.at("samples"), 3);
  EXPECT_EQ(first.at("duration_s"), 0.0025);
  EXPECT_EQ(second.at("runs").at(0).at("statistics").at(0).at("max"), 1.5);
  EXPECT_EQ(service.find_measurement(second.at("id")).value(), second);
  const auto page = service.list_measurements({.state = "", .limit = 1, .cursor = ""});
  ASSERT_EQ(page.at("items").size(), 1U);
  EXPECT_EQ(page.at("items").at(0).at("id"), second.at("id"));
  EXPECT_FALSE(page.at("items").at(0).contains("runs"));
  const auto next = service.list_measurements({.state = "", .limit = 1, .cursor = page.at("next_cursor")});
  EXPECT_EQ(next.at("items").at(0).at("id"), first.at("id"));
  EXPECT_TRUE(service.delete_measurement(first.at("id")));
  EXPECT_FALSE(service.delete_measurement(first.at("id")));
}

TEST(MeasurementService, GivesTheSamplesOfARun) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const std::string id = service.submit_measurement(sample_measurement()).at("id");
  const auto all = [](const std::string&) { return true; };
  const auto view = service.find_measurement_data(id, 1, {}, all).value();
  const engine::Trajectory run = view.read_all();
  EXPECT_EQ(run.channels[0].key, "t_s");
  EXPECT_EQ(run.columns[0], (std::vector<double>{1, 2}));
  EXPECT_EQ(run.columns[1], (std::vector<double>{3, 4}));
  for (const std::optional<std::size_t> number :
       {std::optional<std::size_t>(), std::optional<std::size_t>(2)})
    EXPECT_EQ(pointers_of(
                  faults_of([&] { static_cast<void>(service.find_measurement_data(id, number, {}, all)); })),
              std::vector<std::string>{"/run"});
  EXPECT_FALSE(service.find_measurement_data("mea_none", 0, {}, all).has_value());
}

TEST(MeasurementService, AnswersTheSameKeyWithTheSameMeasurement) {
  const TemporaryStore temporary;
  FakeEngine engine;
  jobs::Service service(options_of(temporary, engine, 1));
  const auto first = service.submit_measurement(sample_measurement(), "key");
  EXPECT_EQ(service.submit_measurement(sample_measurement(), "key"), first);
  EXPECT_EQ(service.list_measurements({}).at("items").size(), 1U);
  EXPECT_THROW(service.submit_measurement(jobs::read_measurement_csv(kMeasuredCsv, {}), "key"),
               jobs::InvalidRequest);
}

}  // namespace
}  // namespace jobs_tests
