// SPDX-License-Identifier: Apache-2.0
#include "server/routes/measurement_routes.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/measurements/read_measurement_csv.h"
#include "jobs/measurements/read_measurement_json.h"
#include "jobs/measurements/read_measurement_npz.h"
#include "server/messages/conditional.h"
#include "server/messages/identifiers.h"
#include "server/messages/json_text.h"
#include "server/messages/problem.h"
#include "server/messages/query.h"
#include "server/routes/listing.h"
#include "server/routes/resource.h"
#include "server/routes/tables.h"
#include "server/routes/trajectory_answer.h"

namespace server {

namespace {

/// Values of a JSON body: each takes some 16 bytes beside its text.
constexpr std::size_t kMostMeasurementJsonValues = 4'000'000;

enum class MeasurementForm { kJson, kCsv, kNpz };

HttpError no_such_measurement(const std::string& id) { return {404, "there is no measurement " + id}; }

/// Form of a body from its media type. The media type that curl gives a body by default is taken for JSON.
/// @throws HttpError 415
MeasurementForm form_of(const std::string& content_type) {
  constexpr std::array<std::pair<std::string_view, MeasurementForm>, 6> kForms{
      {{"", MeasurementForm::kJson},
       {"application/json", MeasurementForm::kJson},
       {"application/x-www-form-urlencoded", MeasurementForm::kJson},
       {"text/csv", MeasurementForm::kCsv},
       {"application/octet-stream", MeasurementForm::kNpz},
       {"application/x-npz", MeasurementForm::kNpz}}};
  std::string media_type = content_type.substr(0, content_type.find_first_of("; \t"));
  std::ranges::transform(media_type, media_type.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto found = std::ranges::find(kForms, media_type, [](const auto& form) { return form.first; });
  if (found == kForms.end())
    throw HttpError(
        415,
        "a measurement is sent as application/json, text/csv, application/x-npz or application/octet-stream");
  return found->second;
}

/// Refuses the keys of CSV and NPZ beside a JSON body. @throws jobs::InvalidRequest
void refuse_column_keys(const Query& query) {
  query.check();
  std::vector<jobs::Fault> faults;
  for (const char* const key : {"name", "time", "channels", "sensors", "parameters"}) {
    if (query.text(key))
      faults.push_back({std::string("/") + key, "is for CSV and NPZ; a JSON body says it in itself"});
  }
  if (!faults.empty()) throw jobs::InvalidRequest(std::move(faults));
}

jobs::ColumnQuery read_column_query(Query& query) {
  return {.name = query.text("name").value_or(""),
          .time = query.text("time").value_or(""),
          .channels = query.list("channels"),
          .sensors = query.object("sensors"),
          .parameters = query.object("parameters")};
}

jobs::Measurement read_measurement(const Request& request) {
  const MeasurementForm form = form_of(request.content_type);
  Query query(request, {"name", "time", "channels", "sensors", "parameters"});
  if (form == MeasurementForm::kJson) {
    refuse_column_keys(query);
    return jobs::read_measurement_json(parse_json(request.body, kMostMeasurementJsonValues));
  }
  const jobs::ColumnQuery columns = read_column_query(query);
  return query.check_and([&] {
    return form == MeasurementForm::kCsv ? jobs::read_measurement_csv(request.body, columns)
                                         : jobs::read_measurement_npz(request.body, columns);
  });
}

}  // namespace

Response post_measurement(const RequestContext& context) {
  const std::string key = find_idempotency_key(context.request);
  const nlohmann::json created = context.service.submit_measurement(read_measurement(context.request), key);
  const std::string id = created.at("id");
  Response response = json_response(201, to_text(under_base_path(context.request, created)));
  response.headers.emplace_back("Location", context.request.base_path + "/v1/measurements/" + id);
  return response;
}

Response get_measurements(const RequestContext& context) {
  return json_response(200, to_text(list_stateless_page(context.request, [&](const jobs::PageQuery& page) {
                         return context.service.list_measurements(page);
                       })));
}

Response get_measurement(const RequestContext& context) {
  Query(context.request, {}).check();
  const auto found = context.service.find_measurement(context.id);
  if (!found) throw no_such_measurement(context.id);
  return with_etag(context.request, json_response(200, to_text(under_base_path(context.request, *found))));
}

Response get_measurement_data(const RequestContext& context) {
  Query query(context.request, {"run", "channels", "from", "to", "points", "format"});
  const TableFormat format = find_column_format(context.request, query);
  const jobs::TrajectoryQuery wanted = read_trajectory_query(query);
  const std::optional<std::size_t> run = query.count("run");
  auto response =
      answer_with_columns(context, query, wanted, format, "measurement-" + context.id,
                          [&](const auto& asked, const auto& is_wanted) {
                            return context.service.find_measurement_data(context.id, run, asked, is_wanted);
                          });
  if (!response) throw no_such_measurement(context.id);
  return std::move(*response);
}

Response delete_measurement(const RequestContext& context) {
  Query(context.request, {}).check();
  if (!context.service.delete_measurement(context.id)) throw no_such_measurement(context.id);
  return {.status = 204, .content_type = {}, .body = {}, .headers = {}};
}

}  // namespace server
