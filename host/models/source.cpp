// Reads a model file, decompressing gzip within a limit.
#include "models/source.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "base/input.h"

namespace sundog::models {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 31;
// Vertex text compresses to between a tenth and a third; gzip reaches a thousandth.
constexpr std::size_t most_growth = 100, grows_freely = std::size_t{64} << 20;

class Inflater {
 public:
  Inflater() { ready_ = inflateInit2(&stream_, 15 + 16) == Z_OK; }  // + 16: expect a gzip header
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  // Several members may follow each other, as in `cat a.gz b.gz`.
  std::string unpack(const std::string& packed, const fs::path& path) {
    const auto broken = [&](const char* why) {
      return SceneError(path.string(), fmt::format("byte {}", packed.size() - stream_.avail_in),
                        fmt::format("the gzip data is broken: {}", why));
    };
    if (!ready_) throw broken("zlib did not start");
    if (packed.size() > most_bytes) throw broken("more than 2 GiB");
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib only reads it
    stream_.avail_in = static_cast<uInt>(packed.size());
    const std::size_t bound = std::max(grows_freely, most_growth * packed.size());
    std::string out;
    for (int status = Z_OK;;) {
      if (status == Z_STREAM_END) {
        if (stream_.avail_in == 0) return out;
        if (inflateReset(&stream_) != Z_OK) throw broken("a second member");
      }
      const std::size_t done = out.size();
      if (done >= most_bytes) throw broken("it unpacks to more than 2 GiB; unpack it and split the model");
      const std::size_t step = std::clamp<std::size_t>(done, packed.size() + 1024, std::size_t{1} << 26);
      out.resize(done + step);
      stream_.next_out = reinterpret_cast<Bytef*>(out.data() + done);
      stream_.avail_out = static_cast<uInt>(step);
      status = inflate(&stream_, Z_NO_FLUSH);
      out.resize(done + step - stream_.avail_out);
      if (out.size() > bound)
        throw SceneError(path.string(), "",
                         fmt::format("its {} bytes unpack to more than {} MiB, over {} times as much, which "
                                     "no model does; where one should, unpack it with gunzip",
                                     packed.size(), bound >> 20, most_growth));
      if (status == Z_BUF_ERROR || (status == Z_OK && stream_.avail_in == 0 && stream_.avail_out > 0))
        throw broken("it ends early");
      if (status != Z_OK && status != Z_STREAM_END) throw broken(stream_.msg ? stream_.msg : "not gzip data");
    }
  }

 private:
  z_stream stream_{};
  bool ready_ = false;
};

}  // namespace

std::string model_extension(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".gz" ? lower_extension(path.stem()) : extension;
}

Source read_source(const fs::path& path) {
  Source source{path, read_input(path, most_bytes)};
  if (lower_extension(path) == ".gz") source.bytes = Inflater().unpack(source.bytes, path);
  // A binary STL may begin with any bytes; glTF forbids the mark.
  const std::string extension = model_extension(path);
  if (source.bytes.starts_with(byte_order_mark) && extension != ".stl" && extension != ".gltf")
    source.bytes.erase(0, byte_order_mark.size());
  return source;
}

void fail(const Source& source, const std::string& place, const std::string& what) {
  throw SceneError(source.path.string(), place, what);
}

void fail_at_byte(const Source& source, std::size_t byte, const std::string& what) {
  fail(source, fmt::format("byte {}", byte), what);
}

}  // namespace sundog::models
