// SPDX-License-Identifier: Apache-2.0
#include "jobs/results/measurement_resource.h"

#include "jobs/base/time_text.h"
#include "jobs/measurements/measurement_json.h"

namespace jobs {

nlohmann::json measurement_resource(const MeasurementRow& row, Detail detail) {
  nlohmann::json resource = stored_json(row.description);
  if (detail == Detail::kListing) resource.erase("runs");
  resource["id"] = row.id;
  resource["name"] = row.name;
  resource["created_at"] = time_text(row.created_ms);
  resource["bytes"] = row.bytes;
  const std::string self = "/v1/measurements/" + row.id;
  resource["links"] = {{"self", self}, {"data", self + "/data"}};
  return resource;
}

const std::vector<std::string>& measurement_listing_keys() {
  static const std::vector<std::string> keys = [] {
    MeasurementRow row;
    row.description = measurement_json({}).dump();
    return keys_of(measurement_resource(row, Detail::kListing));
  }();
  return keys;
}

}  // namespace jobs
