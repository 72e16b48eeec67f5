#include "scene_sources/scene_parameters.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <limits>

#include "scene_sources/scene_outline.h"

namespace verlet_cable {
namespace {

using XmlRpc::XmlRpcValue;

TEST(SceneParameters, NumbersKeepEveryBit) {
  EXPECT_EQ(to_yaml(XmlRpcValue(3)).as<int>(), 3);
  EXPECT_EQ(to_yaml(XmlRpcValue(0.1)).as<double>(), 0.1);
  EXPECT_EQ(to_yaml(XmlRpcValue(1.0 / 3)).as<double>(), 1.0 / 3);
  EXPECT_EQ(to_yaml(XmlRpcValue(-1e-300)).as<double>(), -1e-300);
  EXPECT_EQ(to_yaml(XmlRpcValue(std::numeric_limits<double>::infinity())).as<double>(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(to_yaml(XmlRpcValue(std::numeric_limits<double>::quiet_NaN())).as<double>()));
}

TEST(SceneParameters, TextIsPassedThrough) {
  EXPECT_EQ(to_yaml(XmlRpcValue("1e-5")).as<std::string>(), "1e-5");
  EXPECT_EQ(to_yaml(XmlRpcValue("1e-5")).as<double>(), 1e-5);
  EXPECT_EQ(to_yaml(XmlRpcValue("")).as<std::string>(), "");
  EXPECT_EQ(to_yaml(XmlRpcValue(true)).as<bool>(), true);
}

TEST(SceneParameters, TreesKeepTheirShape) {
  XmlRpcValue value;
  value["frame_id"] = "base";
  value["gravity"][0] = 0;
  value["gravity"][1] = 0.5;
  value["gravity"][2] = "-9.81";
  value["cables"][0]["name"] = "hose";
  const YAML::Node node = to_yaml(value);
  EXPECT_EQ(node.size(), 3U);
  EXPECT_EQ(node["frame_id"].as<std::string>(), "base");
  EXPECT_EQ(node["gravity"].as<std::vector<double>>(), (std::vector<double>{0, 0.5, -9.81}));
  EXPECT_EQ(node["cables"][0]["name"].as<std::string>(), "hose");
}

TEST(SceneParameters, OtherTypesAreNamedWithTheirKey) {
  XmlRpcValue value;
  char bytes[] = "bytes";
  value["cables"][0]["name"] = XmlRpcValue(bytes, sizeof(bytes));
  try {
    to_yaml(value);
    FAIL() << "binary data was accepted";
  } catch (const SceneError& error) {
    EXPECT_NE(error.errors().at(0).find("cables[0].name"), std::string::npos) << error.errors().at(0);
  }
}

/// What `to_yaml` says of a value that is too large.
std::string refusal_of(const XmlRpcValue& value) {
  try {
    to_yaml(value);
  } catch (const SceneError& error) {
    return error.errors().front();
  }
  return "";
}

TEST(SceneParameters, AreNoLargerThanScenesThatAreText) {
  XmlRpcValue deep = 1;
  for (int i = 0; i < 40; ++i) {
    XmlRpcValue outer;
    outer["a"] = deep;
    deep = outer;
  }
  EXPECT_NE(refusal_of(deep).find("a.a: nested deeper than 32 levels; allowed: less"), std::string::npos) << refusal_of(deep);
  XmlRpcValue many;
  many["cables"].setSize(1'000'000);
  EXPECT_EQ(refusal_of(many), "cables[999997]: with it the scene has more than 1000000 values; allowed: less");
  XmlRpcValue long_text;
  long_text["frame_id"] = std::string(std::size_t{17} << 20, 'x');
  EXPECT_EQ(refusal_of(long_text), "frame_id: with it the scene has more than 16777216 bytes of text; allowed: less");
  XmlRpcValue long_name;
  long_name[std::string(std::size_t{17} << 20, 'x')] = 1;
  EXPECT_LT(refusal_of(long_name).size(), 200U);
}

TEST(SceneOutline, CountsWhatThereIs) {
  SceneDesc scene;
  scene.frame_id = "base";
  scene.time_step = 0.0007;
  EXPECT_EQ(scene_outline(scene), "fixed frame \"base\", time step 0.7 ms");
  scene.cables.resize(2);
  scene.cables[0].segments = 60;
  scene.cables[1].segments = 36;
  scene.bodies.resize(1);
  scene.obstacles.resize(3);
  EXPECT_EQ(scene_outline(scene), "2 cables, 96 segments, 1 body, 3 obstacles, fixed frame \"base\", time step 0.7 ms");
}

}  // namespace
}  // namespace verlet_cable
