#pragma once

#include <verlet_cable/Legend.h>

#include <QFont>
#include <QImage>
#include <QString>

namespace verlet_cable {

/// Whether there is something to draw: numbers, all finite, and as many colors.
bool has_scale(const Legend& legend);

/// A number as it is written in a legend: two significant digits.
QString legend_number(double value);

/// A bar of the colors under the name of the quantity, over the first, the middle and the last value. Null without a scale.
QImage legend_picture(const Legend& legend, const QFont& font);

}  // namespace verlet_cable
