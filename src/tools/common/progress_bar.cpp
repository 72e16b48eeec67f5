#include "progress_bar.h"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "duration_text.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::tools {
namespace {

constexpr auto interval = std::chrono::milliseconds(100);
constexpr int width = 40;

}  // namespace

ProgressBar::ProgressBar(double amount, const char* unit, bool has_data)
    : is_on_(isatty(STDERR_FILENO) == 1 && !(has_data && isatty(STDOUT_FILENO) == 1)),
      amount_(amount),
      unit_(unit),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

void ProgressBar::show(double done, std::chrono::steady_clock::time_point now) {
  if (!is_on_ || now - last_ < interval) return;
  last_ = now;
  is_visible_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double fraction = done / amount_;
  const auto filled = static_cast<std::size_t>(fraction * width);
  const std::string so_far =
      unit_ ? rounded_text(done) + " of " + rounded_text(amount_) + " " + unit_ : progress_text(done, amount_);
  std::fprintf(stderr, "\r[%s%s] %3.0f %%  %s, %s left \x1b[K", std::string(filled, '#').c_str(),
               std::string(width - filled, '.').c_str(), 100 * fraction, so_far.c_str(),
               duration_text(elapsed * (1 / fraction - 1)).c_str());
}

void ProgressBar::clear() {
  if (is_visible_) std::fputs("\r\x1b[K", stderr);
  is_visible_ = false;
}

}  // namespace verlet_cable::tools
