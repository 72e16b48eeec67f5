#include "net/model.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

std::vector<Vector3> grid_nodes(const GridDesc& grid) {
  std::vector<Vector3> nodes;
  const Vector3 along = grid.spacing * grid.x_axis.normalized(), down = grid.spacing * grid.y_axis.normalized();
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) nodes.push_back(grid.origin + row * down + column * along);
  return nodes;
}

std::vector<std::array<int, 2>> grid_links(int rows, int columns) {
  std::vector<std::array<int, 2>> links;
  const auto node = [&](int row, int column) { return row * columns + column; };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) links.push_back({node(r, c), node(r, c + 1)});
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c < columns; ++c) links.push_back({node(r, c), node(r + 1, c)});
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) links.push_back({node(r, c), node(r + 1, c + 1)});
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) links.push_back({node(r, c + 1), node(r + 1, c)});
  return links;
}

}  // namespace

SimulatedNet make_net(const NetDesc& desc) {
  SimulatedNet net;
  NetModel& model = net.model;
  model.name = desc.name;
  model.color = desc.color;
  model.link_type = desc.link_type;
  if (desc.link_type != LinkType::rigid) {
    model.stiffness = desc.stiffness;
    model.damping = desc.damping;
  }
  model.tolerance = desc.tolerance;
  model.restitution = desc.restitution;
  model.friction = desc.friction;
  model.minimum_distances = desc.minimum_distances;
  if (desc.grid) {
    model.rows = desc.grid->rows;
    model.columns = desc.grid->columns;
    model.links = grid_links(model.rows, model.columns);
    net.state.positions = grid_nodes(*desc.grid);
  } else {
    model.links = desc.links;
    net.state.positions = desc.nodes;
  }
  const std::size_t nodes = net.state.positions.size();
  model.masses = desc.masses;
  if (model.masses.empty()) model.masses.assign(nodes, desc.mass / static_cast<double>(nodes));
  for (const std::array<int, 2>& link : model.links)
    model.rest_lengths.push_back((net.state.positions[link[1]] - net.state.positions[link[0]]).norm());
  net.state.velocities.assign(nodes, desc.velocity);
  net.state.tension.assign(model.links.size(), 0.0);
  return net;
}

double strain(const SimulatedNet& net, int link) {
  const std::array<int, 2>& nodes = net.model.links[link];
  return (net.state.positions[nodes[1]] - net.state.positions[nodes[0]]).norm() / net.model.rest_lengths[link] - 1;
}

std::vector<double> node_tension(const SimulatedNet& net) {
  std::vector<double> tension(net.model.masses.size(), -infinity);
  for (std::size_t i = 0; i < net.model.links.size(); ++i)
    for (const int node : net.model.links[i]) tension[node] = std::max(tension[node], net.state.tension[i]);
  for (double& t : tension)
    if (t == -infinity) t = 0;
  return tension;
}

int nearest_node(const SimulatedNet& net, const Vector3& point) {
  const auto nearer = [&](const Vector3& a, const Vector3& b) { return (a - point).squaredNorm() < (b - point).squaredNorm(); };
  const std::vector<Vector3>& positions = net.state.positions;
  return static_cast<int>(std::min_element(positions.begin(), positions.end(), nearer) - positions.begin());
}

NearestPoint nearest_link(const SimulatedNet& net, const Vector3& point) {
  NearestPoint nearest{-1, 0, infinity};
  for (std::size_t i = 0; i < net.model.links.size(); ++i) {
    const Vector3& start = net.state.positions[net.model.links[i][0]];
    const Vector3 along = net.state.positions[net.model.links[i][1]] - start;
    const double square = along.squaredNorm();
    const double fraction = square > 0 ? std::clamp((point - start).dot(along) / square, 0.0, 1.0) : 0;
    const double distance = (start + fraction * along - point).norm();
    if (nearest.segment < 0 || distance < nearest.distance) nearest = {static_cast<int>(i), fraction, distance};
  }
  return nearest;
}

}  // namespace verlet_cable
