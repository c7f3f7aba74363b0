// Builds or reuses, in this order: the integrator's kernel, the kernels of first surfaces and photons, the
// scene's tables, the media around the camera.
#include "render/device/frame_kernels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/clock.h"
#include "base/error.h"
#include "scene/integrators.h"

namespace sundog {
namespace {

void check_work_group(const DeviceInfo& device, std::size_t most, const WorkGroup& group) {
  if (group.kind == WorkGroup::Kind::fixed && most > 0 && group.x * group.y > most)
    throw UsageError(
        fmt::format("{}: a work-group of {} is more than the {} that it can have in this scene; ask for "
                    "less, or for a smaller max_depth",
                    device.label(), group.x * group.y, most));
}

Program build(Device& device, const std::string& entry, const KernelConfig& config, FrameKernels& kernels,
              RenderTimes& times, unsigned* built = nullptr) {
  BuildReport report;
  Program program = device.build(entry, config.defines(), &report, config.generated);
  times.cached = times.cached && report.cached;
  if (built) *built += !report.cached;
  if (!report.note.empty()) kernels.notes.push_back("no kernel cache: " + report.note);
  return program;
}

/// Lowers `most` to a built kernel's own limit, which depends on its registers.
void limit_group(std::size_t limit, std::size_t& most) {
  if (limit > 0) most = most > 0 ? std::min(most, limit) : limit;
}

void find_camera_media(Device& device, FrameKernels& kernels) {
  if (!kernels.find_media.kernel())
    kernels.find_media = scene_kernel<Buffer<u32>>(
        device.build("entry/camera_media.cl", kernels.config.defines(), nullptr, kernels.config.generated),
        "find_camera_media");
  run_scene_kernel(device, kernels.find_media, {1, 1, 1, 1}, kernels.tables, kernels.tables.camera_media);
  device.finish();
}

constexpr const char* photon_entry = "entry/trace_photons.cl";
constexpr const char* photon_kernel = "trace_photons";

/// If the integrator's kernel must be built too, starts building the photon kernel in another process, unless
/// the driver can build both at once. Returns whether it does.
bool begin_photon_tracer(Device& device, const Integrator& integrator, const KernelConfig& config) {
  if (device.has(integrator.entry, config.defines(), config.generated)) return false;
  const std::size_t group = photon_group(config, greatest_work_group(config, device.info()));
  return device.build_ahead(photon_entry, config.defines(), PhotonKernel::empty_launch(photon_kernel, group),
                            config.generated);
}

void build_integrator(Device& device, const Integrator& integrator, FrameKernels& kernels, RenderTimes& times,
                      KernelUpdate& update) {
  kernels.integrator = integrator_kernel(
      build(device, integrator.entry, kernels.config, kernels, times, &update.built), integrator.kernel);
  kernels.entry = integrator.entry;
  kernels.most_run = integrator.most_run;
  kernels.first_surfaces = {};
  kernels.trace_photons = {};
  kernels.find_media = {};
  limit_group(device.limits(kernels.integrator).work_group, kernels.most_group);
  update.changed = true;
}

/// Generates the integrator's machine code while another process builds the photon kernel.
void make_integrator_ready(Device& device, FrameKernels& kernels) {
  try {
    device.make_ready(kernels.integrator, first_group(kernels.config));
  } catch (const DeviceError&) {
    // the first real launch will report it
  }
}

/// Chooses kernels for `wanted`: its own, waiting until a builder has built them, or stand-ins.
KernelConfig choose_config(Device& device, const Integrator& integrator, KernelConfig wanted, bool photons,
                           KernelStore& store, KernelUpdate& update) {
  KernelPick picked = store.pick(device, {integrator.entry, integrator.kernel, std::move(wanted)});
  if (!picked.built) {
    if (photons) begin_photon_tracer(device, integrator, picked.kernel.config);
    update.built += store.wait_for(device, picked.kernel);
  }
  return std::move(picked.kernel.config);
}

/// Updates the kernels for the scene, keeping suitable ones.
void renew_kernels(Device& device, const CompiledScene& scene, const Tuning& tuning, const WorkGroup& asked,
                   bool aovs, FrameKernels& kernels, RenderTimes& times, KernelUpdate& update) {
  const Integrator& integrator = integrator_of(scene.integrator);
  const auto config_of = kernels.choice == KernelChoice::general ? general_config
                         : kernels.choice == KernelChoice::draft ? drawing_draft_config
                                                                 : make_kernel_config;
  KernelConfig config = config_of(scene, device.info(), tuning);
  if (kernels.mattes) config.numbers["HAS_MATTES"] = 1;
  if (kernels.light) config.numbers[kernels.groups ? "HAS_LIGHT_GROUPS" : "HAS_LIGHT_PARTS"] = 1;
  if (kernels.counts_rays) config.numbers["HAS_RAY_COUNTS"] = 1;
  KernelStore* const store = kernels.store;
  if (store) store->begin_scene(general_configs(scene, device.info(), tuning));
  const bool photons = scene.features.caustics;
  const auto is_there = [&] {
    return kernels.integrator.kernel() && kernels.entry == integrator.entry &&
           same_kernels(kernels.config, config);
  };
  if (store && !is_there())
    config = choose_config(device, integrator, std::move(config), photons, *store, update);
  if (!is_there()) {
    kernels.config = std::move(config);
    kernels.most_group = greatest_work_group(kernels.config, device.info());
    check_work_group(device.info(), kernels.most_group, asked);
    const bool beside = photons && begin_photon_tracer(device, integrator, kernels.config);
    build_integrator(device, integrator, kernels, times, update);
    if (beside) make_integrator_ready(device, kernels);
    if (store) store->remember(kernels.config);
  }
  // Last, because some drivers neither load nor start other kernels while they compile.
  if (store) store->build_wanted();
  if (aovs) add_first_surfaces(device, kernels, times);
  if (photons) add_photon_tracer(device, kernels, times);
  check_work_group(device.info(), kernels.most_group, asked);
}

/// Determines the media around the camera; none outside all solids.
void renew_camera_media(Device& device, const CompiledScene& scene, FrameKernels& kernels) {
  if (integrator_of(scene.integrator).needs_camera_media && scene.features.camera_inside) {
    find_camera_media(device, kernels);
    kernels.camera_inside = true;
  } else if (std::exchange(kernels.camera_inside, false)) {
    constexpr std::array<u32, 2> outside{};
    device.write(kernels.tables.camera_media, std::span<const u32>(outside));
  }
}

}  // namespace

IntegratorKernel integrator_kernel(const Program& program, const std::string& name) {
  return scene_kernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<float>, Buffer<u32>, Buffer<u32>,
                      Launch>(program, name);
}

bool take_wanted_kernel(Device& device, FrameKernels& kernels) {
  if (!kernels.store) return false;
  std::optional<KernelOrder> order = kernels.store->take_wanted(device);
  if (!order) return false;
  kernels.config = std::move(order->config);
  RenderTimes times;
  kernels.integrator =
      integrator_kernel(build(device, kernels.entry, kernels.config, kernels, times), order->kernel);
  limit_group(device.limits(kernels.integrator).work_group, kernels.most_group);
  return true;
}

void add_first_surfaces(Device& device, FrameKernels& kernels, RenderTimes& times) {
  if (kernels.first_surfaces.kernel() && kernels.there_aovs == kernels.wanted_aovs) return;
  KernelConfig config = kernels.config;
  if (kernels.wanted_aovs.all) config.numbers["ALL_AOVS"] = config.numbers["HAS_UV"] = 1;
  if (kernels.wanted_aovs.features) config.numbers["FEATURE_AOVS"] = 1;
  kernels.there_aovs = kernels.wanted_aovs;
  kernels.first_surfaces =
      scene_kernel<Buffer<u32>, Buffer<u32>, Buffer<float4>, Buffer<u32>, u32, u32, u32, u32, u32>(
          build(device, "entry/aov.cl", config, kernels, times), "first_surfaces");
  limit_group(device.limits(kernels.first_surfaces).work_group, kernels.most_group);
}

std::size_t photon_group(const KernelConfig& config, std::size_t most_group) {
  constexpr std::size_t few = 4, many = 64;
  const std::size_t usual = config.tile_w * config.tile_h > 1 ? few : many;
  return most_group > 0 ? std::min(usual, most_group) : usual;
}

void add_photon_tracer(Device& device, FrameKernels& kernels, RenderTimes& times) {
  if (kernels.trace_photons.kernel()) return;
  kernels.trace_photons = scene_kernel<Buffer<u32>, Buffer<float4>, Buffer<u32>, PhotonLaunch>(
      build(device, photon_entry, kernels.config, kernels, times), photon_kernel);
  limit_group(device.limits(kernels.trace_photons).work_group, kernels.most_group);
}

KernelUpdate update_frame_kernels(Device& device, const CompiledScene& scene, const Tuning& tuning,
                                  const WorkGroup& asked, bool aovs, FrameKernels& kernels,
                                  RenderTimes& times) {
  KernelUpdate update;
  const Stopwatch building;
  device.build_with({.tuned = tuning.options});
  times.cached = true;
  renew_kernels(device, scene, tuning, asked, aovs, kernels, times, update);
  times.build_kernels = building.seconds();
  const Stopwatch uploading;
  if (kernels.tables.info.memory())
    update.uploads = update_scene(device, scene, kernels.tables);
  else {
    kernels.tables = upload_scene(device, scene);
    update.uploads = {0, table_bytes(scene)};
    for_each_table(scene, [&](const char*, const auto& table) { update.uploads.tables += !table.empty(); });
  }
  times.upload = uploading.seconds();
  renew_camera_media(device, scene, kernels);
  return update;
}

bool has_only_draft(const DeviceInfo& info, const CompiledScene& scene, const Tuning& tuning) {
  Device device(info);
  device.build_with({.tuned = tuning.options});
  const Integrator& integrator = integrator_of(scene.integrator);
  const auto has = [&](const KernelConfig& config) {
    return device.has(integrator.entry, config.defines(), config.generated) &&
           (!scene.features.caustics || device.has(photon_entry, config.defines(), config.generated));
  };
  return !has(make_kernel_config(scene, info, tuning)) && has(drawing_draft_config(scene, info, tuning));
}

}  // namespace sundog
