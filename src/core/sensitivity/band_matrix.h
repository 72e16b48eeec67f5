#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace verlet_cable {

/// A square matrix that is zero but in a band about its diagonal. Factorised by rows with the largest pivots: it need neither be
/// symmetric nor definite.
class BandMatrix {
 public:
  /// All zero. `reach`: columns of the band on either side of the diagonal.
  void assign(int rows, int reach) {
    rows_ = rows;
    reach_ = reach;
    width_ = 3 * reach + 1;  // pivoting fills in
    values_.assign(static_cast<std::size_t>(rows) * width_, 0.0);
    pivots_.assign(rows, 0);
  }
  int rows() const { return rows_; }
  double& at(int row, int column) { return values_[static_cast<std::size_t>(row) * width_ + (column - row + reach_)]; }
  void clear_row(int row) { std::fill_n(values_.begin() + static_cast<std::ptrdiff_t>(row) * width_, width_, 0.0); }

  /// False if it is singular: a pivot is smaller than rounding leaves of a row.
  bool factor() {
    for (int k = 0; k < rows_; ++k) {
      const int last_row = std::min(rows_ - 1, k + reach_), last_column = std::min(rows_ - 1, k + 2 * reach_);
      int pivot = k;
      for (int i = k + 1; i <= last_row; ++i)
        if (std::abs(at(i, k)) > std::abs(at(pivot, k))) pivot = i;
      if (!(std::abs(at(pivot, k)) > 0)) return false;
      pivots_[k] = pivot;
      if (pivot != k)
        for (int j = k; j <= last_column; ++j) std::swap(at(k, j), at(pivot, j));
      const double inverse = 1 / at(k, k);
      for (int i = k + 1; i <= last_row; ++i) {
        const double ratio = at(i, k) * inverse;
        at(i, k) = ratio;
        if (ratio == 0) continue;
        double* row = &at(i, k + 1);
        const double* upper = &at(k, k + 1);
        for (int j = 0; j < last_column - k; ++j) row[j] -= ratio * upper[j];
      }
    }
    return true;
  }

  /// In place, of several right-hand sides: `columns` numbers a row.
  void solve(double* x, int columns) {
    const auto row = [&](int i) { return x + static_cast<std::ptrdiff_t>(i) * columns; };
    for (int k = 0; k < rows_; ++k) {
      if (pivots_[k] != k) std::swap_ranges(row(k), row(k) + columns, row(pivots_[k]));
      for (int i = k + 1; i <= std::min(rows_ - 1, k + reach_); ++i) subtract(at(i, k), row(k), columns, row(i));
    }
    for (int k = rows_ - 1; k >= 0; --k) {
      for (int j = k + 1; j <= std::min(rows_ - 1, k + 2 * reach_); ++j) subtract(at(k, j), row(j), columns, row(k));
      const double inverse = 1 / at(k, k);
      for (int c = 0; c < columns; ++c) row(k)[c] *= inverse;
    }
  }

 private:
  static void subtract(double factor, const double* from, int columns, double* to) {
    if (factor == 0) return;
    for (int c = 0; c < columns; ++c) to[c] -= factor * from[c];
  }

  int rows_ = 0, reach_ = 0, width_ = 0;
  std::vector<double> values_;  // a row of the band after the other
  std::vector<int> pivots_;     // a row: that which it was exchanged with
};

}  // namespace verlet_cable
