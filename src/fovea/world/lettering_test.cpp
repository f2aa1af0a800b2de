#include "fovea/world/lettering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fovea/core/random.h"

namespace fovea::lettering_test {

const std::string kAll = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
const Eigen::Vector2f kBoard(0.6f, 0.8f);

/// Ink of a board seen by 60 x 80 sharp eyes, row by row from below.
std::vector<float> drawn(std::string_view text, const Eigen::Vector2f& board = kBoard) {
  std::vector<float> ink;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 60; ++x) {
      ink.push_back(lettering_ink(
          text, {(float(x) + 0.5f) / 60 * board.x(), (float(y) + 0.5f) / 80 * board.y()}, board,
          0.001f));
    }
  }
  return ink;
}

double share(const std::vector<float>& ink) {
  double sum = 0;
  for (const float i : ink) sum += i;
  return sum / double(ink.size());
}

TEST(Lettering, EveryLetterHasInkAndDiffersFromEveryOther) {
  std::vector<std::vector<float>> letters;
  for (const char c : kAll) {
    letters.push_back(drawn(std::string(1, c)));
    EXPECT_GT(share(letters.back()), 0.08) << c;
    EXPECT_LT(share(letters.back()), 0.6) << c;
    for (const float i : letters.back()) EXPECT_TRUE(i >= 0 && i <= 1) << c;
  }
  for (std::size_t a = 0; a < letters.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::vector<float> difference(letters[a].size());
      std::transform(letters[a].begin(), letters[a].end(), letters[b].begin(), difference.begin(),
                     [](float i, float j) { return std::abs(i - j); });
      EXPECT_GT(share(difference), 0.01) << kAll[a] << kAll[b];
    }
  }
}

TEST(Lettering, LettersAreCapitalAndOtherSignsBlank) {
  EXPECT_EQ(drawn("q"), drawn("Q"));
  EXPECT_EQ(share(drawn("")), 0);
  EXPECT_EQ(share(drawn(" ")), 0);
  EXPECT_EQ(share(drawn("-")), 0);
  EXPECT_GT(share(drawn("A")), share(drawn("A ")));  // ... which take their place
}

TEST(Lettering, IsUprightAndReadsFromTheLeft) {
  const auto ink = [](const char* text, float x, float y) {
    return lettering_ink(text, {x, y}, {1, 1}, 0.001f);
  };
  // L: an upright on the left, a bar at the bottom.
  EXPECT_EQ(ink("L", 0.25f, 0.8f), 1);
  EXPECT_EQ(ink("L", 0.7f, 0.125f), 1);
  EXPECT_EQ(ink("L", 0.7f, 0.8f), 0);
  EXPECT_GT(share(drawn("L ", {2, 1})), 0);
  for (float x = 1.05f; x < 2; x += 0.05f) {
    for (float y = 0; y < 1; y += 0.05f) {
      EXPECT_EQ(lettering_ink("L ", {x, y}, {2, 1}, 0.001f), 0) << x << ' ' << y;
    }
  }
}

TEST(Lettering, IsCentredAndAsLargeAsFits) {
  // H and O reach equally far to all sides of their middle.
  for (const Eigen::Vector2f& board :
       {Eigen::Vector2f(1, 1), Eigen::Vector2f(3, 0.5f), Eigen::Vector2f(0.5f, 3)}) {
    for (const char* text : {"H", "O", "HOH"}) {
      Eigen::Vector2f low = board, high = Eigen::Vector2f::Zero();
      constexpr int kSteps = 400;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const Eigen::Vector2f at =
            board.cwiseProduct(Eigen::Vector2f(float(i % kSteps), float(i / kSteps)) / kSteps);
        if (lettering_ink(text, at, board, 1e-4f) < 0.5f) continue;
        low = low.cwiseMin(at);
        high = high.cwiseMax(at);
      }
      const Eigen::Vector2f margin = low - (board - high), size = high - low;
      EXPECT_LT(margin.cwiseAbs().cwiseQuotient(board).maxCoeff(), 2.1f / kSteps) << text;
      EXPECT_GT(size.cwiseQuotient(board).maxCoeff(), 0.7f) << text;
      EXPECT_GE(low.minCoeff(), 0);
    }
  }
}

// A sign far away is as dark, in the mean, as one nearby.
TEST(Lettering, InkFadesIntoItsShare) {
  const Eigen::Vector2f board(0.52f, 0.11f);
  constexpr int kSteps = 24;
  Random random(3);
  for (const float footprint : {0.01f, 0.02f, 0.04f, 0.08f}) {
    double bias = 0, worst = 0;
    constexpr int kPlaces = 60;
    for (int i = 0; i < kPlaces; ++i) {
      const Eigen::Vector2f place(float(random.uniform(0.05, 0.47)),
                                  float(random.uniform(0.02, 0.09)));
      double sum = 0;
      for (int k = 0; k < kSteps * kSteps; ++k) {
        const Eigen::Vector2f offset((float(k % kSteps) + 0.5f) / kSteps - 0.5f,
                                     (float(k / kSteps) + 0.5f) / kSteps - 0.5f);
        sum += lettering_ink("KA 7204", place + footprint * offset, board, 0);
      }
      const double error =
          lettering_ink("KA 7204", place, board, footprint) - sum / (kSteps * kSteps);
      bias += error / kPlaces;
      worst = std::max(worst, std::abs(error));
    }
    EXPECT_NEAR(bias, 0, 0.02) << footprint;
    EXPECT_LT(worst, 0.15) << footprint;
  }
}

}  // namespace fovea::lettering_test
