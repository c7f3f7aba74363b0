// The sizes that `bench workgroup` tries, and that a time counts only with the right result.
#include <algorithm>

#include "base/error.h"
#include "bench/frames/work_groups.h"
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

}  // namespace

TEST_CASE("work-group sizes are powers of two, one prime, the driver's and the default, within the limit") {
  CHECK(texts(1, false) == std::vector<std::string>{"default", "driver", "1"});
  CHECK(texts(8, false) == std::vector<std::string>{"default", "driver", "1", "2", "4", "8", "7"});
  CHECK(texts(4, true) ==
        std::vector<std::string>{"default", "driver", "1", "2", "4", "3", "1x2", "2x2", "1x4"});
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
  const WorkGroupTimes all = measure_work_groups(fake_kernel(8), 3);
  const auto& times = all.sizes;
  REQUIRE(times.size() == 7);
  for (const WorkGroupTime& time : times) {
    CAPTURE(work_group_text(time.group));
    const bool bad = time.group.kind == fixed && (time.group.x == 4 || time.group.x == 8);
    CHECK(time.problem.empty() != bad);
    if (!bad)
      CHECK(time.seconds.median == (time.group.kind == fixed ? static_cast<double>(time.group.x) : 3.0));
  }
  CHECK(times[5].problem == "too large");
  Report report;
  add_work_group_tables(report, fake_kernel(8), all);
  CHECK(report.measurements.rows.size() == 9);  // with the two of the duel
  CHECK_THAT(report_text(report),
             ContainsSubstring("too large") && ContainsSubstring("its result is not the default's"));
  CHECK_THAT(report_html(report), ContainsSubstring("best: 1<"));
}

TEST_CASE("compilation is what a first launch takes beyond the device's events, and not part of a time") {
  TimedKernel kernel = fake_kernel(2);
  CHECK_FALSE(measure_work_groups(kernel, 3).sizes[0].compile_seconds);  // no events
  const auto runs = std::make_shared<int>(0);
  kernel.run = [runs](const WorkGroup&) { return ++*runs <= 4 ? 100.0 : 1.0; };  // four sizes are warmed up
  kernel.beyond_events = [runs] { return std::optional(*runs == 1 ? 99.5 : 0.5); };
  const WorkGroupTimes times = measure_work_groups(kernel, 3);
  REQUIRE(times.sizes.size() == 4);
  CHECK(times.sizes[0].compile_seconds == 99.0);  // compiled for all sizes at once
  CHECK(times.sizes[1].compile_seconds == 0.0);   // a slow first run is no compilation
  CHECK(times.sizes[0].seconds.median == 1);
  Report report;
  add_work_group_tables(report, kernel, times);
  CHECK_THAT(report_text(report), ContainsSubstring("compiled at first launch [ms]"));
}

TEST_CASE(
    "a best size is named only where all its runs are faster than all of the default's, run again in turn") {
  const auto text_of = [](int repeat, std::function<double(const WorkGroup&)> seconds_of) {
    const TimedKernel kernel = fake_kernel(2, seconds_of);
    const WorkGroupTimes times = measure_work_groups(kernel, repeat);
    Report report;
    add_work_group_tables(report, kernel, times);
    const std::string page = report_html(report);
    for (const char* mark : {">best: 1<", "\"cell best\""})
      CHECK((page.find(mark) != std::string::npos) == verdict_text(times).starts_with("best: "));
    return verdict_text(times);
  };
  const auto of_one = [](double one, double usual) {
    return [=](const WorkGroup& group) { return group.kind == fixed && group.x == 1 ? one : usual; };
  };
  CHECK(text_of(5, of_one(0.5, 1)) ==
        "best: 1 took 500 to 500 ms, 0.50 of the default's time (1000 to 1000 ms)");
  CHECK(text_of(2, of_one(0.5, 1)) == "no clear winner: too few runs to name one (--repeat 3 or more)");
  CHECK(text_of(5, of_one(2, 1)) == "no clear winner: no size has a smaller median than the default");
  int runs = 0;  // each third run of any size takes twice the time
  CHECK_THAT(text_of(5, [&](const WorkGroup& group) { return of_one(0.9, 1)(group) * (++runs % 3 ? 1 : 2); }),
             ContainsSubstring("no clear winner: 1, the size with the smallest median, took 900 to 1800 ms"));
}
