#include "server/openapi/query_parameters.h"

#include <vector>

namespace server::openapi {

std::span<const QueryParameter> query_parameters() {
  static const std::vector<QueryParameter> parameters{
      {"state", "Only those in this state", ref("State")},
      {"limit", "How many at most", {{"type", "integer"}, {"minimum", 1}, {"maximum", 1000}, {"default", 50}}},
      {"cursor", "next_cursor of the page before; without it the newest", {{"type", "string"}}},
      {"format", "Instead of the Accept header", {{"type", "string"}, {"enum", {"json", "csv"}}}},
      {"channels", "These columns, after t_s; all if left out", {{"type", "array"}, {"minItems", 1}, {"items", {{"type", "string"}}}}},
      {"from", "Only samples from this time on, in s", {{"type", "number"}}},
      {"to", "Only samples up to this time, in s", {{"type", "number"}}},
  };
  return parameters;
}

}  // namespace server::openapi
