// SPDX-License-Identifier: Apache-2.0
// Every line of the validation report is a test: one for each of its parts.

#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "validation/chapters.h"
#include "validation/report/report.h"

namespace validation {

void PrintTo(const Part& part, std::ostream* out) { *out << part.name; }

namespace {

std::vector<Part> parts_of(Cost cost) {
  std::vector<Part> parts;
  for (const Chapter& chapter : engine_chapters())
    for (const Part& part : chapter.parts)
      if (part.cost == cost) parts.push_back(part);
  return parts;
}

class Validation : public testing::TestWithParam<Part> {};

TEST_P(Validation, HoldsItsBounds) {
  const Findings findings = GetParam().compute();
  EXPECT_FALSE(findings.checks.empty());
  for (const Check& check : findings.checks) {
    EXPECT_TRUE(check.holds()) << describe(check) << "; found " << check.found << ", expected "
                               << check.expected;
    EXPECT_FALSE(check.what.empty() || check.reference.empty() || check.unit.empty() || check.why.empty())
        << check.what;
  }
}

const auto kName = [](const auto& part) { return part.param.name; };
INSTANTIATE_TEST_SUITE_P(Light, Validation, testing::ValuesIn(parts_of(Cost::kLight)), kName);
INSTANTIATE_TEST_SUITE_P(Heavy, Validation, testing::ValuesIn(parts_of(Cost::kHeavy)), kName);

TEST(ValidationParts, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Cost cost : {Cost::kLight, Cost::kHeavy})
    for (const Part& part : parts_of(cost)) EXPECT_TRUE(names.insert(part.name).second) << part.name;
  EXPECT_GT(names.size(), 20u);
}

}  // namespace
}  // namespace validation
