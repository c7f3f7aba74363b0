// Continues a frame from its checkpoint, and renews the checkpoint while the frame is rendered.
#include "render/frame/frame.h"

#include "base/error.h"
#include "base/file.h"
#include "render/film/checkpoint.h"

namespace sundog {

bool continue_checkpoint(Frame& frame) {
  const std::filesystem::path& file = frame.options.resume;
  if (file.empty() || !is_there(file)) return false;
  read_checkpoint(file, frame.film, frame.pass, frame.pass_film, frame.key);
  if (frame.pass.is_none() && frame.film.grows) {
    begin_pass(frame, std::nullopt);
    return true;
  }
  if (frame.pass.is_none()) {  // complete, perhaps of another part: keep its pixels, render the missing ones
    frame.pass_film = std::exchange(frame.film, Film(frame.film.width, frame.film.height, frame.film));
    frame.pass = *next_pass(frame.film, frame.plan);
  }
  if (!may_be_of(frame.plan, frame.pass)) throw damaged_checkpoint(file);
  continue_pass(frame);
  return true;
}

void renew_checkpoint(Frame& frame) {
  const RenderOptions& options = frame.options;
  const bool now = options.keep_now && options.keep_now->exchange(false);
  if (checkpoint_path(options).empty()) return;
  if (!now && frame.since_checkpoint.seconds() < options.checkpoint_seconds) return;
  frame.since_checkpoint = Stopwatch();
  Film film, made;
  Pass pass;
  {
    const std::lock_guard lock(frame.mutex);
    if (frame.pixels_done == frame.pixels_kept) return;
    frame.pixels_kept = frame.pixels_done;
    film = frame.film;
    pass = frame.pass;
    made = frame.pass_film;
  }
  try {
    write_checkpoint(checkpoint_path(options), film, pass, made, frame.key, options.faults);
  } catch (const IoError&) {
    // If the frame is interrupted, the final write reports the same error.
  }
}

void keep_checkpoint(const Frame& frame, RenderResult& result) {
  if (checkpoint_path(frame.options).empty() || result.complete) return;
  try {
    write_checkpoint(checkpoint_path(frame.options), frame.film, frame.pass, frame.pass_film, frame.key,
                     frame.options.faults);
    result.checkpoint_kept = true;
  } catch (const IoError& error) {
    result.checkpoint_error = error.what();
  }
}

}  // namespace sundog
