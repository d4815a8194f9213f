# SPDX-License-Identifier: Apache-2.0
# The tables of server/METRICS.md, from the OpenAPI document of a service:
#   curl -s http://127.0.0.1:8080/v1/openapi.json | jq -r -f script/quantity_table.jq
def row: "| `\(.value["x-name"] // .key)` | \(.value["x-symbol"] // "" | gsub("\\|"; "\\|")) | \(.value["x-unit"]) | \(.value.description | gsub("\\|"; "\\|")) |";
def table($title): "", "## \($title)", "", "| name | symbol | unit | definition |", "|---|---|---|---|", (to_entries[] | row);
.components.schemas
| .Metrics.anyOf[0].properties as $metrics | .Metrics.anyOf[1].patternProperties as $linkage_metrics
| .Trajectory.properties.columns as $columns
| ($metrics | table("Metrics of the RPSUP linkage")),
  ($columns.properties | with_entries(select(.key | startswith("pose_") or test("^ring_[2-9]") | not)) | table("Channels of the RPSUP linkage")),
  ($linkage_metrics | table("Metrics of described linkages")),
  ($columns.patternProperties | table("Channels of described linkages"))
