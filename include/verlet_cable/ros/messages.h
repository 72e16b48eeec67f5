#pragma once

// The generated typedef `verlet_cable::Cable` has the name of the core's struct; in the package's own sources it is
// `CableMessage`.
#define Cable CableMessage
#include <verlet_cable/Cable.h>
#include <verlet_cable/CableArray.h>
#undef Cable
