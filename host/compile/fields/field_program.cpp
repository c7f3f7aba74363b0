// Flattens statements to instructions over unlimited values, with calls inlined, then assigns registers by
// first and last use, and encodes the instructions.
#include "compile/fields/field_program.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <optional>
#include <utility>

namespace sundog {
namespace {

constexpr std::size_t max_table = 0xFFFF;  // the largest number in half a word

/// Thrown for code that programs cannot express.
struct NoProgram {};

std::size_t registers_of(FieldType type) {
  return type == FieldType::sample ? 8 : type == FieldType::point ? 3 : 1;
}

/// A value's registers from `part` on.
struct ValuePlace {
  std::size_t value = 0, part = 0;
};

struct Instruction {
  u32 op = FIELD_COPY;
  std::optional<ValuePlace> result = {};
  std::vector<ValuePlace> operands = {};
  u32 low = 0, high = 0;                   // halves of the second word; `low` replaces operands C and D
  u32 x = 0;                               // the second word, if a literal or a number
  std::optional<std::size_t> target = {};  // a label
  u32 counter = 0;                         // in counter instructions, replaces the result
};

struct StoredValue {
  std::size_t registers = 1, first = 0, last = 0, at = 0;
  bool is_used = false;
};

/// Emits a function and its callees.
class Flattener {
 public:
  /// `hoists`: loads the numbers that a loop uses before the loop, at the cost of a register each.
  Flattener(const FieldCode& code, bool hoists) : hoists_(hoists) {
    const ValuePlace point = add_value(3), active = add_value(1);
    const ValuePlace result = write(code, point, active, 0);
    add({.op = FIELD_END, .operands = {result}});
  }

  std::vector<Instruction> instructions;
  std::vector<StoredValue> values;
  std::vector<std::size_t> labels;                         // the instruction after each label
  std::vector<std::pair<std::size_t, std::size_t>> loops;  // their begin and end labels, inner loops first

 private:
  struct Scope {
    FieldStatement::Kind kind;
    std::size_t begin = 0, out = 0;  // labels
    u32 counter = 0, turn = 0;
    std::size_t next = 0;  // label of the next alternative or cell
    bool is_outermost = false;
  };

  ValuePlace add_value(std::size_t registers) {
    values.push_back({.registers = registers});
    return {values.size() - 1, 0};
  }
  std::size_t add_label() {
    labels.push_back(0);
    return labels.size() - 1;
  }
  void put(std::size_t label) { labels[label] = instructions.size(); }
  void add(Instruction instruction) {
    if (instructions.size() >= max_program) throw NoProgram{};
    instructions.push_back(std::move(instruction));
  }
  u32 take_counter() {
    if (counters_ >= FIELD_COUNTERS) throw NoProgram{};
    return counters_++;
  }
  static u32 half(std::size_t number) {
    if (number > max_table) throw NoProgram{};
    return static_cast<u32>(number);
  }

  /// A number in a register: hoisted before the outermost loop, or loaded here.
  ValuePlace load(u32 op, u32 x) {
    if (loop_depth_ > 0 && hoists_) {
      const auto [found, is_new] = hoisted_.try_emplace({op, x});
      if (is_new) found->second = add_value(1);
      return found->second;
    }
    const ValuePlace place = add_value(1);
    add({.op = op, .result = place, .x = x});
    return place;
  }

  struct Frame {
    std::vector<ValuePlace> variables;
    std::size_t table = 0;
    std::vector<Scope> scopes;
    u32 iteration = 0;  // loop counter
  };

  ValuePlace place(const Frame& frame, const Operand& operand) {
    switch (operand.kind) {
      case Operand::Kind::variable: {
        ValuePlace found = frame.variables[operand.index];
        if (operand.part > 0) found.part += static_cast<std::size_t>(operand.part);
        return found;
      }
      case Operand::Kind::table:
        return load(FIELD_NUMBER, half(frame.table + operand.index));
      default:
        return load(FIELD_LITERAL, std::bit_cast<u32>(static_cast<float>(operand.value)));
    }
  }

  ValuePlace write(const FieldCode& code, const ValuePlace& point, const ValuePlace& active,
                   std::size_t table) {
    Frame frame;
    frame.table = table;
    frame.variables.resize(code.variables().size());
    frame.variables[0] = point;
    frame.variables[1] = active;
    for (const FieldStatement& s : code.statements()) write(frame, code, s);
    return place(frame, code.result());
  }

  void write(Frame& frame, const FieldCode& code, const FieldStatement& s) {
    using Kind = FieldStatement::Kind;
    const auto result = [&] {
      if (s.declares) frame.variables[s.result] = add_value(registers_of(code.variables()[s.result].type));
      return frame.variables[s.result];
    };
    switch (s.kind) {
      case Kind::compute:
        return compute(frame, s, result);
      case Kind::assemble: {
        const ValuePlace whole = result();
        for (std::size_t i = 0; i < s.operands.size(); ++i)
          add({.op = FIELD_COPY,
               .result = ValuePlace{whole.value, i},
               .operands = {place(frame, s.operands[i])}});
        return;
      }
      case Kind::call:
        if (!s.callee) throw NoProgram{};
        frame.variables[s.result] =
            write(*s.callee, place(frame, s.operands[0]), frame.variables[1], frame.table + s.number);
        return;
      case Kind::leave: {
        const Scope& loop = *std::find_if(frame.scopes.rbegin(), frame.scopes.rend(),
                                          [](const Scope& scope) { return scope.kind == Kind::iterate; });
        add({.op = FIELD_LEAVE, .operands = {place(frame, s.operands[0])}, .target = loop.out});
        return;
      }
      case Kind::iterate:
      case Kind::cells:
        return begin_loop(frame, s);
      case Kind::take_turn: {
        Scope turns{.kind = s.kind, .out = add_label(), .turn = take_counter(), .next = add_label()};
        add({.op = FIELD_MODULO,
             .operands = {},
             .x = static_cast<u32>(s.number),
             .counter = turns.turn | frame.iteration << 8});
        below(turns.turn, s.end, turns.next);
        frame.scopes.push_back(turns);
        return;
      }
      case Kind::next_turn: {
        Scope& turns = frame.scopes.back();
        add({.op = FIELD_JUMP, .target = turns.out});
        put(turns.next);
        turns.next = add_label();
        if (s.end) below(turns.turn, s.end, turns.next);
        return;
      }
      case Kind::end:
        return end(frame);
    }
  }

  template <class Result>
  void compute(const Frame& frame, const FieldStatement& s, const Result& result) {
    Instruction made{.op = s.op};
    for (const Operand& operand : s.operands) made.operands.push_back(place(frame, operand));
    const std::size_t number = s.op == FIELD_INVERSE_ROOT ? s.number : frame.table + s.number;
    made.high = half(number);
    if (s.op == FIELD_ITERATION || s.op == FIELD_LATE) made.low = frame.iteration << 8;
    if (s.op == FIELD_REPEAT_CELL) made.low = frame.scopes.back().counter << 8;
    made.result = result();
    add(std::move(made));
  }

  /// Jumps to `label` unless the counter is below `bound`.
  void below(u32 counter, std::size_t bound, std::size_t label) {
    add({.op = FIELD_BELOW, .high = half(bound), .target = label, .counter = counter});
  }

  void begin_loop(Frame& frame, const FieldStatement& s) {
    Scope loop{.kind = s.kind, .begin = add_label(), .out = add_label(), .counter = take_counter()};
    add({.op = FIELD_START, .counter = loop.counter});
    loop.is_outermost = loop_depth_++ == 0;
    if (loop.is_outermost) outside_ = std::exchange(instructions, {});
    put(loop.begin);
    if (s.kind == FieldStatement::Kind::iterate) {
      frame.iteration = loop.counter;
      add({.op = FIELD_WHILE,
           .high = half(frame.table + s.number),
           .target = loop.out,
           .counter = loop.counter});
    } else {
      below(loop.counter, 8, loop.out);
      loop.next = add_label();
      add({.op = FIELD_SKIP,
           .high = static_cast<u32>(~s.number & 7u),
           .target = loop.next,
           .counter = loop.counter});
    }
    frame.scopes.push_back(loop);
  }

  void end(Frame& frame) {
    const Scope scope = frame.scopes.back();
    frame.scopes.pop_back();
    if (scope.kind == FieldStatement::Kind::take_turn) {
      put(scope.next);
      put(scope.out);
      --counters_;
      return;
    }
    if (scope.kind == FieldStatement::Kind::cells) put(scope.next);
    add({.op = FIELD_NEXT, .target = scope.begin, .counter = scope.counter});
    put(scope.out);
    loops.emplace_back(scope.begin, scope.out);
    --counters_;
    --loop_depth_;
    if (scope.is_outermost) insert_hoisted();
  }

  /// Inserts the hoisted loads before the outermost loop.
  void insert_hoisted() {
    std::vector<Instruction> inside = std::exchange(instructions, std::move(outside_));
    for (const auto& [number, place] : hoisted_)
      add({.op = number.first, .result = place, .x = number.second});
    hoisted_.clear();
    const std::size_t shift = instructions.size();
    for (std::size_t label = first_label_; label < labels.size(); ++label) labels[label] += shift;
    first_label_ = labels.size();
    for (Instruction& one : inside) add(std::move(one));
  }

  bool hoists_;
  std::vector<Instruction> outside_;
  std::map<std::pair<u32, u32>, ValuePlace> hoisted_;
  std::size_t first_label_ = 0;
  u32 counters_ = 0;
  int loop_depth_ = 0;
};

/// Assigns registers to values.
class Allocator {
 public:
  explicit Allocator(Flattener& code) : code_(code) {
    find_lives();
    values_by_last_.resize(code_.instructions.size());
    for (std::size_t i = 0; i < code_.values.size(); ++i)
      if (code_.values[i].is_used) values_by_last_[code_.values[i].last].push_back(i);
    take(code_.values[0]);
    take(code_.values[1]);
    for (std::size_t at = 0; at < code_.instructions.size(); ++at) {
      // Values read for the last time here free their registers for the result.
      for (const std::size_t i : values_by_last_[at])
        if (code_.values[i].first < at || i < 2) release(code_.values[i]);
      if (const auto& result = code_.instructions[at].result) {
        StoredValue& value = code_.values[result->value];
        if (value.first == at) take(value);
        if (value.first == at && value.last == at) release(value);
      }
    }
  }

 private:
  void use(const ValuePlace& place, std::size_t at) {
    StoredValue& value = code_.values[place.value];
    if (!std::exchange(value.is_used, true)) value.first = place.value < 2 ? 0 : at;
    value.last = std::max(value.last, at);
  }

  void find_lives() {
    for (std::size_t at = 0; at < code_.instructions.size(); ++at) {
      for (const ValuePlace& place : code_.instructions[at].operands) use(place, at);
      if (const auto& result = code_.instructions[at].result) use(*result, at);
    }
    for (const auto& [begin_label, out_label] : code_.loops) {
      const std::size_t begin = code_.labels[begin_label], end = code_.labels[out_label] - 1;
      for (StoredValue& value : code_.values)
        if (value.first < begin && value.last >= begin) value.last = std::max(value.last, end);
    }
  }

  void take(StoredValue& value) {
    std::size_t run = 0;
    for (std::size_t i = 0; i < FIELD_REGISTERS; ++i) {
      run = taken_[i] ? 0 : run + 1;
      if (run < value.registers) continue;
      value.at = i + 1 - run;
      std::fill_n(taken_.begin() + static_cast<std::ptrdiff_t>(value.at), run, true);
      return;
    }
    throw NoProgram{};
  }
  void release(const StoredValue& value) {
    std::fill_n(taken_.begin() + static_cast<std::ptrdiff_t>(value.at), value.registers, false);
  }

  Flattener& code_;
  std::vector<std::vector<std::size_t>> values_by_last_;
  std::array<bool, FIELD_REGISTERS> taken_{};
};

void append_words(const Flattener& code, const Instruction& one, std::vector<u32>& words) {
  const auto at = [&](const ValuePlace& place) {
    return static_cast<u32>(code.values[place.value].at + place.part);
  };
  std::array<u32, 4> operands{};
  std::transform(one.operands.begin(), one.operands.end(), operands.begin(), at);
  u32 first = one.op | operands[0] << 16 | operands[1] << 24;
  if (one.result)
    first |= at(*one.result) << 8;
  else
    first |= one.counter << 8;
  u32 second = one.low | one.high << 16 | operands[2] | operands[3] << 8 | one.x;
  if (one.target) second |= static_cast<u32>(code.labels[*one.target]);
  words.insert(words.end(), {first, second});
}

std::vector<u32> words_of(const FieldCode& function, bool hoists) {
  try {
    Flattener code(function, hoists);
    const Allocator registers(code);
    std::vector<u32> words;
    for (const Instruction& one : code.instructions) append_words(code, one, words);
    return words;
  } catch (const NoProgram&) {
    return {};
  }
}

}  // namespace

std::vector<u32> field_program(const FieldCode& code) {
  std::vector<u32> words = words_of(code, true);
  return words.empty() ? words_of(code, false) : words;
}

std::vector<u32> field_programs(std::span<const std::vector<FieldCode>> functions) {
  std::vector<u32> words(functions.size() * FIELD_FUNCTIONS, 0);
  const std::size_t directory = words.size();
  for (std::size_t field = 0; field < functions.size(); ++field)
    for (std::size_t i = 0; i < functions[field].size(); ++i) {
      const std::vector<u32> program = field_program(functions[field][i]);
      if (program.empty() || words.size() - directory + program.size() > 2 * max_program) return {};
      words[field * FIELD_FUNCTIONS + i] = static_cast<u32>(words.size());
      words.insert(words.end(), program.begin(), program.end());
    }
  return words;
}

}  // namespace sundog
