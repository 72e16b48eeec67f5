#include "scene/csv_lines.h"

#include <gtest/gtest.h>

#include <sstream>

namespace verlet_cable {
namespace {

TEST(CsvLines, areWithoutWhatSurroundsThem) {
  std::istringstream stream("\xef\xbb\xbf\r\n \n first\t\r\n\nsecond");
  CsvLines lines(stream, 10);
  std::string line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "first");
  EXPECT_EQ(lines.number(), 3u);
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "second");
  EXPECT_EQ(lines.number(), 5u);
  EXPECT_FALSE(lines.next(line));
  EXPECT_EQ(lines.problem(), "");
}

TEST(CsvLines, nothingIsCutOffAtAZero) {
  std::istringstream stream(std::string("a\0b\nc\0d", 7));
  CsvLines lines(stream, 10);
  std::string line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, std::string("a\0b", 3));
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, std::string("c\0d", 3));
}

TEST(CsvLines, longLinesEndTheFile) {
  std::istringstream stream("1234567890\n12345678901\nnext");
  CsvLines lines(stream, 10);
  std::string line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line.size(), 10u);
  EXPECT_FALSE(lines.next(line));
  EXPECT_EQ(lines.number(), 2u);
  EXPECT_EQ(lines.problem(), "too long");
  EXPECT_EQ(lines.allowed(), "at most 10 characters");
}

/// Empty lines without an end.
class Endless : public std::streambuf {
  int_type underflow() override {
    setg(text_.data(), text_.data(), text_.data() + text_.size());
    return traits_type::to_int_type('\n');
  }
  std::string text_ = std::string(65536, '\n');
};

TEST(CsvLines, manyLinesEndTheFile) {
  Endless endless;
  std::istream stream(&endless);
  CsvLines lines(stream, 10);
  std::string line;
  EXPECT_FALSE(lines.next(line));
  EXPECT_EQ(lines.problem(), "too many lines");
  EXPECT_EQ(lines.allowed(), "at most 10000001");
}

TEST(CsvLines, cellsAreBetweenCommas) {
  EXPECT_EQ(csv_cells("a, b\t,,"), (std::vector<std::string>{"a", "b", "", ""}));
}

}  // namespace
}  // namespace verlet_cable
