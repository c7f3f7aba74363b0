// Formats the progress line for the terminal's width, and draws it at most ten times a second.
#include "app/process/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "app/process/warnings.h"

namespace sundog {
namespace {

constexpr double seconds_between_bars = 0.1;

}  // namespace

bool stderr_is_terminal() {
  const char* type = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && type && std::string_view(type) != "dumb";
}

int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::min(seconds + 0.5, 1e9));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string bar_line(double fraction, const std::string& text, int columns) {
  const int bar = std::min(40, columns - static_cast<int>(text.size()) - 3);  // two brackets and the cursor
  if (bar < 4) return text.substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
  const int filled = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * bar);
  return fmt::format("[{:#<{}}{:.<{}}]{}", "", filled, "", bar - filled, text);
}

double RunProgress::seconds_left(double all, double left) const {
  const double each = rendered > 0 ? seconds / static_cast<double>(rendered) : all;
  return left + each * static_cast<double>(total - std::min(total, over + 1));
}

std::string progress_line(const RenderProgress& now, const RenderProgress& since, int columns,
                          const RunProgress& run) {
  const double total = static_cast<double>(std::max<std::uint64_t>(now.pixels_total, 1));
  const double fraction = static_cast<double>(now.pixels_done) / total;
  const double seconds = now.seconds - since.seconds;
  const double rate = seconds > 0 ? static_cast<double>(now.pixels_done - since.pixels_done) / seconds : 0;
  std::string text = run.total > 1 ? fmt::format(" frame {}/{}", run.over + 1, run.total) : "";
  text += fmt::format(" {:3.0f} %", 100 * fraction);
  if (rate > 0)
    text += fmt::format("  {:.3g} Mpixel/s  {} left", rate / 1e6,
                        duration_text(run.seconds_left(total / rate, (1 - fraction) * total / rate)));
  const double frames = static_cast<double>(std::max<std::size_t>(run.total, 1));
  return bar_line((static_cast<double>(run.over) + fraction) / frames, text, columns);
}

ProgressBar::ProgressBar(bool wanted, const RunProgress& run)
    : shown_(wanted && stderr_is_terminal()), run_(run) {}

ProgressBar::~ProgressBar() { erase(); }

void ProgressBar::update(const RenderProgress& progress) {
  if (!started_) first_ = progress;
  started_ = true;
  const double now = clock_.seconds();
  if (!shown_ || (last_drawn_ >= 0 && now - last_drawn_ < seconds_between_bars)) return;
  last_drawn_ = now;
  drawn_ = true;
  tell(fmt::format("\r{}\033[K", progress_line(progress, first_, terminal_columns(), run_)));
  std::fflush(stderr);
}

void ProgressBar::erase() {
  if (!drawn_) return;
  tell("\r\033[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace sundog
