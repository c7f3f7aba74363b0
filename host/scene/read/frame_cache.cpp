// Keeps everything that a frame requested, and drops the rest at the frame's end.
#include "scene/read/frame_cache.h"

#include <fmt/format.h>

#include "base/pixels/stored_image.h"

namespace sundog {
namespace {

/// The map's entry of this name; if missing, filled by `make`.
template <class Map, class Make>
const auto& kept(Map& map, const std::string& name, const Make& make) {
  const auto [found, added] = map.try_emplace(name);
  found->second.asked = true;
  if (!found->second.value) found->second.value = make();
  return *found->second.value;
}

}  // namespace

void share_vertices(Mesh& mesh) {
  const auto share = [](auto& array) {
    using Array = std::remove_reference_t<decltype(array)>;
    const auto owner =
        std::make_shared<const std::vector<typename Array::value_type>>(std::move(array.values()));
    array = Array::held(*owner, owner);
  };
  share(mesh.positions), share(mesh.normals), share(mesh.uvs);
  share(mesh.tangents), share(mesh.colors), share(mesh.alphas), share(mesh.triangles);
}

Model FrameCache::model(const std::string& content, const std::string& place,
                        const std::function<Model()>& read) {
  std::shared_ptr<const Model>& at = at_[place];
  if (checks_ && at && !models_.contains(content)) return *at;
  const Model& model = kept(models_, content, [&] {
    auto made = std::make_shared<Model>(read());
    for (Mesh& mesh : made->meshes) share_vertices(mesh);
    return made;
  });
  at = models_.at(content).value;
  return model;
}

Image FrameCache::picture(const std::string& file, const std::function<Image()>& read) {
  return kept(pictures_, file, [&] { return std::make_shared<const Image>(read()); });
}

void FrameCache::decode(ImageDescription& image, const std::function<void(ImageDescription&)>& read) {
  const std::string content = fmt::format("{} {} {} {}", std::hash<std::string>()(image.encoded),
                                          image.encoded.size(), image.srgb, image.plain);
  std::shared_ptr<const ImageDescription> known;
  {
    const std::lock_guard lock(mutex_);
    Kept<ImageDescription>& entry = images_[content];
    entry.asked = true;
    known = entry.value;
  }
  if (!known) {
    read(image);
    const std::lock_guard lock(mutex_);
    images_[content].value = std::make_shared<const ImageDescription>(image);
    return;
  }
  image.encoded.clear();
  image.pixels = known->pixels;
  image.file_width = known->file_width, image.file_height = known->file_height;
  image.content = known->content;
}

void FrameCache::end_frame() {
  const auto drop = [](auto& map) {
    std::erase_if(map, [](const auto& entry) { return !entry.second.asked; });
    for (auto& [name, kept] : map) kept.asked = false;
  };
  drop(models_), drop(pictures_), drop(images_);
  if (!checks_) at_.clear();
}

}  // namespace sundog
