// The shipped views of rviz.
#include <gtest/gtest.h>
#include <ros/package.h>
#include <rviz/display.h>
#include <rviz/panel.h>
#include <rviz/tool.h>
#include <yaml-cpp/yaml.h>

#include <QIcon>
#include <filesystem>
#include <pluginlib/class_loader.hpp>

namespace {

namespace filesystem = std::filesystem;

filesystem::path package() {
  return ros::package::getPath("verlet_cable");
}

std::vector<filesystem::path> views() {
  std::vector<filesystem::path> files;
  for (const auto& entry : filesystem::recursive_directory_iterator(package() / "rviz"))
    if (entry.path().extension() == ".rviz") files.push_back(entry.path());
  return files;
}

/// How many of a list have a class.
int count(const YAML::Node& list, const std::string& name) {
  int found = 0;
  for (const YAML::Node& item : list) found += item["Class"].as<std::string>() == name ? 1 : 0;
  return found;
}

TEST(Views, HaveALegendAndBeginWithTheCamera) {
  ASSERT_GE(views().size(), 20u);
  for (const filesystem::path& file : views()) {
    const YAML::Node manager = YAML::LoadFile(file.string())["Visualization Manager"];
    EXPECT_EQ(count(manager["Displays"], "verlet_cable/Legend"), 1) << file;
    EXPECT_EQ(manager["Tools"][0]["Class"].as<std::string>(), "rviz/MoveCamera") << file;
  }
}

TEST(Views, EverySceneHasOne) {
  for (const char* scenes : {"config/scenes", "config/scenes/lecture"}) {
    const bool lecture = filesystem::path(scenes).filename() == "lecture";
    for (const auto& entry : filesystem::directory_iterator(package() / scenes)) {
      if (entry.path().extension() != ".yaml") continue;
      const filesystem::path view = package() / "rviz" / (lecture ? "lecture" : "scenes") / entry.path().stem();
      EXPECT_TRUE(filesystem::exists(view.string() + ".rviz")) << entry.path();
    }
  }
}

template <typename Base>
void expect_icons(const std::string& base) {
  pluginlib::ClassLoader<Base> loader("rviz", base);
  for (const std::string& name : loader.getDeclaredClasses()) {
    if (name.rfind("verlet_cable/", 0) != 0) continue;
    const filesystem::path icon = package() / "icons/classes" / (loader.getName(name) + ".svg");
    EXPECT_FALSE(QIcon(QString::fromStdString(icon.string())).pixmap(16).isNull()) << icon;
  }
}

TEST(Views, EveryPluginHasAnIcon) {
  expect_icons<rviz::Display>("rviz::Display");
  expect_icons<rviz::Panel>("rviz::Panel");
  expect_icons<rviz::Tool>("rviz::Tool");
}

}  // namespace
