#include "frames/tf_inputs.h"

#include <algorithm>
#include <utility>

#include "scene/frame_speed.h"
#include "time/ros_time.h"

namespace verlet_cable {
namespace {

using Coverage = FrameHistory::Coverage;

// tf and the clock are two connections: how much earlier than the clock's jump back the first transforms after it may arrive, and
// how much later than the clock their stamps may be.
const ros::WallDuration longest_overtaking(1.0);
const ros::WallDuration longest_receiving(0.005);
constexpr Nanoseconds longest_ahead = 500'000'000;
/// Of a step, in which a frame may begin to go back, or stop: what of that is followed is less than the speed at which gaps
/// close.
constexpr int parts_of_step = 10;
static_assert(FrameGap::fastest_motion / parts_of_step <= FrameGap::speed);

}  // namespace

TfInputs::TfInputs(const ros::NodeHandle& node, const SceneDesc& scene) : listener_(node), buffer_(scene.frame_id) {
  follow_scene(scene, 0);
}

void TfInputs::follow_scene(const SceneDesc& scene, Nanoseconds time) {
  buffer_.see_from(scene.frame_id);
  buffer_.follow(scene.jump_speed, nanoseconds(scene.tf_timeout));
  timeout_ = nanoseconds(scene.tf_timeout);
  max_frame_speed_ = scene.max_frame_speed;
  approaches_ = scene.on_lost_frame != LostFramePolicy::release;
  inputs_ = initial_frames(scene);
  const std::vector<std::string> names = frame_names(scene);
  tracks_.clear();
  for (std::size_t i = 0; i < names.size(); ++i) tracks_.push_back(track_from(names[i], inputs_[i], time));
  for (const std::string& name : computed_frame_names(scene)) tracks_.push_back(computed_track(name));
  scene_frames_ = static_cast<int>(tracks_.size());
  followers_version_.reset();
  inputs_.resize(tracks_.size(), FrameInput{Pose{}, false});
  tracks_.front().status = FrameStatus::ok;
  changes_.clear();
}

TfInputs::Track TfInputs::computed_track(const std::string& frame) const {
  Track track(frame, {Pose{}, false}, timeout_);
  track.status = FrameStatus::computed;
  return track;
}

/// As far back as `time`, if tf knows the frame then.
TfInputs::Track TfInputs::track_from(const std::string& frame, const FrameInput& at, Nanoseconds time) const {
  Track track(frame, at, timeout_);
  if (time > 0 && buffer_.pose(frame, time)) track.history.extend(time);
  update_history(track);
  return track;
}

void TfInputs::receive(Nanoseconds ros_now) {
  const ros::WallTime now = ros::WallTime::now();
  while (!recent_.empty() && recent_.front().first + longest_overtaking < now) recent_.pop_front();
  // Before there was a ROS time, nothing could be too far ahead of it.
  const bool is_first_time = ros_now > 0 && !std::exchange(has_time_, true);
  const Nanoseconds latest = FrameBuffer::latest(ros_now);
  if (is_first_time && buffer_.reaches_beyond(latest)) replay_recent(ros_now, last_ros_time);
  for (ReceivedTransform& received : listener_.take(received_.size())) received_.push_back(std::move(received));
  // The rest waits for the next call: however much somebody sends, others do not wait.
  for (; !received_.empty() && ros::WallTime::now() - now < longest_receiving; received_.pop_front()) {
    insert(received_.front(), ros_now);
    if (FrameBuffer::has_room_for_names(received_.front().transform)) recent_.emplace_back(now, std::move(received_.front()));
  }
}

void TfInputs::insert(const ReceivedTransform& received, Nanoseconds now) {
  const std::string child = without_slash(received.transform.child_frame_id);
  const std::vector<Nanoseconds> known = buffer_.insert(received, now, carried_by(child));
  if (known.empty()) return;
  for (const int frame : followers_of(child)) {
    for (const Nanoseconds stamp : known)
      if (stamp > 0) fill_history(tracks_[frame], stamp);
    update_history(tracks_[frame]);
  }
}

/// From what was sent in the last second until `latest`, as if all of it came now; what came before is forgotten.
void TfInputs::replay_recent(Nanoseconds now, Nanoseconds latest) {
  buffer_.clear();
  for (Track& track : tracks_) {
    if (track.is_body()) continue;
    track.history.clear();
    update_history(track);
  }
  find_followers();
  for (const auto& [arrival, received] : recent_) {
    if (from_ros_time(received.transform.header.stamp) <= latest) insert(received, now);
  }
}

void TfInputs::find_followers() {
  followers_.clear();
  followers_version_ = buffer_.tree_version();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].is_body()) continue;
    for (const std::string& child : buffer_.transforms_of(tracks_[i].name)) followers_[child].push_back(static_cast<int>(i));
  }
}

/// The frames, by id, that a transform moves as the tree is now.
const std::vector<int>& TfInputs::followers_of(const std::string& child) {
  static const std::vector<int> none;
  if (buffer_.tree_version() != followers_version_) find_followers();
  const auto moved = followers_.find(child);
  return moved == followers_.end() ? none : moved->second;
}

/// [m] The origins of the frames that a transform moves, in its child frame.
std::vector<Vector3> TfInputs::carried_by(const std::string& child) {
  std::vector<Vector3> carried;
  for (const int frame : followers_of(child)) {
    if (tracks_[frame].name == child) continue;
    if (const auto position = buffer_.position_in(child, tracks_[frame].name)) carried.push_back(*position);
  }
  return carried;
}

void TfInputs::update_history(Track& track) const {
  const std::optional<Nanoseconds> newest = buffer_.newest(track.name);
  if (!newest) return;
  if (*newest == 0) {
    track.history.set_static();
  } else if (*newest > track.history.newest()) {
    track.history.extend(*newest);
    track.history.forget_before(*newest - FrameBuffer::memory);
  }
}

/// One that came a little ahead of time must not hide those that come after it for earlier times.
void TfInputs::fill_history(Track& track, Nanoseconds stamp) const {
  if (stamp >= track.history.newest() || track.history.at(stamp) == Coverage::covered) return;
  if (buffer_.pose(track.name, stamp)) track.history.extend(stamp);
}

void TfInputs::restart(Nanoseconds now, bool forget) {
  if (forget) unsee_frames();
  replay_recent(now, now + longest_ahead);
}

/// But for those that pins and obstacles added, which are dropped.
void TfInputs::unsee_frames() {
  drop_pinned_frames();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    if (track.is_body()) continue;
    track.status = i == 0 ? FrameStatus::ok : FrameStatus::never_seen;
    track.too_fast = false;
    track.gap = {};
    inputs_[i] = track.initial;
  }
}

void TfInputs::reset(Nanoseconds time) {
  drop_pinned_frames();
  for (int i = 0; i < scene_frames_; ++i) {
    if (tracks_[i].is_body()) continue;
    if (const auto pose = buffer_.pose(tracks_[i].name, time)) {
      if (tracks_[i].history.at(time) == Coverage::covered) place(i, *pose);
    }
  }
}

void TfInputs::drop_pinned_frames() {
  tracks_.erase(tracks_.begin() + scene_frames_, tracks_.end());
  followers_version_.reset();
  inputs_.resize(scene_frames_);
}

int TfInputs::add(const std::string& frame, Nanoseconds time) {
  if (const Track* track = find_track(frame)) return static_cast<int>(track - tracks_.data());
  const std::optional<Pose> pose = find(frame, time);
  const FrameInput at{pose.value_or(Pose{}), pose.has_value()};
  tracks_.push_back(track_from(frame, at, time));
  if (pose) tracks_.back().status = FrameStatus::ok;
  followers_version_.reset();
  inputs_.push_back(at);
  return static_cast<int>(tracks_.size()) - 1;
}

const TfInputs::Track* TfInputs::find_track(const std::string& frame) const {
  const auto found = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& track) { return track.name == frame; });
  return found == tracks_.end() ? nullptr : &*found;
}

std::vector<SavedFrame> TfInputs::save() const {
  std::vector<SavedFrame> frames;
  for (std::size_t i = 0; i < tracks_.size(); ++i)
    frames.push_back({tracks_[i].name, inputs_[i], tracks_[i].gap, tracks_[i].status});
  return frames;
}

void TfInputs::restore(const std::vector<SavedFrame>& saved, Nanoseconds time) {
  std::vector<Track> tracks;
  BoundaryInputs inputs;
  for (const SavedFrame& frame : saved) {
    if (frame.status == FrameStatus::computed) {
      tracks.push_back(computed_track(frame.name));
      inputs.push_back(frame.input);
      continue;
    }
    const Track* followed = find_track(frame.name);
    Track& track = tracks.emplace_back(followed ? *followed : track_from(frame.name, frame.input, time));
    FrameInput input = followed ? inputs_[followed - tracks_.data()] : frame.input;
    if (!input.known) {
      input = frame.input;
      track.status = frame.status;
      track.gap = frame.gap;
    }
    if (!followed) track.status = track.history.at(time) == Coverage::covered ? FrameStatus::ok : FrameStatus::lost;
    inputs.push_back(input);
  }
  tracks_ = std::move(tracks);
  followers_version_.reset();
  inputs_ = std::move(inputs);
}

void TfInputs::rewind(const std::vector<SavedFrame>& saved, Nanoseconds time) {
  restore(saved, time);
  for (std::size_t i = 0; i < saved.size(); ++i) {
    if (tracks_[i].is_body()) continue;
    inputs_[i] = saved[i].input;
    tracks_[i].too_fast = false;
    tracks_[i].gap = saved[i].gap;
    const bool covered = tracks_[i].history.at(time) == Coverage::covered;
    const bool unseen = saved[i].status == FrameStatus::never_seen;
    // A frame that is not known then is not lost anew: it stays where it was saved until tf knows it.
    tracks_[i].status = unseen ? FrameStatus::never_seen : covered ? FrameStatus::ok : FrameStatus::lost;
  }
}

bool TfInputs::all_seen() const {
  return std::all_of(tracks_.begin(), tracks_.end(), [](const Track& track) { return track.is_body() || track.history.seen(); });
}

Nanoseconds TfInputs::first_common_time() const {
  Nanoseconds first = 0;
  for (const Track& track : tracks_) first = std::max(first, track.history.first());
  return first;
}

bool TfInputs::sample(Nanoseconds time, Nanoseconds elapsed, Nanoseconds target, const std::vector<bool>& needed) {
  changes_.clear();
  bool wait = false;
  for (std::size_t i = 0; i < tracks_.size(); ++i) wait |= needed[i] && must_wait(tracks_[i], time, target);
  if (wait) return false;
  sample_frames(time, target, elapsed);
  return true;
}

void TfInputs::sample_without_waiting(Nanoseconds time, Nanoseconds elapsed) {
  changes_.clear();
  sample_frames(time, 0, elapsed);
}

void TfInputs::sample_at_once(Nanoseconds time) {
  changes_.clear();
  sample_frames(time, 0, 0);
}

void TfInputs::sample_frames(Nanoseconds time, Nanoseconds target, Nanoseconds elapsed) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) sample_frame(static_cast<int>(i), time, target, elapsed);
}

bool TfInputs::must_wait(Track& track, Nanoseconds time, Nanoseconds target) const {
  if (track.is_body()) return false;
  const bool late = track.status != FrameStatus::lost && track.history.at(time) == Coverage::ahead &&
                    target - track.history.newest() <= timeout_;
  if (late && track.status == FrameStatus::ok) track.status = FrameStatus::late;
  return late;
}

void TfInputs::sample_frame(int frame, Nanoseconds time, Nanoseconds target, Nanoseconds elapsed) {
  Track& track = tracks_[frame];
  if (track.is_body()) return;
  const Coverage coverage = track.history.at(time);
  if (coverage == Coverage::covered) {
    if (const auto pose = buffer_.pose(track.name, time)) {
      if (track.status == FrameStatus::never_seen) change(FrameChange::Kind::seen, frame);
      if (track.status == FrameStatus::lost) come_back(frame, *pose);
      track.status = FrameStatus::ok;
      track.last_known = time;
      follow(frame, *pose, time, time, elapsed);
      return;
    }
    // Where two give it different parents, tf does not know it at the times of one that is in no tree: not lost, if others come.
    track.last_known = std::min(track.last_known, time);
    if (track.status != FrameStatus::never_seen && track.status != FrameStatus::lost && time - track.last_known <= timeout_) {
      track.status = FrameStatus::late;
      return;
    }
  }
  if (track.status == FrameStatus::never_seen) {
    if (coverage == Coverage::unseen) return;
    change(FrameChange::Kind::seen, frame);
    track.status = FrameStatus::ok;
  }
  if (track.status == FrameStatus::lost) return;
  if (const Nanoseconds last = track.history.last_before(time); last > 0) {
    if (const auto pose = buffer_.pose(track.name, last)) follow(frame, *pose, last, time, elapsed);
  }
  const bool late = coverage == Coverage::ahead && target - track.history.newest() <= timeout_;
  track.status = late ? FrameStatus::late : FrameStatus::lost;
  if (!late) change(FrameChange::Kind::lost, frame);
}

/// Without a way to get there.
void TfInputs::place(int frame, const Pose& pose) {
  inputs_[frame] = {pose, true};
  tracks_[frame].gap = {};
  tracks_[frame].too_fast = false;
}

/// What the frame holds goes on from where it was held meanwhile.
void TfInputs::come_back(int frame, const Pose& pose) {
  const FrameGap gap = FrameGap::between(pose, inputs_[frame].pose);
  changes_.push_back({FrameChange::Kind::back, frame, gap.distance(), gap.angle()});
  tracks_[frame].gap = gap;
  if (!approaches_) place(frame, pose);
}

/// `pose`: the frame's at `stamp`, the last there is until `time`. `elapsed` 0: as far as the frame went, at once.
void TfInputs::follow(int frame, const Pose& pose, Nanoseconds stamp, Nanoseconds time, Nanoseconds elapsed) {
  if (!inputs_[frame].known) return place(frame, pose);
  FrameInput& input = inputs_[frame];
  Track& track = tracks_[frame];
  const Pose before = track.gap.frame(input.pose);
  Pose followed = pose;
  const bool was_too_fast = track.too_fast;
  track.too_fast = elapsed > 0 && limit_motion(before, max_frame_speed_ * seconds(elapsed), followed);
  if (track.too_fast && !was_too_fast) change(FrameChange::Kind::too_fast, frame);
  if (!track.gap.is_closed() && elapsed > 0) {
    if (track.too_fast)
      track.gap.move(before, followed, seconds(elapsed));
    else
      move_gap(track, before, followed, time - elapsed, stamp);
    track.gap.close_by(std::min(FrameGap::speed, max_frame_speed_) * seconds(elapsed), FrameGap::turn_speed * seconds(elapsed));
  }
  input = {track.gap.followed(followed), true};
}

/// By where tf says that the frame went between these times, part by part.
void TfInputs::move_gap(Track& track, const Pose& from, const Pose& to, Nanoseconds begin, Nanoseconds end) const {
  const Nanoseconds duration = std::max<Nanoseconds>(end - begin, 0) / parts_of_step;
  Pose before = from;
  for (int i = 1; i < parts_of_step && duration > 0; ++i) {
    const std::optional<Pose> pose = buffer_.pose(track.name, begin + i * duration);
    if (!pose) continue;
    track.gap.move(before, *pose, seconds(duration));
    before = *pose;
  }
  track.gap.move(before, to, seconds(duration));
}

std::optional<Nanoseconds> TfInputs::back_after(Nanoseconds time, const std::vector<bool>& needed) const {
  Nanoseconds back = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const FrameHistory& history = tracks_[i].history;
    if (!needed[i] || tracks_[i].status != FrameStatus::lost) continue;
    if (history.is_static()) continue;
    const Nanoseconds known = history.at(time) == Coverage::covered ? time : history.first_after(time);
    if (known == 0) return std::nullopt;
    back = std::max(back, known);
  }
  return back;
}

std::optional<Pose> TfInputs::find(const std::string& frame, Nanoseconds time) const {
  if (const auto pose = buffer_.pose(frame, time)) return pose;
  const auto newest = buffer_.newest(frame);
  return newest ? buffer_.pose(frame, *newest) : std::nullopt;
}

std::vector<FrameReport> TfInputs::report() const {
  std::vector<FrameReport> reports;
  for (const Track& track : tracks_) {
    reports.push_back({track.name, track.status, track.history.is_static(), track.history.newest(), track.too_fast});
  }
  return reports;
}

}  // namespace verlet_cable
