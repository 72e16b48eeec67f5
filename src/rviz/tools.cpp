#include "tools.h"

#include <verlet_cable/Cut.h>
#include <verlet_cable/Pin.h>

#include <pluginlib/class_list_macros.hpp>

namespace verlet_cable {

CutTool::CutTool() : ClickTool('x', "it is cut there") {}

void CutTool::clicked(const CableLocation& location) {
  Cut::Request request;
  request.location = location;
  call<Cut>("cut", request);
}

PinTool::PinTool()
    : ClickTool('p', "it is pinned there"),
      frame_(new rviz::StringProperty("Frame", "",
                                      "The tf frame that the pinned place follows; empty: the fixed frame of the simulation",
                                      getPropertyContainer())),
      clamp_(new rviz::BoolProperty("Clamp", false, "Hold the cable's direction, too", getPropertyContainer())) {}

void PinTool::clicked(const CableLocation& location) {
  Pin::Request request;
  request.location = location;
  request.frame_id = frame_->getStdString();
  request.clamp = clamp_->getBool();
  request.keep_offset = true;
  call<Pin>("pin", request);
}

}  // namespace verlet_cable

PLUGINLIB_EXPORT_CLASS(verlet_cable::CutTool, rviz::Tool)
PLUGINLIB_EXPORT_CLASS(verlet_cable::PinTool, rviz::Tool)
