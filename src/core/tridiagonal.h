#pragma once

#include <cstddef>
#include <vector>

namespace verlet_cable {

/// Solves the symmetric tridiagonal system with `diagonal` (n) and `off` (n - 1 used: between rows i and i + 1) in place: `x`
/// holds the right-hand side and becomes the solution; `diagonal` is overwritten. Thomas's algorithm, no pivoting.
inline void solve_tridiagonal(std::vector<double>& diagonal, const std::vector<double>& off, std::vector<double>& x,
                              std::size_t n) {
  diagonal[0] = 1 / diagonal[0];
  for (std::size_t i = 1; i < n; ++i) {
    const double ratio = off[i - 1] * diagonal[i - 1];
    diagonal[i] = 1 / (diagonal[i] - ratio * off[i - 1]);
    x[i] -= ratio * x[i - 1];
  }
  x[n - 1] *= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) x[i] = (x[i] - off[i] * x[i + 1]) * diagonal[i];
}

}  // namespace verlet_cable
