#include "world/state_bytes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "verlet_cable/core/bytes.h"
#include "verlet_cable/core/scene_numbers.h"
#include "world/state_fields.h"

namespace verlet_cable {

namespace {

using Mesh = std::shared_ptr<const TriangleMesh>;

/// Reads what `visit` with a ByteWriter has written.
class StateReader {
 public:
  /// `meshes`: those that there are.
  StateReader(ByteReader& bytes, std::vector<Mesh> meshes) : bytes_(bytes), meshes_(std::move(meshes)) {}

  template <class T>
  void read(T& x) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
      bytes_(x);
    } else if constexpr (std::is_same_v<T, std::shared_ptr<const SceneDesc>>) {
      auto scene = std::make_shared<SceneDesc>(*x);
      read(*scene);
      x = std::move(scene);
    } else if constexpr (std::is_same_v<T, std::shared_ptr<const CableModel>>) {
      auto model = std::make_shared<CableModel>();
      read(*model);
      x = std::move(model);
    } else if constexpr (std::is_same_v<T, Mesh>) {
      x = read_mesh();
    } else if constexpr (std::is_same_v<T, Shape>) {
      read_shape(x);
    } else if constexpr (IsOptional<T>::value) {
      bool is_there = false;
      bytes_(is_there);
      if (!is_there) return x.reset();
      if (!x) x.emplace();
      read(*x);
    } else if constexpr (IsList<T>::value) {
      read_list(x);
    } else {
      std::apply([&](auto&... field) { (read(field), ...); }, fields(x, static_cast<const T*>(nullptr)));
    }
  }

 private:
  template <class List>
  void read_list(List& list) {
    const std::size_t length = bytes_.read_length();
    if constexpr (std::is_same_v<List, std::string> || IsVector<List>::value)
      list.resize(length);
    else if (length != std::size(list))
      throw std::invalid_argument("a list has another length");
    for (auto& element : list) read(element);
  }

  void read_shape(Shape& shape) {
    const std::size_t alternative = bytes_.read_length();
    if (!read_shape_of<0>(alternative, shape)) throw std::invalid_argument("a shape is of no known kind");
  }

  template <std::size_t index>
  bool read_shape_of(std::size_t alternative, Shape& shape) {
    if constexpr (index < std::variant_size_v<Shape>) {
      if (alternative != index) return read_shape_of<index + 1>(alternative, shape);
      std::variant_alternative_t<index, Shape> read_one{};
      read(read_one);
      shape = std::move(read_one);
      return true;
    }
    return false;
  }

  Mesh read_mesh() {
    std::vector<Vector3> vertices;
    std::vector<TriangleMesh::Triangle> triangles;
    read(vertices);
    read(triangles);
    const auto is_it = [&](const Mesh& mesh) { return mesh->vertices() == vertices && mesh->triangles() == triangles; };
    const auto known = std::find_if(meshes_.begin(), meshes_.end(), is_it);
    if (known != meshes_.end()) return *known;
    meshes_.push_back(std::make_shared<TriangleMesh>(std::move(vertices), std::move(triangles)));
    return meshes_.back();
  }

  template <class T>
  struct IsVector : std::false_type {};
  template <class T, class Allocator>
  struct IsVector<std::vector<T, Allocator>> : std::true_type {};

  ByteReader& bytes_;
  std::vector<Mesh> meshes_;
};

std::vector<Mesh> meshes_of(const State& state) {
  std::vector<Mesh> meshes;
  const auto add = [&](const Shape& shape) {
    if (const auto* mesh = std::get_if<MeshShape>(&shape)) meshes.push_back(mesh->mesh);
  };
  for (const Obstacle& obstacle : state.obstacles) add(obstacle.shape);
  for (const SimulatedBody& body : state.bodies)
    for (const BodyShape& shape : body.shapes) add(shape.shape);
  return meshes;
}

/// Whether what a contact names is there, and its vectors are finite. `by_body`: what is touched, a body touches, and no cable.
bool is_sound(const SimulatedContact& contact, bool by_body, const State& state) {
  const auto is_one = [](int index, std::size_t count) { return index >= -1 && index < static_cast<int>(count); };
  const auto is_segment = [&](int cable, int segment) {
    return is_one(cable, state.cables.size()) && (cable < 0 || (segment >= 0 && segment < state.cables[cable].state.segments()));
  };
  const bool is_touched = contact.obstacle >= 0 || (!by_body && (contact.other_cable >= 0 || contact.body >= 0));
  return (by_body ? contact.body >= 0 && contact.cable < 0 : contact.cable >= 0) && is_touched &&
         is_segment(contact.cable, contact.segment) && is_segment(contact.other_cable, contact.other_segment) &&
         is_one(contact.obstacle, state.obstacles.size()) && is_one(contact.body, state.bodies.size()) &&
         contact.position.allFinite() && contact.normal.allFinite() && contact.force.allFinite() && contact.torque.allFinite();
}

bool is_index(int index, std::size_t count) {
  return index >= 0 && index < static_cast<int>(count);
}

bool is_sound(const Intrusion& found, const State& state) {
  return is_index(found.cable, state.cables.size()) &&
         is_index(found.segment, state.cables[found.cable].state.rest_lengths.size()) &&
         is_index(found.obstacle, state.obstacles.size()) && std::isfinite(found.depth);
}

bool is_sound(const BodyIntrusion& found, const State& state) {
  return is_index(found.body, state.bodies.size()) && is_index(found.obstacle, state.obstacles.size()) &&
         std::isfinite(found.depth);
}

bool is_sound(const StatusFinding& found, const State& state) {
  const bool is_known = found.status > StepResult::Status::ok && found.status <= StepResult::Status::fault;
  const auto is_one = [&](BodyId::Kind kind, std::size_t count) {
    return found.body.kind == kind && is_index(found.body.index, count);
  };
  return is_known && std::isfinite(found.max_strain) &&
         (is_one(BodyId::Kind::cable, state.cables.size()) || is_one(BodyId::Kind::net, state.nets.size()) ||
          is_one(BodyId::Kind::particle, state.particles.size()) || is_one(BodyId::Kind::rigid_body, state.bodies.size()));
}

template <class Found, class... More>
void erase_unsound(std::vector<Found>& all, const More&... more) {
  const auto is_wrong = [&](const Found& found) { return !is_sound(found, more...); };
  all.erase(std::remove_if(all.begin(), all.end(), is_wrong), all.end());
}

/// Those that are no events, but hold on until the next step.
template <class AnyFindings>
auto lasting(AnyFindings& findings) {
  return std::tie(findings.unsettled, findings.misfits, findings.unreached, findings.statuses, findings.intrusions,
                  findings.body_intrusions, findings.contacts, findings.body_contacts);
}

}  // namespace

std::string bytes_of(const State& state, const Findings& findings, std::size_t told_unsettled) {
  ByteWriter bytes;
  bytes(hash(state));
  std::apply([&](const auto&... found) { (visit(found, bytes), ...); }, lasting(findings));
  bytes(told_unsettled);
  visit(state, bytes);
  return bytes.take();
}

void restore(std::string_view text, State& state, Findings& findings, std::size_t& told_unsettled) {
  ByteReader bytes(text);
  std::uint64_t expected = 0;
  bytes(expected);
  StateReader reader(bytes, meshes_of(state));
  findings = {};
  std::apply([&](auto&... found) { (reader.read(found), ...); }, lasting(findings));
  bytes(told_unsettled);
  reader.read(state);
  if (!bytes.is_at_end()) throw std::invalid_argument("there are more than a state has");
  if (hash(state) != expected) throw std::invalid_argument("they are damaged, or of another version");
  // The hash does not cover them.
  erase_unsound(findings.statuses, state);
  erase_unsound(findings.intrusions, state);
  erase_unsound(findings.body_intrusions, state);
  erase_unsound(findings.contacts, false, state);
  erase_unsound(findings.body_contacts, true, state);
  told_unsettled = std::min(told_unsettled, findings.unsettled.size());
}

std::string numbers_of(const SceneDesc& scene) {
  ByteWriter bytes;
  visit(scene, bytes);
  return bytes.take();
}

void set_numbers(const std::string& text, SceneDesc& scene) {
  ByteReader bytes(text);
  StateReader(bytes, {}).read(scene);
  if (!bytes.is_at_end()) throw std::invalid_argument("there are more than a scene has");
}

}  // namespace verlet_cable
