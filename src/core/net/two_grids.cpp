// What the constraint solver does with large grids.
#include <algorithm>
#include <cmath>

#include "net/constraint_solver.h"
#include "net/turning_link_rows.h"

namespace verlet_cable {

namespace {

/// Sweeps over a large net after its coarse correction.
constexpr int sweeps_on_two_grids = 2;
/// Sweeps over the links that are at most so many from a held node: what holds a net carries all of it, which a coarse net
/// spreads over too many links.
constexpr int sweeps_near_held = 8, links_near_held = 6;

}  // namespace

void NetConstraintSolver::collect_links_near_held(const NetModel& model, const std::vector<HeldNode>& held) {
  const auto is_near = [&](int node) {
    return std::any_of(held.begin(), held.end(), [&](const HeldNode& h) {
      return std::abs(node / model.columns - h.node / model.columns) <= links_near_held &&
             std::abs(node % model.columns - h.node % model.columns) <= links_near_held;
    });
  };
  near_held_.clear();
  std::vector<char> near(model.masses.size());
  for (int node = 0; node < model.nodes(); ++node) near[node] = is_near(node);
  for (int row = 0; row < static_cast<int>(rows_.size()); ++row) {
    const LinkRun& run = rows_[row].run;
    bool follows = false;
    for (int k = 0; k < run.count; ++k) {
      const int ahead = k * run.stride;
      const bool inside = near[run.first_node + ahead] && near[run.second_node + ahead];
      if (inside && follows)
        ++near_held_.back().run.count;
      else if (inside)
        near_held_.push_back({{run.first + ahead, run.first_node + ahead, run.second_node + ahead, run.stride, 1}, row});
      follows = inside;
    }
  }
}

/// Links that follow each other in a row of the grid, also where they share nodes.
void NetConstraintSolver::add_whole_rows(const NetModel& model) {
  whole_rows_.clear();
  for (int link = 0; link < static_cast<int>(model.links.size()); ++link) {
    if (row_of_[link] < 0) continue;
    const auto follows = [&](const LinkRun& run) {
      const int last = run.first + run.count - 1;
      return link == last + 1 && nodes_[link][0] == nodes_[last][0] + 1 && nodes_[link][1] == nodes_[last][1] + 1 &&
             nodes_[link][0] / model.columns == nodes_[last][0] / model.columns &&
             arrays_.inverse_mass[nodes_[link][0]] == arrays_.inverse_mass[nodes_[last][0]] &&
             arrays_.inverse_mass[nodes_[link][1]] == arrays_.inverse_mass[nodes_[last][1]] &&
             std::abs(model.rest_lengths[link] / model.rest_lengths[run.first] - 1) <= same_length;
    };
    if (!whole_rows_.empty() && follows(whole_rows_.back().run)) {
      ++whole_rows_.back().run.count;
    } else {
      whole_rows_.push_back(rows_[row_of_[link]]);
      whole_rows_.back().run = {link, nodes_[link][0], nodes_[link][1], 1, 1};
    }
  }
  first_whole_row_ = sort_by_grid_rows(model, whole_rows_);
}

/// Large nets do not fit into a processor's cache: what is done to a row is done while it is there, each stage a row behind the
/// one before. That is the same as one after the other, since a row's links end in the next row at most.
template <class... Stages>
void NetConstraintSolver::pass(Stages... stages) {
  const int count = sizeof...(stages), rows = static_cast<int>(first_row_.size()) - 1;
  for (int t = 0; t < rows + count - 1; ++t) {
    int at = t;
    const auto run = [&](const auto& stage) {
      if (at >= 0 && at < rows) stage(at);
      --at;
    };
    (run(stages), ...);
  }
}

int NetConstraintSolver::solve_on_two_grids() {
  const auto for_whole_rows = [&](int at, const auto& work) {
    for (int row = first_whole_row_[at]; row < first_whole_row_[at + 1]; ++row) work(whole_rows_[row]);
  };
  const auto start = [&](int at) { for_whole_rows(at, [&](const Row& row) { start_turning_links(row.run, arrays_); }); };
  const auto lack = [&](int at) {
    for_whole_rows(at, [&](const Row& row) { find_lacking(row.run, row.law, h_, arrays_, lacking_); });
  };
  const auto add = [&](int at) { for_whole_rows(at, [&](const Row& row) { add_impulses(row.run, lacking_, arrays_, added_); }); };
  const auto sweep = [&](int at) {
    for (int row = first_row_[at]; row < first_row_[at + 1]; ++row)
      sweep_turning_links(rows_[row].run, rows_[row].law, h_, arrays_);
  };
  pass(start, lack);
  coarse_net_.correct(arrays_.position, lacking_);
  if (contacts_.empty()) {
    pass(add, sweep, sweep);
  } else {
    pass(add, sweep);
    press_contacts();
    pass(sweep);
  }
  sweep_near_held();
  press_contacts();
  return sweeps_on_two_grids;
}

void NetConstraintSolver::sweep_near_held() {
  for (int i = 0; i < sweeps_near_held; ++i) {
    if (i % 2 == 0) {
      for (auto near = near_held_.rbegin(); near != near_held_.rend(); ++near)
        sweep_turning_links(near->run, rows_[near->row].law, h_, arrays_);
    } else {
      for (auto near = near_held_.begin(); near != near_held_.end(); ++near)
        sweep_turning_links(near->run, rows_[near->row].law, h_, arrays_);
    }
  }
}

}  // namespace verlet_cable
