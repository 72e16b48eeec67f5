#pragma once

#include <cmath>

namespace verlet_cable {

/// A number and its derivatives with respect to n others: the laws, which are templates over the type of their numbers, give with
/// it their derivatives, too.
template <int n>
struct Dual {
  double value = 0;
  double slope[n] = {};

  Dual() = default;
  Dual(double number) : value(number) {}  // NOLINT: numbers are constants
  /// The k-th of those others.
  static Dual variable(double number, int k) {
    Dual a(number);
    a.slope[k] = 1;
    return a;
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }

  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual c(a.value + b.value);
    for (int k = 0; k < n; ++k) c.slope[k] = a.slope[k] + b.slope[k];
    return c;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual c(a.value - b.value);
    for (int k = 0; k < n; ++k) c.slope[k] = a.slope[k] - b.slope[k];
    return c;
  }
  friend Dual operator-(const Dual& a) { return -1.0 * a; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual c(a.value * b.value);
    for (int k = 0; k < n; ++k) c.slope[k] = a.slope[k] * b.value + a.value * b.slope[k];
    return c;
  }
  friend Dual operator*(double a, const Dual& b) {
    Dual c(a * b.value);
    for (int k = 0; k < n; ++k) c.slope[k] = a * b.slope[k];
    return c;
  }
  friend Dual operator*(const Dual& a, double b) { return b * a; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double inverse = 1 / b.value, quotient = a.value * inverse;
    Dual c(quotient);
    for (int k = 0; k < n; ++k) c.slope[k] = (a.slope[k] - quotient * b.slope[k]) * inverse;
    return c;
  }
  friend Dual operator/(const Dual& a, double b) { return (1 / b) * a; }
};

template <int n>
Dual<n> root(const Dual<n>& a) {
  Dual<n> b(std::sqrt(a.value));
  for (int k = 0; k < n; ++k) b.slope[k] = 0.5 * a.slope[k] / b.value;
  return b;
}
inline double root(double a) {
  return std::sqrt(a);
}

template <int n>
double value_of(const Dual<n>& a) {
  return a.value;
}
inline double value_of(double a) {
  return a;
}

}  // namespace verlet_cable
