// Checkpoints that no frame has written are refused where they are read.
#include "render/film/checkpoint.h"

#include <fstream>
#include <functional>

#include "base/error.h"
#include "catch.h"
#include "render/plan/passes.h"
#include "shared/sampler.h"
#include "temporary_folder.h"

using namespace sundog;

namespace {

constexpr int width = 33, height = 18;

/// The film of a frame in passes.
Film growing() { return {width, height, {.shows_surfaces = true, .grows = true, .keeps_earlier = true}}; }

}  // namespace

TEST_CASE("a checkpoint whose values no frame has is refused, whatever its checksum says") {
  const TemporaryFolder folder;
  const auto file = folder / "forged";
  SamplingPlan plan;
  plan.settings.threshold = 0.05, plan.samples = 32;
  const auto forge = [&](const std::function<void(Film&, Pass&, Film&)>& change) {
    Film film = growing();
    Pass pass = list_pass({3 | 4 << 16, 5 | 6 << 16}, 1, 1);
    Film made = film_of_pass(film, pass);
    film.stage = 1;
    film.allocate();
    change(film, pass, made);
    write_checkpoint(file, film, pass, made, 42);
    Film back = growing();
    Pass read;
    Film part;
    read_checkpoint(file, back, read, part, 42);
    return may_be_of(plan, read);
  };
  CHECK(forge([](Film&, Pass&, Film&) {}));
  for (const u32 pixel : {0x7fff7fffu, 0x00500000u, u32{width}, u32{height} << 16, 3u | 4u << 16})
    CHECK_THROWS_AS(forge([&](Film&, Pass& pass, Film&) { pass.pixels[1] = pixel; }), SceneError);
  CHECK_THROWS_AS(forge([](Film& film, Pass&, Film&) { film.states[7] = PixelState{9}; }), SceneError);
  CHECK_THROWS_AS(forge([](Film& film, Pass&, Film&) { film.done[7] = 2; }), SceneError);
  CHECK_THROWS_AS(forge([](Film&, Pass&, Film& made) { made.done[0] = 255; }), SceneError);
  CHECK_THROWS_AS(forge([](Film&, Pass& pass, Film&) { pass.surfaces = true; }), SceneError);
  CHECK_THROWS_AS(forge([](Film& film, Pass& pass, Film& made) {  // a list that is one pixel high
                    pass.width = 16 * pass.height / 4, pass.height = 1;
                    made = film_of_pass(film, pass);
                  }),
                  SceneError);
  CHECK_THROWS_AS(forge([](Film& film, Pass& pass, Film& made) {  // the image on its side
                    pass.width = height, pass.height = width;
                    pass.pixels.clear();
                    made = film_of_pass(film, pass);
                  }),
                  SceneError);
  CHECK_THROWS_AS(forge([](Film& film, Pass&, Film&) { film = growing(); }),
                  SceneError);                                    // sums are missing
  CHECK_THROWS_AS(forge([](Film& film, Pass& pass, Film& made) {  // complete before the first pass
                    film = growing(), pass = {}, made = {};
                  }),
                  SceneError);
  CHECK_FALSE(forge([](Film&, Pass& pass, Film&) { pass.first_sample = 31, pass.sample_count = 2; }));
  CHECK_FALSE(forge([](Film&, Pass& pass, Film&) { pass.sample_count = 0; }));
  CHECK_FALSE(forge([](Film&, Pass& pass, Film&) { pass.first_sample = 3, pass.sample_count = ~0u; }));
}

TEST_CASE("a short checkpoint of many pixels is refused by its length, before memory is taken") {
  const TemporaryFolder folder;
  const auto file = folder / "short";
  Film film = growing(), back = growing();
  Pass pass, read;
  pass.width = 10000, pass.height = 9000, pass.sample_count = 1;
  write_checkpoint(file, film, pass, {}, 42);
  Film part;
  CHECK_THROWS_WITH(read_checkpoint(file, back, read, part, 42), ContainsSubstring("10000x9000 pixels in"));
  CHECK(part.sums.empty());
  std::filesystem::resize_file(file, std::uintmax_t{1} << 40);  // sparse: it takes no room
  CHECK_THROWS_AS(read_checkpoint(file, back, read, part, 42), UsageError);
}

TEST_CASE("the checkpoint of a plain frame has its one pass, or the complete film") {
  const TemporaryFolder folder;
  const auto file = folder / "state";
  const SamplingPlan plan{{}, 4};
  const FilmNeeds plain{.layout = {}};
  Film film(width, height, plain);
  Pass pass = *next_pass(film, plan);
  CHECK(pass.sample_count == 4);
  const auto may_continue = [&](const Film& of, const Pass& in_hand, const Film& made) {
    write_checkpoint(file, of, in_hand, made, 42);
    Film back(width, height, plain), part;
    Pass read;
    read_checkpoint(file, back, read, part, 42);
    CHECK(back.sums.size() + part.sums.size() == film.pixels());
    return read.is_none() || may_be_of(plan, read);
  };
  Film made = film_of_pass(film, pass);
  CHECK(may_continue(film, pass, made));
  Pass fewer = pass;
  fewer.sample_count = 3;
  CHECK_FALSE(may_continue(film, fewer, made));
  fewer = pass, fewer.first_sample = 1;
  CHECK_THROWS_AS(may_continue(film, fewer, made), SceneError);
  made.done[5] = 3;
  CHECK_THROWS_AS(may_continue(film, pass, made), SceneError);
  add_pass(film, pass, film_of_pass(film, pass), true);
  CHECK_FALSE(next_pass(film, plan, pass));
  CHECK(may_continue(film, {}, {}));
  CHECK_THROWS_AS(may_continue(film, pass, film_of_pass(film, pass)), SceneError);  // it has no second pass
}

TEST_CASE("a checkpoint of another version is refused by its name") {
  const TemporaryFolder folder;
  for (const char* version : {"C1", "P3", "F9"}) {
    std::ofstream(folder / "old") << "SUNDOG" << version << std::string(200, '\0');
    Film film = growing(), part;
    Pass pass;
    try {
      read_checkpoint(folder / "old", film, pass, part, 42);
      FAIL("it was read");
    } catch (const UsageError& error) {
      CHECK_THAT(error.what(), ContainsSubstring("is a checkpoint of another version of sundog"));
      CHECK(error.remedy == Remedy::same_version);
    }
  }
}
