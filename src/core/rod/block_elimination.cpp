#include "rod/block_elimination.h"

#include <cstddef>

namespace verlet_cable {

namespace {

PairMatrix minus_scaled_transposed(Pair s, const PairMatrix& m) {
  return {{-s * m.row_x.x, -s * m.row_y.x, -s * m.row_z.x},
          {-s * m.row_x.y, -s * m.row_y.y, -s * m.row_z.y},
          {-s * m.row_x.z, -s * m.row_y.z, -s * m.row_z.z}};
}

PairMatrix plus_scalar(const PairMatrix& m, Pair s) {
  return {{m.row_x.x + s, m.row_x.y, m.row_x.z}, {m.row_y.x, m.row_y.y + s, m.row_y.z}, {m.row_z.x, m.row_z.y, m.row_z.z + s}};
}

/// m + a b^T
PairMatrix plus_outer(const PairMatrix& m, const PairVector& a, const PairVector& b) {
  return {m.row_x + a.x * b, m.row_y + a.y * b, m.row_z + a.z * b};
}

/// m - a b^T, for a b^T symmetric together with what was subtracted before
PairSymmetric minus_outer(const PairSymmetric& m, const PairVector& a, const PairVector& b) {
  return {m.xx - a.x * b.x, m.xy - a.x * b.y, m.xz - a.x * b.z, m.yy - a.y * b.y, m.yz - a.y * b.z, m.zz - a.z * b.z};
}

PairMatrix operator+(const PairMatrix& a, const PairSymmetric& b) {
  return {{a.row_x.x + b.xx, a.row_x.y + b.xy, a.row_x.z + b.xz},
          {a.row_y.x + b.xy, a.row_y.y + b.yy, a.row_y.z + b.yz},
          {a.row_z.x + b.xz, a.row_z.y + b.yz, a.row_z.z + b.zz}};
}

/// What the eliminated blocks left to the next node, to the one after, and to the multiplier before the next node.
struct Front {
  PairSymmetric next{};       ///< block of the next node
  PairMatrix between{};       ///< of the next node and the one after
  PairSymmetric after{};      ///< of the one after
  PairVector reach{};         ///< of the multiplier and the next node
  PairVector beyond{};        ///< of the multiplier and the one after
  Pair compliance = both(1);  ///< of the multiplier
};

struct FrontLoad {
  PairVector next{}, after{};
  Pair gap{};
};

}  // namespace

void KktSystem::resize(int segments) {
  // One node and segment more than the cable has: a held node without couplings that makes the number of nodes even.
  const std::size_t nodes = segments + 2;
  diagonal.assign(nodes, 1.0);
  movable.assign(nodes, 0.0);
  first.assign(nodes, 0.0);
  second.assign(nodes, 0.0);
  direction.assign(nodes, 0.0);
  compliance.assign(nodes, 1.0);
  load.assign(nodes, 0.0);
  gap.assign(nodes, 0.0);
  stiffened = false;
  added.assign(nodes, 0.0);
  added_next.assign(nodes, 0.0);
}

void KktSystem::clear_stiffness() {
  if (!stiffened) return;
  stiffened = false;
  added.assign(diagonal.size(), 0.0);
  added_next.assign(diagonal.size(), 0.0);
}

void KktSystem::add_stiffness(int segment, double fraction, const Eigen::Matrix3d& stiffness) {
  stiffened = true;
  const double here = 1 - fraction;
  add(added, segment, here * here, stiffness);
  add(added, segment + 1, fraction * fraction, stiffness);
  add(added_next, segment, here * fraction, stiffness);
}

Vector3 KktSystem::added_load(int node, const VectorArray& displacement) const {
  Vector3 load = get(added_next, node) * get(displacement, node + 1);
  if (node > 0) load += get(added_next, node - 1) * get(displacement, node - 1);
  return load;
}

void BlockElimination::resize(int segments) {
  nodes_ = segments + 1 + (segments + 1) % 2;
  lane_ = nodes_ / 2 - 1;
  eliminations_.assign(lane_, Elimination{});
  forward_.assign(lane_, Forward{});
  displacement_.assign(segments + 2, 0.0);
  multiplier_.assign(segments + 2, 0.0);
}

void BlockElimination::factor(const KktSystem& system, bool bending) {
  wide_ = bending || system.stiffened;
  if (system.stiffened)
    factor_lanes<true, true>(system);
  else if (bending)
    factor_lanes<true, false>(system);
  else
    factor_lanes<false, false>(system);
}

void BlockElimination::solve(const KktSystem& system) {
  if (wide_)
    solve_lanes<true>(system);
  else
    solve_lanes<false>(system);
}

void BlockElimination::set_solution(const VectorArray& displacement, const std::vector<double>& multiplier) {
  displacement_ = displacement;
  multiplier_ = multiplier;
}

template <bool bending, bool stiffened>
void BlockElimination::factor_lanes(const KktSystem& s) {
  Front front;
  for (int k = 0; k < lane_; ++k) {
    const int left = k, right = nodes_ - 1 - k;  // the segment to the next node: left, and right - 1 backwards
    Elimination& e = eliminations_[k];
    e.first = Pair{s.first[left], s.first[right - 1]};
    e.direction = {Pair{s.direction.x[left], -s.direction.x[right - 1]}, Pair{s.direction.y[left], -s.direction.y[right - 1]},
                   Pair{s.direction.z[left], -s.direction.z[right - 1]}};
    const Pair diagonal{s.diagonal[left], s.diagonal[right]};
    const Pair movable{s.movable[left], s.movable[right]};

    if constexpr (stiffened) front.next = front.next + pair(s.added, left, right);
    const PairSymmetric node = scaled_inverse(plus_diagonal(front.next, diagonal), movable);
    const PairVector held = node * front.reach;
    e.multiplier = 1.0 / (front.compliance + dot(front.reach, held));
    e.cross = e.multiplier * held;
    e.node = minus_outer(node, held, e.cross);
    e.node_along = e.node * e.direction;
    e.multiplier_along = dot(e.cross, e.direction);

    front.compliance = Pair{s.compliance[left], s.compliance[right - 1]} + dot(e.direction, e.node_along);
    if constexpr (bending) {
      e.second = Pair{s.second[left], s.second[right - 2]};
      e.beyond = front.beyond;
      PairMatrix coupling = plus_scalar(front.between, e.first);
      if constexpr (stiffened) coupling = coupling + pair(s.added_next, left, right - 1);
      e.node_next = plus_outer(e.node * coupling, e.cross, e.beyond);
      e.multiplier_next = transposed_times(coupling, e.cross) - e.multiplier * e.beyond;
      front.next = minus_outer(minus_product(front.after, coupling, e.node_next), e.beyond, e.multiplier_next);
      front.between = minus_scaled_transposed(e.second, e.node_next);
      front.after = times(-e.second * e.second, e.node);
      front.reach = e.direction + transposed_times(e.node_next, e.direction);
      front.beyond = e.second * e.node_along;
    } else {
      front.next = times(-e.first * e.first, e.node);
      front.reach = e.direction + e.first * e.node_along;
    }
  }

  const int m = lane_;
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d direction = get(s.direction, m);
  Middle a = Middle::Zero();
  a.block<3, 3>(0, 0) = lane(front.next, 0) + lane(front.after, 1) + s.diagonal[m] * identity;
  a.block<3, 3>(3, 3) = lane(front.next, 1) + lane(front.after, 0) + s.diagonal[m + 1] * identity;
  a.block<3, 3>(0, 3) = lane(front.between, 0) + lane(front.between, 1).transpose() + s.first[m] * identity;
  if constexpr (stiffened) {
    a.block<3, 3>(0, 0) += get(s.added, m);
    a.block<3, 3>(3, 3) += get(s.added, m + 1);
    a.block<3, 3>(0, 3) += get(s.added_next, m);
  }
  a.block<3, 1>(0, 6) = lane(front.reach, 0);
  a.block<3, 1>(3, 6) = lane(front.beyond, 0);
  a.block<3, 1>(0, 7) = lane(front.beyond, 1);
  a.block<3, 1>(3, 7) = lane(front.reach, 1);
  a.block<3, 1>(0, 8) = -direction;
  a.block<3, 1>(3, 8) = direction;
  a.triangularView<Eigen::StrictlyLower>() = a.transpose();
  a(6, 6) = -front.compliance[0];
  a(7, 7) = -front.compliance[1];
  a(8, 8) = -s.compliance[m];
  for (int node = 0; node < 2; ++node) {
    if (s.movable[m + node] != 0) continue;
    a.middleRows<3>(3 * node).setZero();
    a.middleCols<3>(3 * node).setZero();
    a.block<3, 3>(3 * node, 3 * node) = identity;
  }
  middle_.compute(a);
}

template <bool bending>
void BlockElimination::solve_lanes(const KktSystem& s) {
  FrontLoad front;
  for (int k = 0; k < lane_; ++k) {
    const int left = k, right = nodes_ - 1 - k;
    const Elimination& e = eliminations_[k];
    const PairVector load = front.next + PairVector{Pair{s.load.x[left], s.load.x[right]}, Pair{s.load.y[left], s.load.y[right]},
                                                    Pair{s.load.z[left], s.load.z[right]}};
    const PairVector node = e.node * load + front.gap * e.cross;
    const Pair multiplier = dot(e.cross, load) - e.multiplier * front.gap;
    forward_[k] = {node, multiplier};
    if constexpr (bending) {
      // The couplings' transpose times the inverse times the load, by the symmetry of the inverse.
      front.next = front.after - transposed_times(e.node_next, load) - front.gap * e.multiplier_next;
      front.after = -e.second * node;
    } else {
      front.next = -e.first * node;
    }
    front.gap = Pair{s.gap[left], s.gap[right - 1]} + dot(e.direction, node);
  }

  const int m = lane_;
  MiddleVector load;
  load << get(s.load, m) + lane(front.next, 0) + lane(front.after, 1),
      get(s.load, m + 1) + lane(front.next, 1) + lane(front.after, 0), front.gap[0], front.gap[1], s.gap[m];
  for (int node = 0; node < 2; ++node) load.segment<3>(3 * node) *= s.movable[m + node];
  const MiddleVector middle = middle_.solve(load);

  PairVector next{Pair{middle[0], middle[3]}, Pair{middle[1], middle[4]}, Pair{middle[2], middle[5]}};
  PairVector after{Pair{middle[3], middle[0]}, Pair{middle[4], middle[1]}, Pair{middle[5], middle[2]}};
  Pair multiplier{middle[6], middle[7]};
  const auto put = [this](int left, int right, const PairVector& x) {
    displacement_.x[left] = x.x[0];
    displacement_.y[left] = x.y[0];
    displacement_.z[left] = x.z[0];
    displacement_.x[right] = x.x[1];
    displacement_.y[right] = x.y[1];
    displacement_.z[right] = x.z[1];
  };
  put(m, m + 1, next);
  multiplier_[m] = middle[8];
  for (int k = lane_ - 1; k >= 0; --k) {
    const int left = k, right = nodes_ - 1 - k;
    const Elimination& e = eliminations_[k];
    const Forward& f = forward_[k];
    multiplier_[left] = multiplier[0];
    multiplier_[right - 1] = multiplier[1];
    PairVector node = f.node + multiplier * e.node_along;
    multiplier = f.multiplier + multiplier * e.multiplier_along;
    if constexpr (bending) {
      node = node - e.node_next * next - e.second * (e.node * after);
      multiplier = multiplier - dot(e.multiplier_next, next) - e.second * dot(e.cross, after);
      after = next;
    } else {
      node = node - e.first * (e.node * next);
      multiplier = multiplier - e.first * dot(e.cross, next);
    }
    next = node;
    put(left, right, node);
  }
}

}  // namespace verlet_cable
