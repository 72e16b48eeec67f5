#include "body/body_equations.h"

#include <algorithm>

namespace verlet_cable {

void BodyEquations::resize(int bodies) {
  const Eigen::Index unknowns = 6 * bodies;
  if (matrix_.rows() == unknowns) return;
  matrix_.resize(unknowns, unknowns);
  load_.resize(unknowns);
  solution_.resize(unknowns);
}

double BodyEquations::largest_resistance() const {
  double largest = 0;
  for (Eigen::Index i = 0; i < matrix_.rows(); i += 6)
    largest = std::max(largest, matrix_.block<3, 3>(i, i).cwiseAbs().maxCoeff());
  return largest;
}

double BodyEquations::largest_turning_resistance() const {
  double largest = 0;
  for (Eigen::Index i = 3; i < matrix_.rows(); i += 6)
    largest = std::max(largest, matrix_.block<3, 3>(i, i).cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace verlet_cable
