// SPDX-License-Identifier: Apache-2.0
// Measurements of the service.

#include <span>
#include <utility>

#include "jobs/base/content_id.h"
#include "jobs/base/ids.h"
#include "jobs/measurements/measurement_codec.h"
#include "jobs/results/measurement_resource.h"
#include "jobs/results/page.h"
#include "jobs/service.h"
#include "jobs/store/store.h"
#include "jobs/trajectories/trajectory_codec.h"

namespace jobs {
namespace {

StoredBytes stored_bytes(std::string_view blob) {
  return {.size = blob.size(), .read_to = [blob](std::size_t offset, std::span<char> to) {
            blob.copy(to.data(), to.size(), offset);
          }};
}

/// Number of the run that is asked for. @throws InvalidRequest if there is none, or several without a number
std::size_t checked_run(std::optional<std::size_t> run, std::size_t runs) {
  if (!run && runs == 1) return 0;
  if (run && *run < runs) return *run;
  throw InvalidRequest(
      std::vector<Fault>{{"/run", "must be the number of a run, from 0 to " + std::to_string(runs - 1)}});
}

}  // namespace

using nlohmann::json;

json Service::submit_measurement(const Measurement& measurement, const std::string& key) {
  check_open();
  const PackedMeasurement packed = pack(measurement);
  const std::string fingerprint =
      "POST /v1/measurements " + sha256_hex(packed.name + "\n" + packed.description + "\n", packed.samples);
  return answer_once(key, fingerprint, [&](const IdempotentRequest& idempotency) {
    json response;
    const auto make_response = [&](const MeasurementRow& row) {
      return text_of(response = measurement_resource(row, Detail::kFull));
    };
    store_->measurements.add(packed, {idempotency.key, idempotency.fingerprint, make_response});
    return response;
  });
}

std::optional<json> Service::find_measurement(const std::string& id) const {
  const auto row = store_->measurements.find_row(id);
  return row ? std::optional(measurement_resource(*row, Detail::kFull)) : std::nullopt;
}

json Service::list_measurements(const PageQuery& query) const {
  const PageChecker checker(query, kMeasurementPrefix, measurement_listing_keys());
  return make_page(store_->measurements.list(query.cursor, query.limit + 1), query.limit, checker,
                   [](const MeasurementRow& row) { return measurement_resource(row, Detail::kListing); });
}

std::optional<TrajectoryView> Service::find_measurement_data(
    const std::string& id, std::optional<std::size_t> run, const TrajectoryQuery& query,
    const std::function<bool(const std::string&)>& wanted) const {
  const auto samples = store_->measurements.find_samples(id);
  if (!samples) return std::nullopt;
  try {
    const auto runs = split_runs(*samples);
    const StoredBytes blob = stored_bytes(runs[checked_run(run, runs.size())]);
    TrajectoryView view(blob, query);
    if (wanted(view.fingerprint())) view.load(blob);
    return view;
  } catch (const DamagedTrajectory& damage) {
    throw StorageError("the samples of " + id + " cannot be read: " + damage.what());
  }
}

bool Service::delete_measurement(const std::string& id) {
  if (!store_->measurements.erase(id)) return false;
  finish_deleting("measurement " + id);
  return true;
}

}  // namespace jobs
