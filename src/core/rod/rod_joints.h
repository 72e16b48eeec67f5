#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "law/sliding_spring.h"
#include "rod/pair.h"

namespace verlet_cable {

/// Material frames of many segments or clamps: the direction along the cable and the material's y and z axes, unit vectors normal
/// to each other.
struct FrameArrays {
  VectorArray x, y, z;

  void resize(std::size_t count);
};

/// One frame a lane.
struct PairFrame {
  PairVector x, y, z;
};
inline PairFrame neighbours(const FrameArrays& frames, int i) {
  return {neighbours(frames.x, i), neighbours(frames.y, i), neighbours(frames.z, i)};
}
inline void put(const PairFrame& frame, FrameArrays& frames, int i) {
  put(frame.x, frames.x, i);
  put(frame.y, frames.y, i);
  put(frame.z, frames.z, i);
}
inline Eigen::Matrix3d get(const FrameArrays& frames, int i) {
  Eigen::Matrix3d axes;
  axes << get(frames.x, i), get(frames.y, i), get(frames.z, i);
  return axes;
}
inline void set(FrameArrays& frames, int i, const Eigen::Matrix3d& axes) {
  set(frames.x, i, axes.col(0));
  set(frames.y, i, axes.col(1));
  set(frames.z, i, axes.col(2));
}

/// The frames over a substep.
struct FrameMotion {
  FrameArrays start, end;
  FrameArrays middle;  ///< where forces are taken: means of start and end, or the end's

  void resize(std::size_t count);
};

/// The angles by which one frame is turned against the one before it: two of bending, about the material's y and z axes, and one
/// of twist. With Q_jk = d_j . d_k' the products of the axes of the one frame and the other's,
///   u = 1 - Q_xx,   y = -Q_zx,   z = Q_yx
///   twist = atan2(Q_zy - Q_yz, Q_yy + Q_zz), any number of turns
///   (angle_y, angle_z) = chi(u) Rot(-twist / 2) (y, z),   chi = angle / sin(angle)
/// so that the whole bend is as in `angle_energy`, seen half a twist on from the one frame (twist as in Bergou et al., Discrete
/// Elastic Rods, 2008).
struct JointAngles {
  double twist = 0, y = 0, z = 0;  ///< [rad]
};

/// `twist` [rad]: about what it is, which tells the number of turns.
JointAngles joint_angles(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after, double twist);

/// How a joint resists [N m], [N m / rad] and where it is unloaded.
struct JointStiffness {
  double twist = 0, bend_y = 0, bend_z = 0;    ///< GJ and EI over the length of cable that it stands for
  double twist_damping = 0, bend_damping = 0;  ///< over length and time of the substep
  JointAngles rest;
  SlidingSpring yielding;  ///< what of bending yields: a part of `bend_y` and `bend_z`
  SlidingSpring friction;  ///< between strands: beyond them
};

/// [rad] What a spring that slides is bent by, unless it slides on.
AboutAxes strain_of(const SlidingSpring& spring, const JointAngles& rest, const JointAngles& angles);

struct JointEnergy {
  double bend = 0, twist = 0;  ///< [J]
};
JointEnergy joint_energy(const JointStiffness& stiffness, const JointAngles& angles);

/// Joints between neighbouring frames over a substep. The moment M of a joint is the discrete gradient of its energy: for a
/// rotation of every frame by a Cayley vector w, axis' - axis = w x (axis + axis') / 2,
///   energy' - energy = M . (w_after - w_before)
/// exactly, which keeps energy and angular momentum. It acts on the frame before, its opposite on the frame after. Every quantity
/// is built from products of axes, whose changes are products of means and changes; where functions are not, a quotient of
/// differences stands for the derivative.
class RodJoints {
 public:
  void resize(int count);
  /// Whether any of them has springs that slide; before `set`. `from_memory`: in statics, which take one step from what they
  /// remember to the equilibrium, whatever way their iterations go.
  void let_slide(bool slides, bool from_memory) {
    slides_ = slides;
    slides_from_memory_ = from_memory;
  }
  void set(int joint, const JointStiffness& stiffness, double twist);
  /// Without what its springs have slid by.
  void set_stiffness(int joint, const JointStiffness& stiffness);
  /// [rad] What material that flows in brings of what its springs have slid by, while the joint is bent; nothing at first.
  void bring(int joint, const AboutAxes& yielded, const AboutAxes& slipped) {
    memory_[joint].brought_yielded = yielded;
    memory_[joint].brought_slipped = slipped;
  }
  /// Finds the angles at the start. `before`, `after`: index of the first joint's frames; joints `first` to `last` (exclusive).
  /// Twist that is not what the frames have is corrected.
  void start(const FrameArrays& frames_before, int before, const FrameArrays& frames_after, int after, int first, int last);
  /// Finds moments and stiffnesses. `part`: where in the substep forces are taken.
  void evaluate(double part, const FrameMotion& frames_before, int before, const FrameMotion& frames_after, int after, int first,
                int last);
  /// What the matrix is to have of the two.
  void set_exact(bool exact) { is_exact_ = exact; }
  const SymmetricArray& stiffness() const { return is_exact_ ? exact_stiffness : convex_stiffness; }
  double start_twist(int joint) const { return twist_[joint]; }    ///< [rad]
  double end_twist(int joint) const { return end_twist_[joint]; }  ///< [rad]
  /// [rad] By which springs have slid at the start, and since what they remember, but for what is brought.
  AboutAxes start_yielded(int joint) const { return yielding_[joint].slid; }
  AboutAxes start_slipped(int joint) const { return friction_[joint].slid; }
  AboutAxes yielded(int joint) const { return end_yielded_[joint] - memory_[joint].yielded; }
  AboutAxes slipped(int joint) const { return end_slipped_[joint] - memory_[joint].slipped; }

  std::vector<double> bending_loss, twisting_loss;  ///< [J] what damping takes in the substep
  std::vector<double> sliding_loss;                 ///< [J] and what springs that slide do; not set where none does
  VectorArray moment;                               ///< [N m] on the frame before
  /// [N m] Of the moment against rotations, without what turns with the frames: the part of it that is never negative (Gauss and
  /// Newton's), and, where forces are taken at the end, the second derivative of the energy by the rotation of the frame after
  /// against the one before.
  SymmetricArray convex_stiffness, exact_stiffness;

 private:
  /// What springs had slid by before, what has been brought since [rad], and what was lost [J] as those that were bent at once,
  /// not by motion, slid at the start.
  struct Memory {
    AboutAxes yielded, slipped, brought_yielded, brought_slipped;
    double loss = 0;
  };

  void slide_at_once(int joint, const AboutAxes& strain);
  template <bool slides>
  void evaluate_joints(double part, const FrameMotion& frames_before, int before, const FrameMotion& frames_after, int after,
                       int first, int last);
  struct Slid;
  Slid slide(int joint, double part, const AboutAxes& start, const AboutAxes& change);

  bool is_exact_ = false;
  bool slides_ = false, slides_from_memory_ = false;
  // Over the substep; [N m]
  std::vector<double> twist_stiffness_, y_stiffness_, z_stiffness_, twist_damping_, bend_damping_;
  std::vector<double> rest_twist_, rest_y_, rest_z_;  // [rad]
  // At the start
  std::vector<double> twist_, u_, y_, z_, sine_, cosine_;  // sine and cosine times what the planes of the axes have in common
  std::vector<double> chi_, half_sine_, half_cosine_;      // half: of half the twist
  // Of the present iterate
  std::vector<double> end_twist_;  // [rad]
  // Where springs slide
  std::vector<SlidingSpring> yielding_, friction_;
  std::vector<Memory> memory_;
  std::vector<AboutAxes> end_yielded_, end_slipped_;  // of the present iterate
};

}  // namespace verlet_cable
