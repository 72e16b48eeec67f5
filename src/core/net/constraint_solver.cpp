#include "net/constraint_solver.h"

#include <algorithm>
#include <cmath>

#include "rod/work_budget.h"

namespace verlet_cable {

namespace {

/// Sweeps of a step over all links. What hangs or waves follows with these few; bounds are kept by more where it needs them.
constexpr int limited_sweeps = 4;
constexpr int rigid_sweeps = 12;
/// Of the tolerance: sweeps keep inside of this much of it, so that few links are outside of the whole of it afterwards.
constexpr double aimed_part = 0.97;
/// Impulses follow changes over so many links in a few sweeps. In larger nets they lag behind, and what lags behind feeds energy
/// to what swings: there only a part of them is kept from step to step.
constexpr int links_followed = 60;
constexpr double kept_in_large_nets = 0.5;
/// Relative error of a rigid link's length that is left.
constexpr double rigid_tolerance = 1e-4;
/// What is left beyond this is told: grids of rigid links that bend are near no solution, and come to the former slowly.
constexpr double told_rigid_strain = 1e-3;
/// Rounds over what is outside its bounds; then it is reported.
constexpr int maximum_rounds = 800;
/// Corrections of links in a step, for each link of the net; what takes longer is reported, too.
constexpr std::size_t maximum_corrections = 50, fewest_corrections = 20000;
/// So many of them along the links' directions at the start of the step.
constexpr int rounds_along_start = 8;
/// Rigid links are springs in the sweeps, so stiff that a step's motion leaves this part of an error: where more links than
/// needed hold a net in shape, that shares the load between them.
constexpr double rigid_softness = 1e-3;
/// Strain beyond the tolerance that no net comes to which can be kept in its bounds. Held nodes want what is impossible then:
/// what the links' impulses have come to would grow from step to step without end.
constexpr double torn_strain = 0.05;
/// [m] Longer than anything.
constexpr double unbounded = 1e12;
/// Relative: rest lengths of a grid differ by rounding.
constexpr double same_length = 1e-9;
/// [m/s] What comes slower does not bounce, and what is inside an obstacle is pushed out no faster.
constexpr double resting_speed = 0.05;
constexpr double exit_speed = 1;
constexpr double exit_part = 0.2;

double tolerance_of(const NetModel& model) {
  return model.link_type == LinkType::rigid ? rigid_tolerance : model.tolerance;
}

double told_strain_of(const NetModel& model) {
  return model.link_type == LinkType::rigid ? told_rigid_strain : model.tolerance + same_length;
}

}  // namespace

void NetConstraintSolver::resize(const NetModel& model, const std::vector<HeldNode>& held, double h) {
  const std::size_t nodes = model.masses.size(), links = model.links.size() + model.minimum_distances.size();
  arrays_.position.assign(nodes, 0.0);
  arrays_.velocity.assign(nodes, 0.0);
  arrays_.inverse_mass.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i) arrays_.inverse_mass[i] = 1 / model.masses[i];
  held_at_.assign(nodes, -1);
  bound_impulses_.assign(held.size(), Vector3::Zero());
  for (std::size_t k = 0; k < held.size(); ++k) {
    arrays_.inverse_mass[held[k].node] = 0;
    held_at_[held[k].node] = static_cast<int>(k);
  }
  arrays_.impulse.assign(links, 0.0);
  arrays_.inverse_length.assign(links, 0.0);
  nodes_ = model.links;
  for (const MinimumDistanceDesc& minimum : model.minimum_distances) nodes_.push_back(minimum.nodes);
  row_of_.assign(links, -1);
  held_links_.clear();
  for (std::size_t link = 0; link < model.links.size(); ++link)
    if (held_at_[model.links[link][0]] >= 0 && held_at_[model.links[link][1]] >= 0) held_links_.push_back(static_cast<int>(link));
  outside_.reserve(links);
  next_outside_.reserve(links);
  contacts_.reserve(nodes);
  wind_.resize(model);
  long_range_attachments_.resize(model, held, 1 + aimed_part * tolerance_of(model));
  kept_part_ = long_range_attachments_.most_links() > links_followed ? kept_in_large_nets : 1;
  add_rows(model, h);
  connect(nodes);
}

/// Groups links that are alike into runs. Grids give long ones, row by row, so that the nodes of a row are still at hand when its
/// next links come.
void NetConstraintSolver::add_rows(const NetModel& model, double h) {
  rows_.clear();
  const int links = static_cast<int>(model.links.size());
  std::vector<char> used(nodes_.size(), 0);
  const auto held = [&](int link) {
    return arrays_.inverse_mass[nodes_[link][0]] == 0 && arrays_.inverse_mass[nodes_[link][1]] == 0;
  };
  for (int link = 0; link < static_cast<int>(nodes_.size()); ++link) used[link] = held(link);
  const auto run_from = [&](int first, int stride) {
    LinkRun run{first, nodes_[first][0], nodes_[first][1], stride, 1};
    const int apart = std::abs(run.second_node - run.first_node);
    const int most = apart % stride == 0 ? apart / stride : links;
    for (int link = first + stride; link < links && run.count < most; link += stride, ++run.count) {
      const bool follows =
          nodes_[link][0] == run.first_node + run.count * stride && nodes_[link][1] == run.second_node + run.count * stride;
      const double ratio = model.rest_lengths[link] / model.rest_lengths[first];
      if (used[link] || !follows || std::abs(ratio - 1) > same_length) break;
    }
    return run;
  };
  const bool rigid = model.link_type == LinkType::rigid;
  const double tolerance = tolerance_of(model), aimed = aimed_part * tolerance;
  for (int link = 0; link < links; ++link) {
    if (used[link]) continue;
    const LinkRun dense = run_from(link, 1), sparse = run_from(link, 2);
    const LinkRun& run = dense.count >= sparse.count ? dense : sparse;
    for (int k = 0; k < run.count; ++k) used[run.first + k * run.stride] = 1;
    const double length = model.rest_lengths[link];
    LinkLaw law{length, length * (1 - aimed), length * (1 + aimed), model.stiffness, model.damping};
    if (rigid) {
      const double mobility = arrays_.inverse_mass[nodes_[link][0]] + arrays_.inverse_mass[nodes_[link][1]];
      law = {length, 0, unbounded, 1 / (rigid_softness * h * h * mobility), 0};
    }
    rows_.push_back({run, law, length * (1 - tolerance), length * (1 + tolerance), true});
  }
  for (int link = links; link < static_cast<int>(nodes_.size()); ++link) {
    if (used[link]) continue;
    const double least = model.minimum_distances[link - links].distance;
    rows_.push_back({{link, nodes_[link][0], nodes_[link][1], 1, 1},
                     {least, least, unbounded, 0, 0},
                     least * (1 - rigid_tolerance),
                     unbounded,
                     false});
  }
  if (!model.is_grid()) return;
  std::stable_sort(rows_.begin(), rows_.end(), [&](const Row& a, const Row& b) {
    return std::min(a.run.first_node, a.run.second_node) / model.columns <
           std::min(b.run.first_node, b.run.second_node) / model.columns;
  });
}

void NetConstraintSolver::connect(std::size_t nodes) {
  for (std::size_t row = 0; row < rows_.size(); ++row)
    for (int k = 0; k < rows_[row].run.count; ++k)
      row_of_[rows_[row].run.first + k * rows_[row].run.stride] = static_cast<int>(row);
  bounds_.resize(nodes_.size());
  listed_.assign(nodes_.size(), 0);
  for (std::size_t link = 0; link < nodes_.size(); ++link) {
    listed_[link] = row_of_[link] < 0;
    if (listed_[link]) continue;
    const Row& row = rows_[row_of_[link]];
    const double rest = row.law.rest_length;
    const double part = row.law.longest < unbounded ? aimed_part : 0;  // rigid links are brought to their rest length
    bounds_[link] = {nodes_[link], row.shortest, row.longest, rest + part * (row.shortest - rest),
                     row.is_link ? rest + part * (row.longest - rest) : unbounded};
  }
  first_at_.assign(nodes + 1, 0);
  for (const std::array<int, 2>& link : nodes_)
    for (const int node : link) ++first_at_[node + 1];
  for (std::size_t node = 0; node < nodes; ++node) first_at_[node + 1] += first_at_[node];
  links_at_.assign(2 * nodes_.size(), 0);
  std::vector<int> next(first_at_.begin(), first_at_.end() - 1);
  for (std::size_t link = 0; link < nodes_.size(); ++link)
    for (const int node : nodes_[link]) links_at_[next[node]++] = static_cast<int>(link);
}

void NetConstraintSolver::advance_part(const NetStep& step, NetState& state, LinkMemory& memory, NetStepResult& result) {
  load(step, state, memory);
  apply_loads(step);
  find_contacts(step);
  start();
  const int sweeps = step.model.link_type == LinkType::rigid ? rigid_sweeps : limited_sweeps;
  for (int i = 0; i < sweeps; ++i) sweep(step.model, i % 2 == 0);
  result.iterations += sweeps;
  work_ += work_of_parts(step.model, 1);
  long_range_attachments_.pull(step.held, h_, arrays_);
  keep_bounds(result);
  react(step, memory);
  store(step, state, memory);
  judge(step, result);
  result.finite = is_sane(state.positions) && is_sane(state.velocities) && std::isfinite(result.max_strain);
}

/// All that a step does with each of the links, before it corrects single ones.
double NetConstraintSolver::work_of_parts(const NetModel& model, int parts) const {
  const int sweeps = model.link_type == LinkType::rigid ? rigid_sweeps : limited_sweeps;
  return parts * (budget::link_part + budget::link_sweep * sweeps) * static_cast<double>(nodes_.size());
}

void NetConstraintSolver::judge(const NetStep& s, NetStepResult& result) const {
  result.torn = result.max_strain > tolerance_of(s.model) + torn_strain;
  result.overstretched_node = overstretched_node(s);
  result.unsolved_node = result.overstretched_node < 0 ? unsolved_node() : -1;
}

int NetConstraintSolver::overstretched_node(const NetStep& s) const {
  const double strain = told_strain_of(s.model);
  for (const int link : held_links_) {
    const auto [i, j] = nodes_[link];
    const double length = (s.held[held_at_[j]].position - s.held[held_at_[i]].position).norm();
    if (!(std::abs(length / s.model.rest_lengths[link] - 1) <= strain)) return i;
  }
  return long_range_attachments_.overstretched_node(s.held, 1 + strain);
}

int NetConstraintSolver::unsolved_node() const {
  for (const int link : outside_) {
    const Row& row = rows_[row_of_[link]];
    const double length = end_way(loose_node(nodes_[link][0], arrays_), loose_node(nodes_[link][1], arrays_), h_).norm();
    const double slack = row.law.longest < unbounded ? 0 : (told_rigid_strain - rigid_tolerance) * row.law.rest_length;
    if (!(length >= row.shortest - slack && length <= row.longest + slack)) return nodes_[link][0];
  }
  return -1;
}

void NetConstraintSolver::load(const NetStep& s, const NetState& state, LinkMemory& memory) {
  if (!memory.started) begin(s, state, memory);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    set(arrays_.position, static_cast<int>(i), state.positions[i]);
    set(arrays_.velocity, static_cast<int>(i), memory.midstep_velocities[i]);
  }
  for (std::size_t link = 0; link < memory.impulses.size(); ++link)
    arrays_.impulse[link] = kept_part_ * memory.impulses[link] / parts_;
}

/// What the recursion's velocity would have been half a step ago.
void NetConstraintSolver::begin(const NetStep& s, const NetState& state, LinkMemory& memory) {
  for (int i = 0; i < s.model.nodes(); ++i) {
    set(arrays_.position, i, state.positions[i]);
    set(arrays_.velocity, i, state.velocities[i]);
  }
  wind_.evaluate(s.model, s.scene.fluid, h_, arrays_.position, arrays_.velocity);
  for (int i = 0; i < s.model.nodes(); ++i) {
    Vector3 acceleration = s.scene.gravity.at(state.positions[i]);
    if (wind_.active()) acceleration += get(wind_.force(), i) / s.model.masses[i];
    memory.midstep_velocities[i] = state.velocities[i] - 0.5 * s.h() * acceleration;
  }
  memory.started = true;
}

/// Gravity and wind over the step; held nodes get the velocity that takes them where they are held.
void NetConstraintSolver::apply_loads(const NetStep& s) {
  wind_.evaluate(s.model, s.scene.fluid, h_, arrays_.position, arrays_.velocity);
  VectorArray& v = arrays_.velocity;
  const bool uniform = s.scene.gravity.type == GravityDesc::Type::uniform;
  for (int i = 0; i < s.model.nodes(); ++i) {
    const Vector3 gravity = uniform ? s.scene.gravity.acceleration : s.scene.gravity.at(get(arrays_.position, i));
    set(v, i, get(v, i) + h_ * gravity);
  }
  if (wind_.active())
    for (int i = 0; i < s.model.nodes(); ++i) set(v, i, get(v, i) + h_ * arrays_.inverse_mass[i] * get(wind_.force(), i));
  for (const HeldNode& held : s.held) set(v, held.node, (held.position - get(arrays_.position, held.node)) / h_);
}

void NetConstraintSolver::find_contacts(const NetStep& s) {
  contacts_.clear();
  if (s.obstacles.empty()) return;
  Aabb box;
  double fastest = 0;
  for (int i = 0; i < s.model.nodes(); ++i) {
    box.extend(get(arrays_.position, i));
    fastest = std::max(fastest, get(arrays_.velocity, i).squaredNorm());
  }
  fastest = std::sqrt(fastest);
  for (const MovingObstacle& moving : s.obstacles) {
    const double reach = 2 * h_ * (fastest + moving.speed) + moving.obstacle->padding;
    const double moved = part_ * h_ * moving.speed;
    const Aabb wide(moving.box.min().array() - reach - moved, moving.box.max().array() + reach + moved);
    if (!wide.intersects(box)) continue;
    for (int i = 0; i < s.model.nodes(); ++i) {
      const Vector3 position = get(arrays_.position, i);
      if (arrays_.inverse_mass[i] == 0 || !wide.contains(position)) continue;
      NodeContact contact;
      contact.surface = surface_near(moving, position, static_cast<double>(part_) / parts_, s.h(), reach);
      const double gap = contact.surface.distance;
      if (gap >= reach) continue;
      contact.node = i;
      contact.friction = moving.obstacle->friction.value_or(s.model.friction);
      const double approach = -(get(arrays_.velocity, i) - contact.surface.surface_velocity).dot(contact.surface.normal);
      contact.least_velocity = gap >= 0 ? -gap / h_ : std::min(-exit_part * gap / h_, exit_speed);
      if (approach > resting_speed && h_ * approach > gap)
        contact.least_velocity = std::max(contact.least_velocity, s.model.restitution * approach);
      contacts_.push_back(contact);
    }
  }
}

void NetConstraintSolver::start() {
  for (const Row& row : rows_) start_links(row.run, arrays_);
}

void NetConstraintSolver::sweep(const NetModel& model, bool forwards) {
  // What is as soft for each part of a step as for a whole one is stiffer.
  const double stiffer = model.link_type == LinkType::rigid ? parts_ * parts_ : 1;
  const auto sweep_row = [&](const Row& row) {
    LinkLaw law = row.law;
    law.stiffness *= stiffer;
    sweep_links(row.run, law, h_, arrays_);
  };
  if (forwards)
    std::for_each(rows_.begin(), rows_.end(), sweep_row);
  else
    std::for_each(rows_.rbegin(), rows_.rend(), sweep_row);
  press_contacts();
}

void NetConstraintSolver::press_contacts() {
  for (NodeContact& contact : contacts_) set(arrays_.velocity, contact.node, press(get(arrays_.velocity, contact.node), contact));
}

/// Lists what is outside its bounds. False if nothing is.
bool NetConstraintSolver::measure(NetStepResult& result) {
  outside_.clear();
  turned_ = false;
  double least = 1, largest = 1;
  for (const Row& row : rows_) {
    const double rest = row.law.rest_length;
    const SquareRange range = measure_links(row.run, rest, h_, arrays_);
    if (row.is_link) {
      least = std::min(least, range.least);
      largest = std::max(largest, range.largest);
      turned_ = turned_ || range.turned;
    }
    const double shortest = row.shortest / rest, longest = row.longest / rest;
    if (!(range.least >= shortest * shortest && range.largest <= longest * longest)) list_outside(row);
  }
  result.max_strain = std::max(1 - std::sqrt(least), std::sqrt(largest) - 1);
  return !outside_.empty();
}

void NetConstraintSolver::list_outside(const Row& row) {
  for (int k = 0; k < row.run.count; ++k) {
    const int i = row.run.first_node + k * row.run.stride, j = row.run.second_node + k * row.run.stride;
    const double length = end_way(loose_node(i, arrays_), loose_node(j, arrays_), h_).norm();
    if (!(length >= row.shortest && length <= row.longest)) outside_.push_back(row.run.first + k * row.run.stride);
  }
}

/// Corrects what is outside its bounds, then whatever that has pushed out, until nothing is.
void NetConstraintSolver::keep_bounds(NetStepResult& result) {
  std::fill(bound_impulses_.begin(), bound_impulses_.end(), Vector3::Zero());
  if (!measure(result)) return;
  const int nodes = static_cast<int>(arrays_.inverse_mass.size());
  loose_nodes_.resize(nodes);
  for (int i = 0; i < nodes; ++i) loose_nodes_[i] = loose_node(i, arrays_);
  const std::size_t most = std::max(fewest_corrections, maximum_corrections * nodes_.size());
  std::size_t visited = 0;
  for (int round = 0; round < maximum_rounds && visited < most && !outside_.empty(); ++round) {
    exhausted_ = work_ >= most_work_;
    if (exhausted_) break;
    ++result.iterations;
    visited += outside_.size();
    work_ += correct_once(round >= rounds_along_start);
  }
  for (const int link : outside_) listed_[link] = 0;
  for (int i = 0; i < nodes; ++i) set(arrays_.velocity, i, loose_nodes_[i].velocity);
  measure(result);
}

/// One round: lists what is to be looked at in the next one. Returns its work [visits].
double NetConstraintSolver::correct_once(bool along_end) {
  next_outside_.clear();
  std::size_t corrected = 0;
  for (const int link : outside_) listed_[link] = 0;
  for (const int link : outside_) {
    const Bounds& bounds = bounds_[link];
    const auto [i, j] = bounds.nodes;
    const Vector3 end = end_way(loose_nodes_[i], loose_nodes_[j], h_);
    const double length = end.norm();
    if (length >= bounds.shortest && length <= bounds.longest) continue;
    const double next = std::clamp(length, bounds.aimed_shortest, bounds.aimed_longest);
    const Vector3 impulse = set_length(next, end, length, arrays_.inverse_length[link], along_end, h_, loose_nodes_[i],
                                       loose_nodes_[j], arrays_.impulse[link]);
    if (held_at_[i] >= 0) bound_impulses_[held_at_[i]] -= impulse;
    if (held_at_[j] >= 0) bound_impulses_[held_at_[j]] += impulse;
    list_neighbours(i);
    list_neighbours(j);
    ++corrected;
  }
  const double work =
      budget::link_look * static_cast<double>(outside_.size()) + budget::link_correction * static_cast<double>(corrected);
  std::swap(outside_, next_outside_);
  return work;
}

void NetConstraintSolver::list_neighbours(int node) {
  for (int k = first_at_[node]; k < first_at_[node + 1]; ++k) {
    const int neighbour = links_at_[k];
    if (listed_[neighbour]) continue;
    listed_[neighbour] = 1;
    next_outside_.push_back(neighbour);
  }
}

void NetConstraintSolver::react(const NetStep& s, const LinkMemory& memory) const {
  for (std::size_t k = 0; k < s.held.size(); ++k) {
    HeldNode& held = s.held[k];
    Vector3 links = (long_range_attachments_.impulse(k) + bound_impulses_[k]) / h_;
    for (int at = first_at_[held.node]; at < first_at_[held.node + 1]; ++at) {
      const int link = links_at_[at];
      const double sign = nodes_[link][1] == held.node ? 1 : -1;
      const Vector3 along = get(arrays_.position, nodes_[link][1]) - get(arrays_.position, nodes_[link][0]);
      links += sign * arrays_.impulse[link] * arrays_.inverse_length[link] / h_ * along;
    }
    const Vector3 wind = wind_.active() ? get(wind_.force(), held.node) : Vector3(Vector3::Zero());
    const Vector3 acceleration = (get(arrays_.velocity, held.node) - memory.midstep_velocities[held.node]) / h_;
    held.force = force_on_holder(s, held, links, wind, acceleration);
  }
}

/// The recursion's velocity is that of half a step before; the velocity at the end of the step is found by going on as from the
/// step before, but not across a bounce.
void NetConstraintSolver::store(const NetStep& s, NetState& state, LinkMemory& memory) const {
  const bool struck = std::any_of(contacts_.begin(), contacts_.end(), [](const NodeContact& c) { return c.pushed > 0; });
  const double ahead = struck ? 0 : 0.5;
  for (int i = 0; i < s.model.nodes(); ++i) {
    const Vector3 velocity = get(arrays_.velocity, i);
    state.positions[i] += h_ * velocity;
    state.velocities[i] = velocity + ahead * (velocity - memory.midstep_velocities[i]);
    memory.midstep_velocities[i] = velocity;
  }
  for (const HeldNode& held : s.held) {
    state.positions[held.node] = held.position;
    state.velocities[held.node] = held.velocity;
  }
  for (std::size_t link = 0; link < memory.impulses.size(); ++link) memory.impulses[link] = parts_ * arrays_.impulse[link];
  for (std::size_t link = 0; link < state.tension.size(); ++link) {
    const Vector3 along = state.positions[nodes_[link][1]] - state.positions[nodes_[link][0]];
    const double earlier = part_ > 0 ? state.tension[link] : -0.0;
    state.tension[link] = row_of_[link] >= 0 ? earlier - arrays_.impulse[link] / s.h()
                                             : s.model.stiffness * (along.norm() - s.model.rest_lengths[link]);
  }
}

}  // namespace verlet_cable
