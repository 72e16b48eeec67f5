#include "edit_requests/location.h"

#include <gtest/gtest.h>

#include <limits>

#include "edit_requests/checked_pin.h"
#include "edit_requests/error_text.h"
#include "straight_cables.h"

namespace verlet_cable {
namespace {

World two_cables() {
  const SceneDesc scene = straight_cables({{"lower", {0, 0, 0}}, {"upper", {0, 0, 1}}});
  return World(scene, initial_frames(scene));
}

/// Known are the fixed frame and a `hand` 2 m along +x from it.
std::optional<Pose> find_frame(const std::string& frame) {
  if (frame == "world") return Pose{};
  if (frame == "hand") return Pose{Vector3(2, 0, 0), Quaternion::Identity()};
  return std::nullopt;
}

RequestedPlace at_arc_length(const std::string& cable, double arc_length) {
  RequestedPlace place;
  place.cable = cable;
  place.mode = RequestedPlace::at_arc_length;
  place.arc_length = arc_length;
  return place;
}

RequestedPlace nearest(const std::string& cable, const std::string& frame, double x, double y, double z) {
  RequestedPlace place;
  place.cable = cable;
  place.mode = RequestedPlace::nearest;
  place.point_frame = frame;
  place.point = Vector3(x, y, z);
  return place;
}

int node(const RequestedPlace& place) {
  const Location found = locate_node(place, two_cables(), find_frame);
  return found.errors.empty() ? found.node : -1;
}

int segment(const RequestedPlace& place) {
  const Location found = locate_cut(place, two_cables(), find_frame);
  return found.errors.empty() ? found.node : -1;
}

std::string node_errors(const RequestedPlace& place) {
  return join(locate_node(place, two_cables(), find_frame).errors);
}

TEST(Location, NodesByNumber) {
  EXPECT_EQ(node(at_node("lower", 0)), 0);
  EXPECT_EQ(node(at_node("lower", 10)), 10);
  EXPECT_EQ(segment(at_node("lower", 1)), 1);
  EXPECT_EQ(segment(at_node("lower", 8)), 8);
}

TEST(Location, ArcLengthMeansTheNearestNodeOrTheSegmentThatContainsIt) {
  EXPECT_EQ(node(at_arc_length("lower", 0)), 0);
  EXPECT_EQ(node(at_arc_length("lower", 0.34)), 3);
  EXPECT_EQ(node(at_arc_length("lower", 0.36)), 4);
  EXPECT_EQ(node(at_arc_length("lower", 1)), 10);
  EXPECT_EQ(segment(at_arc_length("lower", 0.36)), 3);
}

TEST(Location, NearestPointInAnyFrameOnAnyCable) {
  EXPECT_EQ(node(nearest("lower", "", 0.52, 0.3, 0.2)), 5);
  EXPECT_EQ(node(nearest("lower", "hand", -1.24, 0.3, 0.2)), 8);
  EXPECT_EQ(segment(nearest("lower", "hand", -1.24, 0.3, 0.2)), 7);
  const World world = two_cables();
  EXPECT_EQ(world.cables()[locate_node(nearest("", "world", 0.5, 0, 0.4), world, find_frame).body.index].model->name, "lower");
  EXPECT_EQ(world.cables()[locate_node(nearest("", "world", 0.5, 0, 0.6), world, find_frame).body.index].model->name, "upper");
}

TEST(Location, PointsThatAreTooFarAwayAreRefused) {
  for (const double far : {1e200, -1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(node_errors(nearest("", "", far, 0, 0)).find("location.point.point: ("), std::string::npos) << far;
  }
}

TEST(Location, FramesThatAreTooFarAwayHaveANearestCableAllTheSame) {
  const FindFrame far_away = [](const std::string&) { return Pose{Vector3(1e200, 0, 0), Quaternion::Identity()}; };
  const World world = two_cables();
  const Location found = locate_cut(nearest("", "far", 0.5, 0, 0), world, far_away);
  EXPECT_GE(found.body.index, 0);
  EXPECT_NE(join(found.errors), "") << "its segment 0 cannot be cut";
}

TEST(Location, ErrorsNameFieldValueAndWhatIsAllowed) {
  EXPECT_EQ(node_errors(at_node("hose", 3)), "location.cable: \"hose\"; allowed: lower, upper");
  EXPECT_EQ(node_errors(at_node("lower", 11)), "location.node: 11; allowed: 0 to 10");
  EXPECT_NE(node_errors(at_node("lower", std::numeric_limits<std::uint32_t>::max())), "");
  for (const double bad : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(node_errors(at_arc_length("lower", bad)).find("location.arc_length: "), std::string::npos) << bad;
  }
  RequestedPlace place = at_node("lower", 3);
  place.mode = 9;
  EXPECT_EQ(node_errors(place), "location.mode: 9; allowed: 0 (NODE), 1 (ARC_LENGTH), 2 (NEAREST)");
}

TEST(Location, AllErrorsAtOnce) {
  const std::string errors = node_errors(nearest("hose", "nowhere", std::numeric_limits<double>::quiet_NaN(), 0, 0));
  for (const char* part :
       {"location.cable: \"hose\"", "location.point.point: (nan", "location.point.header.frame_id: \"nowhere\""}) {
    EXPECT_NE(errors.find(part), std::string::npos) << part << " in " << errors;
  }
}

TEST(Location, ACutLeavesEachPieceASegment) {
  for (const int bad : {0, 9, 10}) EXPECT_EQ(segment(at_node("lower", bad)), -1) << bad;
  EXPECT_EQ(segment(at_arc_length("lower", 0.05)), -1);
  EXPECT_EQ(segment(nearest("lower", "", 2, 0, 0)), -1);
  EXPECT_EQ(join(locate_cut(at_node("lower", 0), two_cables(), find_frame).errors),
            "location.node: 0 means segment 0 of cable \"lower\"; allowed: segments 1 to 8, so that each piece keeps one");
}

RequestedPin pin_request() {
  RequestedPin request;
  request.place = at_node("lower", 10);
  request.offset.orientation.coeffs().setZero();
  request.offset.position.x() = 0.9;
  return request;
}

std::string pin_errors(const RequestedPin& request) {
  return join(check_pin(request, two_cables(), find_frame).errors);
}

TEST(CheckedPin, AGoodRequest) {
  const CheckedPin pin = check_pin(pin_request(), two_cables(), find_frame);
  EXPECT_EQ(join(pin.errors), "");
  EXPECT_EQ(pin.node, 10);
  EXPECT_EQ(pin.frame, "world");
  EXPECT_EQ(pin.offset.position, Vector3(0.9, 0, 0));
  EXPECT_EQ(pin.offset.orientation.coeffs(), Quaternion::Identity().coeffs()) << "all zero is the identity";
}

TEST(CheckedPin, LeavesGuidesRoom) {
  SceneDesc scene = straight_cables({{"rope", Vector3::Zero()}});
  GuideDesc& guide = scene.guides.emplace_back();
  guide.name = "eye";
  guide.cable = "rope";
  guide.place = PlaceDesc{PlaceDesc::At::arc_length, 0.5};
  guide.offset = {0.5, 0, 0};
  const World world(scene, {});
  RequestedPin request;
  request.keep_offset = true;
  request.place = at_node("rope", 4);
  EXPECT_EQ(join(check_pin(request, world, find_frame).errors),
            "location: node 4 of cable \"rope\" is 0.1 m of cable from guide \"eye\"; allowed: nodes at least 0.2 m from it");
  request.place = at_node("rope", 5);
  EXPECT_EQ(join(check_pin(request, world, find_frame).errors),
            "location: node 5 of cable \"rope\" is held by \"eye\"; allowed: nodes that nothing holds");
  request.place = at_node("rope", 3);
  EXPECT_EQ(join(check_pin(request, world, find_frame).errors), "");
}

TEST(CheckedPin, KeepsTheNodeWhereItIsRelativeToTheFrame) {
  RequestedPin request = pin_request();
  request.keep_offset = true;
  request.frame_id = "hand";
  const CheckedPin pin = check_pin(request, two_cables(), find_frame);
  EXPECT_EQ(join(pin.errors), "");
  // Rounding of positions around 2 m.
  EXPECT_LT((pin.offset.position - Vector3(-1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((pin.offset.orientation * Vector3::UnitX() - Vector3::UnitX()).norm(), 1e-12);
}

TEST(CheckedPin, RefusesWithFieldAndValue) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RequestedPin request = pin_request();
  request.offset.position.z() = nan;
  EXPECT_NE(pin_errors(request).find("offset.position: (0.9, 0, nan)"), std::string::npos) << pin_errors(request);
  request.offset.position.z() = 1e300;
  EXPECT_NE(pin_errors(request).find("offset.position: (0.9, 0, 1e+300)"), std::string::npos) << pin_errors(request);
  request = pin_request();
  request.offset.orientation.w() = 1e-9;
  EXPECT_NE(pin_errors(request).find("offset.orientation"), std::string::npos);
  request.offset.orientation.w() = nan;
  EXPECT_NE(pin_errors(request).find("offset.orientation"), std::string::npos);
  request = pin_request();
  request.name = "lower_start";
  EXPECT_NE(pin_errors(request).find("name: \"lower_start\""), std::string::npos);
  request.name = "no spaces";
  EXPECT_NE(pin_errors(request).find("name: \"no spaces\""), std::string::npos);
  request = pin_request();
  request.frame_id = "nowhere";
  EXPECT_NE(pin_errors(request).find("frame_id: \"nowhere\""), std::string::npos);
  request.frame_id = "/world";
  EXPECT_NE(pin_errors(request).find("frame_id: \"/world\""), std::string::npos);
  request = pin_request();
  request.place.node = 0;
  EXPECT_NE(pin_errors(request).find("held by \"lower_start\""), std::string::npos);
  request = pin_request();
  request.offset.position.x() = 1.01;
  EXPECT_NE(pin_errors(request).find("is 1.01 m from \"lower_start\""), std::string::npos) << pin_errors(request);
  const std::string advice = "; to hold it where it is: keep_offset: true";
  EXPECT_EQ(pin_errors(request).find(advice), pin_errors(request).size() - advice.size()) << pin_errors(request);
  request.keep_offset = true;
  EXPECT_EQ(pin_errors(request), "");
  request.offset.position.x() = nan;
  EXPECT_EQ(pin_errors(request), "") << "the offset does not count";
}

}  // namespace
}  // namespace verlet_cable
