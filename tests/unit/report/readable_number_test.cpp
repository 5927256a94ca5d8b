#include "drape/report/readable_number.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace drape::report {
namespace {

TEST(ReadableNumber, FourDigitsAreEnough) {
  EXPECT_EQ(readable_value(96.40012), "96.4");
  EXPECT_EQ(readable_value(0.123456), "0.1235");
  EXPECT_EQ(readable_value(-2.5), "-2.5");
  EXPECT_EQ(readable_value(0.00012346), "0.0001235");
  EXPECT_EQ(readable_value(1234.56), "1235");
  EXPECT_EQ(readable_value(0.00001), "1.000e-05");
}

TEST(ReadableNumber, WholeNumbersAreShownInFull) {
  EXPECT_EQ(readable_value(0), "0");
  EXPECT_EQ(readable_value(-0.0), "0");
  EXPECT_EQ(readable_value(9999), "9999");
  EXPECT_EQ(readable_value(362272), "362\u2009272");
  EXPECT_EQ(readable_value(-1234567), "-1\u2009234\u2009567");
}

TEST(ReadableNumber, WhatIsNoNumberIsSaid) {
  EXPECT_EQ(readable_value(std::numeric_limits<double>::quiet_NaN()), "not known");
  EXPECT_EQ(readable_value(std::numeric_limits<double>::infinity()), "\u221e");
}

TEST(ReadableNumber, Times) {
  EXPECT_EQ(readable_seconds(0), "0.00 s");
  EXPECT_EQ(readable_seconds(0.042), "0.04 s");
  EXPECT_EQ(readable_seconds(12.34), "12.3 s");
  EXPECT_EQ(readable_seconds(59.97), "1 min 00 s");
  EXPECT_EQ(readable_seconds(192), "3 min 12 s");
  EXPECT_EQ(readable_seconds(3599.8), "1 h 00 min");
  EXPECT_EQ(readable_seconds(7500), "2 h 05 min");
}

TEST(ReadableNumber, Memory) {
  EXPECT_EQ(readable_memory(812.3), "812 MB");
  EXPECT_EQ(readable_memory(1460), "1.46 GB");
}

TEST(ReadableNumber, TheUnitComesFromTheName) {
  const Number overlap = readable_number("overlap_percent", 96.40012, "how much");
  EXPECT_EQ(overlap.name, "overlap");
  EXPECT_EQ(overlap.value_text, "96.4");
  EXPECT_EQ(overlap.unit, "%");
  EXPECT_EQ(overlap.meaning, "how much");
  EXPECT_EQ(readable_number("boundary_error_px", 1.25).unit, "px");
  EXPECT_EQ(readable_number("boundary_error_px", 1.25).name, "boundary error");
  EXPECT_EQ(readable_number("faces", 12).unit, "");
  EXPECT_EQ(readable_number("pass_1", 12).name, "pass 1");
}

TEST(ReadableNumber, LengthsAreShownInTheUnitThatSuitsThem) {
  const auto shown = [](double metres) {
    const Number number = readable_number("rms_m", metres);
    return number.value_text + " " + number.unit;
  };
  EXPECT_EQ(shown(0.00035), "0.35 mm");
  EXPECT_EQ(shown(0.0000125), "12.5 \u00b5m");
  EXPECT_EQ(shown(0.25), "250 mm");
  EXPECT_EQ(shown(12.5), "12.5 m");
  EXPECT_EQ(shown(0), "0 m");
}

}  // namespace
}  // namespace drape::report
