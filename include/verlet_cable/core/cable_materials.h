#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

inline bool is_elastic(const MaterialDesc& material) {
  return material.axial_stiffness < infinity;
}

/// Index of a material as in CableState::section_material; -1 if the cable does not have it.
int find_material(const CableModel& model, const std::string& name);

/// The materials of a cable along its length: a view of its model and state, valid until either is edited.
class CableMaterials {
 public:
  CableMaterials(const CableModel& model, const CableState& state)
      : model_(model),
        state_(state),
        section_material_(state.section_material.empty() ? nullptr : state.section_material.data()) {}
  explicit CableMaterials(const SimulatedCable& cable) : CableMaterials(*cable.model, cable.state) {}

  /// Whether it has sections. If not, all of it has CableModel::material.
  bool vary() const { return section_material_ != nullptr; }

  /// The material of a segment.
  const MaterialDesc& operator[](int segment) const {
    const int k = vary() ? section_material_[segment] : 0;
    return k == 0 ? model_.material : model_.section_materials[k - 1].material;
  }
  const std::string& name(int segment) const {
    const int k = vary() ? section_material_[segment] : 0;
    return k == 0 ? model_.material_name : model_.section_materials[k - 1].name;
  }

  /// Whether a condition holds for the material of one of the segments.
  template <class Condition>
  bool any(const Condition& condition) const {
    if (!vary()) return condition(model_.material);
    for (int i = 0; i < state_.segments(); ++i)
      if (condition((*this)[i])) return true;
    return false;
  }
  bool any_elastic() const { return any(is_elastic); }
  bool any_elastic_between(int first_node, int last_node) const {
    if (!vary()) return is_elastic(model_.material);
    for (int i = first_node; i < last_node; ++i)
      if (is_elastic((*this)[i])) return true;
    return false;
  }
  bool any_rigid() const {
    return any([](const MaterialDesc& material) { return !is_elastic(material); });
  }
  bool any_bends() const {
    return any([](const MaterialDesc& material) { return material.bending_stiffness.largest() > 0; });
  }

  /// The largest and the smallest value of `property(material)` along the cable.
  template <class Property>
  double largest(const Property& property) const {
    double value = property((*this)[0]);
    for (int i = 1; vary() && i < state_.segments(); ++i) value = std::max(value, property((*this)[i]));
    return value;
  }
  template <class Property>
  double smallest(const Property& property) const {
    return -largest([&](const MaterialDesc& material) { return -property(material); });
  }
  double largest_radius() const {
    return largest([](const MaterialDesc& material) { return material.radius; });
  }
  double largest_bending_stiffness() const {
    return largest([](const MaterialDesc& material) { return material.bending_stiffness.largest(); });
  }

  /// The mean of `property(material)` over the halves of the segments beside a node, by their rest lengths.
  template <class Property>
  double mean_at(int node, const Property& property) const {
    const int before = std::max(node - 1, 0), after = std::min(node, state_.segments() - 1);
    const double first = property((*this)[before]), second = property((*this)[after]);
    if (first == second) return first;
    const double length = state_.rest_lengths[before] + state_.rest_lengths[after];
    return (state_.rest_lengths[before] * first + state_.rest_lengths[after] * second) / length;
  }

 private:
  const CableModel& model_;
  const CableState& state_;
  const int* section_material_;  // of the state; nullptr: none
};

/// [1/m] Curvatures of the segments before and after an inner node at which the cable is bent by `angle` [rad]: the same moment
/// bends both halves, about the axis with the smaller stiffness.
std::array<double, 2> curvature_beside(const CableMaterials& materials, const CableState& state, int node, double angle);

}  // namespace verlet_cable
