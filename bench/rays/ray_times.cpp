// Checks the first answers of each kind with check_hits.h, later ones by their hash, and reports the whole
// run's rate beside the kernel's.
#include "bench/rays/ray_times.h"

#include <fmt/format.h>

#include <algorithm>

#include "bench/report/machine.h"
#include "render/device/kernel_config.h"
#include "render/film/hash.h"

namespace sundog {
namespace {

double number(std::size_t n) { return static_cast<double>(n); }

/// Millions of rays a second, for each of the times.
Spread rates(std::size_t rays, const std::vector<double>& seconds) {
  std::vector<double> all;
  for (const double time : seconds) all.push_back(1e-6 * number(rays) / time);
  return spread(all);
}

}  // namespace

RayTimes::RayTimes(std::string scene_name, std::shared_ptr<const CompiledScene> scene,
                   const DeviceInfo& device, unsigned size, std::vector<std::string> kinds)
    : name_(std::move(scene_name)),
      scene_(std::move(scene)),
      info_(device),
      size_(size),
      wanted_(std::move(kinds)) {}

std::string RayTimes::check(Kind& kind) {
  RayTracer& tracer = tracing_->tracer;
  const Answers answers = kind.set.any ? Answers{{}, tracer.occluded()} : Answers{tracer.hits(), {}};
  const std::uint64_t result = kind.set.any ? hash_of(answers.occluded) : hash_of(answers.hits);
  if (kind.expected != 0) return result == kind.expected ? "" : "its answers are not those of its first run";
  kind.expected = result;
  kind.check = check_hits(*scene_, kind.set, answers);
  const HitCheck& found = kind.check;
  if (found.differ > 0)
    return fmt::format("{}: {} of {} {} rays have wrong answers, so nothing was timed", name_, found.differ,
                       found.checked, kind.set.kind);
  return "";
}

void RayTimes::measure(const MeasureOptions& options) {
  if (options.on_step) options.on_step("making rays", 0);
  Subject all;
  all.name = fmt::format("{} on {}", name_, device_title(info_));
  all.devices = {info_};
  subjects_ = {all};
  std::vector<RaySet> sets;
  const auto open = [&] {
    tracing_ = std::make_shared<OpenedTracer>(info_, *scene_);
    const auto trace = [&](std::span<const Ray> rays) { return tracing_->tracer.trace(rays); };
    sets = frame_rays(*scene_, scene_viewpoint(*scene_), size_, trace, wanted_);
  };
  if (!prepared(subjects_, options, open)) return;
  subjects_.clear();
  for (RaySet& set : sets) {
    const auto kind = std::make_shared<Kind>(Kind{std::move(set), {}, 0, {}});
    kinds_.push_back(kind);
    Subject& subject = subjects_.emplace_back(all);
    subject.name += fmt::format(", {} rays", kind->set.kind);
    subject.run = [this, kind] {
      RayTracer& tracer = tracing_->tracer;
      tracer.upload(kind->set.rays);
      const Stopwatch clock;
      kind->kernel_seconds.push_back(tracer.run({kind->set.any, kind->set.coherent}));
      return clock.seconds();
    };
    subject.check = [this, kind] { return check(*kind); };
  }
  sundog::measure(subjects_, options);
}

std::optional<Spread> RayTimes::rate(std::size_t kind) const {
  if (!subjects_[kind].is_good()) return {};
  return rates(kinds_[kind]->set.rays.size(), subjects_[kind].seconds().runs);
}

std::optional<Spread> RayTimes::kernel_rate(std::size_t kind) const {
  const std::vector<double> seconds = subjects_[kind].counted(kinds_[kind]->kernel_seconds);
  const bool known = std::ranges::all_of(seconds, [](double time) { return time > 0; });
  if (!subjects_[kind].is_good() || seconds.empty() || !known) return {};
  return rates(kinds_[kind]->set.rays.size(), seconds);
}

std::vector<RayTimes::Timed> RayTimes::timed() const {
  std::vector<Timed> all;
  for (std::size_t i = 0; i < kinds_.size(); ++i)
    if (const auto by_wall = rate(i))
      all.push_back({&kinds_[i]->set, kernel_rate(i).value_or(*by_wall), &subjects_[i]});
  return all;
}

void RayTimes::add_to(Report& report) const {
  const std::string tracer = traces_compact(*scene_, info_) ? "compact" : "wide";
  Table table{fmt::format("{} on {}, {} tracer", name_, device_title(info_), tracer), {}, {}};
  BarPlot bars{table.title, "Mrays/s", {}};
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    std::vector<Field> key{{"scene", "", name_}, {"device", "", device_title(info_)}, {"tracer", "", tracer}};
    std::vector<Field> shown, results;
    if (i < kinds_.size()) {
      const Kind& kind = *kinds_[i];
      const auto per_second = rate(i), kernel = kernel_rate(i);
      const std::size_t rays = kind.set.rays.size();
      shown = {{"kind", "", kind.set.kind},
               {"rays", "", number(rays)},
               {"hits", "%", 100.0 * number(kind.check.hits) / number(rays)},
               {"rate", "Mrays/s", per_second},
               {"kernel", "Mrays/s", kernel},
               {"checked", "", fmt::format("{}, {} by rounding", kind.check.checked, kind.check.rounded)}};
      key.push_back(shown[0]);
      results = {shown[1],
                 {"hits", "", number(kind.check.hits)},
                 shown[3],
                 shown[4],
                 {"checked", "", number(kind.check.checked)},
                 {"rounded", "", number(kind.check.rounded)},
                 {"differ", "", number(kind.check.differ)}};
      if (per_second) bars.bars.push_back({kind.set.kind, *per_second, fmt::format("{} rays", rays)});
    }
    add_row(table, shown, subjects_[i]);
    add_measured(report, subjects_[i], key, results);
  }
  report.parts.emplace_back(std::move(table));
  if (!bars.bars.empty()) report.parts.emplace_back(std::move(bars));
}

}  // namespace sundog
