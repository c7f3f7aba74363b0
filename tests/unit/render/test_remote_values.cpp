// Values from a worker's process are checked where they are read.
#include "render/remote/remote_values.h"

#include "base/error.h"
#include "catch.h"
#include "render/remote/remote_worker.h"

using namespace sundog;
using nlohmann::json;

namespace {

const std::vector<std::string> no_aovs;

TileRequest asked_for() {
  TileRequest request;
  request.tile = {8, 4, 4, 4};
  return request;
}

TileResult made_of(const Tile& tile, std::size_t vectors = 0) {
  const auto pixels = static_cast<std::size_t>(tile.width * tile.height);
  TileResult result;
  result.tile = tile;
  result.sums.resize(pixels), result.weights.resize(pixels), result.aovs.resize(vectors * pixels);
  return result;
}

TileResult sent(const TileResult& result, const TileRequest& request,
                const std::vector<std::string>& aovs = no_aovs) {
  const PackedTile packed = pack_tile(result);
  return unpack_tile(packed.values, packed.data, request, aovs);
}

/// Answers each message with the same one.
class Echo : public Channel {
 public:
  explicit Echo(Message answer) : answer_(std::move(answer)) {}
  void send(const Message&) override {}
  std::optional<Message> receive(double) override { return answer_; }

 private:
  Message answer_;
};

}  // namespace

TEST_CASE("a tile from a worker is the one that was asked for, or its first rows") {
  CHECK(sent(made_of({8, 4, 4, 4}), asked_for()).sums.size() == 16);
  CHECK(sent(made_of({8, 4, 4, 2}), asked_for()).sums.size() == 8);
  for (const Tile& other : {Tile{0, 4, 4, 4}, Tile{8, 5, 4, 4}, Tile{8, 4, 8, 4}, Tile{8, 4, 4, 5},
                            Tile{1 << 20, 4, 4, 4}, Tile{8, -4, 4, 4}})
    CHECK_THROWS_AS(sent(made_of(other), asked_for()), DeviceError);
  PackedTile negative = pack_tile(made_of({8, 4, 4, 4}));
  negative.values["tile"]["width"] = -4;
  negative.values["tile"]["height"] = -4;
  CHECK_THROWS_AS(unpack_tile(negative.values, negative.data, asked_for(), no_aovs), DeviceError);
}

TEST_CASE("a tile from a worker has the arrays that its frame wants, for all pixels or none") {
  CHECK_THROWS_AS(sent(made_of({8, 4, 4, 4}, 3), asked_for()), DeviceError);  // the frame has no AOVs
  TileRequest surfaces = asked_for();
  surfaces.surfaces = true;
  CHECK(sent(made_of({8, 4, 4, 4}, 3), surfaces, {"depth"}).aovs.size() == 48);
  CHECK_THROWS_AS(sent(made_of({8, 4, 4, 4}, 9), surfaces, {"depth"}), DeviceError);
  CHECK_THROWS_AS(sent(made_of({8, 4, 4, 4}, 3), surfaces, {"uv"}), DeviceError);
  TileResult with_rays = made_of({8, 4, 4, 4});
  with_rays.rays.resize(16);
  CHECK(sent(with_rays, asked_for(), {"rays"}).rays.size() == 16);
  CHECK_THROWS_AS(sent(with_rays, asked_for()), DeviceError);
}

TEST_CASE("a request for a tile that no frame has, or with values for some of its pixels, is refused") {
  TileRequest request = asked_for();
  request.sums.resize(16), request.weights.resize(16);
  const PackedTile good = pack_request(request);
  CHECK(unpack_request(good.values, good.data).sums.size() == 16);
  for (const json& change : {json{{"/tile/width", -1}}, json{{"/tile/width", 1 << 30}},
                             json{{"/pass/sums", 15}}, json{{"/pass/sums", std::size_t(-1)}},
                             json{{"/pass/rays", 3}}, json{{"/pass/pixels", std::size_t{1} << 62}}}) {
    json values = good.values.flatten();
    values.update(change);
    CAPTURE(change.dump());
    CHECK_THROWS_AS(unpack_request(values.unflatten(), good.data), DeviceError);
  }
}

TEST_CASE("a worker's answer that makes no sense is a failure of its device") {
  for (const json& values : {json(nullptr), json{{"job", 0}}, json{{"figures", 3}, {"tile", "x"}}}) {
    RemoteDevice device;
    device.settings = {{"aovs", json::array()}};
    device.connect = [&] { return std::make_unique<Echo>(Message{Message::ready, values, {}}); };
    RemoteWorker worker(device);
    CHECK_THROWS_AS(worker.open(), DeviceError);
  }
}
