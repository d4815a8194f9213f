// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_fields.h"

#include <algorithm>
#include <string>
#include <utility>

#include "engine/model/rpsup_parameters.h"
#include "jobs/parameters/parameter_table.h"
#include "jobs/parameters/parameter_value.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr Range kLength = between(-1000, 1000);
constexpr Range kAngle = between(-360, 360);
constexpr Range kTime = between(0, 3600);
constexpr Range kCoefficients = between(-1e9, 1e9);

constexpr std::size_t kLongestText = 100;

const std::vector<std::string_view> kAxisNames{"x", "y", "z"};

std::string points_text(const LinkageField& field, std::string_view count) {
  return "must be a list of " + std::string(count) + " numbers, each " + field.range.text() +
      (field.unit.empty() ? "" : " " + std::string(field.unit));
}

std::string describe_list_fault(const LinkageField& field, const json& value) {
  const std::size_t size = value.is_array() ? value.size() : 0;
  const auto fault_unless = [&](bool fits, const std::string& count) -> std::string {
    const bool numbers = fits && std::ranges::all_of(value, [&](const json& x) {
                           return x.is_number() && field.range.contains(x.get<double>());
                         });
    return numbers ? "" : points_text(field, count);
  };
  if (field.kind == FieldKind::kPoint) return fault_unless(size == 3, "three");
  if (field.kind == FieldKind::kInertia) return fault_unless(size == 3 || size == 6, "three or six");
  return fault_unless(size >= field.fewest && size <= kMostNumbers,
                      std::to_string(field.fewest) + " to 10,000");
}

std::string describe_word_fault(const LinkageField& field, const json& value) {
  if (value.is_string() &&
      std::ranges::find(field.words, value.get_ref<const std::string&>()) != field.words.end())
    return "";
  std::string text = "must be one of ";
  for (std::size_t i = 0; i < field.words.size(); ++i)
    text.append(i > 0 ? ", \"" : "\"").append(field.words[i]).append("\"");
  return text;
}

std::string describe_field_fault(const LinkageField& field, const json& value) {
  switch (field.kind) {
    case FieldKind::kNumber: return describe_number_fault(field.range, field.unit, value);
    case FieldKind::kInteger: return describe_integer_fault(field.range, value);
    case FieldKind::kBoolean: return value.is_boolean() ? "" : "must be true or false";
    case FieldKind::kText:
      return value.is_string() && value.get_ref<const std::string&>().size() <= kLongestText
                 ? ""
                 : "must be a string of at most 100 bytes";
    case FieldKind::kWord: return describe_word_fault(field, value);
    case FieldKind::kBody: return value.is_string() ? "" : "must be the name of a body";
    case FieldKind::kPoint:
    case FieldKind::kInertia:
    case FieldKind::kNumbers: return describe_list_fault(field, value);
    case FieldKind::kObject: return value.is_object() ? "" : "must be an object";
    case FieldKind::kEffort:
      if (value.is_object()) return "";
      return value.is_number() ? describe_number_fault(field.range, field.unit, value)
                               : "must be a number or an object with a law";
  }
  return "";
}

json number_schema(const LinkageField& field) {
  json schema{{"type", field.kind == FieldKind::kInteger ? "integer" : "number"}};
  schema[field.range.lower == Bound::kInclusive ? "minimum" : "exclusiveMinimum"] = field.range.minimum;
  schema[field.range.upper == Bound::kInclusive ? "maximum" : "exclusiveMaximum"] = field.range.maximum;
  return schema;
}

json schema_of_field(const LinkageField& field) {
  json schema;
  switch (field.kind) {
    case FieldKind::kNumber:
    case FieldKind::kInteger: schema = number_schema(field); break;
    case FieldKind::kBoolean: schema = {{"type", "boolean"}}; break;
    case FieldKind::kWord: schema = {{"type", "string"}, {"enum", field.words}}; break;
    case FieldKind::kText: schema = {{"type", "string"}, {"maxLength", kLongestText}}; break;
    case FieldKind::kBody: schema = {{"type", "string"}}; break;
    case FieldKind::kPoint: schema = {{"type", "array"}, {"minItems", 3}, {"maxItems", 3},
                                      {"items", number_schema(field)}}; break;
    case FieldKind::kInertia: schema = {{"type", "array"}, {"minItems", 3}, {"maxItems", 6},
                                        {"not", {{"minItems", 4}, {"maxItems", 5}}},
                                        {"items", number_schema(field)}}; break;
    case FieldKind::kNumbers: schema = {{"type", "array"}, {"minItems", field.fewest},
                                        {"maxItems", kMostNumbers}, {"items", number_schema(field)}}; break;
    case FieldKind::kObject: schema = {{"type", "object"}}; break;
    case FieldKind::kEffort: schema = {{"anyOf", {number_schema(field), {{"type", "object"}}}}}; break;
  }
  schema["description"] = field.help;
  if (!field.unit.empty()) schema["x-unit"] = field.unit;
  return schema;
}

/// The value of a coordinate that slides, in m, or turns, in rad.
LinkageField motion_field(engine::Motion motion, std::string_view in_metres, std::string_view in_radians,
                          std::string_view help, bool required, Range range) {
  return {.key = slides(motion) ? in_metres : in_radians,
          .range = range,
          .unit = slides(motion) ? "m" : "rad",
          .help = help,
          .required = required};
}

}  // namespace

const LinkageFields& linkage_fields() {
  static const LinkageFields fields{
      {.key = "name", .kind = FieldKind::kText, .help = "What the linkage is called"},
      {.key = "bodies", .kind = FieldKind::kObject, .help = "The bodies by their names", .required = true},
      {.key = "joints", .kind = FieldKind::kObject, .help = "The joints by their names", .required = true},
      {.key = "springs", .kind = FieldKind::kObject,
       .help = "Springs and dampers between points of two bodies, by their names"},
      {.key = "loads", .kind = FieldKind::kObject, .help = "Forces and moments on bodies, by their names"},
      {.key = "accelerometers",
       .kind = FieldKind::kObject,
       .help = "Accelerometers on bodies, by their names"},
      {.key = "ground_acceleration_m_s2", .kind = FieldKind::kObject,
       .help = "Acceleration of the ground along x, y and z, as of a shaker or a vehicle; positions are "
               "seen from the ground"},
      {.key = "gravity_m_s2", .kind = FieldKind::kPoint, .range = between(-1000, 1000), .unit = "m/s^2",
       .help = "Acceleration of gravity; without it (0, -gravity_m_s2, 0)"},
  };
  return fields;
}

const LinkageFields& body_fields() {
  static const LinkageFields fields{
      {.key = "mass_kg", .range = between(0, 1e6), .unit = "kg", .help = "Mass; 0: none", .required = true},
      {.key = "centre_of_mass_m",
       .kind = FieldKind::kPoint,
       .range = kLength,
       .unit = "m",
       .help = "In the body's frame; without it its origin"},
      {.key = "inertia_kg_m2",
       .kind = FieldKind::kInertia,
       .range = between(-1e9, 1e9),
       .unit = "kg m^2",
       .help = "(xx, yy, zz) or (xx, yy, zz, xy, xz, yz) about the centre of mass, along the body's axes: "
               "elements of the inertia tensor, xy = -integral of x y dm, the negative of the product of "
               "inertia of other conventions; without it none: a point"},
      {.key = "inertia_about_origin_kg_m2",
       .kind = FieldKind::kInertia,
       .range = between(-1e9, 1e9),
       .unit = "kg m^2",
       .help = "The same about the origin of the body's frame, instead"},
      {.key = "beam",
       .kind = FieldKind::kObject,
       .help = "The body is a straight flexible beam along its x axis, from its frame's origin"},
  };
  return fields;
}

const LinkageFields& beam_fields() {
  static const std::string damping_help =
      "Of the first bending mode of the beam pinned at both ends; without it " +
      readable_number(engine::RpsupParameters{}.coupler_damping_ratio);
  static const LinkageFields fields{
      {.key = "length_m", .range = between(1e-3, 1000), .unit = "m", .help = "Length", .required = true},
      {.key = "diameter_mm", .range = above(0, 10'000), .unit = "mm", .help = "Of a round section, outside"},
      {.key = "inner_diameter_mm", .range = between(0, 10'000), .unit = "mm",
       .help = "Of a round section that is a tube"},
      {.key = "height_mm", .range = above(0, 10'000), .unit = "mm",
       .help = "Of a rectangular section, along y"},
      {.key = "width_mm", .range = above(0, 10'000), .unit = "mm",
       .help = "Of a rectangular section, along z"},
      {.key = "axial_inertia_kg_m2", .range = above(0, 1e9), .unit = "kg m^2",
       .help = "Moment of the mass about the beam's axis; without it that of the section"},
      {.key = "elements", .kind = FieldKind::kInteger, .range = between(1, 64),
       .help = "Rigid elements; 1: the beam is rigid; without it rigid_elements of the job"},
      {.key = "youngs_modulus_pa", .range = between(1e5, 1e13), .unit = "Pa",
       .help = "Without it that of the job"},
      {.key = "shear_modulus_pa", .range = between(1e5, 1e13), .unit = "Pa",
       .help = "Without it that of the job"},
      {.key = "damping_ratio", .range = between(0, 10), .help = damping_help},
  };
  return fields;
}

const LinkageFields& joint_fields() {
  static const LinkageFields fields{
      {.key = "kind",
       .kind = FieldKind::kWord,
       .help = "What the joint lets its second body do",
       .required = true,
       .words = {"revolute", "prismatic", "cylindrical", "screw", "universal", "spherical", "planar", "free",
                 "weld"}},
      {.key = "from",
       .kind = FieldKind::kBody,
       .help = "First body; \"ground\" is the fixed frame",
       .required = true},
      {.key = "to",
       .kind = FieldKind::kBody,
       .help = "Second body, whose frame is that of the joint unless the joint closes a loop",
       .required = true},
      {.key = "at_m",
       .kind = FieldKind::kPoint,
       .range = kLength,
       .unit = "m",
       .help = "Place in the first body's frame; without it its origin"},
      {.key = "turned_deg",
       .kind = FieldKind::kPoint,
       .range = kAngle,
       .unit = "deg",
       .help = "How the joint's frame is turned in it: R_z(c) R_y(b) R_x(a) of (a, b, c)"},
      {.key = "axis",
       .kind = FieldKind::kWord,
       .help = "Axis of the joint's frame; without it z",
       .words = kAxisNames},
      {.key = "second_axis",
       .kind = FieldKind::kWord,
       .help = "Second axis of a universal joint; without it y",
       .words = kAxisNames},
      {.key = "lead_mm",
       .range = between(-10'000, 10'000),
       .unit = "mm",
       .help = "How far a screw slides in one turn"},
      {.key = "closes_loop",
       .kind = FieldKind::kBoolean,
       .help = "True: both bodies are carried by other joints"},
      {.key = "to_at_m",
       .kind = FieldKind::kPoint,
       .range = kLength,
       .unit = "m",
       .help = "Of a joint that closes a loop: place in the second body's frame"},
      {.key = "to_turned_deg",
       .kind = FieldKind::kPoint,
       .range = kAngle,
       .unit = "deg",
       .help = "Of a joint that closes a loop: how its frame is turned in the second body's"},
      {.key = "clearance",
       .kind = FieldKind::kObject,
       .help = "Of a revolute, prismatic, cylindrical, universal or spherical joint: it has clearance, as "
               "the job's own parameters say, save those that stand here"},
      {.key = "cross",
       .kind = FieldKind::kObject,
       .help = "Of a universal joint with clearance: the body between its two axes"},
      {.key = "freedoms",
       .kind = FieldKind::kObject,
       .help = "Of a joint of several freedoms: slide and turn of a cylindrical or screw joint, first and "
               "second of a universal one, z, y and x of a "
               "spherical one, x, y and turn of a planar one, x, y, z, turn_z, turn_y and turn_x of a free "
               "one; with clearance slide_x, slide_y, slide_z, turn_x, turn_y and turn_z beside those of the "
               "kind"},
  };
  return fields;
}

const LinkageFields& spring_fields() {
  constexpr Range kNotNegative = between(0, 1e12);
  static const LinkageFields fields{
      {.key = "from", .kind = FieldKind::kBody, .help = "First body; \"ground\" is the fixed frame",
       .required = true},
      {.key = "to", .kind = FieldKind::kBody, .help = "Second body, another one", .required = true},
      {.key = "at_m", .kind = FieldKind::kPoint, .range = kLength, .unit = "m",
       .help = "Its end on the first body, in the body's frame; without it 0"},
      {.key = "to_at_m", .kind = FieldKind::kPoint, .range = kLength, .unit = "m",
       .help = "Its end on the second body, in the body's frame; without it 0"},
      {.key = "stiffness_n_m", .range = kNotNegative, .unit = "N/m", .help = "Of the spring; without it 0"},
      {.key = "damping_n_s_m", .range = kNotNegative, .unit = "N s/m",
       .help = "Of the damper, along the spring; without it 0"},
      {.key = "drag_n_s_m", .range = kNotNegative, .unit = "N s/m",
       .help = "Against the velocity of its end on a body, whichever way, if the other is on the ground; "
               "without it 0"},
      {.key = "free_length_m", .range = between(0, 1000), .unit = "m",
       .help = "At which the spring is unloaded; without it the distance of its ends at t = 0"},
  };
  return fields;
}

const LinkageFields& accelerometer_fields() {
  static const LinkageFields fields{
      {.key = "body", .kind = FieldKind::kBody, .help = "The body on which it sits", .required = true},
      {.key = "at_m", .kind = FieldKind::kPoint, .range = kLength, .unit = "m",
       .help = "Where it sits, in the body's frame; without it 0"},
      {.key = "direction", .kind = FieldKind::kPoint, .range = between(-1e6, 1e6),
       .help = "Along which it measures, of any length", .required = true},
      {.key = "follows_body", .kind = FieldKind::kBoolean,
       .help = "Whether the direction turns with the body, the default; else it is the ground's"},
      {.key = "shows_gravity", .kind = FieldKind::kBoolean,
       .help = "Whether it shows the acceleration less that of gravity, as a sensor does, the default"},
  };
  return fields;
}

LinkageFields freedom_fields(engine::Motion motion) {
  constexpr Range kAny = between(-1e6, 1e6);
  constexpr Range kPositive = between(0, 1e12);
  return {
      motion_field(motion, "start_m", "start_rad",
                   "Where the coordinate is at t = 0; without it the loops decide", false, kAny),
      {.key = slides(motion) ? "start_rate_m_s" : "start_rate_rad_s",
       .range = kAny,
       .unit = slides(motion) ? "m/s" : "rad/s",
       .help = "Its rate at t = 0; without it the loops decide, and where they leave it free it is 0"},
      motion_field(motion, "guess_m", "guess_rad",
                   "Where closing the loops begins to look for it; without it 0", false, kAny),
      {.key = slides(motion) ? "stiffness_n_m" : "stiffness_n_m_rad",
       .range = kPositive,
       .unit = slides(motion) ? "N/m" : "N m/rad",
       .help = "Of a spring that is unloaded at 0"},
      {.key = slides(motion) ? "damping_n_s_m" : "damping_n_m_s_rad",
       .range = kPositive,
       .unit = slides(motion) ? "N s/m" : "N m s/rad",
       .help = "Of a damper"},
      {.key = "drive",
       .kind = FieldKind::kObject,
       .help = "The law by which the coordinate moves, or the actuator that moves it; without it it is free"},
      {.key = slides(motion) ? "load_n" : "load_n_m",
       .kind = FieldKind::kEffort,
       .range = between(-1e9, 1e9),
       .unit = slides(motion) ? "N" : "N m",
       .help = slides(motion) ? "A force along the coordinate on the second body, and its reaction on the "
                                "first: a number, or a law"
                              : "A torque about the axis on the second body, and its reaction on the first: "
                                "a number, or a law"},
      {.key = "friction",
       .kind = FieldKind::kObject,
       .help = "Dry friction in the joint, as the job's own parameters say, save those that stand here"},
  };
}

LinkageFields drive_fields(engine::Motion motion, std::string_view law) {
  constexpr Range kAny = between(-1e6, 1e6);
  LinkageFields fields{{.key = "law", .kind = FieldKind::kWord, .help = "Kind of motion", .required = true,
                        .words = {std::begin(kLaws), std::end(kLaws)}}};
  const auto add = [&](LinkageField field) { fields.push_back(std::move(field)); };
  if (law == "run_up") {
    add({.key = slides(motion) ? "velocity_m_s" : "velocity_rad_s", .range = kAny,
         .unit = slides(motion) ? "m/s" : "rad/s",
         .help = "Reached by the cycloidal law, then kept", .required = true});
    add({.key = "time_s", .range = kTime, .unit = "s",
         .help = "In which it is reached, 0 or at least 1e-6; without it run_up_s of the job, 0: from the "
                 "start"});
    add(motion_field(motion, "from_m", "from_rad", "Position at t = 0; without it 0", false, kAny));
  } else if (law == "rise_return_pause") {
    add(motion_field(motion, "stroke_m", "stroke_rad", "Length of the rise, and of the return", true, kAny));
    add({.key = "stroke_time_s", .range = between(1e-3, 3600), .unit = "s",
         .help = "Of the rise, and of the return", .required = true});
    add({.key = "pause_s", .range = kTime, .unit = "s", .help = "After each return; without it 0"});
    add({.key = "stroke_law",
         .kind = FieldKind::kWord,
         .help = "Law of the rise and of the return; without it cycloidal. cosine: harmonic motion; "
                 "parabolic: constant acceleration and deceleration",
         .words = {"cycloidal", "cosine", "parabolic"}});
    add(motion_field(motion, "from_m", "from_rad", "Position in the pause; without it 0", false, kAny));
  } else if (law == "cycloidal") {
    add(motion_field(motion, "from_m", "from_rad", "Where it begins; without it 0", false, kAny));
    add(motion_field(motion, "rise_m", "rise_rad", "How far it goes", true, kAny));
    add({.key = "begin_s", .range = kTime, .unit = "s", .help = "When it begins; without it 0"});
    add({.key = "time_s", .range = between(1e-3, 3600), .unit = "s", .help = "How long it takes",
         .required = true});
  } else if (law == "harmonic") {
    add(motion_field(motion, "mean_m", "mean_rad", "Without it 0", false, kAny));
    add(motion_field(motion, "amplitude_m", "amplitude_rad", "Of the sine", true, kAny));
    add({.key = "frequency_hz", .range = above(0, 1e5), .unit = "Hz", .help = "Of the sine",
         .required = true});
    add({.key = "phase_rad", .range = kAny, .unit = "rad", .help = "Of the sine; without it 0"});
  } else if (law == "polynomial") {
    const auto [key, former_key] = coefficient_keys(motion);
    const std::string_view unit = slides(motion) ? "m/s^k" : "rad/s^k";
    add({.key = key, .kind = FieldKind::kNumbers, .range = kCoefficients, .unit = unit,
         .help = "c_0, c_1, ... of the coordinate itself, c_0 + c_1 t + c_2 t^2 + ...: the element of index "
                 "k in the unit of the coordinate by s^k",
         .required = true});
    add({.key = former_key, .kind = FieldKind::kNumbers, .range = kCoefficients, .unit = unit,
         .help = slides(motion) ? "Former name of coefficients_m, with the same meaning"
                                : "Former name of coefficients_rad, with the same meaning"});
  } else if (law == "table") {
    add({.key = "times_s", .kind = FieldKind::kNumbers, .range = between(-3600, 7200), .unit = "s",
         .help = "Rising by 1e-6 s or more; 2 to 10,000", .required = true, .fewest = 2});
    add({.key = slides(motion) ? "values_m" : "values_rad",
         .kind = FieldKind::kNumbers,
         .range = kAny,
         .unit = slides(motion) ? "m" : "rad",
         .help = "One for each time; between them the natural cubic spline, outside straight on",
         .required = true, .fewest = 2});
  } else if (law == "velocity_table") {
    add({.key = "times_s", .kind = FieldKind::kNumbers, .range = between(-3600, 7200), .unit = "s",
         .help = "Rising by 1e-6 s or more; 2 to 10,000", .required = true, .fewest = 2});
    add({.key = slides(motion) ? "velocities_m_s" : "velocities_rad_s",
         .kind = FieldKind::kNumbers,
         .range = kAny,
         .unit = slides(motion) ? "m/s" : "rad/s",
         .help = "One for each time; constant before the first and after the last. The position is their "
                 "exact integral",
         .required = true, .fewest = 2});
    add({.key = "interpolation",
         .kind = FieldKind::kWord,
         .help = "Between the times; without it monotone_cubic, which has no extremes between them; linear: "
                 "the acceleration jumps at each",
         .words = {"linear", "monotone_cubic"}});
    add(motion_field(motion, "from_m", "from_rad", "Position at t = 0; without it 0", false, kAny));
  }
  return fields;
}

CoefficientKeys coefficient_keys(engine::Motion motion) {
  return slides(motion) ? CoefficientKeys{"coefficients_m", "coefficients_m_s"}
                        : CoefficientKeys{"coefficients_rad", "coefficients_rad_s"};
}

const LinkageFields& clearance_fields() {
  static const LinkageFields fields = [] {
    LinkageFields made;
    for (const ParameterInfo& info : parameter_table()) {
      if (info.scope != ParameterScope::kJoint && info.scope != ParameterScope::kMaterial) continue;
      const FieldKind kind = info.kind == ParameterKind::kChoice    ? FieldKind::kWord
                             : info.kind == ParameterKind::kInteger ? FieldKind::kInteger
                                                                    : FieldKind::kNumber;
      made.push_back({.key = info.key, .kind = kind, .range = info.range, .unit = info.unit,
                      .help = info.help, .words = info.choices});
    }
    return made;
  }();
  return fields;
}

void check_fields(const json& object, const LinkageFields& fields, const std::string& pointer,
                  std::vector<Fault>& faults) {
  std::vector<std::string_view> known;
  for (const LinkageField& field : fields) {
    known.push_back(field.key);
    if (field.required && !object.contains(field.key))
      faults.push_back({pointer + pointer_token(field.key), "is missing"});
  }
  for (const auto& [key, value] : object.items()) {
    const auto field = std::ranges::find(fields, key, &LinkageField::key);
    std::string detail =
        field == fields.end() ? describe_unknown_key(key, known) : describe_field_fault(*field, value);
    if (!detail.empty()) faults.push_back({pointer + pointer_token(key), std::move(detail)});
  }
}

json schema_of_fields(const LinkageFields& fields) {
  json schema{{"type", "object"}, {"additionalProperties", false}, {"properties", json::object()}};
  for (const LinkageField& field : fields) {
    schema["properties"][field.key] = schema_of_field(field);
    if (field.required) schema["required"].push_back(field.key);
  }
  return schema;
}

}  // namespace jobs
