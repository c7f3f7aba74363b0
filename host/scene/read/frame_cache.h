// Keeps files and generated meshes between frames of an animation, so that they are read and made once.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "models/model.h"

namespace sundog {

/// A thing of one frame is found again in the next; what a frame has not asked for is dropped behind it.
class FrameCache {
 public:
  /// The model, or the generated mesh, that `content` says all about; `place` wants it. While frames are
  /// checked alone, another model of that place stands for one that would have to be read.
  Model model(const std::string& content, const std::string& place, const std::function<Model()>& read);
  Image picture(const std::string& file, const std::function<Image()>& read);
  /// Decodes the image, or takes what came of the same bytes for the same use.
  void decode(ImageDescription& image, const std::function<void(ImageDescription&)>& read);

  /// From now on frames are read in full, or only checked.
  void check(bool only) { checks_ = only; }
  bool checks() const { return checks_; }
  /// Drops what was not asked for since the last call.
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
  std::map<std::string, std::shared_ptr<const Model>> at_;  // the last model of each place
  bool checks_ = false;
  std::mutex mutex_;  // of images_: several are decoded at once
};

/// Copies hold the same vertices.
void share_vertices(Mesh& mesh);

}  // namespace sundog
