// Loops and ways out: lanes leave one by one, and a loop ends when none is left.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

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

  // Statements that compute the condition, the condition itself, and the step.
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

void Writer::leave(const Statement& s) {
  const bool breaks = s.kind == Statement::Kind::leave_loop;
  bool divergent = false;
  const Frame* loop = nullptr;
  for (auto f = frames_.rbegin(); f != frames_.rend() && !loop; ++f) {
    divergent |=
        f->divergent && (f->kind == Frame::Kind::branch || (f->kind == Frame::Kind::round && breaks));
    if (f->kind == Frame::Kind::loop) loop = &*f;
  }
  const Loop& l = *std::ranges::find(all_loops_, loop->node, &Loop::node);
  if (!divergent && (breaks || !s_.divergent_continue.contains(loop->node)))
    return line(breaks ? "break;" : "continue;");
  const std::string gone = mask_;
  if (breaks) line(fmt::format("{} &= ~{};", l.lanes, gone));
  if (l.going != l.lanes) line(fmt::format("{} &= ~{};", l.going, gone));
  if (gone != l.going && gone != l.lanes) line(fmt::format("{} = NO_LANES;", gone));
}

void Writer::give(const Statement& s) {
  const Type& type = s_.function.result;
  const bool gives = !s.expressions.empty();
  if (!s_.divergent_return) {
    if (!gives) return line("return;");
    const std::string value = s_.result_varies ? lanes(*s.expressions[0]) : plain(*s.expressions[0]);
    return line(fmt::format("return {};", value));
  }
  const bool parted = std::ranges::any_of(frames_, &Frame::divergent);
  if (gives && s_.only_result) {
    if (!parted) return line(fmt::format("return {};", s_.only_result->name));
  } else if (gives) {
    const std::string value = lanes(*s.expressions[0]);
    line(!returned_ && !comes_again()
             ? fmt::format("result_ = {};", value)
             : fmt::format("result_ = {};", selected(type, "result_", value, mask_, s.place)));
  }
  returned_ = true;
  if (!parted) return line(gives ? "return result_;" : "return;");
  const std::string gone = mask_;
  std::vector<std::string> masks{"m_"};
  for (const Loop& l : loops_) masks.insert(masks.end(), {l.lanes, l.going});
  std::set<std::string> seen{gone};
  for (const std::string& mask : masks)
    if (seen.insert(mask).second) line(fmt::format("{} &= ~{};", mask, gone));
  line(fmt::format("{} = NO_LANES;", gone));
}

void Writer::each_alike(const Statement& s) {
  const Variable& v = *s.variables[0];
  const Expression& of = *s.expressions[0];
  const std::string type = type_text(v.type, false);
  if (!varies(of)) {
    line("{");
    ++depth_;
    line(fmt::format("const {} {} = {};", type, v.name, plain(of)));
    --depth_;
    inside({Frame::Kind::alike, &s, 0, false, ""}, mask_, *s.body[0]);
    return line("}");
  }
  std::string all = simple(of);
  if (v.type.is(Type::Kind::natural)) all = fmt::format("AS_MASK({})", all);
  const std::string left = fresh("left"), word = fresh("word"), mask = fresh("m");
  line(fmt::format("u32 {};", word));
  line(fmt::format("for (u32 {0} = lane_bits({1}); {0};) {{", left, mask_));
  ++depth_;
  line(fmt::format("MASK {} = take_alike({}, &{}, &{});", mask, all, left, word));
  line(fmt::format("const {0} {1} = ({0}){2};", type, v.name, word));
  --depth_;
  frames_.push_back({Frame::Kind::alike, &s, 0, true, ""});
  s_.declare(&v, frames_);
  frames_.pop_back();
  inside({Frame::Kind::alike, &s, 0, true, ""}, mask, *s.body[0]);
  line("}");
  if (exits_of(*s.body[0]).gives && mask_ != "m_") line(fmt::format("{} &= m_;", mask_));
}

}  // namespace sundog::spmd
