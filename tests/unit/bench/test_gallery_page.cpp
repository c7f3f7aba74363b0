// The gallery's page of HTML shows its pictures and figures, and escapes its data.
#include <string>

#include "bench/report/gallery_page.h"
#include "catch.h"

using namespace sundog;

namespace {

bool has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a gallery's page has each picture with its rays, rate and command, and no markup of its data") {
  GalleryPicture ice{"ice <1>", "ice.png", "sundog render ice.json -o \"ice.png\"", 640, 480, 4, 0.5, {}};
  ice.rays = {{"primary", 1'228'800}, {"reflection", 0}, {"shadow", 771'200}};
  const std::string page = gallery_html({"A gallery & more", {{"device", "0:0 <any>"}}, {ice, ice}});
  CHECK(has(page, "<title>A gallery &amp; more</title>"));
  CHECK(has(page, "0:0 &lt;any&gt;"));
  CHECK(has(page, "<h2>ice &lt;1&gt;</h2>"));
  CHECK(has(page, "src=\"ice.png\" alt=\"The scene ice &lt;1&gt;\" width=\"640\" height=\"480\""));
  CHECK(has(page, "640 x 480, 4 samples a pixel, 500 ms"));
  CHECK(has(page, "2 million rays, 4 million a second (1.23 million primary, 771 thousand shadow)"));
  CHECK(has(page, "-o &quot;ice.png&quot;"));
  std::size_t articles = 0;
  for (std::size_t at = 0; (at = page.find("<article>", at)) != std::string::npos; ++at) ++articles;
  CHECK(articles == 2);
  CHECK_FALSE(has(page, "<script"));
}
