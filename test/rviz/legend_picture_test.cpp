#include "legend_picture.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QFontMetrics>
#include <QIcon>
#include <cmath>

namespace verlet_cable {
namespace {

Legend legend_from_blue_to_red() {
  Legend legend;
  legend.quantity = "tension";
  legend.unit = "N";
  legend.values = {0, 1.7, 3.4};
  legend.colors.resize(3);
  legend.colors[0].b = legend.colors[1].g = legend.colors[2].r = 1;
  return legend;
}

bool has_color(const QImage& picture, const QColor& wanted) {
  const auto near = [](int a, int b) { return std::abs(a - b) <= 8; };
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const QColor color = picture.pixelColor(x, y);
      if (near(color.red(), wanted.red()) && near(color.green(), wanted.green()) && near(color.blue(), wanted.blue()))
        return true;
    }
  return false;
}

TEST(LegendPicture, NumbersHaveTwoDigits) {
  EXPECT_EQ(legend_number(0), "0");
  EXPECT_EQ(legend_number(3.4666), "3.5");
  EXPECT_EQ(legend_number(1), "1");
  EXPECT_EQ(legend_number(9.96), "10");
  EXPECT_EQ(legend_number(123.4), "120");
  EXPECT_EQ(legend_number(0.001234), "0.0012");
}

TEST(LegendPicture, ShowsTheColors) {
  const QImage picture = legend_picture(legend_from_blue_to_red(), QApplication::font());
  ASSERT_FALSE(picture.isNull());
  EXPECT_GT(picture.width(), 3 * picture.height());
  for (const QColor& color : {QColor(Qt::blue), QColor(Qt::green), QColor(Qt::red)}) EXPECT_TRUE(has_color(picture, color));
  EXPECT_FALSE(has_color(picture, QColor(Qt::magenta)));
}

TEST(LegendPicture, IsAsWideAsItsTitle) {
  Legend legend = legend_from_blue_to_red();
  const int least = legend_picture(legend, QApplication::font()).width();
  legend.quantity = "contact force, by its cube root";
  const int needed = QFontMetrics(QApplication::font()).horizontalAdvance(QString::fromStdString(legend.quantity) + " [N]");
  EXPECT_GE(legend_picture(legend, QApplication::font()).width(), std::max(least, needed));
}

TEST(LegendPicture, IsNoneWhereThereIsNothingToShow) {
  EXPECT_TRUE(legend_picture({}, QApplication::font()).isNull());
  Legend legend = legend_from_blue_to_red();
  legend.values.pop_back();
  EXPECT_TRUE(legend_picture(legend, QApplication::font()).isNull());
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    legend = legend_from_blue_to_red();
    legend.values[1] = bad;
    EXPECT_TRUE(legend_picture(legend, QApplication::font()).isNull());
  }
  legend = legend_from_blue_to_red();
  legend.colors[0].r = std::nanf("");
  legend.quantity = std::string(100000, 'x');
  EXPECT_LT(legend_picture(legend, QApplication::font()).width(), 1000);
}

}  // namespace
}  // namespace verlet_cable
