#pragma once

#include <vector>

#include "law/winch.h"
#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A segment whose rest length changes while the cable moves: at a winch it pays cable out or takes it in; between two ends that
/// are being joined it shrinks.
struct LengthDrive {
  enum class Place { start, end, inside };
  Place place = Place::start;
  int segment = 0;
  double left = 0;             ///< [m] still to be paid out, < 0: to be taken in
  double speed = 0;            ///< [m/s] to be reached, > 0
  double acceleration = 0;     ///< [m/s^2] with which it is reached and left, > 0
  double rate = 0;             ///< [m/s] at the world's time, < 0: taking in; of a winch that keeps a tension the last mean
  double tension = infinity;   ///< [N] that a winch keeps, or above which it gives way; 0, kept: nothing drives it
  bool keeps_tension = false;  ///< a winch goes by the tension, not by `left`
  double min_length = 0, max_length = infinity;  ///< [m] of the cable, between which a winch keeps a tension
  double motor_speed = 0;  ///< [m/s] that one which keeps a tension has come to: behind its clutch the motor runs on
  double slip = 0;         ///< [m/s] by which the rest length grew faster than planned, in the last substep
  /// [m] that a bent place lost in length when its node was taken in, [m/s] how that changes; it is given back smoothly
  double debt = 0, debt_rate = 0;

  // Of the present step
  double start_length = 0;          ///< [m] the segment's rest length at its start
  double start_masses[2] = {0, 0};  ///< [kg] of its nodes, then
  double wound = 0;                 ///< [m] of `left` in this step
  double change = 0;                ///< [m] of the rest length
  double next_rate = 0;             ///< [m/s] at its end
  double next_debt = 0, next_debt_rate = 0;
  bool arrives = false;
  double fastest_in = 0, fastest_out = 0;  ///< [m/s] >= 0: how fast a winch may go as its tension is
  double carried = 0;                      ///< [m/s] of `slip` at its start, with which it is wound on
  double slipped = 0;                      ///< [m] beyond what is planned, so far

  double growth() const { return rate - debt_rate; }   ///< [m/s] of the rest length, at the world's time
  double fed_rate() const { return growth() + slip; }  ///< [m/s] likewise, with what it has slipped by
  double next_growth() const { return next_rate - next_debt_rate; }
  bool is_winch() const { return place != Place::inside; }
  bool heeds_tension() const { return tension < infinity; }
  double fed() const { return wound + slipped; }  ///< [m] of material that has come through a winch in the step, at its end
  int end_node(int segments) const { return place == Place::start ? 0 : segments; }  ///< of a winch
};

/// While a winch winds, what goes through a clamp there of a cable without bending stiffness may have any direction: the clamp
/// does not hold the neighbour of its node.
void open_clamp(const LengthDrive& drive, const std::vector<Attachment>& attachments, int segments, KinematicTargets& targets);

/// Plans the next step: speeds up, goes on or brakes so that it comes to rest at the end of `left`, or where no more than
/// `available` [m] is taken in.
void plan_drive(double available, double time_step, LengthDrive& drive);

/// The same of a winch that keeps a tension: it goes on as it goes, `going` [m/s], but no faster than it may; what its tension
/// makes of that each substep finds. At most `most_out` [m] is let out.
void plan_kept_tension(double going, double available, double most_out, double time_step, LengthDrive& drive);
/// Takes in no more than `most` [m] in this step: what is beside the winch may be in a guide that lets nothing through.
void stall(double most, double time_step, LengthDrive& drive);
/// In a substep of `h` [s] that ends at a part of the step.
WinchLaw winch_law(const LengthDrive& drive, double part, double h, double time_step);
/// A substep of `h` [s] has found that the rest length grows by `beyond` [m] more than planned. Gives the segment and its nodes
/// the `share` of it that they have of what is planned for the substep; they have all of it as they are wound on.
void slip(double beyond, double share, double h, const CableModel& model, CableState& state, LengthDrive& drive);

/// [m] The segment's rest length at a part of the step.
double planned_length(const LengthDrive& drive, double part, double time_step);

/// Gives the segment the rest length, and its nodes the masses, that it has at a part of the step, 0 to 1.
void wind(const LengthDrive& drive, double part, double time_step, const CableModel& model, CableState& state);
/// What else has changed the rest length and the masses since they were wound to a part of the step stays: guides let material
/// flow into the segment or out of it.
void keep_flow(double part, double time_step, const CableModel& model, const CableState& state, LengthDrive& drive);
/// [m/s] growth of the rest length at a part of the step.
double growth_at(const LengthDrive& drive, double part);

/// The step is done: what was next is now. False if the drive has nothing left to do.
bool complete_drive(double time_step, LengthDrive& drive);

/// Splits a segment in two of the rest lengths `first` [m] and what is left, on a straight line; velocities change linearly along
/// it. Mass and momentum stay as they are.
void insert_node(int segment, double first, const CableModel& model, CableState& state);

/// Makes one segment of the two at an inner node, with the strain that they had. Its mass and momentum go to its neighbours.
/// Returns by how much the rest length is shorter than that of the two [m]: a bent place has no straight segment of its length.
double remove_node(int node, CableState& state);

}  // namespace verlet_cable
