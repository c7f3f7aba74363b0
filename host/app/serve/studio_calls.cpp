// Answers the pages' HTTP calls: the schema and lists for their panels, downloads, and uploads of scenes.
// Each call has the token in its header; only POST changes state.
#include <fmt/format.h>

#include "app/commands/formulas_command.h"
#include "app/options/option_values.h"
#include "app/serve/folder.h"
#include "app/serve/messages.h"
#include "app/serve/page_files.h"
#include "app/serve/studio.h"
#include "base/error.h"
#include "base/image_io.h"
#include "base/json_text.h"
#include "models/model.h"
#include "scene/json/parse.h"
#include "scene/shot.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr const char* json_type = "application/json; charset=utf-8";

WebAnswer plain(int status, std::string text) {
  return {status, "text/plain; charset=utf-8", std::move(text) + "\n", ""};
}

WebAnswer json_answer(const json& value) { return {200, json_type, message_text(value), ""}; }

/// The image with only its first `channels` channels, as `sundog render` would write it.
Image with_channels(const Image& image, int channels) {
  if (image.channels <= channels) return image;
  Image out(image.width, image.height, channels);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) std::copy_n(image.pixel(x, y), channels, out.pixel(x, y));
  return out;
}

}  // namespace

WebAnswer Studio::answer(const WebRequest& request) {
  try {
    if (!request.path.starts_with("/api/")) return page_answer(request.path);
    const std::string call = request.method + " " + request.path.substr(5);
    if (call == "GET schema") return {200, json_type, scene_schema(), ""};
    if (call == "GET formulas") return {200, json_type, formulas_json(), ""};
    if (call == "GET files") return json_answer(list_scenes(setup_.folder));
    if (call == "GET command") return plain(200, command_line());
    if (call == "GET scene")
      return {200, json_type, json_text(document_.now(), 2) + "\n",
              document_.file().stem().string() + ".json"};
    if (call == "GET picture") return picture(query_value(request.query, "format"));
    if (call == "POST scene") return open_upload(request);
    return plain(404, "there is nothing here");
  } catch (const SceneError& error) {
    return plain(422, error.what());
  } catch (const UsageError& error) {
    return plain(422, error.what());
  } catch (const std::exception& error) {
    return plain(500, error.what());
  }
}

/// Opens a model that was dropped on the page, alone in its folder: files that it names are missing.
void Studio::open_model(const std::string& name, const std::string& bytes) {
  try {
    document_.open(uploads_.keep(name, bytes));
  } catch (const SceneError& error) {
    const std::string reason = uploads_.without_folder(error.reason);
    uploads_.forget_newest();
    throw UsageError(fmt::format("{}: {}{}{}", name, error.place, error.place.empty() ? "" : ": ", reason));
  } catch (const std::exception&) {
    uploads_.forget_newest();
    throw;
  }
  uploads_.forget_others();
}

/// Opens a scene or model that was dropped on the page, or a scene from a link. File names in a scene are
/// relative to the previous scene's folder.
WebAnswer Studio::open_upload(const WebRequest& request) {
  const std::string name = safe_file_name(query_value(request.query, "name"));
  if (is_model_file(name)) {
    open_model(name, request.body);
  } else {
    check_document_size(request.body.size(), name);  // its values would take many times as much memory
    document_.replace(parse_json(request.body, name), document_.file().parent_path() / name);
  }
  begin_drawing();
  tell_scene();
  return plain(200, "opened");
}

WebAnswer Studio::picture(const std::string& format) {
  if (format != "png" && format != "exr") return plain(400, "wanted format=png or format=exr");
  std::unique_lock lock(mutex_);
  const Snapshot now = session_.snapshot();
  const auto scene = drawn_;
  lock.unlock();
  if (now.state != SessionState::settled || !now.picture)
    return plain(409, "the picture is not finished yet");
  const std::string name = "picture." + format;
  const ImageSettings& settings = scene->image;
  const Image image = shown_in(name, with_channels(*now.picture, image_channels(name, settings.transparent)),
                               settings.tone_map);
  return {200, format == "png" ? "image/png" : "image/x-exr",
          encode_image(image, name, {}, {.shot = shot_of(*scene)}), name};
}

/// The command line that renders this picture. Names a scene that is in no file as the page would save it,
/// and an uploaded model without its folder, which is removed with the server.
std::string Studio::command_line() const {
  const fs::path file = document_.file();
  std::error_code ignored;
  std::string text = "sundog render ";
  const auto settings = settings_between(document_.opened(), document_.now(), file);
  if (!settings || !document_.is_file() || !fs::exists(file, ignored))
    text += shell_word(file.stem().string() + ".json");
  else
    text += shell_word((uploads_.hold(file) ? file.filename() : file).string());
  text += lights_.empty() ? " -o picture.png" : " -o picture.exr --aov light_groups";
  for (const DeviceInfo& device : setup_.picked) text += " --device " + shell_word(device.spec());
  if (split_ != "dynamic") text += " --split " + shell_word(split_);
  if (work_group_ != "auto") text += " --work-group " + shell_word(work_group_);
  if (settings)
    for (const std::string& setting : *settings) text += " --set " + shell_word(setting);
  if (!lights_.empty()) {
    text += " && sundog mix picture.exr -o picture.png";
    for (const std::string& light : lights_) text += " --light " + shell_word(light);
  }
  return text;
}

}  // namespace sundog
