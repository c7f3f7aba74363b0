// Renders that mpirun starts as several processes on this machine: the same bits as one process, and what
// comes of ranks that fail, die or stop. Left out where there is no Open MPI.
#include <base/file.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "catch.h"
#include "cli_scene.h"

using namespace sundog;
using nlohmann::json;

namespace {

struct MpiFolder : CliFolder {
  CommandOptions options;
  std::string plain;  // the picture without MPI

  MpiFolder() {
    options.environment = {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                           {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                           {"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                           {"PRTE_MCA_rmaps_default_mapping_policy", ":oversubscribe"},  // Open MPI 5
                           // One machine, perhaps without a network, for which some would wait a second.
                           {"OMPI_MCA_btl", "^tcp,openib,ofi,usnic,uct"},
                           {"OMPI_MCA_pml", "ob1"},
                           {"POCL_DEVICES", "pthread"},
                           {"SUNDOG_SILENCE_LIMIT", "3"}};
    REQUIRE(run_sundog(arguments({"--device", "0:0"}), options).status == 0);
    plain = read_file(*this / "a.pfm");
    std::filesystem::remove(*this / "a.pfm");
  }
  std::vector<std::string> arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"render",  scene,       "-o", file("a.pfm"), "--size",
                                    "160x120", "--samples", "4",  "--stats",     file("s.json")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// `on_rank_1` is a shell command that only rank 1 runs before it becomes sundog.
  CommandResult mpirun(int ranks, std::vector<std::string> of_sundog, const std::string& on_rank_1 = "true;",
                       const std::vector<std::string>& of_mpirun = {}) const {
    std::vector<std::string> all = {"mpirun", "-n", std::to_string(ranks)};
    all.insert(all.end(), of_mpirun.begin(), of_mpirun.end());
    const std::string script =
        "if [ $OMPI_COMM_WORLD_RANK = 1 ]; then " + on_rank_1 + R"( fi; exec "$0" "$@")";
    all.insert(all.end(), {"bash", "-c", script, SUNDOG_BINARY});
    all.insert(all.end(), of_sundog.begin(), of_sundog.end());
    return run_command(all, options);
  }
  json stats() const { return json::parse(read_file(*this / "s.json")); }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The lines that sundog wrote; mpirun has its own to say.
std::vector<std::string> lines_of_sundog(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (text.compare(at, 8, "sundog: ") == 0) lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// Open MPI 5 names a dead rank itself, and ends the job before sundog has missed the rank.
bool named_by_mpirun(const std::string& text) {
  return contains(text, "prterun noticed that process rank 1 ");
}

const std::vector<std::string> halves = {"--device", "0:0/1", "--split", "static"};

}  // namespace

TEST_CASE("mpirun: one, two and three ranks make the bits of one process, each with its device") {
  const MpiFolder folder;
  for (const int ranks : {1, 2, 3}) {
    CAPTURE(ranks);
    const std::string shares = std::string("1,1,1").substr(0, static_cast<std::size_t>(2 * ranks - 1));
    const CommandResult result =
        folder.mpirun(ranks, folder.arguments({"--device", "0:0/1", "--split", shares}));
    CAPTURE(result.err);
    CHECK(result.status == 0);
    CHECK(result.err.empty());
    CHECK(read_file(folder / "a.pfm") == folder.plain);
    std::filesystem::remove(folder / "a.pfm");
    const json devices = folder.stats()["devices"];
    REQUIRE(devices.size() == static_cast<std::size_t>(ranks));
    for (std::size_t rank = 0; rank < devices.size(); ++rank) {
      CHECK(devices[rank]["rank"] == rank);
      CHECK_FALSE(devices[rank]["host"].get<std::string>().empty());
      CHECK(devices[rank]["pixels"] == 160 * 120 / ranks);
      CHECK(devices[rank]["kernels"]["render_whitted"]["launches"] > 0);
    }
  }
}

TEST_CASE(
    "mpirun: a scene from the standard input reaches all ranks; no picture goes to the standard output") {
  MpiFolder folder;
  const auto render = [&](const std::string& out) {
    const std::string line =
        R"(exec mpirun -n 2 "$0" render - -o "$2" --size 160x120 --samples 4 --device 0:0/1 --split 1,1 <"$1")";
    return run_command({"bash", "-c", line, SUNDOG_BINARY, folder.scene, out}, folder.options);
  };
  const CommandResult result = render(folder.file("a.pfm"));
  CAPTURE(result.err);
  CHECK(result.status == 0);
  CHECK((read_file(folder / "a.pfm") == folder.plain));
  folder.options.environment["OMPI_MCA_odls_base_sigkill_timeout"] = "0";
  const CommandResult refused = render("-");
  CHECK(refused.status == 2);
  CHECK(contains(refused.err, "-o -: under mpirun"));
}

TEST_CASE("mpirun: --allow-outside-files holds for all ranks, and without it rank 0 alone refuses") {
  MpiFolder folder;
  folder.write("out/m.obj", "v -2 -1 0\nv 2 -1 0\nv 0 2 0\nf 1 2 3\n");
  json scene = json::parse(small_scene);
  scene["objects"].push_back({{"type", "model"}, {"file", "../out/m.obj"}});
  const std::string inner = folder.write("in/scene.json", scene.dump()).string();
  const auto render = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> all = {"render",   inner,     "-o",      folder.file(out),
                                    "--size",   "160x120", "--stats", folder.file("s.json"),
                                    "--device", "0:0/1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  REQUIRE(run_sundog(render("one.pfm", {"--allow-outside-files"}), folder.options).status == 0);
  CHECK(read_file(folder / "one.pfm") != folder.plain);
  using Words = std::vector<std::string>;
  for (const Words& more : {Words{}, Words{"--isolate"}}) {  // a process more for each rank
    Words allowed = {"--allow-outside-files", "--split", "1,1"};
    allowed.insert(allowed.end(), more.begin(), more.end());
    CAPTURE(more.size());
    const CommandResult both = folder.mpirun(2, render("two.pfm", allowed));
    CAPTURE(both.err);
    CHECK(both.status == 0);
    CHECK(both.err.empty());
    CHECK((read_file(folder / "two.pfm") == read_file(folder / "one.pfm")));
    CHECK(folder.stats()["devices"][1]["pixels"] == 160 * 120 / 2);
  }
  folder.options.environment["OMPI_MCA_odls_base_sigkill_timeout"] = "0";
  const CommandResult refused = folder.mpirun(2, render("three.pfm", {"--split", "1,1"}));
  CAPTURE(refused.err);
  CHECK(refused.status == 3);
  REQUIRE(lines_of_sundog(refused.err).size() == 1);
  CHECK(contains(lines_of_sundog(refused.err)[0], "leads out of the scene's folder"));
}

TEST_CASE("mpirun: without --device the ranks of a machine divide its processor, and take tiles by speed") {
  const MpiFolder folder;
  const CommandResult result = folder.mpirun(2, folder.arguments({"--tile", "16", "-v"}));
  CAPTURE(result.err, result.out);
  CHECK(result.status == 0);
  CHECK(read_file(folder / "a.pfm") == folder.plain);
  const json devices = folder.stats()["devices"];
  unsigned units = 0;
  for (const json& device : devices) units += device["sub_units"].get<unsigned>();
  CHECK((devices.size() == 1 || units == std::thread::hardware_concurrency()));
  CHECK(contains(result.out, "(rank 0 on "));
}

TEST_CASE("mpirun: the frames of an animation are those of one process") {
  const MpiFolder folder;
  json scene = json::parse(small_scene);
  scene["animate"] = json::parse(R"([{"type": "linear", "value": "/camera/position",
    "keys": [{"frame": 0, "value": [0, 1, 5]}, {"frame": 2, "value": [0, 3, 5]}]}])");
  const std::string moving = folder.write("moving.json", scene.dump()).string();
  for (const char* shutter : {"0.5", "0"}) {
    INFO(shutter);
    const auto frames = [&](const std::string& out) {
      std::vector<std::string> all = {"render", moving,     "-o",   folder.file(out), "--device",
                                      "0:0/1",  "--frames", "0..2", "--stats",        folder.file("s.json")};
      all.insert(all.end(),
                 {"--set", std::string("/camera/shutter=") + shutter, "--set", "/camera/shutter_steps=2"});
      return all;
    };
    REQUIRE(run_sundog(frames("one.pfm"), folder.options).status == 0);
    std::vector<std::string> split = frames("two.pfm");
    split.insert(split.end(), {"--split", "1,1"});
    const CommandResult result = folder.mpirun(2, split);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    for (const std::string number : {"_0000.pfm", "_0001.pfm", "_0002.pfm"})
      CHECK(read_file(folder / ("one" + number)) == read_file(folder / ("two" + number)));
  }
  const json last = json::parse(read_file(folder / "s_0002.json"));
  CHECK(last["devices"][1]["share"] == 0.5);
  CHECK(last["devices"][1]["kernels_cached"] == true);
}

TEST_CASE("mpirun: passes, AOVs and rays of pixels are those of one process") {
  const MpiFolder folder;
  const auto render = [&](const std::string& out, const std::string& split) {
    std::vector<std::string> all =
        folder.arguments({"--device", "0:0/1", "--adaptive", "0.02", "--tile", "16"});
    all[3] = folder.file(out);
    for (const char* name : {"rays", "samples", "variance", "normal", "crypto_object"})
      all.insert(all.end(), {"--aov", name});
    if (!split.empty()) all.insert(all.end(), {"--split", split});
    return all;
  };
  REQUIRE(run_sundog(render("one.exr", ""), folder.options).status == 0);
  const json one = folder.stats()["rays"];
  const CommandResult result = folder.mpirun(2, render("two.exr", "1,1"));
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  CHECK((read_file(folder / "one.exr") == read_file(folder / "two.exr")));
  CHECK(folder.stats()["rays"] == one);
  for (const json& device : folder.stats()["devices"]) CHECK(device["pixels"] > 0);
}

TEST_CASE("mpirun: an error is reported in one line, by one rank, with its status") {
  MpiFolder folder;
  folder.options.environment["OMPI_MCA_odls_base_sigkill_timeout"] = "0";  // nothing is to be kept
  struct Case {
    std::vector<std::string> arguments;
    int status;
    const char* says;
  };
  folder.write("bad.json", "{");
  for (const Case& c : {Case{{"render", folder.scene}, 2, "--out"},
                        Case{{"render", folder.file("bad.json"), "-o", folder.file("b.png")}, 3, "bad.json"},
                        Case{folder.arguments({"--device", "nosuch"}), 4, "no such device"}}) {
    const CommandResult result = folder.mpirun(2, c.arguments);
    CAPTURE(result.err);
    CHECK(result.status == c.status);
    REQUIRE(lines_of_sundog(result.err).size() == 1);
    CHECK(contains(lines_of_sundog(result.err)[0], c.says));
  }
}

TEST_CASE("mpirun: a rank without a device, or whose device fails, costs its part, not the frame") {
  const MpiFolder folder;
  struct Case {
    const char *on_rank_1, *says, *more;
  };
  for (const Case& c :
       {Case{"export OCL_ICD_VENDORS=/nowhere;", "warning: rank 1 on ", "-q"},
        Case{"export SUNDOG_FAULTS=build@0:0;", "did not build", "-q"},
        Case{"export SUNDOG_FAULTS=launch=-36@0:0;", "(rank 1 on ", "-q"},
        Case{"export SUNDOG_FAULTS=hang@0:0#2 SUNDOG_LAUNCH_LIMIT=1;", "the driver hangs", "-q"},
        Case{"export SUNDOG_FAULTS=crash@0:0#2;", "was killed by signal 6", "--isolate"}}) {
    CAPTURE(c.on_rank_1);
    std::vector<std::string> arguments = folder.arguments(halves);
    arguments.push_back(c.more);
    const CommandResult result = folder.mpirun(2, arguments, c.on_rank_1);
    CAPTURE(result.err);
    CHECK(result.status == 0);
    CHECK(contains(result.err, c.says));
    CHECK(read_file(folder / "a.pfm") == folder.plain);
    std::filesystem::remove(folder / "a.pfm");
  }
}

TEST_CASE(
    "mpirun: when a rank dies, the checkpoint has the finished part, and the same command continues from "
    "it") {
  const MpiFolder folder;
  // Half of the frame is rank 1's, which dies in it: the frame cannot end before mpirun ends the job.
  std::vector<std::string> arguments = folder.arguments(halves);
  arguments.insert(arguments.end(), {"--resume", folder.file("checkpoint")});
  const CommandResult died = folder.mpirun(2, arguments, "export SUNDOG_FAULTS=crash@0:0#2;");
  CAPTURE(died.err);
  CHECK(died.status != 0);
  if (!named_by_mpirun(died.err)) {
    CHECK(contains(died.err, "sundog: warning: rank 1 on "));
    CHECK(contains(died.err, "it has died or is stopped"));
  }
  CHECK(contains(died.err, "sundog: interrupted: "));
  REQUIRE(std::filesystem::exists(folder / "checkpoint"));
  CHECK(folder.stats()["devices"][0]["pixels"] == 160 * 60);
  const CommandResult resumed = folder.mpirun(2, arguments);
  CAPTURE(resumed.err);
  CHECK(resumed.status == 0);
  CHECK(read_file(folder / "a.pfm") == folder.plain);
  // The missing half alone, of which rank 0 may make a tile too that rank 1 is late with.
  const json devices = folder.stats()["devices"];
  CHECK(devices[0]["pixels"].get<int>() + devices[1]["pixels"].get<int>() == 160 * 60);
  CHECK_FALSE(std::filesystem::exists(folder / "checkpoint"));
}

TEST_CASE("mpirun: a dead rank is named first, then finished work is kept, then the picture is written") {
  const char* crash = "export SUNDOG_FAULTS=crash@0:0#2;";
  struct Case {
    const char* fault;  // of rank 0: what never comes to its end before mpirun ends the job
    bool kept;
  };
  for (const Case& c : {Case{"stall@a.pfm", true}, Case{"stall@a.pfm.checkpoint", false}}) {
    CAPTURE(c.fault);
    MpiFolder folder;
    folder.options.environment["SUNDOG_FAULTS"] = c.fault;
    const CommandResult died = folder.mpirun(2, folder.arguments(halves), crash);
    CAPTURE(died.err);
    CHECK(died.status != 0);
    const std::string checkpoint = folder.file("a.pfm.checkpoint");
    std::vector<std::string> lines = lines_of_sundog(died.err);
    if (!named_by_mpirun(died.err)) {
      REQUIRE_FALSE(lines.empty());
      CHECK(lines[0].starts_with("sundog: warning: rank 1 on "));
      CHECK(lines[0].ends_with("finished work is kept in " + checkpoint));
      lines.erase(lines.begin());
    }
    CHECK_FALSE(std::filesystem::exists(folder / "a.pfm"));
    CHECK(std::filesystem::exists(checkpoint) == c.kept);
    REQUIRE(lines.size() == (c.kept ? 1 : 0));
    if (!c.kept) continue;
    CHECK(contains(lines[0], "sundog: interrupted: "));
    CHECK(contains(lines[0], "--resume " + checkpoint));
    folder.options.environment.erase("SUNDOG_FAULTS");
    REQUIRE(
        run_sundog(folder.arguments({"--device", "0:0", "--resume", checkpoint}), folder.options).status ==
        0);
    CHECK(folder.stats()["devices"][0]["pixels"] < 160 * 120);
    CHECK(read_file(folder / "a.pfm") == folder.plain);
  }
}

TEST_CASE("mpirun: a rank that stops, or that dies with --enable-recovery, costs time alone") {
  const MpiFolder folder;
  struct Case {
    const char *on_rank_1, *of_mpirun;
  };
  for (const Case& c : {Case{"export SUNDOG_FAULTS=crash@0:0#2;", "--enable-recovery"},
                        Case{"export SUNDOG_FAULTS=stop@0:0#2;", "--disable-recovery"}}) {
    CAPTURE(c.on_rank_1);
    const CommandResult result = folder.mpirun(2, folder.arguments(halves), c.on_rank_1, {c.of_mpirun});
    CAPTURE(result.err);
    CHECK(result.status == 0);
    const std::vector<std::string> lines = lines_of_sundog(result.err);
    REQUIRE(lines.size() == 1);
    CHECK(lines[0].starts_with("sundog: warning: rank 1 on "));
    CHECK(lines[0].ends_with("it has died or is stopped; the device was retired"));
    CHECK(read_file(folder / "a.pfm") == folder.plain);
    std::filesystem::remove(folder / "a.pfm");
  }
}

TEST_CASE("mpirun: when rank 0 is killed, the checkpoint of a moment ago is there") {
  MpiFolder folder;
  folder.options.environment["SUNDOG_CHECKPOINT_EVERY"] = "0.1";
  folder.options.environment["SUNDOG_SILENCE_LIMIT"] = "60";
  const std::string checkpoint = folder.file("checkpoint");
  std::vector<std::string> arguments = folder.arguments(halves);
  arguments.insert(arguments.end(), {"--resume", checkpoint});
  // Rank 1 stops in its half of the frame; rank 0 is killed once something is kept.
  const CommandResult killed = folder.mpirun(2, arguments,
                                             "export SUNDOG_FAULTS=stop@0:0#2; (until [ -s '" + checkpoint +
                                                 "' ]; do sleep 0.1; done; kill -9 $(pgrep -P $PPID sundog | "
                                                 "grep -vx $$)) </dev/null >/dev/null 2>&1 &");
  CAPTURE(killed.err);
  CHECK(killed.status != 0);
  REQUIRE(std::filesystem::exists(checkpoint));
  const CommandResult resumed =
      run_sundog(folder.arguments({"--device", "0:0", "--resume", checkpoint}), folder.options);
  CHECK(resumed.status == 0);
  CHECK(folder.stats()["devices"][0]["pixels"] < 160 * 120);
  CHECK(read_file(folder / "a.pfm") == folder.plain);
}
