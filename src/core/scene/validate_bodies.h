#pragma once

#include "scene/scene_errors.h"
#include "scene/validate_holders.h"

namespace verlet_cable {

/// The part of `validate` that is about bodies. `names`: those of cables, nets, particles, bodies and guides; `attachments`:
/// those of attachments.
void check_bodies(const SceneDesc& scene, const SceneNames& scene_names, UniqueNames& names, UniqueNames& attachments,
                  Errors& errors);

/// Frames of the scene that have the name of a body, where the bodies' poses are frames, too.
void check_broadcast(const SceneDesc& scene, const SceneNames& scene_names, Errors& errors);

}  // namespace verlet_cable
