// Handles pages' messages, with a function for each "do". A change restarts drawing and goes to all pages.
#include "app/serve/studio.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/options/light_balance.h"
#include "app/options/option_values.h"
#include "app/serve/folder.h"
#include "app/serve/messages.h"
#include "base/error.h"
#include "base/limits.h"
#include "models/model.h"
#include "scene/json/parse.h"
#include "scene/light_groups.h"

namespace sundog {
using nlohmann::json;

namespace {

/// Replaces the file's name in errors about JSON that a page has sent.
constexpr const char* page_file = "the page";

std::string text_of(const json& message, const char* key) {
  const auto found = message.find(key);
  return found != message.end() && found->is_string() ? found->get<std::string>() : "";
}

std::vector<std::string> texts_of(const json& message, const char* key) {
  std::vector<std::string> texts;
  if (const auto list = message.find(key); list != message.end() && list->is_array())
    for (const json& text : *list)
      if (text.is_string()) texts.push_back(text);
  return texts;
}

/// A pixel coordinate in a message. Throws UsageError.
int pixel_of(const json& message, const char* key) {
  const auto found = message.find(key);
  const double place = found != message.end() && found->is_number() ? found->get<double>() : std::nan("");
  if (!(std::abs(place) < most_edge))
    throw UsageError(fmt::format("wanted a pixel, \"x\" and \"y\" below {}", most_edge));
  return static_cast<int>(place);
}

std::vector<Change> changes_of(const json& message) {
  constexpr std::size_t most_changes = 200;
  const auto list = message.find("changes");
  if (list == message.end() || !list->is_array() || list->empty() || list->size() > most_changes)
    throw UsageError("wanted 1 to 200 changes");
  std::vector<Change> changes;
  for (const json& one : *list) {
    if (!one.is_object() || text_of(one, "at").empty())
      throw UsageError("wanted changes with \"at\" and \"value\"");
    Change change{text_of(one, "at"), {}};
    if (one.contains("value")) change.value = one["value"];
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace

Studio::Studio(WebServer& server, StudioSetup setup, SceneDocument document)
    : server_(server),
      setup_(std::move(setup)),
      document_(std::move(document)),
      session_(setup_.picked),
      stream_(server, session_, [this](Generation generation) { return version_of(generation); }) {
  begin_drawing();
}

/// Stops the threads' work before the members that it uses are destroyed.
Studio::~Studio() {
  edits_.stop();
  uploads_.forget_all();  // before anything waits for a driver
  session_.cancel();
  asks_.stop();
}

WebHandlers Studio::handlers() {
  WebHandlers all;
  all.message = [this](ClientId client, std::string text) {
    const std::size_t bytes = text.size();
    if (!edits_.post([this, client, text = std::move(text)] { take_message(client, text); }, bytes))
      server_.send(client, message_text({{"is", "refused"}, {"reason", "too much is waiting"}}));
  };
  all.opened = [this](ClientId client) {
    edits_.post([this, client] {
      server_.send(client, message_text({{"is", "welcome"},
                                         {"client", client},
                                         {"version", SUNDOG_VERSION},
                                         {"models", SUNDOG_MODEL_EXTENSIONS},
                                         {"most_upload_bytes", server_.limits().body_bytes}}));
      server_.send(client, message_text(devices_message(setup_.devices, setup_.picked)));
      server_.send(client, page_text(scene_message(document_)));
      server_.send(client, message_text({{"is", "balance"}, {"client", 0}, {"lights", lights_}}));
      stream_.greet(client);
    });
  };
  all.answer = [this](WebRequest request, const std::function<void(WebAnswer)>& reply) {
    const bool slow = request.path == "/api/picture";
    const bool taken =
        (slow ? asks_ : edits_).post([this, request = std::move(request), reply] { reply(answer(request)); });
    if (!taken) reply({503, "text/plain; charset=utf-8", "too much is waiting\n", ""});
  };
  return all;
}

std::uint64_t Studio::version_of(Generation generation) {
  const std::lock_guard lock(mutex_);
  const auto found = versions_.find(generation);
  return found == versions_.end() ? 0 : found->second;
}

void Studio::begin_drawing() {
  const std::lock_guard lock(mutex_);
  drawn_ = document_.scene();
  show_balance();
  const Generation generation = session_.start(drawn_, settings_);
  versions_[generation] = document_.version();
  constexpr std::size_t most_versions = 1000;
  if (versions_.size() > most_versions) versions_.erase(versions_.begin());
}

/// Applies `lights_` to the session. The caller holds the mutex.
void Studio::show_balance() {
  const std::vector<std::string> groups = light_groups(*drawn_);
  std::vector<glm::vec3> factors;
  for (const std::string& typed : lights_) {
    const auto [name, factor] = parse_light(typed);
    const std::size_t number = number_of_group(groups, name);
    if (number == 0 && name != "rest") continue;  // an edit has removed the group
    factors.resize(groups.size() + 1, glm::vec3(1));
    factors[number] = factor;
  }
  session_.set_balance(std::move(factors));
}

std::string Studio::page_text(const json& message) const {
  return uploads_.without_folder(message_text(message));
}

void Studio::tell_scene() { server_.send_to_all(page_text(scene_message(document_))); }

void Studio::refuse(ClientId client, const json& message, const std::string& place,
                    const std::string& reason) {
  json answer = {{"is", "refused"}, {"at", place}, {"reason", reason}};
  if (message.is_object() && message.contains("id")) answer["id"] = message["id"];
  server_.send(client, page_text(answer));
}

void Studio::take_message(ClientId client, const std::string& text) {
  json message;
  try {
    message = parse_json(text, page_file);
    if (!message.is_object()) throw UsageError("wanted an object");
    dispatch(client, message);
  } catch (const SceneError& error) {
    refuse(client, message, error.place, error.reason);
  } catch (const BuildError& error) {
    refuse(client, message, "", std::string(error.what()) + "\n" + error.log);
  } catch (const std::exception& error) {
    refuse(client, message, "", error.what());
  }
}

void Studio::dispatch(ClientId client, const json& message) {
  const std::string what = text_of(message, "do");
  if (what == "edit") return edit(client, message);
  if (what == "undo" || what == "redo") return step(client, message, what == "undo");
  if (what == "pick") return pick(client, message);
  if (what == "devices") return use_devices(message);
  if (what == "options") return set_options(message);
  if (what == "balance") return balance(client, message);
  if (what == "scene") return server_.send(client, page_text(scene_message(document_)));
  if (what == "stop") return session_.cancel();
  if (what == "draw") return begin_drawing();
  if (what == "open") {
    try {
      document_.open(file_below(setup_.folder, text_of(message, "file")));
    } catch (const SceneError& error) {
      throw UsageError(error.what());  // its place is not one of the scene on the page
    }
    begin_drawing();
    return tell_scene();
  }
  throw UsageError(fmt::format("\"{}\" is nothing that this server does", what));
}

void Studio::edit(ClientId client, const json& message) {
  const std::vector<Change> changes = changes_of(message);
  std::string gesture = text_of(message, "gesture");
  if (!gesture.empty()) gesture = fmt::format("{}/{}", client, gesture);  // pages number their gestures alike
  document_.apply(changes, gesture);
  begin_drawing();
  server_.send_to_all(page_text({{"is", "changed"},
                                 {"version", document_.version()},
                                 {"client", client},
                                 {"id", message.value("id", json(nullptr))},
                                 {"changes", message["changes"]},
                                 {"can_undo", document_.can_undo()},
                                 {"can_redo", document_.can_redo()},
                                 {"resolved", resolved_json(*document_.scene())}}));
}

/// Sends the scene to all pages; only to the page that asked if there was nothing to undo or redo.
void Studio::step(ClientId client, const json& message, bool back) {
  const bool changed = back ? document_.undo() : document_.redo();
  json scene = scene_message(document_);
  scene["client"] = client;
  scene["id"] = message.value("id", json(nullptr));
  if (!changed) return server_.send(client, page_text(scene));
  begin_drawing();
  server_.send_to_all(page_text(scene));
}

void Studio::use_devices(const json& message) {
  const std::vector<std::string> specs = texts_of(message, "specs");
  if (specs.empty()) throw UsageError("at least one device has to draw");
  std::vector<DeviceInfo> picked = select_devices(setup_.devices, specs);
  session_.use_devices(picked);
  setup_.picked = std::move(picked);
  begin_drawing();
  server_.send_to_all(message_text(devices_message(setup_.devices, setup_.picked)));
}

void Studio::set_options(const json& message) {
  SessionSettings settings = settings_;
  if (const std::string split = text_of(message, "split"); !split.empty()) {
    settings.split = parse_split(split);
    if (!settings.split.shares.empty() && settings.split.shares.size() != setup_.picked.size())
      throw UsageError(
          fmt::format("split {}: wanted a share for each of {} devices", split, setup_.picked.size()));
    split_ = split;
  }
  if (const std::string group = text_of(message, "work_group"); !group.empty()) {
    settings.work_group = parse_work_group(group);
    work_group_ = group;
  }
  if (const auto coarse = message.find("coarse"); coarse != message.end() && coarse->is_boolean())
    settings.coarse = *coarse;
  settings_ = settings;
  begin_drawing();
  server_.send_to_all(message_text(
      {{"is", "options"}, {"split", split_}, {"work_group", work_group_}, {"coarse", settings_.coarse}}));
}

/// Sets the balance of light groups. The first time, draws the picture again with separate groups; later, it
/// is only developed again.
void Studio::balance(ClientId client, const json& message) {
  std::vector<std::string> lights = texts_of(message, "lights");
  if (lights.size() > most_light_groups + 1) lights.resize(most_light_groups + 1);
  for (const std::string& light : lights) parse_light(light);
  {
    const std::lock_guard lock(mutex_);
    lights_ = lights;
    show_balance();
  }
  if (!std::exchange(settings_.light_groups, true)) begin_drawing();
  server_.send_to_all(message_text({{"is", "balance"}, {"client", client}, {"lights", lights}}));
}

void Studio::pick(ClientId client, const json& message) {
  const int x = pixel_of(message, "x"), y = pixel_of(message, "y");
  const json id = message.value("id", json(nullptr));
  const bool taken = asks_.post([this, client, x, y, id] {
    json answer = {{"is", "picked"}, {"object", nullptr}};
    try {
      if (const std::optional<Picked> picked = session_.pick(x, y)) answer = picked_message(*picked);
    } catch (const std::exception& error) {
      answer["error"] = error.what();
    }
    answer["id"] = id;
    server_.send(client, message_text(answer));
  });
  if (!taken) throw UsageError("too much is waiting");
}

}  // namespace sundog
