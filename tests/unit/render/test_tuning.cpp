// Tuning results as JSON: what is written is read again, and files of earlier versions too.
#include <memory>
#include <nlohmann/json.hpp>

#include "base/environment.h"
#include "base/error.h"
#include "catch.h"
#include "render/device/tuning.h"
#include "scene/json/value.h"
#include "temporary_folder.h"

using namespace sundog;
using nlohmann::json;

namespace {

TuningFile read_again(const json& written) {
  const JsonContext context{};
  return read_tuning(JsonValue(written, context));
}

}  // namespace

TEST_CASE("a tuning's options are written, read and shown; without them a file is as before") {
  TuningEntry entry;
  entry.scene_class = "meshes+compact+rays";
  entry.scene = "ice";
  entry.tuning.work_group = {WorkGroup::Kind::fixed, 64, 1};
  TuningFile file{"P", "D", "1", "k", 0, {entry}};
  CHECK_FALSE(to_json(file).at("entries")[0].contains("options"));
  CHECK(read_again(to_json(file)).entries.at(0).tuning == entry.tuning);
  for (const char* options : {"-DNODE_LOOP=2", "!-DDEVICE_INLINES_ALL -cl-nv-maxrregcount=96",
                              "-cl-intel-256-GRF-per-thread !-DDEVICE_WAVES"}) {
    file.entries[0].tuning.options = options;
    const TuningFile again = read_again(to_json(file));
    CHECK(again.entries.at(0).tuning == file.entries[0].tuning);
    CHECK(tuning_text(again.entries[0].tuning) == std::string("work-group 64, compiled with ") + options);
  }
}

TEST_CASE("the text of a tuning says which of its work-groups is for first surfaces") {
  Tuning tuning;
  tuning.work_group = {WorkGroup::Kind::fixed, 64, 1};
  tuning.surfaces_group = {WorkGroup::Kind::fixed, 8, 4};
  CHECK(tuning_text(tuning) == "work-group 64, work-group 8x4 for first surfaces");
}

TEST_CASE("a tuning file has no options that no tuning tries") {
  TuningFile file{"P", "D", "1", "k", 0, {TuningEntry{"render_whitted", "solids+paths", "s", {}}}};
  const auto read_with = [&](const char* options) {
    file.entries[0].tuning.options = options;
    return read_again(to_json(file));
  };
  CHECK(read_with("-DNODE_LOOP=1").entries.size() == 1);
  for (const char* options : {"-cl-fast-relaxed-math", "-DTILE_W=4", "-DNODE_LOOP=7"})
    CHECK_THROWS_AS(read_with(options), SceneError);
}

TEST_CASE("scenes traced by paths have their own tuning, or Whitted's without its options") {
  const TemporaryFolder folder;
  HostEnvironment environment;
  environment.cache = folder.path();
  DeviceInfo device;
  device.platform_name = device.name = device.driver = "some";
  device.environment = std::make_shared<const HostEnvironment>(environment);
  CompiledScene whitted, path;
  path.integrator = "path";
  TuningEntry entry{"render_whitted", scene_class(whitted), "s", {}};
  entry.tuning.launch_ms = 25;
  entry.tuning.options = "-DNODE_LOOP=1";
  keep_tuning(device, entry);
  CHECK(saved_tuning(device, whitted) == entry.tuning);
  Tuning others = entry.tuning;
  others.options.clear();
  CHECK(saved_tuning(device, path) == others);
  entry.scene_class = scene_class(path);
  entry.tuning.options = "-DNODE_LOOP=2";
  keep_tuning(device, entry);
  CHECK(saved_tuning(device, path).options == "-DNODE_LOOP=2");
  CHECK(saved_tuning(device, whitted).options == "-DNODE_LOOP=1");
}
