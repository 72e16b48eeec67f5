#pragma once

#include <vector>

#include "rod/pair.h"

namespace verlet_cable {

/// Solves the symmetric tridiagonal system with `diagonal` (n) and `off` (n - 1 used: between rows i and i + 1) in place: `x`
/// holds the right-hand side and becomes the solution; `diagonal` is overwritten. Thomas's algorithm from both ends at once, no
/// pivoting.
inline void solve_tridiagonal(std::vector<double>& diagonal, const std::vector<double>& off, std::vector<double>& x, int n) {
  const int half = (n - 1) / 2;  // rows from either end; one or two are left in the middle
  Pair before{}, value{};
  for (int k = 0; k < half; ++k) {
    const int left = k, right = n - 1 - k;
    const Pair coupling = k == 0 ? Pair{} : Pair{off[left - 1], off[right]};
    const Pair ratio = coupling * before;
    before = 1.0 / (Pair{diagonal[left], diagonal[right]} - ratio * coupling);
    value = Pair{x[left], x[right]} - ratio * value;
    diagonal[left] = before[0];
    diagonal[right] = before[1];
    x[left] = value[0];
    x[right] = value[1];
  }
  const int first = half, last = n - 1 - half;
  if (half > 0) {
    const double left = off[first - 1] * diagonal[first - 1], right = off[last] * diagonal[last + 1];
    diagonal[first] -= left * off[first - 1];
    x[first] -= left * x[first - 1];
    diagonal[last] -= right * off[last];
    x[last] -= right * x[last + 1];
  }
  if (first == last) {
    x[first] /= diagonal[first];
  } else {
    const double determinant = diagonal[first] * diagonal[last] - off[first] * off[first];
    const double a = x[first], b = x[last];
    x[first] = (diagonal[last] * a - off[first] * b) / determinant;
    x[last] = (diagonal[first] * b - off[first] * a) / determinant;
  }
  Pair solution{x[first], x[last]};
  for (int k = half - 1; k >= 0; --k) {
    const int left = k, right = n - 1 - k;
    solution = (Pair{x[left], x[right]} - Pair{off[left], off[right - 1]} * solution) * Pair{diagonal[left], diagonal[right]};
    x[left] = solution[0];
    x[right] = solution[1];
  }
}

}  // namespace verlet_cable
