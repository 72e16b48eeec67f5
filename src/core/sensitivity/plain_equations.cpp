#include "sensitivity/plain_equations.h"

#include <algorithm>
#include <array>

namespace verlet_cable {

namespace {

template <class To>
VectorOf<To> constants_of(const ColumnVector& v) {
  return {To(v.x.value), To(v.y.value), To(v.z.value)};
}

template <class To>
PlainSegment<To> constants_of(const PlainSegment<Column>& s) {
  return {s.is_elastic, To(s.rest_length.value), To(s.axial_stiffness.value), To(s.axial_damping.value), To(s.compliance.value)};
}
template <class To>
PlainJoint<To> constants_of(const PlainJoint<Column>& j) {
  return {To(j.stiffness.value), To(j.damping.value), To(j.inverse_before.value), To(j.inverse_after.value),
          constants_of<To>(j.turned)};
}
template <class To>
PlainClamp<To> constants_of(const PlainClamp<Column>& c) {
  return {c.direction,
          c.segment,
          c.is_elastic,
          To(c.inverse_length.value),
          To(c.stiffness.value),
          To(c.damping.value),
          constants_of<To>(c.start_axis),
          constants_of<To>(c.end_axis)};
}

/// A difference of two places, the first of which is the `from`-th, the second the `to`-th number of the derivatives.
template <int n>
void vary(int from, int to, VectorOf<Dual<n>>& v) {
  int k = 0;
  for (Dual<n>* component : {&v.x, &v.y, &v.z}) {
    component->slope[from + k] -= 1;
    component->slope[to + k] += 1;
    ++k;
  }
}

/// Adds the derivatives of a load on a node. `columns`: of the matrix, one a derivative.
template <std::size_t n>
void add_load(int node, double sign, const VectorOf<Dual<static_cast<int>(n)>>& load, const std::array<int, n>& columns,
              BandMatrix& matrix) {
  int row = unknowns_a_node * node;
  for (const Dual<static_cast<int>(n)>* component : {&load.x, &load.y, &load.z}) {
    for (std::size_t k = 0; k < n; ++k) matrix.at(row, columns[k]) += sign * component->slope[k];
    ++row;
  }
}

}  // namespace

void PlainEquations::find_share() {
  share_ = 0;
  mode_ = TurnedShare::none;
  if (!is_damped) return;
  Column along;
  turned_square_ = 0;
  for (int i = 1; i + 1 < nodes(); ++i) {
    const PlainJoint<Column>& joint = joints[i];
    const BendDamping<Column> damper{joint.damping, zero_vector<Column>(), joint.turned};
    along += damper.along(bend_of(joint, change_of(i - 1), change_of(i)));
    turned_square_ += damper.square();
  }
  const double share = turned_share(along.value, turned_square_.value);
  if (share <= 0) return;
  mode_ = share < 1 ? TurnedShare::some : TurnedShare::all;
  share_ = mode_ == TurnedShare::some ? along / turned_square_ : Column(1);
}

void PlainEquations::evaluate() {
  const int n = nodes() - 1;
  find_share();
  force.resize(n);
  force_along.resize(n);
  mean_length.resize(n);
  gap_.resize(n);
  residual_.resize(n + 1);
  clamp_bends.resize(clamps.size());
  std::vector<ColumnVector> bending(n, zero_vector<Column>());
  for (int i = 1; i < n; ++i) {
    const PlainJoint<Column>& joint = joints[i];
    const ColumnVector moment =
        joint_bend(joint, bend_of(joint, start[i - 1], start[i]), bend_of(joint, change_of(i - 1), change_of(i)), share_, part)
            .moment;
    bending[i] = bending[i] + joint.inverse_after * moment;
    bending[i - 1] = bending[i - 1] - joint.inverse_before * moment;
  }
  for (std::size_t k = 0; k < clamps.size(); ++k) {
    const int i = clamps[k].segment;
    clamp_bends[k] = clamp_bend(clamps[k], start[i], change_of(i), part);
    bending[i] = bending[i] + clamps[k].inverse_length * clamp_bends[k].moment;
  }
  for (int i = 0; i < n; ++i) {
    const Stretching<Column> stretched = stretching(segments[i], start[i], change_of(i), density[i], part);
    const ColumnVector middle = start[i] + (Column() + part) * change_of(i);
    force[i] = stretched.force + bending[i];
    force_along[i] = dot(bending[i], middle) / segments[i].rest_length;
    mean_length[i] = stretched.mean;
    gap_[i] = stretched.row.gap;
  }
  for (int i = 0; i <= n; ++i) {
    residual_[i] = load[i] - inertia[i] * displacement[i];
    if (i < n) residual_[i] = residual_[i] + force[i];
    if (i > 0) residual_[i] = residual_[i] - force[i - 1];
  }
}

void PlainEquations::assemble() {
  const int n = nodes() - 1;
  matrix_.assign(unknowns_a_node * (n + 1), coupling_reach);
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k < 3; ++k) matrix_.at(unknowns_a_node * i + k, unknowns_a_node * i + k) = is_static ? 0 : -inertia[i].value;
  for (int i = 0; i < n; ++i) {
    using Real = Dual<7>;
    const int c = unknowns_a_node * i;
    const std::array<int, 7> columns{c, c + 1, c + 2, c + 4, c + 5, c + 6, c + density_place};
    VectorOf<Real> from = constants_of<Real>(start[i]), change = constants_of<Real>(change_of(i));
    vary(0, 3, is_static ? from : change);
    const Stretching<Real> stretched =
        stretching(constants_of<Real>(segments[i]), from, change, Real::variable(density[i].value, 6), part);
    add_load(i, 1, stretched.force, columns, matrix_);
    add_load(i + 1, -1, stretched.force, columns, matrix_);
    for (int k = 0; k < 7; ++k) matrix_.at(c + density_place, columns[k]) += stretched.row.gap.slope[k];
  }
  for (int i = 1; i < n; ++i) {
    if (joints[i].stiffness.value == 0 && joints[i].damping.value == 0) continue;
    using Real = Dual<9>;
    const int c = unknowns_a_node * (i - 1);
    const std::array<int, 9> columns{c, c + 1, c + 2, c + 4, c + 5, c + 6, c + 8, c + 9, c + 10};
    VectorOf<Real> before = constants_of<Real>(is_static ? start[i - 1] : change_of(i - 1));
    VectorOf<Real> after = constants_of<Real>(is_static ? start[i] : change_of(i));
    vary(0, 3, before);
    vary(3, 6, after);
    const PlainJoint<Real> joint = constants_of<Real>(joints[i]);
    const VectorOf<Real> varied = bend_of(joint, before, after);
    const VectorOf<Real> given =
        is_static ? zero_vector<Real>() : bend_of(joint, constants_of<Real>(start[i - 1]), constants_of<Real>(start[i]));
    const VectorOf<Real> moment =
        joint_bend(joint, is_static ? varied : given, is_static ? given : varied, Real(share_.value), part).moment;
    const double inverse_before = joint.inverse_before.value, inverse_after = joint.inverse_after.value;
    add_load(i - 1, -inverse_before, moment, columns, matrix_);
    add_load(i, inverse_before + inverse_after, moment, columns, matrix_);
    add_load(i + 1, -inverse_after, moment, columns, matrix_);
  }
  for (const PlainClamp<Column>& clamp : clamps) {
    using Real = Dual<6>;
    const int i = clamp.segment, c = unknowns_a_node * i;
    const std::array<int, 6> columns{c, c + 1, c + 2, c + 4, c + 5, c + 6};
    VectorOf<Real> from = constants_of<Real>(start[i]), change = constants_of<Real>(change_of(i));
    vary(0, 3, is_static ? from : change);
    const VectorOf<Real> moment = clamp_bend(constants_of<Real>(clamp), from, change, part).moment;
    const double inverse = clamp.inverse_length.value;
    add_load(i, inverse, moment, columns, matrix_);
    add_load(i + 1, -inverse, moment, columns, matrix_);
  }
  const auto fix = [this](int row) {
    matrix_.clear_row(row);
    matrix_.at(row, row) = 1;
  };
  for (int i = 0; i <= n; ++i)
    if (movable[i] == 0)
      for (int k = 0; k < 3; ++k) fix(unknowns_a_node * i + k);
  for (int i = 0; i < n; ++i)
    if (fixed_density[i] != 0) fix(unknowns_a_node * i + density_place);
  fix(unknowns_a_node * n + density_place);  // there is no segment after the last node
}

bool PlainEquations::factor() {
  assemble();
  if (!matrix_.factor()) return false;
  turned_ = {};
  if (mode_ != TurnedShare::some) return true;
  const int n = nodes() - 1;
  std::vector<Vector3> loads(n + 1, Vector3::Zero());
  for (int i = 1; i < n; ++i) {
    const PlainJoint<Column>& joint = joints[i];
    const Vector3 moment = joint.damping.value * values_of(joint.turned);
    loads[i - 1] += joint.inverse_before.value * moment;
    loads[i] -= (joint.inverse_before.value + joint.inverse_after.value) * moment;
    loads[i + 1] += joint.inverse_after.value * moment;
  }
  turned_.load.assign(unknowns_a_node * (n + 1), 0.0);
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k < 3; ++k) turned_.load[unknowns_a_node * i + k] = movable[i] != 0 ? loads[i][k] : 0;
  turned_.solution = turned_.load;
  turned_.square = turned_square_.value;
  matrix_.solve(turned_.solution.data(), 1);
  return true;
}

double PlainEquations::solve(PlainEquations& factored) {
  const int n = nodes() - 1, columns = columns_at_once + 1, rows = unknowns_a_node * (n + 1);
  right_.assign(static_cast<std::size_t>(rows) * columns, 0.0);
  const auto put = [&](int row, const Column& lacking) {
    double* to = right_.data() + static_cast<std::ptrdiff_t>(row) * columns;
    for (int k = 0; k < columns_at_once; ++k) to[k] = -lacking.slope[k];
    to[columns_at_once] = -lacking.value;
  };
  for (int i = 0; i <= n; ++i) {
    if (movable[i] != 0) {
      put(unknowns_a_node * i, residual_[i].x);
      put(unknowns_a_node * i + 1, residual_[i].y);
      put(unknowns_a_node * i + 2, residual_[i].z);
    }
    if (i < n && fixed_density[i] == 0) put(unknowns_a_node * i + density_place, gap_[i]);
  }
  factored.matrix_.solve(right_.data(), columns);
  const Turned& turned = factored.turned_;
  if (!turned.load.empty()) {
    // The share's own derivative: a matrix of rank one is added (Sherman and Morrison).
    double square = turned.square;
    for (int row = 0; row < rows; ++row) square += turned.load[row] * turned.solution[row];
    for (int k = 0; k < columns; ++k) {
      double along = 0;
      for (int row = 0; row < rows; ++row) along += turned.load[row] * right_[row * columns + k];
      for (int row = 0; row < rows; ++row) right_[row * columns + k] -= along / square * turned.solution[row];
    }
  }
  const auto take = [&](int row, Column& unknown) {
    const double* from = right_.data() + static_cast<std::ptrdiff_t>(row) * columns;
    for (int k = 0; k < columns_at_once; ++k) unknown.slope[k] += from[k];
    return from[columns_at_once];
  };
  correction_.resize(n + 1);
  density_correction_.resize(n);
  double largest = 0;
  for (int i = 0; i <= n; ++i) {
    ColumnVector& u = displacement[i];
    correction_[i] = {take(unknowns_a_node * i, u.x), take(unknowns_a_node * i + 1, u.y), take(unknowns_a_node * i + 2, u.z)};
    const double size = correction_[i].norm();
    if (!(size <= largest)) largest = size;  // what is no number is the largest
    if (i < n) density_correction_[i] = take(unknowns_a_node * i + density_place, density[i]);
  }
  if (!is_static) evaluate();
  return largest;
}

}  // namespace verlet_cable
