#include "simulation/batch.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <utility>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

/// Worlds that a thread steps together: enough for the widest lanes, and few enough to stay in its cache.
constexpr std::size_t share = 16;

template <class Items, class Name>
std::vector<std::string> names_of(const Items& items, const Name& name) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(name(item));
  return names;
}

/// What scenes of a batch have in common, as text: the names of all things, and how many numbers they have.
std::vector<std::pair<std::string, std::vector<std::string>>> structure_of(const SceneDesc& scene) {
  const auto name = [](const auto& item) { return item.name; };
  std::vector<std::string> attachments;
  for (const CableDesc& cable : scene.cables)
    for (const AttachmentDesc& attachment : cable.attachments) attachments.push_back(attachment.name);
  for (const BodyDesc& body : scene.bodies)
    for (const auto& attachment : body.attachments) attachments.push_back(attachment.name);
  return {
      {"frames", frame_names(scene)},
      {"materials", names_of(scene.materials, name)},
      {"cables",
       names_of(scene.cables,
                [](const CableDesc& cable) { return cable.name + " of " + std::to_string(cable.segments) + " segments"; })},
      {"nets", names_of(scene.nets, name)},
      {"particles", names_of(scene.particles, name)},
      {"bodies", names_of(scene.bodies, name)},
      {"junctions", names_of(scene.junctions, name)},
      {"guides", names_of(scene.guides, name)},
      {"attachments", attachments},
      {"obstacles", names_of(scene.obstacles, name)},
      {"time_step", {number_text(scene.time_step) + " s"}},
  };
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

void check_alike(const std::vector<std::shared_ptr<const SceneDesc>>& scenes) {
  const auto first = structure_of(*scenes.front());
  for (std::size_t i = 1; i < scenes.size(); ++i) {
    if (scenes[i] == scenes.front()) continue;
    const auto other = structure_of(*scenes[i]);
    for (std::size_t k = 0; k < first.size(); ++k)
      if (other[k].second != first[k].second)
        throw SceneError({"scenes[" + std::to_string(i) + "]." + first[k].first + ": " + joined(other[k].second) +
                          "; allowed: scenes that differ in numbers only, the first has " + joined(first[k].second)});
  }
}

void change(const Field<MaterialDesc>& field, MaterialDesc& material, const BendingStiffness& value) {
  material.*field.member = value.front();
}

std::string material_keys() {
  std::string text = bending_stiffness_field.key;
  for (const auto& field : material_fields) text += std::string(", ") + field.key;
  return text;
}

/// Changes a material of the scene of world `index`; what is wrong is added to `errors`.
void change(const std::string& path, const MaterialChange& wanted, std::size_t index, MaterialDesc& material,
            std::vector<std::string>& errors) {
  const BendingStiffness& value = wanted.values[index];
  const auto check = [&](const auto& field) {
    for (const double number : value)
      if (!field.range.contains(number)) {
        errors.push_back(path + "." + wanted.field + "[" + std::to_string(index) + "]: " + number_text(number) +
                         "; allowed: " + field.range.text(field.unit));
        return;
      }
  };
  if (wanted.field == bending_stiffness_field.key) {
    check(bending_stiffness_field);
    material.bending_stiffness = value;
    return;
  }
  for (const auto& field : material_fields) {
    if (wanted.field != field.key) continue;
    check(field);
    change(field, material, value);
  }
}

bool is_material_field(const std::string& name) {
  return name == bending_stiffness_field.key ||
         std::any_of(material_fields.begin(), material_fields.end(), [&](const auto& field) { return name == field.key; });
}

}  // namespace

/// The threads that step, and what each needs for it.
class Batch::Threads {
 public:
  struct Buffers {
    WorldStepper stepper;
    std::vector<WorldStep> steps;
  };

  explicit Threads(int count) : arena_(count == 0 ? tbb::task_arena::automatic : count), alone_(count == 1) {}

  /// Calls `work(first, last)` for shares of so many items, on all threads.
  template <class Work>
  void share_out(std::size_t items, const Work& work) {
    if (alone_) {
      for (std::size_t first = 0; first < items; first += share) work(first, std::min(items, first + share));
      return;
    }
    const std::size_t shares = (items + share - 1) / share;
    arena_.execute([&] {
      tbb::parallel_for(std::size_t{0}, shares, [&](std::size_t i) { work(i * share, std::min(items, (i + 1) * share)); });
    });
  }

  Buffers& buffers() { return buffers_.local(); }

 private:
  tbb::task_arena arena_;
  bool alone_;
  tbb::enumerable_thread_specific<Buffers> buffers_;
};

Batch::Batch(std::vector<std::shared_ptr<const SceneDesc>> scenes, const Motion& motion, int threads)
    : motion_(motion), threads_(std::make_shared<Threads>(threads)) {
  check_alike(scenes);
  worlds_ = make_worlds(scenes);
  status_.assign(worlds_.size(), StepResult::Status::ok);
}

std::vector<DrivenWorld> Batch::make_worlds(const std::vector<std::shared_ptr<const SceneDesc>>& scenes) const {
  std::vector<DrivenWorld> worlds;
  worlds.reserve(scenes.size());
  std::map<const SceneDesc*, std::size_t> known;  // looked up only: its order does not matter
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto [same, is_new] = known.emplace(scenes[i].get(), i);
    if (is_new)
      worlds.emplace_back(scenes[i], std::make_shared<FrameSource>(*scenes[i], motion_));
    else
      worlds.push_back(worlds[same->second]);
    worlds.back().world().step_one_by_one(true);
  }
  return worlds;
}

void Batch::set_material(const std::string& name, const std::vector<MaterialChange>& changes) {
  const SceneDesc& first = worlds_.front().scene();
  if (!first.find_material(name))
    throw UnknownName("material: " + quoted(name) + "; allowed: " + material_names(first.materials));
  const bool started = worlds_.front().world().steps() > 0;
  std::vector<std::string> errors;
  for (const MaterialChange& wanted : changes) {
    if (!is_material_field(wanted.field))
      throw UnknownName("materials." + name + "." + escaped(wanted.field) + ": no such key; allowed: " + material_keys());
    if (started && wanted.field == "linear_density")
      errors.push_back("materials." + name + ".linear_density: given after the first step; allowed: before it");
  }
  std::vector<std::shared_ptr<const SceneDesc>> scenes;
  for (std::size_t i = 0; i < worlds_.size() && errors.size() < 100; ++i) {
    SceneDesc scene = worlds_[i].scene();
    for (NamedMaterial& material : scene.materials) {
      if (material.name != name) continue;
      for (const MaterialChange& wanted : changes) change("materials." + name, wanted, i, material.material, errors);
    }
    scenes.push_back(std::make_shared<SceneDesc>(std::move(scene)));
  }
  for (std::size_t i = 0; i < scenes.size() && errors.empty(); ++i)
    for (const std::string& line : validate(*scenes[i])) errors.push_back("world " + std::to_string(i) + ": " + line);
  if (!errors.empty()) throw SceneError(std::move(errors));
  if (!started) {
    std::vector<DrivenWorld> worlds = make_worlds(scenes);
    for (std::size_t i = 0; i < worlds.size(); ++i) worlds[i].take_given_poses(worlds_[i]);
    worlds_ = std::move(worlds);
    return;
  }
  std::vector<DrivenWorld> tuned = worlds_;
  for (std::size_t i = 0; i < tuned.size(); ++i) tuned[i].tune(scenes[i]);
  worlds_ = std::move(tuned);
}

void Batch::begin_steps(std::int64_t steps, std::int64_t record_every, const std::vector<Quantity>& quantities) {
  Records records;
  if (record_every > 0)
    records = Records(worlds_.front().world(), quantities, worlds_.size(), static_cast<std::size_t>(steps / record_every));
  records_ = std::move(records);
  record_every_ = record_every;
  steps_done_ = 0;
  status_.assign(worlds_.size(), StepResult::Status::ok);
}

void Batch::advance(std::int64_t steps) {
  threads_->share_out(worlds_.size(), [&](std::size_t first, std::size_t last) { advance(first, last, steps); });
  steps_done_ += steps;
}

void Batch::advance(std::size_t first, std::size_t last, std::int64_t steps) {
  Threads::Buffers& buffers = threads_->buffers();
  for (std::int64_t done = steps_done_ + 1; done <= steps_done_ + steps; ++done) {
    buffers.steps.clear();
    for (std::size_t i = first; i < last; ++i) buffers.steps.push_back({&worlds_[i].world(), &worlds_[i].next_inputs(), {}});
    buffers.stepper.step(buffers.steps, false);
    for (std::size_t i = first; i < last; ++i) status_[i] = std::max(status_[i], buffers.steps[i - first].result.status);
    if (record_every_ == 0 || done % record_every_ != 0) continue;
    for (std::size_t i = first; i < last; ++i)
      records_.add(worlds_[i].world(), i, static_cast<std::size_t>(done / record_every_ - 1));
  }
}

std::vector<char> Batch::settle() {
  std::vector<char> found(worlds_.size());
  threads_->share_out(worlds_.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) found[i] = worlds_[i].world().settle();
  });
  return found;
}

}  // namespace verlet_cable
