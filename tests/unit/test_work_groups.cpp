// The sizes that `bench workgroup` tries, and that a time counts only with the right result.
#include <algorithm>

#include "base/error.h"
#include "bench/work_groups.h"
#include "catch.h"

using namespace sundog;
using enum WorkGroup::Kind;

namespace {

std::vector<std::string> texts(std::size_t limit, bool two_dimensions) {
  std::vector<std::string> all;
  for (const WorkGroup& group : work_group_candidates(limit, two_dimensions))
    all.push_back(work_group_text(group));
  return all;
}

/// Takes the seconds of `seconds_of`; the result of a group of 4 is wrong, one of 8 is refused.
TimedKernel fake_kernel(std::size_t limit) {
  const auto last = std::make_shared<WorkGroup>();
  TimedKernel kernel;
  kernel.limit = limit;
  kernel.run = [last, runs = 0](const WorkGroup& group) mutable {
    if (group.kind == fixed && group.x == 8) throw DeviceError("too large");
    *last = group;
    return ++runs <= 6 ? 5.0 : group.kind == fixed ? static_cast<double>(group.x) : 3.0;
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
  const auto times = measure_work_groups(fake_kernel(8), 3);
  REQUIRE(times.size() == 7);
  for (const WorkGroupTime& time : times) {
    CAPTURE(work_group_text(time.group));
    const bool bad = time.group.kind == fixed && (time.group.x == 4 || time.group.x == 8);
    CHECK(time.problem.empty() != bad);
    if (!bad)
      CHECK(time.seconds.median == (time.group.kind == fixed ? static_cast<double>(time.group.x) : 3.0));
  }
  CHECK(times[0].first_run == 2);  // 5 seconds at first, 3 later
  CHECK(times[5].problem == "too large");
  Report report;
  add_work_group_tables(report, fake_kernel(8), times, 3);
  CHECK(report.measurements.rows.size() == 7);
  CHECK_THAT(report_text(report),
             ContainsSubstring("too large") && ContainsSubstring("its result is not the default's"));
  CHECK_THAT(report_html(report), ContainsSubstring("best: 1<"));
}
