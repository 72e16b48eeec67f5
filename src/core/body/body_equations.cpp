#include "body/body_equations.h"

#include <algorithm>
#include <set>

namespace verlet_cable {

void BodyEquations::begin(int bodies) {
  couples_.clear();
  if (bodies == bodies_) return;
  bodies_ = bodies;
  last_couples_.assign(1, {-1, -1});  // none are like them
  loads_.resize(bodies);
  solution_.resize(bodies);
  eliminated_.resize(bodies);
  pivots_.resize(bodies);
}

void BodyEquations::couple(int a, int b) {
  if (a != b) couples_.emplace_back(std::min(a, b), std::max(a, b));
}

void BodyEquations::end() {
  std::sort(couples_.begin(), couples_.end());
  couples_.erase(std::unique(couples_.begin(), couples_.end()), couples_.end());
  if (couples_ == last_couples_) return;
  find_order();
  last_couples_ = couples_;
}

/// Always the body that acts on the fewest (minimum degree; Tinney and Walker 1967): leaves of a tree first. What it acts on act
/// on each other from then on.
void BodyEquations::find_order() {
  std::vector<std::set<int>> neighbours(bodies_);
  for (const auto& [a, b] : couples_) {
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  }
  std::vector<char> done(bodies_, 0);
  order_.clear();
  later_.assign(bodies_, {});
  places_.assign(bodies_, {});
  int count = bodies_;
  for (int i = 0; i < bodies_; ++i) {
    int next = -1;
    for (int b = 0; b < bodies_; ++b)
      if (!done[b] && (next < 0 || neighbours[b].size() < neighbours[next].size())) next = b;
    done[next] = 1;
    order_.push_back(next);
    later_[next].assign(neighbours[next].begin(), neighbours[next].end());
    for (const int other : later_[next]) {
      places_[next].emplace_back(count, count + 1);
      count += 2;
      neighbours[other].erase(next);
      for (const int third : later_[next])
        if (third != other) neighbours[other].insert(third);
    }
  }
  blocks_.resize(count);
  groups_.resize(bodies_);
  const auto place_of = [&](int body) { return std::find(order_.begin(), order_.end(), body); };
  for (auto next = order_.rbegin(); next != order_.rend(); ++next) {
    const std::vector<int>& later = later_[*next];
    const auto first = std::min_element(later.begin(), later.end(), [&](int a, int b) { return place_of(a) < place_of(b); });
    groups_[*next] = first == later.end() ? *next : groups_[*first];
  }
}

void BodyEquations::clear_matrix() {
  for (Matrix6& block : blocks_) block.setZero();
}

Matrix6& BodyEquations::block(int row, int column) {
  if (row == column) return blocks_[row];
  const auto find = [&](int first, int second) {
    const std::vector<int>& later = later_[first];
    const auto same = std::lower_bound(later.begin(), later.end(), second);
    return same != later.end() && *same == second ? static_cast<int>(same - later.begin()) : -1;
  };
  const int of_row = find(row, column);
  return of_row >= 0 ? blocks_[places_[row][of_row].first] : blocks_[places_[column][find(column, row)].second];
}

double BodyEquations::largest_resistance() const {
  double largest = 0;
  for (int b = 0; b < bodies_; ++b) largest = std::max(largest, blocks_[b].topLeftCorner<3, 3>().cwiseAbs().maxCoeff());
  return largest;
}

double BodyEquations::largest_turning_resistance() const {
  double largest = 0;
  for (int b = 0; b < bodies_; ++b) largest = std::max(largest, blocks_[b].bottomRightCorner<3, 3>().cwiseAbs().maxCoeff());
  return largest;
}

/// In place: of a body's row what it is divided by its pivot.
void BodyEquations::factor() {
  for (const int k : order_) {
    pivots_[k].compute(blocks_[k]);
    for (const auto& [row, column] : places_[k]) {
      const Matrix6 before = blocks_[row];
      blocks_[row] = pivots_[k].solve(before);
    }
    for (std::size_t i = 0; i < later_[k].size(); ++i)
      for (std::size_t j = 0; j < later_[k].size(); ++j)
        block(later_[k][i], later_[k][j]).noalias() -= blocks_[places_[k][i].second] * blocks_[places_[k][j].first];
  }
}

void BodyEquations::solve() {
  eliminated_ = loads_;
  for (const int k : order_) {
    const Vector6 load = eliminated_[k];
    eliminated_[k] = pivots_[k].solve(load);
    for (std::size_t i = 0; i < later_[k].size(); ++i)
      eliminated_[later_[k][i]].noalias() -= blocks_[places_[k][i].second] * eliminated_[k];
  }
  for (auto next = order_.rbegin(); next != order_.rend(); ++next) {
    Vector6& solution = solution_[*next];
    solution = eliminated_[*next];
    for (std::size_t i = 0; i < later_[*next].size(); ++i)
      solution.noalias() -= blocks_[places_[*next][i].first] * solution_[later_[*next][i]];
  }
}

double BodyEquations::work() const {
  double work = 0;
  for (int b = 0; b < bodies_; ++b) work += loads_[b].dot(solution_[b]);
  return work;
}

}  // namespace verlet_cable
