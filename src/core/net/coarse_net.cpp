#include "net/coarse_net.h"

#include <algorithm>
#include <cmath>

#include "geometry/vector_code.h"

namespace verlet_cable {

namespace {

/// Links in a coarse link's length.
constexpr double links_in_one = 4;
constexpr int sweeps = 6;
/// Of a correction, what is made: the rest costs less than a correction that goes too far.
constexpr double corrected_part = 0.75;
/// Squares of a coarse link's length over that at rest: from the second it takes part, below the first it does not. Where a net
/// is in folds, coarse links are shorter than what they stand for, and know nothing of it.
constexpr double folded = 0.97, taut = 1;

/// to += weight * from
VERLET_CABLE_VECTOR_CODE void add_weighted(int count, double weight, const double* __restrict from, double* __restrict to) {
  for (int k = 0; k < count; ++k) to[k] += weight * from[k];
}

VERLET_CABLE_VECTOR_CODE void blend(int count, double lower, const double* __restrict a, double upper, const double* __restrict b,
                                    double* __restrict to) {
  for (int k = 0; k < count; ++k) to[k] = lower * a[k] + upper * b[k];
}

/// Coarse links that share no node.
struct Run {
  int count, i, j;
  const double *x, *y, *z, *lacking, *softening, *mobility, *w;
  double *impulse, *u, *v, *s;
};

template <int stride>
inline __attribute__((always_inline)) void relax(const Run& p) {
#pragma GCC ivdep
  for (int k = 0; k < p.count; ++k) {
    const int link = k * stride, i = p.i + link, j = p.j + link;
    const double x = p.x[link], y = p.y[link], z = p.z[link];
    const double rate = x * (p.u[j] - p.u[i]) + y * (p.v[j] - p.v[i]) + z * (p.s[j] - p.s[i]);
    const double change = (p.lacking[link] - p.impulse[link] - p.softening[link] * rate) * p.mobility[link];
    p.impulse[link] += change;
    const double of_i = change * p.w[i], of_j = change * p.w[j];
    p.u[i] -= of_i * x;
    p.v[i] -= of_i * y;
    p.s[i] -= of_i * z;
    p.u[j] += of_j * x;
    p.v[j] += of_j * y;
    p.s[j] += of_j * z;
  }
}

VERLET_CABLE_VECTOR_CODE void relax_by_one(Run run) {
  relax<1>(run);
}
VERLET_CABLE_VECTOR_CODE void relax_by_two(Run run) {
  relax<2>(run);
}

}  // namespace

/// Linear interpolation; what lies between nodes, beyond the last of them, goes to zero at a free edge, as what pulls across it.
CoarseNet::Axis::Axis(int samples, int coarse, double ratio, bool between_nodes) {
  const double offset = between_nodes ? 0.5 : 0;
  for (int i = 0; i < samples; ++i) {
    const double at = (i + offset) / ratio - offset, inside = std::clamp(at, 0.0, coarse - 1.0);
    const double part = 1 - std::abs(at - inside);
    first.push_back(std::min(static_cast<int>(inside), coarse - 2));
    upper.push_back(part * (inside - first.back()));
    lower.push_back(part - upper.back());
  }
}

void CoarseNet::resize(const NetModel& model, const std::vector<double>& inverse_mass, double softening) {
  fine_rows_ = model.rows;
  fine_columns_ = model.columns;
  const auto intervals = [](int nodes) { return std::max(2, static_cast<int>(std::lround((nodes - 1) / links_in_one))); };
  rows_ = intervals(fine_rows_) + 1;
  columns_ = intervals(fine_columns_) + 1;
  row_ratio_ = (fine_rows_ - 1.0) / (rows_ - 1);
  column_ratio_ = (fine_columns_ - 1.0) / (columns_ - 1);
  for (int k = 0; k < 4; ++k) {
    Direction& d = directions_[k];
    const bool across = k != 1, down = k != 0;
    d.rows = rows_ - down;
    d.columns = columns_ - across;
    d.first_offset = k == 3 ? 1 : 0;
    d.second_offset = k == 0 ? 1 : k == 2 ? columns_ + 1 : columns_;
    d.series = k == 0 ? column_ratio_ : k == 1 ? row_ratio_ : std::sqrt(row_ratio_ * column_ratio_);
    d.row_axis = Axis(fine_rows_ - down, d.rows, row_ratio_, down);
    d.column_axis = Axis(fine_columns_ - across, d.columns, column_ratio_, across);
    const std::size_t links = static_cast<std::size_t>(d.rows) * d.columns;
    for (std::vector<double>* values :
         {&d.weight, &d.lacking, &d.impulse, &d.softening, &d.whole_softening, &d.part, &d.mobility})
      values->assign(links, 0.0);
    d.along.assign(links, 0.0);
    d.strip.assign(static_cast<std::size_t>(d.rows) * d.column_axis.samples(), 0.0);
  }
  add_pieces(model);
  add_weights(softening);
  add_nodes(model, inverse_mass);
}

void CoarseNet::add_pieces(const NetModel& model) {
  pieces_.clear();
  for (int link = 0; link < static_cast<int>(model.links.size()); ++link) {
    const auto [i, j] = model.links[link];
    const int apart = j - i;
    const int direction = apart == 1 ? 0 : apart == fine_columns_ ? 1 : apart == fine_columns_ + 1 ? 2 : 3;
    const int row = i / fine_columns_, column = i % fine_columns_ - (direction == 3 ? 1 : 0);
    directions_[direction].length = directions_[direction].series * model.rest_lengths[link];
    Piece* last = pieces_.empty() ? nullptr : &pieces_.back();
    if (last != nullptr && last->direction == direction && last->row == row && last->column + last->count == column)
      ++last->count;
    else
      pieces_.push_back({direction, row, column, link, 1});
  }
}

void CoarseNet::add_weights(double softening) {
  for (const Piece& piece : pieces_) {
    Direction& d = directions_[piece.direction];
    for (int k = 0; k < piece.count; ++k) {
      const int row = d.row_axis.first[piece.row], column = d.column_axis.first[piece.column + k];
      for (const int down : {0, 1})
        for (const int across : {0, 1}) {
          const double part = (down ? d.row_axis.upper : d.row_axis.lower)[piece.row] *
                              (across ? d.column_axis.upper : d.column_axis.lower)[piece.column + k];
          if (part > 0) d.weight[(row + down) * d.columns + column + across] += part;
        }
    }
  }
  for (Direction& d : directions_)
    for (std::size_t link = 0; link < d.weight.size(); ++link)
      d.whole_softening[link] = softening * d.weight[link] / (d.series * d.series);
}

/// A coarse node at a held one is held.
void CoarseNet::add_nodes(const NetModel& model, const std::vector<double>& inverse_mass) {
  const Axis down(fine_rows_, rows_, row_ratio_, false), across(fine_columns_, columns_, column_ratio_, false);
  std::vector<double> mass(static_cast<std::size_t>(rows_) * columns_, 0.0);
  std::vector<char> held(mass.size(), 0);
  for (int row = 0; row < fine_rows_; ++row)
    for (int column = 0; column < fine_columns_; ++column) {
      const int node = row * fine_columns_ + column;
      double* corner = mass.data() + down.first[row] * columns_ + across.first[column];
      corner[0] += model.masses[node] * down.lower[row] * across.lower[column];
      corner[1] += model.masses[node] * down.lower[row] * across.upper[column];
      corner[columns_] += model.masses[node] * down.upper[row] * across.lower[column];
      corner[columns_ + 1] += model.masses[node] * down.upper[row] * across.upper[column];
      if (inverse_mass[node] == 0) held[std::lround(row / row_ratio_) * columns_ + std::lround(column / column_ratio_)] = 1;
    }
  inverse_mass_.resize(mass.size());
  for (std::size_t node = 0; node < mass.size(); ++node) inverse_mass_[node] = held[node] ? 0 : 1 / mass[node];
  position_.assign(mass.size(), 0.0);
  velocity_.assign(mass.size(), 0.0);
}

void CoarseNet::correct(const VectorArray& position, std::vector<double>& impulses) {
  aim(position);
  gather(impulses);
  velocity_.assign(inverse_mass_.size(), 0.0);
  for (int i = 0; i < sweeps; ++i) sweep(i % 2 == 0);
  spread(impulses);
}

void CoarseNet::aim(const VectorArray& position) {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const int upper = std::min(static_cast<int>(row * row_ratio_), fine_rows_ - 2);
      const int left = std::min(static_cast<int>(column * column_ratio_), fine_columns_ - 2);
      const double down = row * row_ratio_ - upper, across = column * column_ratio_ - left;
      const int node = upper * fine_columns_ + left;
      const Vector3 above = (1 - across) * get(position, node) + across * get(position, node + 1);
      const int below_node = node + fine_columns_;
      const Vector3 below = (1 - across) * get(position, below_node) + across * get(position, below_node + 1);
      set(position_, row * columns_ + column, (1 - down) * above + down * below);
    }
  for (Direction& d : directions_)
    for (int row = 0; row < d.rows; ++row)
      for (int column = 0; column < d.columns; ++column) {
        const int link = row * d.columns + column, i = row * columns_ + column + d.first_offset;
        const int j = row * columns_ + column + d.second_offset;
        const Vector3 along = (get(position_, j) - get(position_, i)) / d.length;
        set(d.along, link, along);
        d.part[link] = std::clamp((along.squaredNorm() - folded) / (taut - folded), 0.0, 1.0);
        d.softening[link] = d.part[link] * d.whole_softening[link];
        d.mobility[link] = 1 / (1 + d.softening[link] * along.squaredNorm() * (inverse_mass_[i] + inverse_mass_[j]));
      }
}

void CoarseNet::gather(const std::vector<double>& impulses) {
  for (Direction& d : directions_) {
    std::fill(d.lacking.begin(), d.lacking.end(), 0.0);
    std::fill(d.impulse.begin(), d.impulse.end(), 0.0);
    std::fill(d.strip.begin(), d.strip.end(), 0.0);
  }
  for (const Piece& piece : pieces_) {
    Direction& d = directions_[piece.direction];
    const int samples = d.column_axis.samples();
    const double* const from = impulses.data() + piece.link;
    double* const to = d.strip.data() + d.row_axis.first[piece.row] * samples + piece.column;
    add_weighted(piece.count, d.row_axis.lower[piece.row], from, to);
    add_weighted(piece.count, d.row_axis.upper[piece.row], from, to + samples);
  }
  for (Direction& d : directions_)
    for (int row = 0; row < d.rows; ++row)
      for (int column = 0; column < d.column_axis.samples(); ++column) {
        const double sum = d.strip[row * d.column_axis.samples() + column] / d.series;
        double* const to = d.lacking.data() + row * d.columns + d.column_axis.first[column];
        to[0] += d.column_axis.lower[column] * sum;
        to[1] += d.column_axis.upper[column] * sum;
      }
  for (Direction& d : directions_)
    for (std::size_t link = 0; link < d.lacking.size(); ++link) d.lacking[link] *= d.part[link];
}

void CoarseNet::sweep(bool forwards) {
  for (int k = 0; k < rows_; ++k)
    for (int m = 0; m < 4; ++m) {
      const int row = forwards ? k : rows_ - 1 - k, direction = forwards ? m : 3 - m;
      Direction& d = directions_[direction];
      if (row >= d.rows) continue;
      const auto run_from = [&](int column, int count) {
        const int at = row * d.columns + column, node = row * columns_ + column;
        return Run{count,
                   node + d.first_offset,
                   node + d.second_offset,
                   d.along.x.data() + at,
                   d.along.y.data() + at,
                   d.along.z.data() + at,
                   d.lacking.data() + at,
                   d.softening.data() + at,
                   d.mobility.data() + at,
                   inverse_mass_.data(),
                   d.impulse.data() + at,
                   velocity_.x.data(),
                   velocity_.y.data(),
                   velocity_.z.data()};
      };
      if (direction != 0) {
        relax_by_one(run_from(0, d.columns));
      } else {
        relax_by_two(run_from(0, (d.columns + 1) / 2));
        relax_by_two(run_from(1, d.columns / 2));
      }
    }
}

void CoarseNet::spread(std::vector<double>& impulses) {
  for (Direction& d : directions_) {
    for (std::size_t link = 0; link < d.impulse.size(); ++link)
      d.impulse[link] *= d.weight[link] > 0 ? corrected_part * d.series / d.weight[link] : 0;
    for (int row = 0; row < d.rows; ++row)
      for (int column = 0; column < d.column_axis.samples(); ++column) {
        const double* const from = d.impulse.data() + row * d.columns + d.column_axis.first[column];
        d.strip[row * d.column_axis.samples() + column] =
            d.column_axis.lower[column] * from[0] + d.column_axis.upper[column] * from[1];
      }
  }
  for (const Piece& piece : pieces_) {
    const Direction& d = directions_[piece.direction];
    const int samples = d.column_axis.samples();
    const double* const from = d.strip.data() + d.row_axis.first[piece.row] * samples + piece.column;
    blend(piece.count, d.row_axis.lower[piece.row], from, d.row_axis.upper[piece.row], from + samples,
          impulses.data() + piece.link);
  }
}

}  // namespace verlet_cable
