// A thread encodes each new picture once and sends it to all pages.
#include "app/serve/picture_stream.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/serve/messages.h"
#include "base/clock.h"
#include "base/json_text.h"
#include "base/pixels/preview.h"
#include "base/pixels/quick_png.h"

namespace sundog {
namespace {

constexpr double status_seconds = 0.1;    // interval between status messages
constexpr double picture_seconds = 0.03;  // interval between pictures
constexpr double idle_seconds = 0.25;     // longest wait for a change
constexpr int quality_full = 90, quality_coarse = 82;

}  // namespace

std::string picture_message(const Snapshot& now, std::uint64_t version) {
  const bool settled = now.state == SessionState::settled && now.shown == now.generation;
  const Image& image = *now.picture;
  const nlohmann::json header = {{"generation", now.shown}, {"version", version},    {"width", image.width},
                                 {"height", image.height},  {"settled", settled},    {"block", now.block},
                                 {"samples", now.samples},  {"seconds", now.seconds}};
  const std::string text = json_text(header);
  std::string bytes;
  for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(text.size() >> shift & 255);
  bytes += text;
  bytes += settled ? encode_quick_png(image)  // same pixels as the PNG of `sundog render`
                   : encode_preview(image, now.block > 1 ? quality_coarse : quality_full);
  return bytes;
}

PictureStream::PictureStream(WebServer& server, RenderSession& session,
                             std::function<std::uint64_t(Generation)> version_of)
    : server_(server), session_(session), version_of_(std::move(version_of)), thread_([this] { run(); }) {}

PictureStream::~PictureStream() {
  stop_ = true;
  thread_.join();
}

void PictureStream::greet(ClientId client) {
  const std::lock_guard lock(mutex_);
  if (!last_status_.empty()) server_.send(client, last_status_);
  if (last_) server_.show(client, last_);
}

void PictureStream::tell_status(const Snapshot& now) {
  std::string text = message_text(status_message(now));
  const std::lock_guard lock(mutex_);
  if (text == last_status_) return;
  last_status_ = std::move(text);
  server_.send_to_all(last_status_);
}

/// Sends the picture if it is new. Returns false if no page can take it yet.
bool PictureStream::send_picture() {
  if (server_.ready_clients() == 0) return false;
  const Snapshot now = session_.snapshot();
  if (!now.picture) return true;
  const std::uint64_t version = version_of_(now.shown);
  const bool settled = now.state == SessionState::settled && now.shown == now.generation;
  if (now.picture == shown_ && settled == shown_settled_ && version == shown_version_) return true;
  auto bytes = std::make_shared<const std::string>(picture_message(now, version));
  shown_ = now.picture, shown_settled_ = settled, shown_version_ = version;
  const std::lock_guard lock(mutex_);
  last_ = bytes;
  server_.show_to_all(std::move(bytes));
  return true;
}

/// send_picture(); if it throws (encoder, out of memory), sends the reason as a status instead.
bool PictureStream::try_picture(Snapshot now) {
  try {
    return send_picture();
  } catch (const std::exception& error) {
    now.state = SessionState::failed;
    now.error = fmt::format("the picture cannot be shown: {}", error.what());
    tell_status(now);
    return true;
  }
}

/// Streams until stopped; starts again after an exception, such as lack of memory for a message.
void PictureStream::run() {
  while (!stop_) {
    try {
      stream();
    } catch (const std::exception& error) {
      fmt::print(stderr, "sundog: serve: {}\n", error.what());
      std::this_thread::sleep_for(std::chrono::duration<double>(idle_seconds));
    }
  }
}

void PictureStream::stream() {
  std::uint64_t revision = 0;
  double status_at = -1, picture_at = -1;
  bool all_sent = true, told = true;
  const Stopwatch clock;
  while (!stop_) {
    const bool waits = server_.clients() > 0 && !(all_sent && told);
    const bool changed = session_.wait_for_change(revision, waits ? picture_seconds : idle_seconds);
    if (!changed && all_sent && told) continue;
    const Snapshot now = session_.snapshot(false);
    revision = now.revision;
    const bool ended = now.state >= SessionState::settled;
    told = ended || clock.seconds() - status_at >= status_seconds;
    if (told) tell_status(now), status_at = clock.seconds();
    all_sent = ended || clock.seconds() - picture_at >= picture_seconds;
    if (all_sent) {
      all_sent = try_picture(now);
      picture_at = clock.seconds();
    }
    // Changes may arrive faster than pictures are sent, so leave the remaining time to the renderer.
    const double spare = picture_seconds - (clock.seconds() - picture_at);
    if (!ended && spare > 0)
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(spare, 0.01)));
  }
}

}  // namespace sundog
