// Draws a progress bar: one line on the terminal, with rate and time left, erased at the end.
#pragma once
#include <string>

#include "base/clock.h"
#include "render/render.h"

namespace sundog {

/// Progress through the frames of an animation.
struct RunProgress {
  std::size_t over = 0, total = 1;  // frames finished or skipped; all frames
  std::size_t rendered = 0;         // frames rendered so far, in `seconds`
  double seconds = 0;

  /// Estimated seconds until the last frame is done, if this one takes `all` seconds and has `left` to go.
  double seconds_left(double all, double left) const;
};

/// The bar's text, at most `columns` wide. `since`: progress when this run began, which excludes pixels
/// resumed from a checkpoint from the rate. The time left covers all frames.
std::string progress_line(const RenderProgress& now, const RenderProgress& since, int columns,
                          const RunProgress& run);

/// "34 s", "2 min 05 s".
std::string duration_text(double seconds);

/// "[####......]" followed by `text`, at most `columns` wide; the bar shrinks to fit.
std::string bar_line(double fraction, const std::string& text, int columns);

/// Whether stderr is a terminal on which a line can be redrawn.
bool stderr_is_terminal();
int terminal_columns();

/// Draws on stderr, at most ten times a second, if it is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted, const RunProgress& run = {});
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(const RenderProgress& progress);
  /// Erases the line from the terminal.
  void erase();

 private:
  bool shown_ = false, drawn_ = false, started_ = false;
  RunProgress run_;
  RenderProgress first_;
  double last_drawn_ = -1;
  Stopwatch clock_;
};

}  // namespace sundog
