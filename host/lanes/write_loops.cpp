// Writes loops, break, continue and return: lanes leave one by one, and a loop ends when no lane is left.
#include "lanes/writer.h"

namespace sundog::spmd {
namespace {

std::string all_of(const std::vector<std::string>& tests) {
  return tests.empty() ? "true" : fmt::format("{}", fmt::join(tests, " && "));
}

}  // namespace

std::string Writer::alive() const {
  const auto masked = std::find_if(loops_.rbegin(), loops_.rend(), [](const Loop& l) { return l.masked; });
  return masked == loops_.rend() ? "m_" : masked->going;
}

void Writer::loop(const Statement& s) {
  const bool rounds = s_.divergent_continue.contains(&s);
  const Expression& asked = *s.expressions[0];
  const Statement& body = *s.body[1];
  const std::string outer = mask_;
  line("{");
  ++depth_;
  frames_.push_back({Frame::Kind::loop, &s, s_.divergent_break.contains(&s)});
  statement(*s.body[0]);
  const bool asks_lanes = varies(asked), gives = exits_of(body).gives && s_.divergent_return;
  const bool parts = frames_.back().divergent || gives || asks_lanes;
  Loop entry{&s, mask_, mask_, parts || rounds};
  if (entry.masked) {
    entry.lanes = fresh("in");
    line("MASK {} = {};", entry.lanes, outer);
  }
  entry.going = rounds ? fresh("go") : entry.lanes;
  loops_.push_back(entry);
  mask_ = entry.lanes;

  // Lines that compute the condition, the condition itself, and the step.
  const std::size_t begin = out_.size();
  std::vector<std::string> tests;
  if (!asks_lanes) tests.push_back(value(asked));
  std::erase(tests, "true");
  if (parts)
    tests.push_back(asks_lanes ? fmt::format("any_lane({} &= {})", entry.lanes, mask_of(asked))
                               : fmt::format("any_lane({})", entry.lanes));
  std::vector<Line> before(out_.begin() + static_cast<std::ptrdiff_t>(begin), out_.end());
  out_.resize(begin);
  const std::string step = s.expressions.size() > 1 ? computed(*s.expressions[1]) : "";
  if (out_.size() != begin)
    fail(s.expressions[1]->place, "the step of a loop is simple: put this into its body");

  line("for (;; {}) {{", step);
  const std::size_t head = out_.size() - 1;
  if (!before.empty()) {
    for (Line& l : before) ++l.depth;
    out_.insert(out_.end(), before.begin(), before.end());
    line("  if (!({})) break;", all_of(tests));
  }
  if (rounds) line("  MASK {} = {};", entry.going, entry.lanes);
  inside({Frame::Kind::round, &s, rounds}, entry.going, body);
  if (before.empty()) {
    if (loops_.back().checked && !asks_lanes) std::erase(tests, fmt::format("any_lane({})", entry.lanes));
    out_[head].text = fmt::format("for (; {}; {}) {{", all_of(tests), step);
  }
  line("}");
  loops_.pop_back();
  mask_ = outer;
  if (gives && outer != "m_") line("{} &= {};", outer, alive());
  frames_.pop_back();
  --depth_;
  line("}");
}

void Writer::leave(const Statement& s) {
  const bool breaks = s.is(Statement::Kind::leave_loop);
  const auto [left, divergent] = left_loop(s, frames_);
  const Loop& l = *std::ranges::find(loops_, left, &Loop::node);
  if (!divergent && (breaks || !s_.divergent_continue.contains(left)))
    return line(breaks ? "break;" : "continue;");
  const std::string gone = mask_;
  if (breaks) line("{} &= ~{};", l.lanes, gone);
  if (l.going != l.lanes) line("{} &= ~{};", l.going, gone);
  if (gone != l.going && gone != l.lanes) line("{} = NO_LANES;", gone);
}

void Writer::give(const Statement& s) {
  const bool gives = !s.expressions.empty();
  if (!s_.divergent_return) {
    if (!gives) return line("return;");
    return line("return {};", s_.result_varies ? lanes(*s.expressions[0]) : value(*s.expressions[0]));
  }
  if (gives && !s_.only_result) {
    const std::string value = lanes(*s.expressions[0]);
    const bool is_first = !returned_ && !comes_again();
    line("result_ = {};", is_first ? value : selected(s_.function.result, "result_", value, mask_, s.place));
  }
  if (!is_parted(frames_)) {
    returned_ |= !s_.only_result;
    const std::string result = s_.only_result ? s_.only_result->name : "result_";
    return line("return{};", gives ? " " + result : "");
  }
  returned_ = true;
  const std::string gone = mask_;
  std::set<std::string> seen{gone};
  const auto take_out = [&](const std::string& mask) {
    if (seen.insert(mask).second) line("{} &= ~{};", mask, gone);
  };
  take_out("m_");
  for (const Loop& l : loops_) {
    if (!l.masked) continue;
    take_out(l.lanes);
    take_out(l.going);
  }
  line("{} = NO_LANES;", gone);
}

void Writer::each_alike(const Statement& s) {
  const Variable& v = *s.variables[0];
  const Expression& of = *s.expressions[0];
  std::string all = simple(of);
  if (v.type.is_natural()) all = fmt::format("AS_MASK({})", all);
  const std::string left = fresh("left"), word = fresh("word"), mask = fresh("m");
  line("u32 {};", word);
  line("for (u32 {0} = lane_bits({1}); {0};) {{", left, mask_);
  line("  MASK {} = take_alike({}, &{}, &{});", mask, all, left, word);
  line("  const {0} {1} = ({0}){2};", type_text(v.type, false), v.name, word);
  inside({Frame::Kind::alike, &s, varies(of)}, mask, *s.body[0]);
  line("}");
  if (exits_of(*s.body[0]).gives && mask_ != "m_") line("{} &= m_;", mask_);
}

}  // namespace sundog::spmd
