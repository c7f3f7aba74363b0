// Studio connects the viewer's pages to the renderer: one scene that all pages see and change, and one render
// session. One thread handles the pages' messages in order; another does work that waits for a device or
// encodes a file.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/serve/folder.h"
#include "app/serve/picture_stream.h"
#include "app/serve/scene_document.h"
#include "app/serve/web_server.h"
#include "app/serve/work_queue.h"
#include "render/session/render_session.h"

namespace sundog {

struct StudioSetup {
  std::filesystem::path folder;  // scenes below it may be opened
  std::vector<DeviceInfo> devices, picked;
};

class Studio {
 public:
  /// Starts to draw the scene of `document`.
  Studio(WebServer& server, StudioSetup setup, SceneDocument document);
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  WebHandlers handlers();

 private:
  void begin_drawing();
  void take_message(ClientId client, const std::string& text);
  void dispatch(ClientId client, const nlohmann::json& message);
  void edit(ClientId client, const nlohmann::json& message);
  void step(ClientId client, const nlohmann::json& message, bool back);
  void use_devices(const nlohmann::json& message);
  void set_options(const nlohmann::json& message);
  void balance(ClientId client, const nlohmann::json& message);
  void show_balance();
  void pick(ClientId client, const nlohmann::json& message);
  /// message_text() for messages that may name files; removes the folders of uploaded files.
  std::string page_text(const nlohmann::json& message) const;
  void tell_scene();
  void refuse(ClientId client, const nlohmann::json& message, const std::string& place,
              const std::string& reason);
  WebAnswer answer(const WebRequest& request);  // on the first thread, except for pictures
  WebAnswer open_upload(const WebRequest& request);
  void open_model(const std::string& name, const std::string& bytes);
  WebAnswer picture(const std::string& format);  // on the second thread
  std::uint64_t version_of(Generation generation);
  std::string command_line() const;

  WebServer& server_;
  StudioSetup setup_;
  SceneDocument document_;
  Uploads uploads_;
  RenderSession session_;
  SessionSettings settings_;
  std::vector<std::string> lights_;  // the balance of light groups, as for `sundog mix --light`
  std::string split_ = "dynamic", work_group_ = "auto";
  std::mutex mutex_;  // guards versions_ and drawn_, which the threads share
  std::map<Generation, std::uint64_t> versions_;
  std::shared_ptr<const SceneDescription> drawn_;
  PictureStream stream_;
  WorkQueue edits_, asks_;  // last, because their threads use all other members
};

}  // namespace sundog
