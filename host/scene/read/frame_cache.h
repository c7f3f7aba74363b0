// Keeps files and generated meshes between frames of an animation, so that they are read and generated once.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "models/model.h"

namespace sundog {

/// Keeps the results of one frame for the next, and drops those that a frame did not request.
class FrameCache {
 public:
  /// The model or generated mesh that `content` identifies, for the object at `place`; calls `read` if it is
  /// not kept. While frames are only checked, the place's last model replaces one that would have to be read.
  Model model(const std::string& content, const std::string& place, const std::function<Model()>& read);
  Image picture(const std::string& file, const std::function<Image()>& read);
  /// Decodes the image with `read`, or copies the result of equal bytes with the same use.
  void decode(ImageDescription& image, const std::function<void(ImageDescription&)>& read);

  /// Whether frames are only checked from now on, or read in full.
  void check(bool only) { checks_ = only; }
  bool checks() const { return checks_; }
  /// Drops everything not requested since the last call.
  void end_frame();

 private:
  template <class T>
  struct Kept {
    std::shared_ptr<const T> value;
    bool asked = true;
  };
  std::map<std::string, Kept<Model>> models_;
  std::map<std::string, Kept<Image>> pictures_;
  std::map<std::string, Kept<ImageDescription>> images_;
  std::map<std::string, std::shared_ptr<const Model>> at_;  // each place's last model
  bool checks_ = false;
  std::mutex mutex_;  // guards images_, because several are decoded at once
};

/// Moves the mesh's arrays into shared storage, so that its copies share them.
void share_vertices(Mesh& mesh);

}  // namespace sundog
