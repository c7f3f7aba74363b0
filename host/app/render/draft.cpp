#include "app/render/draft.h"

#include <exception>

#include "render/device/frame_kernels.h"
#include "render/render.h"

namespace sundog {
namespace {

/// What changes neither files but the picture, nor how the frame ends.
RenderOptions draft_options(const RenderOptions& options) {
  RenderOptions draft;
  draft.kernels = KernelChoice::draft;
  draft.passes = true;
  draft.tuning = options.tuning;
  draft.region = options.region;
  draft.channels = options.channels;
  draft.picture_seconds = options.picture_seconds;
  return draft;
}

}  // namespace

Draft::Draft(std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device,
             const RenderOptions& options) {
  RenderOptions draft = draft_options(options);
  draft.stop = &stop_;
  draft.on_picture = [this, show = options.on_picture](const Film& film) {
    const std::lock_guard lock(showing_);
    if (stop_) return;
    show(film);
    ++pictures_;
  };
  thread_ = std::thread([draft, device, scene = std::move(scene)] {
    try {
      const Tuning tuning = draft.tuning ? draft.tuning(device) : Tuning{};
      if (!has_only_draft(device, *scene, tuning)) return;
      const RenderResult whole = render(scene, std::vector{device}, draft);
      if (whole.complete) draft.on_picture(whole.film);
    } catch (const std::exception&) {
      // The frame reports what is wrong with its device.
    }
  });
}

void Draft::end() {
  const std::lock_guard lock(showing_);
  stop_ = true;
}

Draft::~Draft() {
  end();
  thread_.join();
}

}  // namespace sundog
