#include "rod/rod_elimination.h"

#include <algorithm>
#include <cmath>

#include "rod/outer_products.h"

namespace verlet_cable {

namespace {

/// Where what is held does not give way, so much does, relative to what is beside it. Between held nodes next to each other
/// nothing else does: less would leave nothing but rounding of how the segment between them turns.
constexpr double held_compliance = 1e-10, neighbours_compliance = 1e-6;
/// Where a stretch would meet less resistance than this, relative to what it meets where nothing is added, the matrix is replaced
/// by one that is as good.
constexpr double least_resistance = 1e-3;

PairVector row(const PairSymmetric& m, int i) {
  return i == 0 ? PairVector{m.xx, m.xy, m.xz} : i == 1 ? PairVector{m.xy, m.yy, m.yz} : PairVector{m.xz, m.yz, m.zz};
}

PairMatrix full(const PairSymmetric& m) {
  return {row(m, 0), row(m, 1), row(m, 2)};
}

PairMatrix operator*(const PairMatrix& m, const PairMatrix& a) {
  return {transposed_times(a, m.row_x), transposed_times(a, m.row_y), transposed_times(a, m.row_z)};
}

PairMatrix operator*(const PairMatrix& m, const PairSymmetric& a) {
  return {a * m.row_x, a * m.row_y, a * m.row_z};
}

/// a + b c^T, for b c^T symmetric
PairSymmetric plus_product_transposed(const PairSymmetric& a, const PairMatrix& b, const PairMatrix& c) {
  return {a.xx + dot(b.row_x, c.row_x), a.xy + dot(b.row_x, c.row_y), a.xz + dot(b.row_x, c.row_z),
          a.yy + dot(b.row_y, c.row_y), a.yz + dot(b.row_y, c.row_z), a.zz + dot(b.row_z, c.row_z)};
}

/// m - [d]x
PairMatrix minus_cross(const PairMatrix& m, const PairVector& d) {
  return {{m.row_x.x, m.row_x.y + d.z, m.row_x.z - d.y},
          {m.row_y.x - d.z, m.row_y.y, m.row_y.z + d.x},
          {m.row_z.x + d.y, m.row_z.y - d.x, m.row_z.z}};
}

PairMatrix operator-(const PairMatrix& a, const PairMatrix& b) {
  return {a.row_x - b.row_x, a.row_y - b.row_y, a.row_z - b.row_z};
}

PairMatrix operator*(Pair s, const PairMatrix& m) {
  return {s * m.row_x, s * m.row_y, s * m.row_z};
}

/// m + a b^T
PairMatrix plus_outer(const PairMatrix& m, const PairVector& a, const PairVector& b) {
  return {m.row_x + a.x * b, m.row_y + a.y * b, m.row_z + a.z * b};
}

/// (A^-1 + m)^-1
PairSymmetric stiffened_by(const PairSymmetric& a, Pair m) {
  const PairSymmetric z = scaled_inverse(plus_diagonal(times(m, a), both(1)), both(1));
  const auto element = [&](int i, int j) { return dot(row(z, i), row(a, j)); };
  return {element(0, 0), element(0, 1), element(0, 2), element(1, 1), element(1, 2), element(2, 2)};
}

/// (A^-1 + M)^-1 = (1 + A M)^-1 A
PairSymmetric stiffened_by(const PairSymmetric& a, const PairSymmetric& m) {
  const auto element = [&](int i, int j) { return dot(row(a, i), row(m, j)) + (i == j ? 1.0 : 0.0); };
  const PairVector x{element(0, 0), element(0, 1), element(0, 2)}, y{element(1, 0), element(1, 1), element(1, 2)},
      z{element(2, 0), element(2, 1), element(2, 2)};
  const PairVector yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const Pair scale = 1.0 / dot(x, yz);
  // Columns of the inverse are yz, zx and xy.
  const auto image = [&](int j) {
    const PairVector c = row(a, j);
    return scale * (c.x * yz + (c.y * zx + c.z * xy));
  };
  const PairVector first = image(0), second = image(1), third = image(2);
  return {first.x, second.x, third.x, second.y, third.y, third.z};
}

/// n of the part n x of the added couplings of two segments that is not symmetric, in the directions of their eliminations.
PairVector skew_pair(const MatrixArray& m, int left, int right) {
  const auto half_difference = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return Pair{0.5, -0.5} * (pair(a, left, right) - pair(b, left, right));
  };
  return {half_difference(m.row_z.y, m.row_y.z), half_difference(m.row_x.z, m.row_z.x), half_difference(m.row_y.x, m.row_x.y)};
}

bool is_positive(Pair value) {
  return value[0] > 0 && value[1] > 0;
}

/// The inverse; false if it is not positive definite.
bool invert(const PairSymmetric& m, PairSymmetric& inverse) {
  inverse = scaled_inverse(m, both(1));
  const Pair minor = m.xx * m.yy - m.xy * m.xy;
  const Pair determinant_sign = inverse.zz * minor;  // minor² / determinant
  return is_positive(m.xx) && is_positive(minor) && is_positive(determinant_sign);
}

}  // namespace

void RodStiffness::resize(int segments) {
  // One node and segment more than the cable has, where that makes the number of segments even.
  const std::size_t nodes = segments + 2;
  segment.assign(nodes, 0.0);
  force_density.assign(nodes, 0.0);
  torque.assign(nodes, 0.0);
  segment.xx[segments] = segment.yy[segments] = segment.zz[segments] = 1;
}

void RodElimination::resize(int segments) {
  segments_ = segments;
  padded_ = segments + segments % 2;
  inertia_.assign(segments + 2, 0.0);
  mobility_.assign(2, 0.0);
  eliminations_.assign(padded_ / 2, Elimination{});
  forward_.assign(padded_ / 2, Forward{});
  held_inside_.reserve(padded_ / 2);
  solution_.resize(segments);
}

namespace {

/// Of a node inside, in a direction in which nothing else gives way [m/N]; `before`: the node that the elimination comes from.
double least_compliance(const KktSystem& system, const RodStiffness& stiffness, const RodJoints& joints, int before, int node) {
  double beside = system.diagonal[node];
  for (const int i : {node - 1, node})
    beside += std::abs(stiffness.force_density[i]) +
              (get(stiffness.segment, i).trace() + get(joints.stiffness(), i).trace()) / get(system.direction, i).squaredNorm();
  return (system.movable[before] == 0 ? neighbours_compliance : held_compliance) / beside;
}

}  // namespace

bool RodElimination::factor(const KktSystem& system, const RodStiffness& stiffness, const RodJoints& joints) {
  const int n = segments_;
  std::copy_n(system.diagonal.begin(), n + 1, inertia_.begin());
  if (padded_ > n) inertia_[n] = inertia_[n + 1] = 0.5 * inertia_[n];
  mobility_[0] = system.movable[0] != 0 ? 1 / inertia_[0] : 0;
  mobility_[1] = system.movable[n] != 0 ? 1 / inertia_[padded_] : 0;
  stiffened_ = system.stiffened;
  held_inside_.clear();
  return stiffened_ ? factor_lanes<true>(system, stiffness, joints) : factor_lanes<false>(system, stiffness, joints);
}

void RodElimination::solve(const KktSystem& system, const std::vector<double>& torque) {
  if (stiffened_)
    solve_lanes<true>(system, torque);
  else
    solve_lanes<false>(system, torque);
}

/// How the outermost nodes give way alone.
template <bool stiffened>
PairSymmetric RodElimination::ends(const KktSystem& system) const {
  const Pair mobility{mobility_[0], mobility_[1]};
  const PairSymmetric free{mobility, Pair{}, Pair{}, mobility, Pair{}, mobility};
  if constexpr (!stiffened) return free;
  PairSymmetric added = pair(system.added, 0, segments_) + symmetric_pair(system.added_next, 0, segments_ - 1);
  if (padded_ > segments_) added = times(Pair{1, 0}, added);
  return stiffened_by(free, added);
}

/// How far the outermost nodes are displaced by what holds them.
PairVector RodElimination::held_ends(const KktSystem& system) const {
  const Pair held{1 - system.movable[0], 1 - system.movable[segments_]};
  return held * pair(system.held_displacement, 0, segments_);
}

template <bool stiffened>
bool RodElimination::factor_lanes(const KktSystem& system, const RodStiffness& stiffness, const RodJoints& joints) {
  const int half = padded_ / 2;
  const Pair side{1, -1}, turning_part = stiffness.turning_part * side;
  PairSymmetric give = ends<stiffened>(system), resist{};
  PairMatrix turned{};
  // Where what is added outweighs the stiffness of a stretch, pivots may be negative though the matrix is not.
  bool positive = true, judged = true;
  for (int k = 0; k < half; ++k) {
    const int left = k, right = padded_ - 1 - k;  // segments; the nodes after them are left + 1 and right
    const bool last = k + 1 == half;
    Elimination& e = eliminations_[k];
    const PairVector direction = pair(system.direction, left, right);
    e.direction = side * direction;
    Pair square = dot(direction, direction);
    if (right == segments_) square[1] = 1;
    e.inverse_square = 1.0 / square;
    e.axis = square_root(e.inverse_square) * direction;
    // The segment is stretched by gap_share gap + stretch direction . f of its length.
    const Pair compliance = pair(system.compliance, left, right);
    e.force_density = pair(stiffness.force_density, left, right);
    Pair resistance = square + compliance * e.force_density;
    for (int lane = 0; lane < 2; ++lane) {
      // A tension that does not change with the length has a compliance that is negative, and so is this then.
      const double least = least_resistance * square[lane];
      resistance[lane] =
          compliance[lane] < 0 && resistance[lane] < 0 ? std::min(resistance[lane], -least) : std::max(resistance[lane], least);
    }
    e.gap_share = 1.0 / resistance;
    e.stretch = compliance * e.gap_share * e.inverse_square;
    resist = resist + pair(stiffness.segment, left, right);
    turned = minus_cross(turned, e.direction);
    if constexpr (stiffened) {
      // What couples the segment's nodes is given to both, and taken from the segment between them.
      e.across = symmetric_pair(system.added_next, left, right);
      const PairVector along = e.across * e.direction;
      e.stretch_turn = cross(e.direction, along);
      Pair softened = 1.0 - e.stretch * dot(e.direction, along);
      for (int lane = 0; lane < 2; ++lane) {
        judged = judged && softened[lane] > 0;
        if (std::abs(softened[lane]) < least_resistance) softened[lane] = least_resistance;
      }
      e.stretch = e.stretch / softened;
      e.gap_share = e.gap_share / softened;
      const PairMatrix arm = minus_cross(PairMatrix{}, e.direction);
      resist = minus_product(resist, arm, e.across * arm);
      resist = plus_outer(resist, -e.stretch, e.stretch_turn);
      turned = plus_outer(turned, e.stretch * e.direction, e.stretch_turn);
    }
    give = plus_outer(give, e.stretch, e.direction);

    Pair inertia = pair(inertia_, left + 1, right);
    if (last) inertia *= Pair{1, 0};
    PairMatrix image, beside;
    if constexpr (stiffened) {
      e.inertia = pair(system.added, left + 1, right) + symmetric_pair(system.added_next, left, right - 1) +
                  symmetric_pair(system.added_next, left + 1, right);
      if (last) e.inertia = times(Pair{1, 0}, e.inertia);
      e.inertia = plus_diagonal(e.inertia, inertia);
      e.skew = skew_pair(system.added_next, left, right);
      e.lever = cross(e.direction, e.skew);
      const Pair along = dot(e.skew, e.direction);
      beside = plus_outer(PairMatrix{{along, Pair{}, Pair{}}, {Pair{}, along, Pair{}}, {Pair{}, Pair{}, along}},
                          both(-1) * e.direction, e.skew);
      // The node stretches the segment, too: by that it gives way and resists otherwise, as do the two together.
      const PairVector stretched = e.stretch * e.direction, levered = give * e.lever;
      give = plus_both(give, both(2) * stretched, levered + (0.5 * dot(e.lever, levered)) * stretched);
      turned = plus_outer(turned, stretched, transposed_times(turned, e.lever));
      e.inertia = plus_outer(e.inertia, -e.stretch, e.lever);
      beside = plus_outer(beside, -e.stretch * e.lever, e.stretch_turn);
      e.give = stiffened_by(give, e.inertia);
      image = e.inertia * turned;
    } else {
      e.inertia.xx = inertia;
      e.give = stiffened_by(give, inertia);
      image = inertia * turned;
    }
    const PairSymmetric behind = resist;
    if constexpr (stiffened) {
      resist = minus_product(resist, both(-1) * turned, beside);
      image = image - both(-1) * beside;
    }
    e.turned = turned - e.give * image;
    resist = minus_product(resist, both(-1) * image, e.turned);
    const Pair free{left + 1 == segments_ ? 1 : system.movable[left + 1], last || right == segments_ ? 1 : system.movable[right]};
    if (free[0] == 0 || free[1] == 0) {
      // x = 0: the force is what makes it so, -A^-1 (B w + a).
      Pair floor = both(1);
      if (free[0] == 0) floor[0] = least_compliance(system, stiffness, joints, left, left + 1);
      if (free[1] == 0) floor[1] = least_compliance(system, stiffness, joints, std::min(right + 1, segments_), right);
      HeldInside held{k, free, scaled_inverse(plus_diagonal(give, floor), 1.0 - free), {}, {}};
      held.turned = held.stiffness * turned;
      held_inside_.push_back(held);
      resist = times(free, resist) + times(1.0 - free, minus_product(behind, both(-1) * turned, held.turned));
      e.give = times(free, e.give);
      e.turned = free * e.turned;
    }
    if (last) break;

    const PairSymmetric joint = pair(joints.stiffness(), left + 1, right);
    positive = invert(resist + joint, e.pivot) && positive;
    const PairMatrix coupling = both(-1) * minus_cross(full(joint), turning_part * pair(joints.moment, left + 1, right));
    e.carried = e.pivot * coupling;
    e.turned_pivot = e.turned * e.pivot;
    give = plus_product_transposed(e.give, e.turned_pivot, e.turned);
    turned = both(-1) * (e.turned_pivot * coupling);
    resist = minus_product(joint, coupling, e.carried);
  }

  // The two sides meet at a node and the joint there: the force between them, on the left one, and the rotations beside it.
  const Elimination& e = eliminations_[half - 1];
  const Eigen::Matrix3d joint = get(joints.stiffness(), half);
  const Eigen::Vector3d moment = stiffness.turning_part * get(joints.moment, half);
  Eigen::Matrix3d turning;
  turning << 0, -moment.z(), moment.y(), moment.z(), 0, -moment.x(), -moment.y(), moment.x(), 0;
  Middle a = Middle::Zero();
  a.block<3, 3>(0, 0) = lane(e.give, 0) + lane(e.give, 1);
  a.block<3, 3>(0, 3) = lane(e.turned, 0);
  a.block<3, 3>(0, 6) = -lane(e.turned, 1);
  a.block<3, 3>(3, 0) = -lane(e.turned, 0).transpose();
  a.block<3, 3>(6, 0) = lane(e.turned, 1).transpose();
  a.block<3, 3>(3, 3) = lane(resist, 0) + joint;
  a.block<3, 3>(6, 6) = lane(resist, 1) + joint;
  a.block<3, 3>(3, 6) = turning - joint;
  a.block<3, 3>(6, 3) = -turning - joint;
  middle_.compute(a);
  return !judged || (positive && middle_.determinant() > 0);
}

template <bool stiffened>
void RodElimination::solve_lanes(const KktSystem& system, const std::vector<double>& torque) {
  const int half = padded_ / 2;
  const auto inertia_times = [](const Elimination& e, const PairVector& v) {
    if constexpr (stiffened)
      return e.inertia * v;
    else
      return e.inertia.xx * v;
  };
  // The moment on a segment of the node after it.
  const auto moment_of = [](const Elimination& e, const PairVector& place) {
    return dot(e.skew, e.direction) * place - dot(e.direction, place) * e.skew -
           (e.stretch * dot(e.lever, place)) * e.stretch_turn;
  };
  // A node with another hanging on to it shares its load with that.
  const double part = padded_ > segments_ ? 0.5 : 1;
  const Pair share{1, part}, next_share{segments_ == 1 ? part : 1, part};
  PairVector give = ends<stiffened>(system) * (share * pair(system.load, 0, segments_)), moment{};
  if (system.moves_held) give = give + held_ends(system);
  auto held = held_inside_.begin();
  for (int k = 0; k < half; ++k) {
    const int left = k, right = padded_ - 1 - k;
    const Elimination& e = eliminations_[k];
    const Pair stretch = e.gap_share * pair(system.gap, left, right);
    moment = moment + pair(torque, left, right) * e.axis;
    if constexpr (stiffened) moment = moment + stretch * e.stretch_turn;
    give = give + stretch * e.direction;
    PairVector load = pair(system.load, left + 1, right);
    if (k == 0) load = next_share * load;
    if (k + 1 == half) load = Pair{1, 0} * load;
    if constexpr (stiffened) {
      give = give + (e.stretch * dot(e.lever, give)) * e.direction;
      load = load + stretch * e.lever;
    }
    const PairVector rest = load - inertia_times(e, give);
    if constexpr (stiffened) moment = moment - moment_of(e, give);
    if (held != held_inside_.end() && held->step == k) {
      PairVector place{};
      if (system.moves_held) place = (1.0 - held->free) * pair(system.held_displacement, left + 1, right);
      if constexpr (stiffened) moment = moment + (1.0 - held->free) * moment_of(e, give - place);
      const PairVector away = give - place;
      held->force = held->stiffness * away;
      moment = moment - transposed_times(held->turned, away);
      give = held->free * give + place;
      ++held;
    }
    give = give + e.give * rest;
    moment = moment + transposed_times(e.turned, rest);
    forward_[k] = {load, give, moment};
    if (k + 1 == half) break;
    give = give + e.turned_pivot * moment;
    moment = both(-1) * transposed_times(e.carried, moment);
  }

  MiddleVector right_side;
  right_side << lane(give, 1) - lane(give, 0), lane(moment, 0), lane(moment, 1);
  const MiddleVector middle = middle_.solve(right_side);
  PairVector force{Pair{middle[0], -middle[0]}, Pair{middle[1], -middle[1]}, Pair{middle[2], -middle[2]}};
  PairVector rotation{Pair{middle[3], middle[6]}, Pair{middle[4], middle[7]}, Pair{middle[5], middle[8]}};
  const auto put = [](const PairVector& v, int left, int right, VectorArray& array) {
    array.x[right] = v.x[1];
    array.y[right] = v.y[1];
    array.z[right] = v.z[1];
    array.x[left] = v.x[0];
    array.y[left] = v.y[0];
    array.z[left] = v.z[0];
  };
  for (int k = half - 1; k >= 0; --k) {
    const int left = k, right = padded_ - 1 - k;
    const Elimination& e = eliminations_[k];
    const Forward& f = forward_[k];
    if (k + 1 < half) rotation = e.pivot * f.moment + transposed_times(e.turned_pivot, force) - e.carried * rotation;
    const PairVector node = e.give * force + e.turned * rotation + f.give;
    put(node, left + 1, right, solution_.displacement);  // in the middle both are one node
    force = force + f.load - inertia_times(e, node);
    if constexpr (stiffened)
      force = force - (dot(e.skew, e.direction) * rotation - dot(e.skew, rotation) * e.direction -
                       (e.stretch * dot(e.stretch_turn, rotation)) * e.lever);
    if (held != held_inside_.begin() && (held - 1)->step == k) {
      --held;
      force = held->free * force - held->force - held->turned * rotation;
    }
    if constexpr (stiffened) force = force + (e.stretch * dot(e.direction, force)) * e.lever;
    put(Pair{1, -1} * force, left, right, solution_.force);

    Pair along = dot(e.direction, force);
    if constexpr (stiffened) along = along + dot(e.stretch_turn, rotation) + dot(e.lever, node);
    const Pair stretch = e.gap_share * pair(system.gap, left, right) + e.stretch * along;
    const PairVector change = cross(rotation, e.direction) + stretch * e.direction;
    PairVector transmitted = force;
    if constexpr (stiffened) transmitted = transmitted + e.across * change + cross(e.skew, node);
    const Pair multiplier = e.inverse_square * dot(transmitted, e.direction) - e.force_density * stretch;
    const Pair twist = dot(e.axis, rotation);
    solution_.multiplier[left] = multiplier[0];
    solution_.multiplier[right] = multiplier[1];
    solution_.twist[left] = twist[0];
    solution_.twist[right] = twist[1];
    if (k == 0) put(node - change, 0, padded_, solution_.displacement);
  }
  for (int i = 0; i <= segments_; ++i)
    if (system.movable[i] == 0)
      set(solution_.displacement, i, system.moves_held ? get(system.held_displacement, i) : Vector3(Vector3::Zero()));
}

}  // namespace verlet_cable
