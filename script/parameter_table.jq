# SPDX-License-Identifier: Apache-2.0
# The README's table of parameters, from the JSON Schema that GET /v1/parameters answers:
#   curl -s http://127.0.0.1:8080/v1/parameters | jq -r -f script/parameter_table.jq
def range:
  if .oneOf then "`rpsup`, or an object that describes another: [jobs/linkages/README.md](jobs/linkages/README.md)"
  elif .type == "array" and .items.type == "array" then "lists of \(.items.minItems) to \(.items.maxItems) depths, a list for each ring"
  elif .enum then (.enum | map("`\(.)`") | join(", "))
  else (if has("exclusiveMinimum") then "> \(.exclusiveMinimum)" elif has("minimum") then "≥ \(.minimum)" else "" end)
    + (if has("exclusiveMaximum") then ", < \(.exclusiveMaximum)" elif has("maximum") then ", ≤ \(.maximum)" else "" end)
  end;
def row($key): "| `\($key)` | \(if has("default") then .default | tojson | gsub("\""; "") else "–" end) | \(.["x-unit"] // "") | \(range) | \(.description) | \(.["x-default-source"] // "–") |";
"| parameter | default | unit | allowed | meaning | default from |",
"|---|---|---|---|---|---|",
(.properties | to_entries[] | select(.key != "links") | .key as $key | .value | row($key)),
(.properties.links.properties | to_entries[] | .key as $link | .value.properties | to_entries[]
  | "links.\($link).\(.key)" as $key | .value
  | if .type == "array" then .default as $d | .items as $i | . + $i | .default = $d else . end | row($key))
