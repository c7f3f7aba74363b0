// Content keys: which members of a description's parts count.
#include <boost/pfr.hpp>
#include <type_traits>

#include "catch.h"
#include "compile/content_key.h"

using namespace sundog;

namespace {

/// Indices of the numbers, texts and enumerators of a part that its key does not count.
template <class Part>
std::vector<std::size_t> uncounted(Part part) {
  std::vector<std::size_t> all;
  std::size_t index = 0;
  const ContentKey before = KeyMaker().add(part).key();
  boost::pfr::for_each_field(part, [&](auto& member) {
    using Member = std::remove_cvref_t<decltype(member)>;
    const Member kept = member;
    const std::size_t at = index++;
    if constexpr (std::is_same_v<Member, std::string>)
      member += "x";
    else if constexpr (std::is_enum_v<Member> || std::is_arithmetic_v<Member>)
      member = static_cast<Member>(member == Member{});
    else
      return;
    if (KeyMaker().add(part).key() == before) all.push_back(at);
    member = kept;
  });
  return all;
}

}  // namespace

TEST_CASE("content keys count every member but those that change no bytes") {
  using Indices = std::vector<std::size_t>;
  CHECK(uncounted(Camera()) == Indices{8});  // the shutter
  CHECK(uncounted(LightDescription()).empty());
  CHECK(uncounted(EnvironmentDescription()).empty());
  CHECK(uncounted(MediumDescription()) == Indices{0});                       // the name
  CHECK(uncounted(ImageDescription()) == Indices{0, 1, 2, 3, 4, 5, 9, 10});  // names, the file's own
  CHECK(uncounted(TextureDescription()) == Indices{0});
  CHECK(uncounted(MaterialDescription()) == Indices{0, 32, 33, 34, 35});  // displacement is in the meshes
  CHECK(uncounted(Mesh()) == Indices{0, 10});
  CHECK(uncounted(SdfDescription()) == Indices{0});
  CHECK(uncounted(SdfNode()).empty());
}

TEST_CASE("content keys count what a part holds by pointers, in lists and below") {
  const auto key = [](const auto& part) { return KeyMaker().add(part).key(); };
  MaterialDescription material, layered;
  layered.layers.emplace().coat_roughness = 0.5;
  CHECK(!(key(layered) == key(material)));
  SdfDescription field, inner;
  field.root.children.resize(1), inner.root.children.resize(1);
  inner.root.children[0].formula.steps.resize(1);
  CHECK(!(key(inner) == key(field)));
  CHECK(key(field) == key(SdfDescription(field)));
}
