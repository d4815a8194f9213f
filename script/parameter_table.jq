# SPDX-License-Identifier: Apache-2.0
# The tables of jobs/parameters/README.md, from the JSON Schema that GET /v1/parameters answers:
#   curl -s http://127.0.0.1:8080/v1/parameters | jq -r -f script/parameter_table.jq

# Subjects in the order of the document; a parameter belongs to the first subject whose pattern matches its key.
def subjects: [
  ["Linkage and gravity", "^(linkage|yoke_axis|gravity_.*|guide_.*|(coupler|crank|cross|rod)_length_m+)$"],
  ["Drives", "^(crank_drive|rod_drive|crank_velocity_rad_s|crank_start_rad|run_up_s|rod_(law|pause_s|start_m|stroke_mm|stroke_time_s)|drive|baumgarte_.*)$"],
  ["Clearance joint", "^(clearance_mm|axial_(clearance_mm|levels|elements)|bearing_.*|radial_.*|contact|wear_depth_um)$"],
  ["Normal force", "^(axial_stiffness_n_m|contact_.*|normal_law|restitution|stiffness_law|minimum_impact_velocity_m_s)$"],
  ["Friction", "^(friction.*|bristle_.*|break_away_ratio|stribeck_velocity_m_s)$"],
  ["Flexible links and material", "^(coupler|crank|cross|rod|rigid_elements|.*_(elements|damping_ratio|diameter_mm|modulus_pa))$"],
  ["Mass and inertia", "^links\\."],
  ["Run, integration and output", "^(duration_s|output_rate_hz|keep|integrator|step_s|.*_tolerance)$"]];
def subject_of($key): first(subjects[] | . as [$title, $pattern] | select($key | test($pattern)) | $title) // error("\($key) belongs to no subject");

# jq writes numbers as they stood in the JSON, 100.0, from 1.7 on, unless something is computed with them.
def plain: walk(if type == "number" then . + 0 else . end);

def range:
  if .oneOf and has("default") then "`rpsup`, or an object that describes another: [linkages](../linkages/README.md)"
  elif .oneOf then "an object with a `law` or an `actuator`: [laws](../linkages/README.md#joints), [actuators](../linkages/README.md#actuators-and-loads)"
  elif .type == "array" and .items.type == "array" then "lists of \(.items.minItems) to \(.items.maxItems) depths, a list for each ring"
  elif .enum then (.enum | map("`\(.)`") | join(", "))
  else (if has("exclusiveMinimum") then "> \(.exclusiveMinimum)" elif has("minimum") then "≥ \(.minimum)" else "" end)
    + (if has("exclusiveMaximum") then ", < \(.exclusiveMaximum)" elif has("maximum") then ", ≤ \(.maximum)" else "" end)
  end;
def row($key): "| `\($key)` | \(if has("default") then .default | tojson | gsub("\""; "") else "–" end) | \(.["x-unit"] // "") | \(range) | \(.description) | \(.["x-default-source"] // "–") |";

plain | [(.properties | to_entries[] | select(.key != "links") | .key as $key | .value | {key: $key, row: row($key)}),
 (.properties.links.properties | to_entries[] | .key as $link | .value.properties | to_entries[]
  | "links.\($link).\(.key)" as $key | .value
  | if .type == "array" then .default as $d | .items as $i | . + $i | .default = $d else . end | {key: $key, row: row($key)})]
| map(. + {subject: subject_of(.key)}) | . as $rows
| subjects[] | .[0] as $subject
| "### \($subject)", "", "| parameter | default | unit | allowed | meaning | default from |", "|---|---|---|---|---|---|",
  ($rows[] | select(.subject == $subject) | .row), ""
