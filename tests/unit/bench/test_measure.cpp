// Ways of doing work, timed in turn: what counts, what is left out, and what fails. All times are made up.
#include "bench/runs/measure.h"

#include <dlfcn.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "base/error.h"
#include "bench/report/report.h"
#include "catch.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

/// A machine of two cores: a run takes what it is said to take, and others what they have of the cores.
struct Machine {
  ProcessorTimes now{0, 0, 0};
  double others = 0;  // cores

  void pass(double seconds, double cores) {
    now.wall += seconds;
    now.own += cores * seconds;
    now.all += (cores + others) * seconds;
  }
  MeasureOptions options(int repeat) {
    MeasureOptions options;
    options.repeat = repeat;
    options.load = std::make_shared<LoadMeter>(2, [this] { return now; });
    return options;
  }
};

/// A way that takes a second on one core.
Subject second(Machine& machine, const std::string& name, std::function<void(int run)> before = {}) {
  Subject subject;
  subject.name = name;
  subject.run = [&machine, before, runs = std::make_shared<int>(0)] {
    if (before) before((*runs)++);
    machine.pass(1, 1);
    return 1.0;
  };
  return subject;
}

}  // namespace

TEST_CASE("each way is warmed up once and has the runs that were asked for") {
  Machine machine;
  int prepared = 0;
  std::vector<Subject> subjects{second(machine, "a"), second(machine, "b")};
  subjects[0].prepare = [&] { ++prepared; };
  int told = 0;
  MeasureOptions options = machine.options(5);
  options.on_runs = [&] { ++told; };
  measure(subjects, options);
  CHECK(prepared == 1);
  CHECK(told >= 12);
  for (const Subject& subject : subjects) {
    CHECK(subject.runs.size() == 5);
    CHECK(subject.seconds().median == 1);
    CHECK(subject.cores().median == 1);
    CHECK_FALSE(subject.noisy);
  }
  CHECK(machine.now.wall == 12);
}

TEST_CASE("a wrong result in any run takes the way out, and the others are measured") {
  for (const int bad : {0, 1, 4}) {
    CAPTURE(bad);
    Machine machine;
    std::vector<Subject> subjects{second(machine, "a"), second(machine, "b")};
    int checks = 0;
    subjects[1].check = [&]() -> std::string { return checks++ == bad ? "its image differs" : ""; };
    measure(subjects, machine.options(5));
    CHECK(subjects[0].is_good());
    CHECK_FALSE(subjects[1].is_good());
    CHECK_THAT(subjects[1].problem, ContainsSubstring("its image differs"));
    CHECK(checks == bad + 1);
    if (bad > 0) CHECK(subjects[1].runs.back().left_out == "wrong result");
  }
}

TEST_CASE("a device that fails in a timed run leaves a row with its runs and its error") {
  Machine machine;
  std::vector<Subject> subjects{second(machine, "a"), second(machine, "b", [](int run) {
                                  if (run == 3) throw DeviceError("out of resources");
                                })};
  measure(subjects, machine.options(5));
  CHECK(subjects[0].runs.size() == 5);
  CHECK(subjects[1].runs.size() == 2);
  CHECK(subjects[1].problem == "run 3: out of resources");
  Report report;
  report.ways = {subjects[0], subjects[1]};
  const nlohmann::json ways = report_json(report).at("ways");
  CHECK(ways[1].at("problem") == "run 3: out of resources");
  CHECK(ways[1].at("runs").size() == 2);
  CHECK(ways[0].at("runs")[0].at("seconds") == 1);
}

TEST_CASE("runs beside which other programs work are left out and measured again") {
  Machine machine;
  const auto burst = [&](int run) { machine.others = run == 2 || run == 3 ? 0.8 : 0; };
  std::vector<Subject> subjects{second(machine, "a", burst)};
  measure(subjects, machine.options(5));
  CHECK(subjects[0].runs.size() == 7);
  CHECK(subjects[0].seconds().runs.size() == 5);
  CHECK(subjects[0].runs[1].left_out == "busy");
  CHECK(subjects[0].runs[1].others > 0.5);
  CHECK_FALSE(subjects[0].noisy);
}

TEST_CASE("where quiet runs cannot be had the least disturbed count, and the way is noisy") {
  Machine machine;
  const auto always = [&](int run) { machine.others = run % 2 ? 0.5 : 1; };
  std::vector<Subject> subjects{second(machine, "a", always)};
  measure(subjects, machine.options(3));
  CHECK(subjects[0].noisy);
  CHECK(subjects[0].runs.size() == 6);
  CHECK(subjects[0].seconds().runs.size() == 3);
  CHECK(subjects[0].others().max < 0.9);
  // Which runs they were can be seen in the report, and in one that continues it.
  Report report;
  report.ways = {subjects[0]};
  const nlohmann::json runs = report_json(report).at("ways")[0].at("runs");
  CHECK(std::ranges::count(runs, "busy", [](const auto& run) { return run.at("disturbed"); }) == 3);
  CHECK(std::ranges::count(runs, "busy", [](const auto& run) { return run.at("left_out"); }) == 3);
  for (const nlohmann::json& run : runs) CHECK(run.at("disturbed").is_null() != run.at("left_out").is_null());
}

TEST_CASE("a cold way has no warm-up: its first run counts, with the figures of each run") {
  Machine machine;
  std::vector<Subject> subjects{second(machine, "a"), second(machine, "b")};
  subjects[0].cold = true;
  MeasureOptions options = machine.options(1);
  measure(subjects, options);
  CHECK((subjects[0].runs.size() == 1 && subjects[1].runs.size() == 1));
  CHECK(machine.now.wall == 1 + 2);
  CHECK(subjects[0].counted(std::vector<int>{7}) == std::vector<int>{7});
  CHECK(subjects[1].counted(std::vector<int>{7, 8}) == std::vector<int>{8});
}

TEST_CASE("each way has the joules of its own devices, and none where one of them is not counted") {
  REQUIRE(::dlopen(SUNDOG_FAKE_NVML, RTLD_NOW) != nullptr);
  DeviceInfo counted, other;
  counted.type = other.type = "gpu";
  counted.vendor = "NVIDIA Corporation", other.vendor = "another", other.device = 1;
  Machine machine;
  std::vector<Subject> subjects{second(machine, "a"), second(machine, "b"), second(machine, "c")};
  subjects[0].devices = {counted}, subjects[1].devices = {other}, subjects[2].devices = {counted, other};
  measure(subjects, machine.options(3));
  CHECK(subjects[0].joules() > 0);
  CHECK(subjects[0].watts() == Approx(subjects[0].joules()));  // its runs take a second
  for (std::size_t i : {1u, 2u}) CHECK((subjects[i].joules() < 0 && subjects[i].watts() < 0));
}

TEST_CASE("a run that had fewer cores than others of its way, and took longer, is disturbed") {
  MeasuredWay way;
  way.runs = {{1, 2, -1, 0, ""}, {2, 1, -1, 0, ""}, {0.9, 1, -1, 0, ""}};
  CHECK(disturbance(way, way.runs[0], 0.1).empty());
  CHECK(disturbance(way, way.runs[1], 0.1) == "busy");
  CHECK(disturbance(way, way.runs[2], 0.1).empty());
}

TEST_CASE("runs with a lower clock are left out and measured again, and the report says so") {
  Machine machine;
  std::vector<Subject> subjects{second(machine, "a")};
  int runs = 0;
  subjects[0].run = [&] {
    const bool slow = ++runs == 3 || runs == 4;
    machine.now.clock = slow ? 2000 : 3000;
    machine.pass(slow ? 1.5 : 1, 1);
    return slow ? 1.5 : 1.0;
  };
  measure(subjects, machine.options(5));
  CHECK(subjects[0].runs.size() == 7);
  CHECK(subjects[0].runs[1].left_out == "slow clock");
  CHECK(subjects[0].runs[1].clock == 2000);
  CHECK(subjects[0].seconds().max == 1);
  const TemporaryFolder folder;
  CHECK(core_clock((folder / "none").string()) == 0);
  std::filesystem::create_directories(folder / "cpu1" / "cpufreq");
  folder.write("cpu1/cpufreq/scaling_cur_freq", "2450000\n");
  CHECK(core_clock((folder / ".").string()) == 2450);
}

TEST_CASE("runs are taken until they took so long, or until the median is known so well") {
  Machine machine;
  std::vector<Subject> long_ones{second(machine, "a")};
  MeasureOptions options = machine.options(6);
  options.seconds = 10;
  measure(long_ones, options);
  CHECK(long_ones[0].runs.size() == 10);
  std::vector<Subject> noisy{second(machine, "a"), second(machine, "b")};
  std::mt19937 random;
  noisy[1].run = [&] {
    const double seconds = 1 + 0.1 * static_cast<double>(random() % 100) / 100;
    machine.pass(seconds, 1);
    return seconds;
  };
  options.seconds = 0;
  options.precision = 0.01;
  measure(noisy, options);
  CHECK(noisy[0].runs.size() == 6);
  CHECK((noisy[1].runs.size() > 12 && noisy[1].runs.size() < 200));
  const Interval interval = median_interval(noisy[1].seconds());
  CHECK(interval.high - interval.low <= 0.02 * noisy[1].seconds().median);
  CHECK((is_precise(noisy[1], 0.01) && !is_precise(noisy[1], 0.001)));
  MeasuredWay brief;
  brief.runs.assign(5, Run{1, 1, 0, 0, ""});
  CHECK_FALSE(is_precise(brief, 0.5));  // five runs have no interval of 95 %
}

TEST_CASE("runs of an earlier report count, and only the rest is measured") {
  Machine machine;
  std::vector<Subject> subjects{second(machine, "a"), second(machine, "b")};
  MeasureOptions options = machine.options(3);
  MeasuredWay known;
  known.runs = {{1, 1, 0, 0, ""}, {1, 1, 0, 0, ""}};
  options.known["a"] = known;
  measure(subjects, options);
  CHECK(subjects[0].runs.size() == 3);
  CHECK(machine.now.wall == 2 + 1 + 3);
}

TEST_CASE("a stop leaves what was measured, and a budget ends with the round") {
  Machine machine;
  std::atomic<bool> stop = false;
  std::vector<Subject> subjects{second(machine, "a", [&](int run) { stop = run == 3; })};
  MeasureOptions options = machine.options(10);
  options.stop = &stop;
  measure(subjects, options);
  CHECK(subjects[0].runs.size() == 2);  // the run that was stopped does not count
  stop = false;
  std::vector<Subject> others{second(machine, "a"), second(machine, "b")};
  MeasureOptions brief = machine.options(1000000);
  brief.budget = 1e-9;
  measure(others, brief);
  CHECK(others[0].runs.size() == 1);
  CHECK_THAT(others[1].problem, ContainsSubstring("--budget"));
}

TEST_CASE("a median's interval holds it with 95 % confidence, from six runs on") {
  const auto interval = [](std::vector<double> runs) {
    const Interval found = median_interval(spread(runs));
    return std::pair(found.low, found.high);
  };
  CHECK(interval({5, 1, 3}) == std::pair(1.0, 5.0));
  CHECK(interval({6, 5, 4, 3, 2, 1}) == std::pair(1.0, 6.0));
  CHECK(interval({1, 2, 3, 4, 5, 6, 7, 8, 9}) == std::pair(2.0, 8.0));
  std::vector<double> many;
  for (int i = 1; i <= 20; ++i) many.push_back(i);
  CHECK(interval(many) == std::pair(6.0, 15.0));
  for (int i = 21; i <= 1000; ++i) many.push_back(i);
  CHECK(interval(many).first > 465);
  CHECK(interval(many).second < 536);
}
