#pragma once

#include "scene/scene_errors.h"

namespace verlet_cable {

/// The parts of `validate` that are about particles, nets and how they are integrated. `names`: those of cables, nets,
/// particles, bodies and guides; `attachments`: those of attachments.
void check_particles(const SceneDesc& scene, UniqueNames& names, Errors& errors);
void check_nets(const SceneDesc& scene, UniqueNames& names, UniqueNames& attachments, Errors& errors);
void check_integrator(const SceneDesc& scene, Errors& errors);

}  // namespace verlet_cable
