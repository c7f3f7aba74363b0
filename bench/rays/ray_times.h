// Times one scene's rays on one device's tracer, by kind.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/rays/check_hits.h"
#include "bench/rays/ray_tracer.h"
#include "bench/report/report.h"
#include "bench/runs/measure.h"

namespace sundog {

class RayTimes {
 public:
  /// `size`: camera rays a side; `kinds`: of ray_kinds, or empty for all.
  RayTimes(std::string scene_name, std::shared_ptr<const CompiledScene> scene, const DeviceInfo& device,
           unsigned size, std::vector<std::string> kinds);

  /// Checks every answer of a kind's first run; later runs must give the same bits.
  void measure(const MeasureOptions& options);
  void add_to(Report& report) const;

  /// A timed kind of rays: millions of rays a second by the device's events, otherwise by the wall clock.
  struct Timed {
    const RaySet* set;
    Spread rate;
    const MeasuredWay* way;
  };
  std::vector<Timed> timed() const;

 private:
  struct Kind {
    RaySet set;
    HitCheck check;
    std::uint64_t expected = 0;          // hash of the answers
    std::vector<double> kernel_seconds;  // of each run, the first included, by the device's events
  };
  std::string check(Kind& kind);
  std::optional<Spread> rate(std::size_t kind) const;
  std::optional<Spread> kernel_rate(std::size_t kind) const;

  std::string name_;
  std::shared_ptr<const CompiledScene> scene_;
  DeviceInfo info_;
  unsigned size_;
  std::vector<std::string> wanted_;
  std::shared_ptr<OpenedTracer> tracing_;
  std::vector<std::shared_ptr<Kind>> kinds_;
  std::vector<Subject> subjects_;
};

}  // namespace sundog
