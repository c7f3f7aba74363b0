// Pictures and figures of a render session on their way to the pages: JPEG while the picture changes, PNG
// when it rests, never more than each page can draw.
#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

#include "app/serve/web_server.h"
#include "render/session/render_session.h"

namespace sundog {

/// The bytes of a picture's message: the length of a JSON header (4 bytes, little-endian), the header, an
/// image file.
std::string picture_message(const Snapshot& now, std::uint64_t version);

class PictureStream {
 public:
  /// `version_of` gives the document's version that a generation draws. Both outlive the stream.
  PictureStream(WebServer& server, RenderSession& session,
                std::function<std::uint64_t(Generation)> version_of);
  ~PictureStream();
  PictureStream(const PictureStream&) = delete;
  PictureStream& operator=(const PictureStream&) = delete;

  /// A page has come: it gets the newest picture.
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
  std::shared_ptr<const std::string> last_;  // picture that was sent
  std::string last_status_;
  std::shared_ptr<const Image> shown_;  // of the last picture
  bool shown_settled_ = false;
  std::uint64_t shown_version_ = 0;
  std::atomic<bool> stop_ = false;
  std::thread thread_;  // last: it uses all others
};

}  // namespace sundog
