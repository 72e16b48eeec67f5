#include "rod/block_elimination.h"

#include <cstddef>

#include "geometry/eigen_vectors.h"

namespace verlet_cable {

namespace {

[[gnu::always_inline]] inline NodeCouplings<Pair> couplings_of_lanes(const KktSystem& s, int left, int right) {
  // The segment to the next node: left, and right - 1 backwards.
  return {{Pair{s.direction.x[left], -s.direction.x[right - 1]}, Pair{s.direction.y[left], -s.direction.y[right - 1]},
           Pair{s.direction.z[left], -s.direction.z[right - 1]}},
          Pair{s.compliance[left], s.compliance[right - 1]},
          Pair{s.first[left], s.first[right - 1]},
          pair_transposing_second(s.added_next, left, right - 1),
          Pair{s.second[left], s.second[right - 2]}};
}

SymmetricOf<double> symmetric(const SymmetricArray& a, int i) {
  return {a.xx[i], a.xy[i], a.xz[i], a.yy[i], a.yz[i], a.zz[i]};
}

MatrixOf<double> matrix(const MatrixArray& a, int i) {
  return {numbers_at(a.row_x, i), numbers_at(a.row_y, i), numbers_at(a.row_z, i)};
}

SymmetricOf<double> own_block(const KktSystem& s, int i) {
  return plus_diagonal(symmetric(s.added, i), s.diagonal[i]);
}

PairVector joined(const VectorOf<double>& a, const VectorOf<double>& b) {
  return {Pair{a.x, b.x}, Pair{a.y, b.y}, Pair{a.z, b.z}};
}

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
  moves_held = false;
  held_displacement.assign(nodes, 0.0);
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

void KktSystem::add_stiffness(const CablePoint& point, const Eigen::Matrix3d& stiffness) {
  stiffened = true;
  const int i = point.segment;
  const double here = 1 - point.fraction, next = point.fraction;
  if (point.own == 0) {
    add(added, i, here * here, stiffness);
    add(added, i + 1, next * next, stiffness);
    add(added_next, i, here * next * stiffness);
    return;
  }
  const Eigen::Matrix3d turn = point.along * point.across.transpose(), crossed = stiffness * turn;
  if (point.before != 0) {
    // Nodes two apart are not coupled: each segment resists turning alone, by as much more as both could do together at most.
    const Eigen::Matrix3d turned = (point.own + point.before) * turn.transpose() * crossed;
    const Eigen::Matrix3d own = point.own * turned, before = point.before * turned, lever = (point.before - point.own) * crossed;
    add(added, i - 1, 1, before);
    add(added, i, 1, stiffness + lever + lever.transpose() + own + before);
    add(added, i + 1, 1, own);
    add(added_next, i, point.own * crossed - own);
    add(added_next, i - 1, -point.before * crossed.transpose() - before);
    return;
  }
  // What the point's displacement has of each node's.
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d of_here = here * identity - point.own * turn, of_next = next * identity + point.own * turn;
  add(added, i, 1, of_here.transpose() * stiffness * of_here);
  add(added, i + 1, 1, of_next.transpose() * stiffness * of_next);
  add(added_next, i, of_here.transpose() * stiffness * of_next);
}

Vector3 KktSystem::added_load(int node, const VectorArray& displacement) const {
  Vector3 load = get(added_next, node) * get(displacement, node + 1);
  if (node > 0) load += get(added_next, node - 1).transpose() * get(displacement, node - 1);
  return load;
}

void KktSolution::resize(int segments) {
  const std::size_t nodes = segments + 2;
  displacement.assign(nodes, 0.0);
  multiplier.assign(nodes, 0.0);
  force.assign(nodes, 0.0);
  twist.assign(nodes, 0.0);
}

void KktSolution::add(const KktSolution& other) {
  const auto sum = [](const std::vector<double>& more, std::vector<double>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) all[i] += more[i];
  };
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z}) {
    sum(other.displacement.*component, displacement.*component);
    sum(other.force.*component, force.*component);
  }
  sum(other.multiplier, multiplier);
  sum(other.twist, twist);
}

void BlockElimination::resize(int segments) {
  nodes_ = segments + 1 + (segments + 1) % 2;
  lane_ = nodes_ / 2 - 1;
  eliminations_.assign(lane_, Elimination<Pair>{});
  forward_.assign(lane_, Forward<Pair>{});
  solution_.resize(segments);
  load_.assign(segments + 2, 0.0);
  gap_.assign(segments + 2, 0.0);
}

void BlockElimination::factor(const KktSystem& system, bool bending) {
  couplings_ = system.stiffened ? Couplings::stiffened : bending ? Couplings::bending : Couplings::plain;
  if (couplings_ == Couplings::stiffened)
    factor_lanes<Couplings::stiffened>(system);
  else if (couplings_ == Couplings::bending)
    factor_lanes<Couplings::bending>(system);
  else
    factor_lanes<Couplings::plain>(system);
}

void BlockElimination::solve(const KktSystem& system) {
  if (system.moves_held) load_by_held(system);
  const VectorArray& load = system.moves_held ? load_ : system.load;
  const std::vector<double>& gap = system.moves_held ? gap_ : system.gap;
  if (couplings_ == Couplings::plain)
    solve_lanes<Couplings::plain>(load, gap);
  else
    solve_lanes<Couplings::bending>(load, gap);
  if (!system.moves_held) return;
  for (int i = 0; i < static_cast<int>(system.movable.size()) - 1; ++i)
    if (system.movable[i] == 0) set(solution_.displacement, i, get(system.held_displacement, i));
}

/// What displaced nodes do to the others stands on the right-hand sides.
void BlockElimination::load_by_held(const KktSystem& system) {
  load_ = system.load;
  gap_ = system.gap;
  const int last = static_cast<int>(system.movable.size()) - 2;
  const auto load_node = [&](int i, const Vector3& load) { set(load_, i, get(load_, i) - load); };
  for (int i = 0; i <= last; ++i) {
    if (system.movable[i] != 0) continue;
    const Vector3 held = get(system.held_displacement, i);
    if (i > 0) {
      load_node(i - 1, system.first[i - 1] * held + get(system.added_next, i - 1) * held);
      gap_[i - 1] -= get(system.direction, i - 1).dot(held);
    }
    if (i < last) {
      load_node(i + 1, system.first[i] * held + get(system.added_next, i).transpose() * held);
      gap_[i] += get(system.direction, i).dot(held);
    }
    if (i > 1) load_node(i - 2, system.second[i - 2] * held);
    if (i + 1 < last) load_node(i + 2, system.second[i] * held);
  }
}

void BlockElimination::set_solution(const VectorArray& displacement, const std::vector<double>& multiplier) {
  solution_.displacement = displacement;
  solution_.multiplier = multiplier;
}

template <Couplings couplings>
void BlockElimination::factor_lanes(const KktSystem& s) {
  Front<Pair> front;
  start(Pair{}, front);
  for (int k = 0; k < lane_; ++k) {
    const int left = k, right = nodes_ - 1 - k;
    SymmetricOf<Pair> own = plus_diagonal(SymmetricOf<Pair>{}, Pair{s.diagonal[left], s.diagonal[right]});
    if constexpr (couplings == Couplings::stiffened) own = own + pair(s.added, left, right);
    eliminate<couplings>(own, Pair{s.movable[left], s.movable[right]}, couplings_of_lanes(s, left, right), front,
                         eliminations_[k]);
  }
  const int m = lane_;
  const NodeCouplings<double> between{numbers_at(s.direction, m), s.compliance[m], s.first[m], matrix(s.added_next, m), 0};
  eliminate_middle(lane_of(front, 0), lane_of(front, 1), own_block(s, m), own_block(s, m + 1), s.movable[m], s.movable[m + 1],
                   between, middle_);
}

template <Couplings couplings>
void BlockElimination::solve_lanes(const VectorArray& load, const std::vector<double>& gap) {
  FrontLoad<Pair> front{};
  for (int k = 0; k < lane_; ++k) {
    const int left = k, right = nodes_ - 1 - k;
    forward<couplings>(eliminations_[k], pair(load, left, right), Pair{gap[left], gap[right - 1]}, front, forward_[k]);
  }

  const int m = lane_;
  const MiddleSolution middle = solve_middle(middle_, numbers_at(load, m) + lane_of(front.next, 0) + lane_of(front.after, 1),
                                             numbers_at(load, m + 1) + lane_of(front.next, 1) + lane_of(front.after, 0),
                                             front.gap[0], gap[m], front.gap[1]);

  VectorArray& displacement = solution_.displacement;
  std::vector<double>& multiplier = solution_.multiplier;
  const auto put_nodes = [&](int left, int right, const PairVector& x) {
    displacement.x[left] = x.x[0];
    displacement.y[left] = x.y[0];
    displacement.z[left] = x.z[0];
    displacement.x[right] = x.x[1];
    displacement.y[right] = x.y[1];
    displacement.z[right] = x.z[1];
  };
  Solved<Pair> solved{joined(middle.left, middle.right), joined(middle.right, middle.left), Pair{middle.before, middle.after}};
  put_nodes(m, m + 1, solved.next);
  multiplier[m] = middle.between;
  for (int k = lane_ - 1; k >= 0; --k) {
    multiplier[k] = solved.multiplier[0];
    multiplier[nodes_ - 2 - k] = solved.multiplier[1];
    back<couplings>(eliminations_[k], forward_[k], solved);
    put_nodes(k, nodes_ - 1 - k, solved.next);
  }
}

}  // namespace verlet_cable
