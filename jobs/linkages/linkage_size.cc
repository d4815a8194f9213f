// SPDX-License-Identifier: Apache-2.0
#include "jobs/linkages/linkage_size.h"

#include <algorithm>

#include "jobs/linkages/linkage_joint.h"

namespace jobs {
namespace {

using nlohmann::json;

constexpr std::size_t kMostCoordinates = 600;
constexpr std::size_t kMostConstraints = 300;
constexpr std::size_t kFreedomsOfABody = 6;
constexpr std::size_t kFreedomsOfAnElement = 3;

std::size_t elements_of(const json& beam, std::size_t otherwise) {
  const auto found = beam.find("elements");
  // A swept value may be any number so far.
  return found == beam.end() || !found->is_number()
             ? otherwise
             : static_cast<std::size_t>(std::clamp(found->get<double>(), 1.0, 1e6));
}

void add_size_of_joint(const json& joint, LinkageSize& size) {
  const bool cross = has_cross(joint), closes = closes_loop(joint), has_play = joint.contains("clearance");
  if (cross) size.freedoms += closes ? kFreedomsOfABody : 2 * kFreedomsOfABody;
  else if (!closes) size.freedoms += list_freedoms(joint).size();
  // Those of a joint with clearance put it together at the start.
  if (cross) size.constraints += 2 * (kFreedomsOfABody - 1);
  else if (closes || has_play)
    size.constraints += kFreedomsOfABody - freedoms_of(find_joint_kind(joint).value()).size();
}

}  // namespace

LinkageSize size_of_linkage(const json& description, std::size_t elements) {
  LinkageSize size;
  for (const json& joint : description.at("joints")) add_size_of_joint(joint, size);
  size.coordinates = size.freedoms;
  for (const json& body : description.at("bodies")) {
    if (body.contains("beam"))
      size.coordinates += kFreedomsOfAnElement * (elements_of(body.at("beam"), elements) - 1);
  }
  return size;
}

std::string describe_size_fault(const LinkageSize& size) {
  if (size.coordinates > kMostCoordinates)
    return "has " + std::to_string(size.coordinates) +
           " coordinates, of its joints and between the elements of its beams; at most " +
           std::to_string(kMostCoordinates) + " are allowed";
  if (size.constraints > kMostConstraints)
    return "has " + std::to_string(size.constraints) +
           " constraints by joints that close loops or have clearance; at most " +
           std::to_string(kMostConstraints) + " are allowed";
  return "";
}

double calc_closing_work(const LinkageSize& size) {
  // As measured: of linkages of 600 coordinates, without loops and with 300 constraints.
  const auto square = static_cast<double>(size.coordinates * size.coordinates);
  const auto product =
      static_cast<double>(size.freedoms * size.constraints * std::min(size.freedoms, size.constraints));
  return 1.0 + square / 3e3 + product / 1e5;
}

}  // namespace jobs
