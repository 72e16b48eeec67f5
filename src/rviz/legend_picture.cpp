#include "legend_picture.h"

#include <QFontMetrics>
#include <QLinearGradient>
#include <QPainter>
#include <algorithm>
#include <cmath>

namespace verlet_cable {
namespace {

// In heights of a line of text.
constexpr double least_bar_width = 13, bar_height = 0.8, margin = 0.5;
const QColor background(25, 26, 30, 190), foreground(240, 240, 240);
constexpr int significant_digits = 2;
constexpr int longest_text = 40;  // characters

QColor to_color(const std_msgs::ColorRGBA& color) {
  const auto channel = [](float value) { return std::isfinite(value) ? std::clamp(static_cast<double>(value), 0.0, 1.0) : 0.0; };
  return QColor::fromRgbF(channel(color.r), channel(color.g), channel(color.b));
}

QString title(const Legend& legend) {
  return QString::fromStdString(legend.quantity).left(longest_text) + " [" +
         QString::fromStdString(legend.unit).left(longest_text) + "]";
}

QLinearGradient gradient(const Legend& legend, const QRectF& bar) {
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  for (std::size_t i = 0; i < legend.colors.size(); ++i)
    gradient.setColorAt(static_cast<double>(i) / (legend.colors.size() - 1), to_color(legend.colors[i]));
  return gradient;
}

}  // namespace

bool has_scale(const Legend& legend) {
  return legend.values.size() > 1 && legend.values.size() == legend.colors.size() &&
         std::all_of(legend.values.begin(), legend.values.end(), [](double value) { return std::isfinite(value); });
}

QString legend_number(double value) {
  return QString::number(QString::number(value, 'g', significant_digits).toDouble(), 'g', 6);
}

QImage legend_picture(const Legend& legend, const QFont& font) {
  if (!has_scale(legend)) return {};
  const double line = QFontMetrics(font).height();
  const double width = std::max<double>(least_bar_width * line, QFontMetrics(font).horizontalAdvance(title(legend)));
  const QRectF bar(margin * line, (margin + 1.2) * line, width, bar_height * line);
  const QRectF numbers(bar.left(), bar.bottom() + 0.1 * line, bar.width(), line);
  QImage picture(static_cast<int>(bar.right() + margin * line), static_cast<int>(numbers.bottom() + margin * line),
                 QImage::Format_ARGB32);
  picture.fill(background);
  QPainter painter(&picture);
  painter.setFont(font);
  painter.setPen(foreground);
  painter.drawText(QRectF(bar.left(), margin * line, bar.width(), line), Qt::AlignLeft, title(legend));
  painter.fillRect(bar, gradient(legend, bar));
  painter.drawText(numbers, Qt::AlignLeft, legend_number(legend.values.front()));
  painter.drawText(numbers, Qt::AlignRight, "\u2265 " + legend_number(legend.values.back()));
  if (legend.values.size() % 2 == 1)
    painter.drawText(numbers, Qt::AlignHCenter, legend_number(legend.values[legend.values.size() / 2]));
  return picture;
}

}  // namespace verlet_cable
