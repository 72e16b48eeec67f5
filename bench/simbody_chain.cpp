#include <Simbody.h>

#include <cstdio>

#include "rope.h"

namespace verlet_cable::bench {

namespace {

constexpr double observation_interval = 0.01;

enum class Method { merson, feldberg, runge_kutta_3, verlet, semi_explicit_euler_2, adams };

struct NamedMethod {
  Method method;
  const char* name;
};
constexpr NamedMethod methods[] = {{Method::merson, "RungeKuttaMerson"},
                                   {Method::adams, "CPodes Adams"},
                                   {Method::runge_kutta_3, "RungeKutta3"},
                                   {Method::feldberg, "RungeKuttaFeldberg"},
                                   {Method::verlet, "Verlet"},
                                   {Method::semi_explicit_euler_2, "SemiExplicitEuler2"}};

std::unique_ptr<SimTK::Integrator> make_integrator(Method method, const SimTK::System& system) {
  switch (method) {
    case Method::merson:
      return std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system);
    case Method::feldberg:
      return std::make_unique<SimTK::RungeKuttaFeldbergIntegrator>(system);
    case Method::runge_kutta_3:
      return std::make_unique<SimTK::RungeKutta3Integrator>(system);
    case Method::verlet:
      return std::make_unique<SimTK::VerletIntegrator>(system);
    case Method::semi_explicit_euler_2:
      return std::make_unique<SimTK::SemiExplicitEuler2Integrator>(system);
    case Method::adams:
      break;
  }
  return std::make_unique<SimTK::CPodesIntegrator>(system, SimTK::CPodes::Adams, SimTK::CPodes::Functional);
}

/// Massless links on pins, a point mass at the end of each: the motion from the horizontal stays in a plane, and pins, one
/// coordinate a link, are the cheapest joints for it. Simbody's plane x-y is the task's x-z.
class SimbodyChain : public Rope {
 public:
  SimbodyChain(const RopeTask& task, Method method, double accuracy)
      : matter_(system_), forces_(system_), link_(task.length / task.segments, 0, 0) {
    SimTK::Force::UniformGravity(forces_, matter_, SimTK::Vec3(0, -9.81, 0));
    for (int i = 1; i <= task.segments; ++i) {
      const double mass = task.node_mass(i);
      const SimTK::Body::Rigid body(SimTK::MassProperties(mass, link_, SimTK::Inertia(link_, mass)));
      if (i == 1)
        links_.push_back(SimTK::MobilizedBody::Pin(matter_.updGround(), SimTK::Transform(), body, SimTK::Transform()));
      else
        links_.push_back(SimTK::MobilizedBody::Pin(links_.back(), SimTK::Transform(link_), body, SimTK::Transform()));
    }
    system_.realizeTopology();
    integrator_ = make_integrator(method, system_);
    integrator_->setAccuracy(accuracy);
    stepper_ = std::make_unique<SimTK::TimeStepper>(system_, *integrator_);
    stepper_->initialize(system_.getDefaultState());
  }

  void advance() override { stepper_->stepTo(++observations_ * observation_interval); }
  double time() const override { return static_cast<double>(observations_) * observation_interval; }
  void observe(std::vector<Vector3>& positions, std::vector<Vector3>& velocities) const override {
    const SimTK::State& state = integrator_->getState();
    system_.realize(state, SimTK::Stage::Velocity);
    positions.assign(1, Vector3::Zero());
    velocities.assign(1, Vector3::Zero());
    for (const SimTK::MobilizedBody::Pin& link : links_) {
      const SimTK::Vec3 x = link.findStationLocationInGround(state, link_), v = link.findStationVelocityInGround(state, link_);
      positions.emplace_back(x[0], 0, x[1]);
      velocities.emplace_back(v[0], 0, v[1]);
    }
  }

 private:
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Vec3 link_;
  std::vector<SimTK::MobilizedBody::Pin> links_;
  std::unique_ptr<SimTK::Integrator> integrator_;
  std::unique_ptr<SimTK::TimeStepper> stepper_;
  long observations_ = 0;
};

}  // namespace

std::vector<Candidate> simbody_candidates(const RopeTask& task) {
  std::vector<Candidate> candidates;
  for (const NamedMethod& named : methods) {
    for (const double accuracy : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5}) {
      char name[64];
      std::snprintf(name, sizeof name, "%s %g", named.name, accuracy);
      const Method method = named.method;
      candidates.push_back({name, [task, method, accuracy] { return std::make_unique<SimbodyChain>(task, method, accuracy); }});
    }
  }
  return candidates;
}

}  // namespace verlet_cable::bench
