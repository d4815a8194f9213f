// SPDX-License-Identifier: Apache-2.0
#include "jobs/statistics/first_order_index.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace jobs_tests {
namespace {

using nlohmann::json;

constexpr std::size_t kPoints = 4000;

/// Three columns of numbers, each uniform over [0, 1).
struct UniformSample {
  std::array<std::vector<json>, 3> x;

  UniformSample() {
    std::mt19937_64 engine(20260101);
    for (std::size_t i = 0; i < kPoints; ++i)
      for (auto& column : x) column.emplace_back(static_cast<double>(engine() >> 11) * 0x1p-53);
  }

  [[nodiscard]] double at(std::size_t column, std::size_t i) const { return x[column][i].get<double>(); }
};

// Variances of independent parts add up: of a x_1 + b x_2 they are a^2 / 12 and b^2 / 12. 16 stretches leave
// 1/256 of an input's variance within them, and the share of a sample's variance has a standard deviation of
// about 2 sqrt(S (1 - S) / n) < 0.016.
TEST(FirstOrderIndex, IsThePartOfTheVarianceOfALinearFunction) {
  const UniformSample sample;
  const struct {
    double a, b;
  } cases[] = {{1, 1}, {3, 1}, {1, -2}, {5, 0}};
  for (const auto& [a, b] : cases) {
    std::vector<double> y;
    for (std::size_t i = 0; i < kPoints; ++i) y.push_back(7.0 + a * sample.at(0, i) + b * sample.at(1, i));
    const double sum = a * a + b * b;
    EXPECT_NEAR(jobs::calc_first_order_index(sample.x[0], y).value(), a * a / sum, 0.04) << a << " " << b;
    EXPECT_NEAR(jobs::calc_first_order_index(sample.x[1], y).value(), b * b / sum, 0.04) << a << " " << b;
    EXPECT_LT(jobs::calc_first_order_index(sample.x[2], y).value(), 0.02) << "y does not depend on it";
  }
}

// In x_1 x_2 about the means, neither input alone says anything of y.
TEST(FirstOrderIndex, IsNothingOfAnInteraction) {
  const UniformSample sample;
  std::vector<double> y;
  for (std::size_t i = 0; i < kPoints; ++i) y.push_back((sample.at(0, i) - 0.5) * (sample.at(1, i) - 0.5));
  EXPECT_LT(jobs::calc_first_order_index(sample.x[0], y).value(), 0.02);
  EXPECT_LT(jobs::calc_first_order_index(sample.x[1], y).value(), 0.02);
}

// Neither linear nor monotonic: classes need no form of the function. x^2 has the variance 4/45 for x over
// [-1, 1), and 0.5 x_2 has 0.25/12.
TEST(FirstOrderIndex, SeesAnEvenFunction) {
  const UniformSample sample;
  std::vector<double> y;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double x = 2.0 * sample.at(0, i) - 1.0;
    y.push_back(x * x + 0.5 * sample.at(1, i));
  }
  const double of_x = 4.0 / 45.0, beside = 0.25 / 12.0;
  EXPECT_NEAR(jobs::calc_first_order_index(sample.x[0], y).value(), of_x / (of_x + beside), 0.04);
}

// 20 words are 20 classes, though numbers have 16 stretches at most. y is 0 or 10 by the word, plus or minus
// 1 by the sign.
TEST(FirstOrderIndex, TakesWordsAsClasses) {
  std::vector<json> words, signs;
  std::vector<double> y;
  for (std::size_t i = 0; i < 400; ++i) {
    words.emplace_back("word " + std::to_string(i % 20));
    signs.emplace_back(i / 20 % 2 == 0 ? "plus" : "minus");
    y.push_back((i % 20 == 13 ? 10.0 : 0.0) + (i / 20 % 2 == 0 ? 1.0 : -1.0));
  }
  // Means of the words: 10 of one in twenty, a variance of 100 (1/20) (19/20) = 4.75; of the signs 1.
  const auto without_chance = [](double share, double classes) {
    return share - (1.0 - share) * (classes - 1.0) / (400.0 - classes);
  };
  EXPECT_NEAR(jobs::calc_first_order_index(words, y).value(), without_chance(4.75 / 5.75, 20.0), 1e-12);
  EXPECT_NEAR(jobs::calc_first_order_index(signs, y).value(), without_chance(1.0 / 5.75, 2.0), 1e-12);
}

// Numbers of few values are classes, too, whether they are written 1 or 1.0.
TEST(FirstOrderIndex, TakesFewNumbersAsClasses) {
  std::vector<json> x;
  std::vector<double> y;
  for (int i = 0; i < 60; ++i) {
    x.push_back(i % 3 == 0 ? json(1) : i % 3 == 1 ? json(1.0) : json(2.5));
    y.push_back(i % 3 == 2 ? 4.0 : 1.0);
  }
  EXPECT_DOUBLE_EQ(jobs::calc_first_order_index(x, y).value(), 1.0);
}

TEST(FirstOrderIndex, IsNoneWhereNothingVariesOrThereIsTooLittle) {
  const std::vector<json> x{1, 2, 1, 2};
  EXPECT_FALSE(jobs::calc_first_order_index(x, std::vector<double>{3, 3, 3, 3}));
  std::vector<json> many;
  for (int i = 0; i < 60; ++i) many.emplace_back(i % 5);
  EXPECT_FALSE(jobs::calc_first_order_index(many, std::vector<double>(60, std::log(3.5))))
      << "whose mean is rounded";
  EXPECT_TRUE(jobs::calc_first_order_index(x, std::vector<double>{3, 4, 3, 4}));
  const std::vector<json> three_classes{1, 2, 3, 1}, one_class{1, 1, 1, 1};
  const std::vector<double> y{3, 4, 5, 6};
  EXPECT_FALSE(jobs::calc_first_order_index(three_classes, y));
  EXPECT_EQ(jobs::calc_first_order_index(one_class, y), 0.0);
  EXPECT_FALSE(jobs::calc_first_order_index({}, {}));
}

}  // namespace
}  // namespace jobs_tests
