#include "screen_picture.h"

#include <OGRE/Overlay/OgreOverlay.h>
#include <OGRE/Overlay/OgreOverlayContainer.h>
#include <OGRE/Overlay/OgreOverlayManager.h>
#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgreResourceGroupManager.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

namespace verlet_cable {
namespace {

constexpr int distance_from_edges = 12;  // [pixels]

const Ogre::String& resource_group() {
  return Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME;
}

}  // namespace

ScreenPicture::ScreenPicture(const std::string& unique_name)
    : name_(unique_name), material_(Ogre::MaterialManager::getSingleton().create(name_, resource_group())) {
  Ogre::Pass& pass = *material_->getTechnique(0)->getPass(0);
  pass.setLightingEnabled(false);
  pass.setDepthCheckEnabled(false);
  pass.setDepthWriteEnabled(false);
  pass.setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  Ogre::OverlayManager& overlays = Ogre::OverlayManager::getSingleton();
  panel_ = static_cast<Ogre::OverlayContainer*>(overlays.createOverlayElement("Panel", name_));
  panel_->setMetricsMode(Ogre::GMM_PIXELS);
  panel_->setVerticalAlignment(Ogre::GVA_BOTTOM);
  overlay_ = overlays.create(name_);
  overlay_->add2D(panel_);
}

ScreenPicture::~ScreenPicture() {
  Ogre::OverlayManager::getSingleton().destroy(overlay_);
  Ogre::OverlayManager::getSingleton().destroyOverlayElement(panel_);
  Ogre::MaterialManager::getSingleton().remove(material_->getHandle());
  remove_texture();
}

void ScreenPicture::show(const QImage& picture) {
  if (picture.isNull()) return overlay_->hide();
  fill_texture(picture.convertToFormat(QImage::Format_ARGB32));
  panel_->setMaterialName(name_);
  panel_->setDimensions(picture.width(), picture.height());
  panel_->setPosition(distance_from_edges, -picture.height() - distance_from_edges);
  overlay_->show();
}

void ScreenPicture::fill_texture(const QImage& picture) {
  Ogre::Pass& pass = *material_->getTechnique(0)->getPass(0);
  pass.removeAllTextureUnitStates();
  remove_texture();
  const auto width = static_cast<Ogre::uint32>(picture.width()), height = static_cast<Ogre::uint32>(picture.height());
  texture_ = Ogre::TextureManager::getSingleton().createManual(name_, resource_group(), Ogre::TEX_TYPE_2D, width, height, 0,
                                                               Ogre::PF_A8R8G8B8);
  texture_->getBuffer()->blitFromMemory(Ogre::PixelBox(width, height, 1, Ogre::PF_A8R8G8B8, const_cast<uchar*>(picture.bits())));
  pass.createTextureUnitState(name_)->setTextureFiltering(Ogre::TFO_NONE);
}

void ScreenPicture::remove_texture() {
  if (texture_.get() == nullptr) return;
  Ogre::TextureManager::getSingleton().remove(texture_->getHandle());
  texture_.reset();
}

}  // namespace verlet_cable
