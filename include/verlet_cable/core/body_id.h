#pragma once

namespace verlet_cable {

/// Something that moves in a world.
struct BodyId {
  enum class Kind { none, cable, net, particle, rigid_body };
  Kind kind = Kind::none;
  int index = -1;  ///< into World::cables(), nets(), particles() or bodies()

  bool is_cable() const { return kind == Kind::cable; }
  bool is_net() const { return kind == Kind::net; }
  bool is_rigid_body() const { return kind == Kind::rigid_body; }
  explicit operator bool() const { return kind != Kind::none; }
  bool operator==(const BodyId& other) const { return kind == other.kind && index == other.index; }
  bool operator!=(const BodyId& other) const { return !(*this == other); }
};

inline BodyId cable_id(int index) {
  return {BodyId::Kind::cable, index};
}
inline BodyId net_id(int index) {
  return {BodyId::Kind::net, index};
}
inline BodyId particle_id(int index) {
  return {BodyId::Kind::particle, index};
}
inline BodyId rigid_body_id(int index) {
  return {BodyId::Kind::rigid_body, index};
}

}  // namespace verlet_cable
