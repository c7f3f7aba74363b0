// A thread renders the draft; the device's owner takes it over if it outlives the frame.
#include "app/render/draft.h"

#include <exception>
#include <mutex>

#include "render/device/frame_kernels.h"
#include "render/render.h"

namespace sundog {

struct Draft::State {
  std::atomic<bool> stop{false};
  std::mutex showing;
  unsigned pictures = 0;
};

Draft::Draft(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device,
             const RenderOptions& options)
    : state_(std::make_shared<State>()), owner_(device.threads) {
  const auto show = [state = state_, on_picture = options.on_picture](const Film& film) {
    const std::lock_guard lock(state->showing);
    if (state->stop) return;
    on_picture(film);
    ++state->pictures;
  };
  RenderOptions draft;
  draft.kernels = KernelChoice::draft;
  draft.passes = true;
  draft.tuning = options.tuning;
  draft.region = options.region;
  draft.channels = options.channels;
  draft.on_picture = show;
  draft.picture_seconds = options.picture_seconds;
  draft.stop = &state_->stop;
  thread_ = start_thread([draft, device, scene = std::move(scene), state = state_] {
    try {
      const Tuning tuning = draft.tuning ? draft.tuning(device) : Tuning{};
      if (!has_only_draft(device, *scene, tuning)) return;
      const RenderResult whole = render(scene, std::vector{device}, draft);
      if (whole.complete) draft.on_picture(whole.film);
    } catch (const std::exception&) {
      // the frame reports its device's errors
    }
  });
}

void Draft::end() {
  const std::lock_guard lock(state_->showing);
  state_->stop = true;
}

unsigned Draft::pictures() const {
  const std::lock_guard lock(state_->showing);
  return state_->pictures;
}

Draft::~Draft() {
  end();
  leave_thread(owner_, std::move(thread_));
}

}  // namespace sundog
