#include "html_text.hpp"

#include <gtest/gtest.h>

namespace drape::report {
namespace {

TEST(HtmlText, MarkUpIsReplaced) {
  EXPECT_EQ(escaped("<a href=\"x\">Tom & 'Jerry'</a>"),
            "&lt;a href=&quot;x&quot;&gt;Tom &amp; &#39;Jerry&#39;&lt;/a&gt;");
}

TEST(HtmlText, ValidUtf8StaysAsItIs) {
  const std::string text = "caf\u00e9 \u20ac \U0001F41F \u4e2d\n\ttab";
  EXPECT_EQ(escaped(text), text);
}

TEST(HtmlText, WhatIsNoUtf8BecomesTheReplacementCharacter) {
  const std::string r = "\uFFFD";
  EXPECT_EQ(escaped("a\xFF"
                    "b"),
            "a" + r + "b");
  EXPECT_EQ(escaped("\xC3"), r);                          // cut off
  EXPECT_EQ(escaped("\xC0\xAF"), r + r);                  // a slash in two bytes
  EXPECT_EQ(escaped("\xED\xA0\x80"), r + r + r);          // half a surrogate pair
  EXPECT_EQ(escaped("\xF4\x90\x80\x80"), r + r + r + r);  // beyond the last character
  EXPECT_EQ(escaped("\xE2\x82<"), r + r + "&lt;");        // the next character is not swallowed
}

TEST(HtmlText, ControlCharactersDoNotGetThrough) {
  EXPECT_EQ(escaped(std::string("a\0b", 3)),
            "a\uFFFD"
            "b");
  EXPECT_EQ(escaped("a\x1B[31mb\r\nc\x7F"), "a\uFFFD[31mb\nc\uFFFD");
}

TEST(HtmlText, Base64OfTheStandardsExamples) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFB\xFF\xFE"), "+//+");
}

}  // namespace
}  // namespace drape::report
