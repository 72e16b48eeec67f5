#include <gtest/gtest.h>

#include <string>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

TEST(QuotedText, KeepsCharactersOfUtf8Whole) {
  for (const std::string text : {"", "hose 2", "\u00e9", "\u20ac", "\ud7ff", "\ue000", "\U00010000", "\U0010ffff"}) {
    EXPECT_EQ(escaped(text), text);
    EXPECT_EQ(in_quotes(text), '"' + text + '"');
  }
  EXPECT_EQ(escaped("a\u20acb", 2), "a\u20ac...");
  EXPECT_EQ(escaped("a\u20acb", 1), "a...");
  EXPECT_EQ(escaped(std::string(61, 'a')), std::string(60, 'a') + "...");
}

TEST(QuotedText, EscapesWhatIsNoCharacter) {
  EXPECT_EQ(escaped("a\nb\x7f"), "a\\x0ab\\x7f");
  EXPECT_EQ(escaped("\xff\x80"), "\\xff\\x80");
  EXPECT_EQ(escaped("\xe2\x82"), "\\xe2\\x82");           // cut short
  EXPECT_EQ(escaped("\xe2(\xac"), "\\xe2(\\xac");         // interrupted
  EXPECT_EQ(escaped("\xc0\xaf"), "\\xc0\\xaf");           // longer than needed
  EXPECT_EQ(escaped("\xe0\x9f\xbf"), "\\xe0\\x9f\\xbf");  // likewise
  EXPECT_EQ(escaped("\xf0\x8f\xbf\xbf"), "\\xf0\\x8f\\xbf\\xbf");
  EXPECT_EQ(escaped("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // half of a pair of UTF-16
  EXPECT_EQ(escaped("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond the last
}

}  // namespace
}  // namespace verlet_cable
