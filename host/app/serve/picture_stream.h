// Sends pictures and statistics of a render session to the pages: JPEG while the picture changes, PNG when it
// is settled, never more than each page can draw.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

#include "app/serve/web_server.h"
#include "render/session/render_session.h"

namespace sundog {

/// A picture's message: the length of a JSON header (4 bytes, little-endian), the header, and an image file.
std::string picture_message(const Snapshot& now, std::uint64_t version);

class PictureStream {
 public:
  /// `version_of` returns the document's version that a generation draws. References outlive the stream.
  PictureStream(WebServer& server, RenderSession& session,
                std::function<std::uint64_t(Generation)> version_of);
  ~PictureStream();
  PictureStream(const PictureStream&) = delete;
  PictureStream& operator=(const PictureStream&) = delete;

  /// Sends the newest status and picture to a new page.
  void greet(ClientId client);

 private:
  void run();
  void stream();
  void tell_status(const Snapshot& now);
  bool send_picture();
  bool try_picture(Snapshot now);

  WebServer& server_;
  RenderSession& session_;
  std::function<std::uint64_t(Generation)> version_of_;
  std::mutex mutex_;
  std::shared_ptr<const std::string> last_;  // message of the last picture
  std::string last_status_;
  std::shared_ptr<const Image> shown_;  // the last picture
  bool shown_settled_ = false;
  std::uint64_t shown_version_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;  // last, because it uses all other members
};

}  // namespace sundog
