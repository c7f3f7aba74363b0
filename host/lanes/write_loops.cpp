// Loops: lanes leave them one by one, and the loop ends when none is left.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

std::string all_of(const std::vector<std::string>& tests) {
  return tests.empty() ? "true" : fmt::format("{}", fmt::join(tests, " && "));
}

}  // namespace

void Writer::loop(const Statement& s) {
  const bool is_do = s.kind == Statement::Kind::do_loop;
  const Expression* asked = s.expressions[0].get();
  const Statement& body = *s.body[1];
  line("{");
  ++depth_;
  frames_.push_back({Frame::Kind::loop, &s, 0, s_.divergent_break.contains(&s), ""});
  if (s.body[0]) statement(*s.body[0]);
  const bool asks_lanes = asked && varies(*asked);
  const bool gives = exits_of(body).gives && s_.divergent_return;
  const bool parts = s_.divergent_break.contains(&s) || gives || asks_lanes;
  const bool rounds = s_.divergent_continue.contains(&s);
  const std::string outer = mask_;
  Loop entry{&s, mask_, mask_};
  if (parts || rounds) {
    entry.lanes = fresh("in");
    line(fmt::format("MASK {} = {};", entry.lanes, outer));
  }
  entry.going = rounds ? fresh("go") : entry.lanes;
  all_loops_.push_back(entry);
  if (parts || rounds) loops_.push_back(entry);
  mask_ = entry.lanes;

  // What the condition needs first, and the condition; what the step does.
  std::vector<std::string> tests;
  const std::size_t begin = out_.size();
  if (asked && !asks_lanes) tests.push_back(plain(*asked));
  if (parts)
    tests.push_back(asks_lanes ? fmt::format("any_lane({} &= {})", entry.lanes, mask_of(*asked))
                               : fmt::format("any_lane({})", entry.lanes));
  std::vector<Line> before(std::make_move_iterator(out_.begin() + static_cast<std::ptrdiff_t>(begin)),
                           std::make_move_iterator(out_.end()));
  out_.resize(begin);
  const std::string step = s.expressions[1] ? computed(*s.expressions[1]) : "";
  if (out_.size() != begin)
    fail(s.expressions[1]->place, "the step of a loop is simple: put this into its body");
  std::erase(tests, "true");

  const bool asks_later = is_do && (!before.empty() || rounds);
  const std::string leave = fmt::format("  if (!({})) break;", all_of(tests));
  std::size_t head = out_.size();
  const auto deeper = [&](int more) {
    for (Line& l : before) l.depth += more;
    out_.insert(out_.end(), before.begin(), before.end());
  };
  if (asks_later) {
    const std::string again = fresh("again");
    line(fmt::format("bool {} = false;", again));
    line("while (true) {");
    line(fmt::format("  if ({}) {{", again));
    deeper(2);
    line("  " + leave);
    line("  }");
    line(fmt::format("  {} = true;", again));
  } else if (!before.empty()) {
    line(fmt::format("for (;; {}) {{", step));
    deeper(1);
    line(leave);
  } else if (is_do) {
    line("do {");
  } else {
    head = out_.size();
    line(fmt::format("for (; {}; {}) {{", all_of(tests), step));
  }
  if (rounds) line(fmt::format("  MASK {} = {};", entry.going, entry.lanes));
  inside({Frame::Kind::round, &s, 0, rounds, ""}, entry.going, body);
  if (checked_.contains(entry.lanes) && !is_do && before.empty() && !asks_lanes) {
    const std::string test = fmt::format("any_lane({})", entry.lanes);
    std::erase(tests, test);
    out_[head].text = fmt::format("for (; {}; {}) {{", all_of(tests), step);
  }
  if (is_do && !asks_later) {
    std::ranges::reverse(tests);
    line(fmt::format("}} while ({});", all_of(tests)));
  } else {
    line("}");
  }
  all_loops_.pop_back();
  if (parts || rounds) loops_.pop_back();
  mask_ = outer;
  if (gives && outer != "m_") line(fmt::format("{} &= {};", outer, alive()));
  frames_.pop_back();
  --depth_;
  line("}");
}

}  // namespace sundog::spmd
