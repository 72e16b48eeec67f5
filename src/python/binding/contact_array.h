#pragma once

#include "binding/arguments.h"

namespace verlet_cable {

/// The contacts of the cables in the last step, as both cables feel them: fields as Contact.msg, with `cable` before them.
py::object contact_array(const World& world);

}  // namespace verlet_cable
