#include "fovea/map/color_display.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/errors.h"

namespace fovea::color_display_test {

LogColor gray(double value) {
  const std::uint16_t code = color_code(value);
  return LogColor::of_codes(code, code, code);
}

FrameRecord frame_of(int index, std::optional<double> log2_gain) {
  FrameRecord record;
  record.index = index;
  ViewRecord view;
  if (log2_gain) view.log2_gain = Eigen::Vector3d(*log2_gain, 0, 1);
  record.views = {view};
  return record;
}

TEST(ColorDisplay, OfTheReferenceExposureIsTheNearestByte) {
  const ColorDisplay display;
  for (const double value : {0.0, 1.0, 17.0, 128.0, 254.0, 255.0, 300.0, 4000.0}) {
    EXPECT_EQ(display(gray(value)), to_rgb(gray(value))) << value;
  }
}

TEST(ColorDisplay, AppliesAGainToEachChannel) {
  const ColorDisplay display({LogGain(-2, 0, 0.5f), {}}, /*tone_mapped=*/false);
  EXPECT_EQ(display(gray(160)), (Rgb{40, 160, 226}));
  EXPECT_EQ(display(gray(800)), (Rgb{200, 255, 255}));
}

TEST(ColorDisplay, ToneMappingKeepsDifferencesOfBrightValues) {
  const ColorDisplay display({LogGain::Zero(), {}}, /*tone_mapped=*/true);
  EXPECT_EQ(display(gray(200)), (Rgb{200, 200, 200}));
  std::uint8_t last = 200;
  for (const double value : {220.0, 255.0, 300.0, 350.0, 400.0}) {
    const std::uint8_t shown = display(gray(value)).g;
    EXPECT_GT(shown, last) << value;
    last = shown;
  }
  EXPECT_EQ(display(gray(4000)).r, 255);
}

TEST(Exposure, AutoIsTheMedianOfTheImages) {
  const std::vector<FrameRecord> frames = {frame_of(0, 0), frame_of(1, -1), frame_of(2, {}),
                                           frame_of(3, -4)};
  EXPECT_EQ(color_display({}, frames)(gray(80)), (Rgb{40, 80, 160}));
  EXPECT_EQ(color_display({}, {frame_of(2, {})})(gray(250)).r, 250);  // no gains: as it is
}

TEST(Exposure, OfAFrameIsThatOfItsImage) {
  const std::vector<FrameRecord> frames = {frame_of(0, 0), frame_of(1, -1), frame_of(2, {})};
  EXPECT_EQ(color_display(parse_exposure("frame:1"), frames)(gray(80)), (Rgb{40, 80, 160}));
  EXPECT_THROW(color_display(parse_exposure("frame:2"), frames), InputError);
  EXPECT_THROW(color_display(parse_exposure("frame:7"), frames), InputError);
}

TEST(Exposure, OfStopsIsRelativeToTheMap) {
  EXPECT_EQ(color_display(parse_exposure("-1"), {frame_of(0, 3)})(gray(80)), (Rgb{40, 40, 40}));
  EXPECT_EQ(color_display(parse_exposure("0.5"), {})(gray(100)).r, 141);
}

TEST(Exposure, OtherTextIsAnError) {
  for (const char* text : {"", "bright", "frame:", "frame:x", "frame:-1", "frame:1.5", "1 2", "17",
                           "nan", "inf", "frame:99999999999"}) {
    EXPECT_THROW(parse_exposure(text), ConfigError) << text;
  }
}

TEST(DeepColorDisplay, Is257TimesTheValue) {
  const DeepColorDisplay display{ViewLight()};
  for (const double value : {1.0, 17.0, 99.5, 255.0}) {
    const LogColor color = gray(value);
    EXPECT_NEAR(display(color)[0], 257 * double(to_float(color)[0]), 0.51) << value;
  }
  EXPECT_EQ(display(gray(300))[0], 65535);
  EXPECT_EQ(display(LogColor())[0], 0);
}

TEST(DeepColorDisplay, CutsOffAtMostAThousandth) {
  CodeCounts points{};
  points[color_code(100)] = 9980;
  points[color_code(400)] = 20;
  // 400 becomes 200 after one stop. Half a stop would leave 283.
  const DeepColorDisplay lowered = deep_color_display({}, {}, points);
  EXPECT_NEAR(lowered(gray(400))[0], 257 * 200, 257);
  points[color_code(400)] = 10;
  points[color_code(100)] = 9990;
  const DeepColorDisplay reference = deep_color_display({}, {}, points);
  EXPECT_EQ(reference(gray(400))[0], 65535);
  EXPECT_NEAR(reference(gray(100))[0], 257 * 100, 100);
  // A stated exposure is kept.
  const ExposureChoice stops = parse_exposure("0");
  points[color_code(400)] = 5000;
  EXPECT_NEAR(deep_color_display(stops, {}, points)(gray(100))[0], 257 * 100, 100);
}

TEST(ColorDisplay, AppliesTheResponseOfTheCamera) {
  const ColorDisplay display({LogGain::Constant(1), {14, {-0.5, 0, 0}}}, /*tone_mapped=*/false);
  EXPECT_EQ(display(gray(20)), (Rgb{54, 54, 54}));  // (20 + 14) * 2 - 14
}

}  // namespace fovea::color_display_test
