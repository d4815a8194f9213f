// SPDX-License-Identifier: Apache-2.0
#include "jobs/surrogate/surrogate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "jobs/base/errors.h"
#include "jobs/parameters/parameter_value.h"
#include "jobs/requests/axis.h"
#include "jobs/results/table_groups.h"
#include "jobs/surrogate/polynomial_chaos.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::size_t kFewestPoints = 6;
constexpr std::size_t kMostInputs = 8;
constexpr int kGrid = 33;  ///< values along each side of the surface

/// One input: what it may be, and how it lies in [-1, 1].
struct Input {
  std::string parameter;
  std::size_t column = 0;
  double from = 0.0, to = 0.0;
  bool logarithmic = false;

  [[nodiscard]] double to_unit(double value) const {
    const double part =
        logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
    return 2.0 * part - 1.0;
  }
  [[nodiscard]] double at(double part) const {
    return logarithmic ? from * std::pow(to / from, part) : std::lerp(from, to, part);
  }
};

/// The range or the list that the request gives of a parameter; null: neither.
json given_values_of(const json& request, const std::string& parameter) {
  const json over = request.value("design", json::object()).value("over", json::object());
  const json& given_in = over.contains(parameter) ? over
                      : request.contains("sweep") ? request.at("sweep")
                                                  : over;
  return given_in.value(parameter, json());
}

/// A range that the request gives is the input's; otherwise its values span it. Jobs of another linkage may
/// have none.
Input input_of(const json& request, const ResultTable& results, const std::string& parameter) {
  Input input{.parameter = parameter, .column = find_column(results, parameter, "")};
  const json given = given_values_of(request, parameter);
  input.logarithmic = given.is_object() && given.value("scale", "linear") == "log";
  std::vector<double> values;
  for (const auto& row : results.rows) {
    if (const auto value = number_in(row[input.column])) values.push_back(*value);
  }
  if (values.empty()) return input;
  const auto [least, most] = std::ranges::minmax(values);
  input.from = given.is_object() ? std::min(least, given.at("from").get<double>()) : least;
  input.to = given.is_object() ? std::max(most, given.at("to").get<double>()) : most;
  return input;
}

/// A point of one combination, the mean of its replicates.
struct Point {
  std::vector<double> coordinates;  ///< values of the inputs
  double value = 0.0;
};

/// None if the job has not all inputs.
std::optional<std::vector<double>> coordinates_of(const std::vector<json>& row,
                                                  const std::vector<Input>& inputs) {
  std::vector<double> coordinates;
  for (const Input& input : inputs) {
    const auto value = number_in(row[input.column]);
    if (!value) return std::nullopt;
    coordinates.push_back(*value);
  }
  return coordinates;
}

std::vector<Point> points_of(const ResultTable& results, const std::vector<std::size_t>& rows,
                             const std::vector<Input>& inputs, std::size_t metric) {
  std::map<std::vector<double>, std::pair<double, int>> sums;
  for (const std::size_t r : rows) {
    const auto value = number_in(results.rows[r][metric]);
    const auto coordinates = coordinates_of(results.rows[r], inputs);
    if (!value || !coordinates) continue;
    auto& [sum, count] = sums[*coordinates];
    sum += *value;
    ++count;
  }
  std::vector<Point> points;
  for (const auto& [coordinates, sum] : sums) points.push_back({coordinates, sum.first / sum.second});
  return points;
}

PolynomialChaos fit(const std::vector<Point>& points, const std::vector<Input>& inputs) {
  Eigen::MatrixXd unit_points(static_cast<Eigen::Index>(points.size()),
                              static_cast<Eigen::Index>(inputs.size()));
  Eigen::VectorXd response(unit_points.rows());
  for (Eigen::Index k = 0; k < unit_points.rows(); ++k) {
    const Point& point = points[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i < unit_points.cols(); ++i) {
      const auto input = static_cast<std::size_t>(i);
      unit_points(k, i) = inputs[input].to_unit(point.coordinates[input]);
    }
    response[k] = point.value;
  }
  return {unit_points, response};
}

std::vector<double> grid_of(const Input& input) {
  std::vector<double> values;
  for (int k = 0; k < kGrid; ++k) values.push_back(input.at(static_cast<double>(k) / (kGrid - 1)));
  return values;
}

/// A row of values for each value along y; one row if there is no y.
json surface_of(const PolynomialChaos& surrogate, std::size_t inputs, std::size_t x,
                std::optional<std::size_t> y) {
  json rows = json::array();
  std::vector<double> at(inputs, 0.0);
  for (int j = 0; j < (y ? kGrid : 1); ++j) {
    json row = json::array();
    if (y) at[*y] = 2.0 * j / (kGrid - 1) - 1.0;
    for (int i = 0; i < kGrid; ++i) {
      at[x] = 2.0 * i / (kGrid - 1) - 1.0;
      row.push_back(surrogate.predict(at));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

std::size_t find_input(const std::vector<Input>& inputs, const std::string& name,
                       const std::string& pointer) {
  const auto found = std::ranges::find(inputs, name, &Input::parameter);
  if (found != inputs.end()) return static_cast<std::size_t>(found - inputs.begin());
  std::vector<std::string_view> known;
  for (const Input& input : inputs) known.push_back(input.parameter);
  throw InvalidRequest(
      std::vector<Fault>{{pointer, "\"" + name + "\": " + describe_unknown_key(name, known)}});
}

/// Result of a combination without a surrogate: its points and its grids.
json unfitted_json(const std::vector<Point>& points, const std::vector<Input>& inputs, std::size_t x,
                   std::optional<std::size_t> y) {
  json made{{"points", points.size()}, {"degree", nullptr}, {"terms", nullptr},
            {"cross_validation_error", nullptr}, {"predicted_part", nullptr},
            {"x_values", grid_of(inputs[x])}, {"y_values", y ? json(grid_of(inputs[*y])) : json::array()},
            {"values", nullptr},
            {"at", json::array()}};
  for (const Point& point : points) {
    json at{{"value", point.value}, {"left_out_prediction", nullptr}};
    for (std::size_t i = 0; i < inputs.size(); ++i) at[inputs[i].parameter] = point.coordinates[i];
    made["at"].push_back(std::move(at));
  }
  return made;
}

json surface_json(const std::vector<Point>& points, const std::vector<Input>& inputs, std::size_t x,
                  std::optional<std::size_t> y) {
  json made = unfitted_json(points, inputs, x, y);
  if (points.size() < kFewestPoints) return made;
  const PolynomialChaos surrogate = fit(points, inputs);
  made.update({{"degree", surrogate.degree()}, {"terms", surrogate.terms()},
               {"cross_validation_error", surrogate.cross_validation_error()},
               {"predicted_part", surrogate.predicted_part()},
               {"values", surface_of(surrogate, inputs.size(), x, y)}});
  const Eigen::VectorXd& predictions = surrogate.left_out_predictions();
  for (std::size_t k = 0; k < points.size(); ++k)
    made["at"][k]["left_out_prediction"] = predictions[static_cast<Eigen::Index>(k)];
  return made;
}

}  // namespace

json make_surrogate(const json& sweep, const ResultTable& results, const SurrogateQuery& query) {
  const std::size_t metric = find_metric(results, query.metric);
  std::vector<Input> inputs;
  std::vector<std::size_t> others;
  std::vector<std::string> other_names;
  for (const json& path : sweep.at("axes")) {
    const auto name = path.get<std::string>();
    const Input input = is_numeric(name) ? input_of(sweep.at("request"), results, name) : Input{};
    if (input.from < input.to) {
      inputs.push_back(input);
    } else {
      others.push_back(find_column(results, name, ""));
      other_names.push_back(name);
    }
  }
  if (inputs.empty()) throw WrongState("the sweep varies no number, over which a surrogate could be made");
  if (inputs.size() > kMostInputs)
    throw WrongState("the sweep varies " + std::to_string(inputs.size()) +
                     " numbers; a surrogate is made over " + std::to_string(kMostInputs) + " at most");
  const std::size_t x = query.x.empty() ? 0 : find_input(inputs, query.x, "/x");
  std::optional<std::size_t> y;
  if (!query.y.empty()) y = find_input(inputs, query.y, "/y");
  else if (inputs.size() > 1) y = x == 0 ? 1 : 0;
  if (y == x) throw InvalidRequest(std::vector<Fault>{{"/y", "must be another input than x"}});
  json made{{"metric", query.metric}, {"x", inputs[x].parameter},
            {"y", y ? json(inputs[*y].parameter) : json()}, {"inputs", json::array()},
      {"surfaces", json::array()}};
  for (const Input& input : inputs) {
    made["inputs"].push_back({{"parameter", input.parameter}, {"from", input.from}, {"to", input.to},
        {"scale", input.logarithmic ? "log" : "linear"}, {"middle", input.at(0.5)}});
  }
  for (const RowGroup& group : group_rows(results, others)) {
    json surface = surface_json(points_of(results, group.rows, inputs, metric), inputs, x, y);
    surface["where"] = json::object();
    for (std::size_t i = 0; i < others.size(); ++i) surface["where"][other_names[i]] = group.values[i];
    made["surfaces"].push_back(std::move(surface));
  }
  return made;
}

}  // namespace jobs
