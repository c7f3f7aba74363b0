// mandelbulb: one picture of a Mandelbulb of power 8 (gradient normal, openness, soft shadow) by sundog's
// kernels with 1, 4, 8 and 16 lanes and by hand-written C++, in turn, one thread each; prints milliseconds of
// processor time and the ratios. The pictures are compared before a time counts.
#include <fmt/format.h>

#include <cmath>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "base/arguments.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/file.h"
#include "bench/report/samples.h"
#include "compile/fields/sdf.h"
#include "device/device.h"
#include "mandelbulb_peer.h"
#include "parse_arguments.h"
#include "scene/formula/list.h"

using namespace sundog;

namespace {

struct Options {
  std::string device = "cpu/1", json, image;
  int size = 640, repeats = 7;
  bool exact = false;
};

Picture make_picture(const Options& options) {
  Picture p;
  p.width = p.height = options.size;
  const glm::vec3 eye(1.5f, -2.2f, 1.2f), forward = glm::normalize(-eye),
                                          right = glm::normalize(glm::cross(forward, glm::vec3(0, 0, 1)));
  const glm::vec3 up = glm::cross(right, forward), light = glm::normalize(glm::vec3(0.3f, -0.5f, 0.9f));
  const auto copy = [](const glm::vec3& from, float* to) { std::copy(&from.x, &from.x + 3, to); };
  copy(eye, p.origin);
  copy(right, p.right);
  copy(up, p.up);
  copy(forward, p.forward);
  copy(light, p.light);
  p.half_angle = 0.42f;
  return p;
}

SdfDescription field_of(const Picture& p, bool exact) {
  SdfDescription field = default_field(*find_formula("mandelbulb"));
  field.root.formula.iterations = p.iterations;
  field.root.formula.bailout = p.bailout;
  // The derivative that everybody uses, and the peers too; --exact measures the one that is a proven bound.
  field.root.formula.steps[0].definition.derivative =
      exact ? FormulaDerivative::running : FormulaDerivative::radial;
  field.lower = glm::dvec3(-p.bound);
  field.upper = glm::dvec3(p.bound);
  field.least = p.least;
  field.greatest = p.greatest;
  field.detail = p.detail;
  field.step_limit = p.step_limit;
  return field;
}

/// The kernel for one number of lanes, ready to run.
class KernelPeer {
 public:
  KernelPeer(Device& device, const Picture& p, int lanes, bool exact)
      : device_(device), p_(p), lanes_(lanes) {
    const SdfDescription field = field_of(p, exact);
    const CompiledFields compiled = compile_fields(std::span(&field, 1));
    kernel_ = device
                  .build("entry/field_picture.cl",
                         {{"LANES", std::to_string(lanes)}, {"SDF_FLAGS", "3"}, {"SDF_TWO_SIDED", "1"}},
                         nullptr, {{"generated/sdf.cl", compiled.source}})
                  .kernel<Buffer<SdfField>, Buffer<float>, Buffer<float>, Buffer<u32>, float4, float4, float4,
                          float4, float4, u32, u32>("field_picture");
    fields_ = device.upload<SdfField>(compiled.fields);
    parameters_ = device.upload<float>(compiled.parameters);
    shades_ = device.make<float>(pixels());
    counts_ = device.upload<u32>(std::vector<u32>(4));
  }

  void run(std::vector<float>& shades) {
    const auto four = [](const float* v, float w = 0) { return float4{v[0], v[1], v[2], w}; };
    device_.run(kernel_, {.x = pixels() / static_cast<std::size_t>(lanes_), .local_x = 64}, fields_,
                parameters_, shades_, counts_, four(p_.origin, p_.half_angle), four(p_.right), four(p_.up),
                four(p_.forward), four(p_.light), u32(p_.width), u32(p_.height));
    device_.read(shades_, std::span<float>(shades));
  }

  std::vector<u32> counts() {
    std::vector<u32> values(4);
    device_.read(counts_, std::span<u32>(values));
    return values;
  }

 private:
  std::size_t pixels() const {
    return static_cast<std::size_t>(p_.width) * static_cast<std::size_t>(p_.height);
  }
  Device& device_;
  const Picture& p_;
  int lanes_;
  Kernel<Buffer<SdfField>, Buffer<float>, Buffer<float>, Buffer<u32>, float4, float4, float4, float4, float4,
         u32, u32>
      kernel_;
  Buffer<SdfField> fields_;
  Buffer<float> parameters_, shades_;
  Buffer<u32> counts_;
};

template <class Work>
double milliseconds(const Work& work) {
  const double start = processor_seconds();
  work();
  return 1e3 * (processor_seconds() - start);
}

/// Share of the pixels that differ by more than 5 % of white.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += !(std::abs(a[i] - b[i]) <= 0.05f);
  return static_cast<double>(count) / static_cast<double>(a.size());
}

void write_picture(const Options& options, const std::vector<float>& shades) {
  std::string bytes = fmt::format("P5\n{0} {0}\n255\n", options.size);
  for (const float s : shades)
    bytes += static_cast<char>(static_cast<unsigned char>(255 * std::sqrt(std::clamp(s, 0.0f, 1.0f))));
  write_file(options.image, bytes);
}

using Render = std::function<void(std::vector<float>&)>;
using Times = std::map<std::string, std::vector<double>>;  // milliseconds, by contender

constexpr const char *scalar_name = "C++ scalar", *simd_name = "C++ omp simd, 16 lanes";

/// Whether all pictures are the scalar one, as far as they must be; the shares that differ go into `report`.
bool pictures_agree(const std::map<std::string, Render>& contenders, std::vector<float>& shades, bool exact,
                    nlohmann::json& report) {
  std::vector<float> reference(shades.size());
  contenders.at(scalar_name)(reference);
  for (const auto& [name, render] : contenders) {
    render(shades);
    const double share = difference(reference, shades);
    report["differs"][name] = share;
    if (!exact && share > 0.02) {
      fmt::print(stderr, "{}: {:.2f} % of the pixels differ; its time does not count\n", name, 100 * share);
      return false;
    }
  }
  return true;
}

std::vector<double> ratios(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> result;
  for (std::size_t i = 0; i < a.size(); ++i) result.push_back(a[i] / b[i]);
  return result;
}

void tell_times(const Times& times, nlohmann::json& report) {
  fmt::print("{:28} {:>9} {:>9} {:>9} {:>11} {:>11} {:>9}\n", "", "ms", "least", "greatest", "x scalar",
             "x simd", "differs");
  for (const auto& [name, values] : times) {
    const Spread s = spread(values);
    const double to_scalar = spread(ratios(times.at(scalar_name), values)).median;
    const double to_simd = spread(ratios(times.at(simd_name), values)).median;
    report["results"][name] = {{"ms", s.median}, {"scalar_ratio", to_scalar}, {"simd_ratio", to_simd}};
    fmt::print("{:28} {:9.1f} {:9.1f} {:9.1f} {:11.2f} {:11.2f} {:8.2f}%\n", name, s.median, s.min, s.max,
               to_scalar, to_simd, 100 * report["differs"][name].get<double>());
  }
}

int run(const Options& options) {
  const Picture picture = make_picture(options);
  Device device(select_devices(enumerate_devices(plain_environment()), {options.device}).at(0));
  const std::size_t pixels =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  std::map<std::string, Render> contenders;
  contenders[scalar_name] = [&](auto& out) { render_scalar(picture, out); };
  contenders[simd_name] = [&](auto& out) { render_simd(picture, out); };
  std::vector<std::unique_ptr<KernelPeer>> kernels;
  for (const int lanes : {1, 4, 8, 16}) {
    kernels.push_back(std::make_unique<KernelPeer>(device, picture, lanes, options.exact));
    contenders[fmt::format("sundog, {:2} lanes", lanes)] = [kernel = kernels.back().get()](auto& out) {
      kernel->run(out);
    };
  }
  nlohmann::json report{
      {"device", device.info().label()}, {"size", options.size}, {"repeats", options.repeats}};
  std::vector<float> shades(pixels);
  if (!pictures_agree(contenders, shades, options.exact, report)) return 6;
  if (!options.image.empty()) write_picture(options, shades);
  Times times;
  for (int i = 0; i < options.repeats; ++i)
    for (auto& [name, render] : contenders) times[name].push_back(milliseconds([&] { render(shades); }));
  const auto counts = kernels.back()->counts();
  fmt::print("Mandelbulb, power 8, {0}x{0}, one thread of {1}\n", options.size, device.info().label());
  tell_times(times, report);
  const double frames = options.repeats + 1;
  fmt::print("steps a pixel {:.2f}, taken back {:.2f}, hits {:.1f} %, ended by the step limit {:.0f}\n",
             counts[0] / frames / double(pixels), counts[3] / frames / double(pixels),
             100 * counts[1] / frames / double(pixels), counts[2] / frames);
  if (!options.json.empty()) write_file(options.json, report.dump(2) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  Arguments app("A Mandelbulb by sundog's kernels and by hand-written C++, in turn, one thread each.");
  app.add_option("--device", options.device,
                 "the OpenCL device (a sub-device of one unit keeps it to one thread)");
  app.add_option("--size", options.size, "pixels a side, a multiple of 4")->range(16, 4096);
  app.add_option("--repeats", options.repeats)->range(1, 1000);
  app.add_option("--json", options.json);
  app.add_option("--image", options.image, "write the picture as .pgm");
  app.add_flag("--exact", options.exact,
               "the kernels use the derivative that is a proven bound (their picture then differs, and is "
               "not held against)");
  parse_or_exit(app, argc, argv);
  try {
    return run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mandelbulb: {}\n", error.what());
    return 1;
  }
}
