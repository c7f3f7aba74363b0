// The progress bar: one line on the terminal, with rate and time left, erased at the end.
#pragma once
#include <string>

#include "base/clock.h"
#include "render/render.h"

namespace sundog {

/// The frames of an animation, of which one is rendered now.
struct RunProgress {
  std::size_t over = 0, total = 1;  // frames that are behind it, and all
  std::size_t rendered = 0;         // of those behind it, in `seconds`
  double seconds = 0;

  /// Until the last frame is done, when this one takes `all` seconds, of which `left` are to come.
  double seconds_left(double all, double left) const;
};

/// The bar's text, at most `columns` wide. `since` is the first progress of this run: a resumed render begins
/// with pixels that cost it nothing. The time left is that of all frames.
std::string progress_line(const RenderProgress& now, const RenderProgress& since, int columns,
                          const RunProgress& run);

/// "34 s", "2 min 05 s".
std::string duration_text(double seconds);

/// "[####......]" with `text` behind it, at most `columns` wide: the bar takes what room there is.
std::string bar_line(double fraction, const std::string& text, int columns);

/// True where a line on stderr can be drawn over.
bool stderr_is_terminal();
int terminal_columns();

/// Draws on stderr at most ten times a second, and only when that is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted, const RunProgress& run = {});
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(const RenderProgress& progress);
  /// Takes the line off the terminal.
  void erase();

 private:
  bool shown_ = false, drawn_ = false, started_ = false;
  RunProgress run_;
  RenderProgress first_;
  double last_drawn_ = -1;
  Stopwatch clock_;
};

}  // namespace sundog
