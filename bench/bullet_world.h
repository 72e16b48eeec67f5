#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

namespace verlet_cable::bench {

/// A world of Bullet's soft bodies under gravity.
struct BulletWorld {
  BulletWorld() : dispatcher(&configuration), world(&dispatcher, &broadphase, &solver, &configuration) {
    const btVector3 gravity(0, 0, -9.81);
    world.setGravity(gravity);
    world.getWorldInfo().m_gravity = gravity;
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  /// Of stiffest links, without damping or collisions. It stays the caller's.
  void add(btSoftBody& body, int iterations) {
    body.m_materials[0]->m_kLST = 1;
    body.updateConstants();
    body.m_cfg.kDP = 0;
    body.m_cfg.piterations = iterations;
    body.m_cfg.collisions = 0;
    body.setActivationState(DISABLE_DEACTIVATION);
    world.addSoftBody(&body);
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world;
};

}  // namespace verlet_cable::bench
