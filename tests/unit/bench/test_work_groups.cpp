// The sizes that `bench workgroup` tries, and that a time counts only with the right result.
#include <algorithm>

#include "base/error.h"
#include "bench/frames/work_groups.h"
#include "bench/report/svg.h"
#include "catch.h"
#include "render/device/tuning.h"

using namespace sundog;
using enum WorkGroup::Kind;

namespace {

std::vector<std::string> texts(std::size_t limit, bool two_dimensions) {
  std::vector<std::string> all;
  for (const WorkGroup& group : work_group_candidates(limit, two_dimensions))
    all.push_back(work_group_text(group));
  return all;
}

/// Takes as many seconds as a group has work-items, the default 3; `seconds_of` says otherwise. The result of
/// a group of 4 is wrong, one of 8 is refused.
TimedKernel fake_kernel(std::size_t limit, std::function<double(const WorkGroup&)> seconds_of = {}) {
  const auto last = std::make_shared<WorkGroup>();
  TimedKernel kernel;
  kernel.limit = limit;
  kernel.run = [last, seconds_of](const WorkGroup& group) {
    if (group.kind == fixed && group.x == 8) throw DeviceError("too large");
    *last = group;
    if (seconds_of) return seconds_of(group);
    return group.kind == fixed ? static_cast<double>(group.x) : 3.0;
  };
  kernel.result = [last] { return last->kind == fixed && last->x == 4 ? 2u : 1u; };
  return kernel;
}

std::vector<std::string> texts_of(const WorkGroupTimes& times) {
  std::vector<std::string> all;
  for (const auto& way : times.ways()) all.push_back(way->text);
  return all;
}

std::shared_ptr<WorkGroupTimes> measured(const TimedKernel& kernel, int repeat) {
  const auto times = std::make_shared<WorkGroupTimes>(kernel, [kernel] { return kernel; });
  MeasureOptions options;
  options.repeat = repeat;
  options.load = std::make_shared<LoadMeter>(2, [] { return ProcessorTimes{}; });
  times->measure(options);
  return times;
}

}  // namespace

TEST_CASE("work-group sizes are powers of two, one prime and the driver's, within the limit") {
  CHECK(texts(1, false) == std::vector<std::string>{"driver", "1"});
  CHECK(texts(8, false) == std::vector<std::string>{"driver", "1", "2", "4", "8", "7"});
  CHECK(texts(4, true) == std::vector<std::string>{"driver", "1", "2", "4", "3", "1x2", "2x2", "1x4"});
  for (const std::size_t limit : {0u, 1u, 2u, 3u, 100u, 273u, 1024u})
    for (const WorkGroup& group : work_group_candidates(limit, true))
      if (group.kind == fixed) CHECK((group.x * group.y <= limit && group.x > 0 && group.y > 0));
  const auto all = texts(1024, true);
  CHECK(std::ranges::count(all, "61") == 1);
  CHECK(std::ranges::count(all, "16x16") == 1);
  auto unique = all;
  std::ranges::sort(unique);
  CHECK(std::ranges::adjacent_find(unique) == unique.end());
}

TEST_CASE("a size whose result differs or that is refused has a problem and no time") {
  const auto times = measured(fake_kernel(8), 6);
  REQUIRE(times->ways().size() == 6);  // the driver's choice is the default here
  for (std::size_t i = 0; i < times->ways().size(); ++i) {
    const WorkGroup& group = times->ways()[i]->group;
    const Subject& subject = times->subjects()[i];
    CAPTURE(times->ways()[i]->text);
    const bool bad = group.kind == fixed && (group.x == 4 || group.x == 8);
    CHECK(subject.is_good() != bad);
    if (!bad) CHECK(subject.seconds().median == (group.kind == fixed ? static_cast<double>(group.x) : 3.0));
  }
  Report report;
  times->add_to(report);
  CHECK(report.measurements.rows.size() == times->ways().size() + 2);  // with the two of the duel
  CHECK(report.ways.size() == report.measurements.rows.size());
  CHECK_THAT(report_text(report),
             ContainsSubstring("too large") && ContainsSubstring("its result is not the default's"));
  CHECK_THAT(report_html(report), ContainsSubstring("best: 1<"));
}

TEST_CASE(
    "one spoiled run of the default is no reference for all sizes; where no two agree nothing is timed") {
  TimedKernel kernel = fake_kernel(2);
  int results = 0;
  kernel.result = [&] { return ++results == 1 ? 7u : 1u; };
  for (const Subject& subject : measured(kernel, 1)->subjects()) CHECK(subject.is_good());
  kernel.result = [&] { return static_cast<unsigned>(++results); };
  const auto times = measured(kernel, 1);
  REQUIRE(times->subjects().size() == 1);
  CHECK_THAT(times->subjects()[0].problem, ContainsSubstring("differ from run to run"));
}

TEST_CASE("the default is named with its size, which stands once") {
  TimedKernel kernel = fake_kernel(2);
  kernel.local = [] { return std::pair<std::size_t, std::size_t>(2, 1); };
  const auto times = measured(kernel, 1);
  CHECK(texts_of(*times) == std::vector<std::string>{"default (2)", "driver's choice", "1"});
  Report report;
  times->add_to(report);
  const auto& map = std::get<HeatMap>(report.parts[1]);  // in which the default takes its 3 seconds
  CHECK(map.columns == std::vector<std::string>{"1", "2"});
  CHECK(map.values == std::vector<std::vector<std::optional<double>>>{{1000.0, 3000.0}});
  CHECK_THAT(svg(map), ContainsSubstring(">work-items in x; cells in ms</text>"));
  kernel.local = [] { return std::pair<std::size_t, std::size_t>(0, 0); };
  CHECK(texts_of(*measured(kernel, 1)) ==
        std::vector<std::string>{"default (the driver's choice)", "1", "2"});
}

TEST_CASE("sizes of one's own are tried instead of the usual ones") {
  TimedKernel kernel = fake_kernel(8);
  kernel.sizes = {{fixed, 2, 1}, {fixed, 3, 2}};
  CHECK(texts_of(*measured(kernel, 1)) ==
        std::vector<std::string>{"default (the driver's choice)", "2", "3x2"});
}

TEST_CASE("compilation is what a first launch takes beyond the device's events, and not part of a time") {
  TimedKernel kernel = fake_kernel(2);
  const auto times = measured(kernel, 3);
  CHECK_FALSE(times->ways()[0]->compile_seconds());  // no events
  WorkGroupTimes::Way way;
  way.beyond = {99.5, 0.5, 0.4, 0.6};
  CHECK(way.compile_seconds() == 99.0);
  way.beyond = {0.5, 0.5, 0.6};  // a slow first run is no compilation
  CHECK(way.compile_seconds() == 0.0);
}

TEST_CASE("a best size is named only where six runs in turn with the default, or more, are faster") {
  const auto text_of = [](int repeat, std::function<double(const WorkGroup&)> seconds_of) {
    const auto times = measured(fake_kernel(2, seconds_of), repeat);
    Report report;
    times->add_to(report);
    const std::string page = report_html(report);
    for (const char* mark : {">best: 1<", "\"cell best\""})
      CHECK((page.find(mark) != std::string::npos) == times->verdict().starts_with("best: "));
    return times->verdict();
  };
  const auto of_one = [](double one, double usual) {
    return [=](const WorkGroup& group) { return group.kind == fixed && group.x == 1 ? one : usual; };
  };
  CHECK(text_of(6, of_one(0.5, 1)) ==
        "best: 1 took 500 to 500 ms, 0.50 of the default's time (1000 to 1000 ms)");
  for (const int few : {2, 3, 5})
    CHECK(text_of(few, of_one(0.5, 1)) ==
          "no clear winner: too few runs to name one (--repeat 6 or more, and a --budget for them)");
  // Both slow down alike: their intervals overlap, the pairs' ratios do not hold 1.
  int duel = 0;
  CHECK_THAT(
      text_of(6, [&](const WorkGroup& group) { return of_one(0.9, 1)(group) * (1 + 0.1 * (duel++ / 3)); }),
      ContainsSubstring("best: 1"));
  CHECK(text_of(5, of_one(2, 1)) == "no clear winner: no size has a smaller median than the default");
  int runs = 0;  // each third run of any size takes twice the time
  CHECK_THAT(text_of(9, [&](const WorkGroup& group) { return of_one(0.7, 1)(group) * (++runs % 3 ? 1 : 2); }),
             ContainsSubstring("no clear winner: 1, the size with the smallest median, took 700 to 1400 ms"));
}
