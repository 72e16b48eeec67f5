#include "publish/wrench_means.h"

#include <algorithm>
#include <utility>

namespace verlet_cable {

void WrenchMeans::add(const World& world) {
  if (std::exchange(shown_, false))
    for (Sum& sum : sums_) sum = {std::move(sum.attachment)};
  const std::vector<Attachment>& attachments = world.attachments();
  if (sums_.size() < attachments.size()) sums_.resize(attachments.size());
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    if (sums_[i].attachment != attachments[i].name) {
      const auto moved = std::find_if(sums_.begin() + static_cast<std::ptrdiff_t>(i), sums_.end(),
                                      [&](const Sum& sum) { return sum.attachment == attachments[i].name; });
      if (moved != sums_.end()) {
        std::swap(sums_[i], *moved);
      } else {
        sums_.insert(sums_.begin() + static_cast<std::ptrdiff_t>(i), Sum{attachments[i].name});
      }
    }
    sums_[i].force += attachments[i].force;
    sums_[i].torque += attachments[i].torque;
    ++sums_[i].steps;
  }
  sums_.resize(attachments.size());
}

Attachment WrenchMeans::mean(const Attachment& attachment) const {
  Attachment shown = attachment;
  const auto sum = std::find_if(sums_.begin(), sums_.end(), [&](const Sum& s) { return s.attachment == attachment.name; });
  if (sum == sums_.end() || sum->steps == 0) return shown;
  shown.force = sum->force / sum->steps;
  shown.torque = sum->torque / sum->steps;
  return shown;
}

}  // namespace verlet_cable
