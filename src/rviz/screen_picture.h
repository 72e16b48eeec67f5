#pragma once

#include <OgreMaterial.h>
#include <OgreTexture.h>

#include <QImage>
#include <string>

namespace Ogre {
class Overlay;
class OverlayContainer;
}  // namespace Ogre

namespace verlet_cable {

/// A picture in the lower left corner of rviz's window, in front of the scene. Not there until it is shown.
class ScreenPicture {
 public:
  explicit ScreenPicture(const std::string& unique_name);
  ~ScreenPicture();
  ScreenPicture(const ScreenPicture&) = delete;
  ScreenPicture& operator=(const ScreenPicture&) = delete;

  /// Nothing, where it is null.
  void show(const QImage& picture);

 private:
  void fill_texture(const QImage& picture);
  void remove_texture();

  std::string name_;
  Ogre::MaterialPtr material_;
  Ogre::TexturePtr texture_;
  Ogre::OverlayContainer* panel_;
  Ogre::Overlay* overlay_;
};

}  // namespace verlet_cable
