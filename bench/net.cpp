#include <BulletSoftBody/btSoftBodyHelpers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bullet_world.h"
#include "nets.h"
#include "rows.h"
#include "stopwatch.h"

namespace verlet_cable::bench {

namespace {

constexpr double time_step = 1e-3, duration = 0.4;  // [s]
constexpr double mass = 0.2;                        // [kg]
constexpr double size = 1;                          // [m]

struct Run {
  double links = 0;
  double largest_strain = 0;
  double cost = 0;    ///< processor time a simulated second [s]
  double sweeps = 0;  ///< over all links, that each step takes
};

int steps() {
  return static_cast<int>(std::lround(duration / time_step));
}

Run run_package(int nodes) {
  SceneDesc scene = scenes::flag(nodes, nodes, size / (nodes - 1), LinkType::limited);
  scene.time_step = time_step;
  scene.fluid.velocity.setZero();
  scene.nets[0].mass = mass;
  scene.nets[0].stiffness = 500;
  scene.nets[0].damping = 0.5;
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  Run run;
  run.links = static_cast<double>(world.nets()[0].model.links.size());
  const double start = processor_seconds();
  int fewest = std::numeric_limits<int>::max();
  for (int i = 0; i < steps(); ++i) {
    const StepResult result = world.step(inputs);
    run.largest_strain = std::max(run.largest_strain, result.max_strain);
    fewest = std::min(fewest, result.iterations);  // others correct single links besides
  }
  run.cost = (processor_seconds() - start) / duration;
  run.sweeps = fewest;
  return run;
}

/// Bullet's patch held at the same corners; it has one diagonal a cell.
Run run_bullet(int nodes, int iterations) {
  BulletWorld bullet;
  btSoftBody* const patch =
      btSoftBodyHelpers::CreatePatch(bullet.world.getWorldInfo(), btVector3(0, 0, 0), btVector3(size, 0, 0),
                                     btVector3(0, 0, -size), btVector3(size, 0, -size), nodes, nodes, 1 + 2, true);
  for (int i = 0; i < patch->m_nodes.size(); ++i)
    if (patch->m_nodes[i].m_im > 0) patch->setMass(i, mass / (nodes * nodes));
  bullet.add(*patch, iterations);
  Run run;
  run.links = patch->m_links.size();
  run.sweeps = iterations;
  double seconds = 0;
  for (int i = 0; i < steps(); ++i) {
    const double start = processor_seconds();
    bullet.world.stepSimulation(time_step, 0);
    seconds += processor_seconds() - start;
    for (int k = 0; k < patch->m_links.size(); ++k) {
      const btSoftBody::Link& link = patch->m_links[k];
      const double strain = (link.m_n[0]->m_x - link.m_n[1]->m_x).length() / link.m_rl - 1;
      run.largest_strain = std::max(run.largest_strain, std::abs(strain));
    }
  }
  run.cost = seconds / duration;
  bullet.world.removeSoftBody(patch);
  delete patch;
  return run;
}

double per_link_and_sweep(const Run& run) {
  return run.cost * time_step / (run.links * run.sweeps);
}

void net_row(Report& report, const std::string& name, const Run& run, const std::string& ratio, const std::string& verdict) {
  report.row({name, figure(run.links, 5), figure(run.sweeps), figure(100 * run.largest_strain), figure(1 / run.cost),
              figure(1e9 * per_link_and_sweep(run)), ratio, verdict});
}

}  // namespace

void net(Report& report, bool quick) {
  const int nodes = quick ? 30 : 100;
  report.table("A flag of " + std::to_string(nodes) + " x " + std::to_string(nodes) +
                   " nodes that falls, held at two corners, 1 ms: links limited to 10 % beside Bullet's soft-body patch",
               {"            engine", "links", "sweeps", "largest strain [%]", "   RTF", "ns a link, sweep", "ratio", "verdict"});
  const Run own = run_package(nodes);
  net_row(report, "verlet_cable", own, "1", report.at_least(1 / own.cost, 1));
  // Of Bullet's settings the first that is as good, else the best of those that can be waited for.
  for (const int iterations : {4, 10, 20, 40, 80, 160}) {
    const Run bullet = run_bullet(nodes, iterations);
    const double ratio = bullet.cost / own.cost;
    const bool equal = bullet.largest_strain <= own.largest_strain;
    net_row(report, "Bullet", bullet, figure(ratio), equal ? report.at_least(ratio, 3) : "strains more");
    if (equal) break;
  }
}

}  // namespace verlet_cable::bench
