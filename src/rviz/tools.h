#pragma once

#include <rviz/properties/bool_property.h>
#include <rviz/properties/string_property.h>

#include "click_tool.h"

namespace verlet_cable {

/// Cuts the segment that is clicked on.
class CutTool : public ClickTool {
  Q_OBJECT
 public:
  CutTool();

 private:
  void clicked(const CableLocation& location) override;
};

/// Pins the node that is clicked on, where it is then.
class PinTool : public ClickTool {
  Q_OBJECT
 public:
  PinTool();

 private:
  void clicked(const CableLocation& location) override;

  rviz::StringProperty* frame_;
  rviz::BoolProperty* clamp_;
};

}  // namespace verlet_cable
