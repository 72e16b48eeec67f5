#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <locale>
#include <string>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

TEST(NumberText, MeasuredNumbersAreRoundedForPeople) {
  EXPECT_EQ(rounded_text(0.4000000000000001), "0.4");
  EXPECT_EQ(rounded_text(1.0 / 3), "0.3333");
  EXPECT_EQ(rounded_text(12345.678), "12346");
  EXPECT_EQ(rounded_text(-0.0123456), "-0.01235");
  EXPECT_EQ(rounded_text(0.0), "0");
  EXPECT_EQ(rounded_text(12.3456789, 6), "12.3457");
  EXPECT_EQ(rounded_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(NumberText, GivenNumbersStayWhatTheyAre) {
  EXPECT_EQ(std::stod(number_text(0.4000000000000001)), 0.4000000000000001);
}

TEST(NumberText, WhatIsNoNumberHasNoSign) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {nan, std::copysign(nan, -1.0), std::copysign(nan, 1.0)}) {
    EXPECT_EQ(number_text(value), "nan");
    EXPECT_EQ(rounded_text(value), "nan");
    EXPECT_EQ(rounded_bound_text(value, -1), "nan");
  }
}

TEST(NumberText, WhatABoundSaysIsAllowed) {
  for (const double bound : {0.4000000000000001, 0.4, 1.2345678, 999.96, 12345.678, 1e-7 / 3, 2e12 / 3, -2.34567}) {
    EXPECT_GE(std::stod(rounded_bound_text(bound, 1)), bound);
    EXPECT_LE(std::stod(rounded_bound_text(bound, -1)), bound);
    EXPECT_LE(rounded_bound_text(bound, 1).size(), 9u);
    EXPECT_LE(rounded_bound_text(bound, -1).size(), 9u);
  }
  EXPECT_EQ(rounded_bound_text(0.4, 1), "0.4");
  EXPECT_EQ(rounded_bound_text(std::numeric_limits<double>::infinity(), -1), "inf");
}

/// As a program may set it around the simulation: of C++, and where localedef can make one, of C.
class CommaLocale {
 public:
  CommaLocale() : before_(std::locale::global(std::locale(std::locale::classic(), new Comma))) {
    std::string pattern = testing::TempDir() + "locales_XXXXXX";
    directory_ = mkdtemp(pattern.data());
    std::ofstream(directory_ + "/source")
        << "LC_CTYPE\ncopy \"POSIX\"\nEND LC_CTYPE\n"
        << "LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n";
    const std::string make = "cd " + directory_ + " && localedef -c -i ./source -f ISO-8859-1 ./comma >/dev/null 2>&1";
    // What is left out of it is warned of by the status.
    [[maybe_unused]] const int status = std::system(make.c_str());
    setenv("LOCPATH", directory_.c_str(), 1);
    std::setlocale(LC_NUMERIC, "comma");
  }
  ~CommaLocale() {
    std::setlocale(LC_NUMERIC, "C");
    unsetenv("LOCPATH");
    std::locale::global(before_);
    std::filesystem::remove_all(directory_);
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

 private:
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale before_;
  std::string directory_;
};

TEST(NumberText, IsTheSameInEveryLocale) {
  const CommaLocale locale;
  EXPECT_EQ(number_text(0.4000000000000001), "0.4000000000000001");
  EXPECT_EQ(rounded_text(1.0 / 3), "0.3333");
  EXPECT_EQ(rounded_text(12345.678), "12346");
  EXPECT_EQ(rounded_bound_text(1.0 / 3, 1), "0.3334");
  EXPECT_EQ(rounded_bound_text(2.0 / 3, -1), "0.6666");
  EXPECT_EQ(printed_text(1234.5, 1, true), "1234.5");
}

}  // namespace
}  // namespace verlet_cable
