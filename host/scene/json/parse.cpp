// Builds the document with a SAX handler that tracks the current JSON pointer, and explains errors in plain
// words.
#include "scene/json/parse.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/input.h"
#include "base/json_memory.h"
#include "scene/json/value.h"

namespace sundog {
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

std::string line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t last_break = before.rfind('\n');
  const std::size_t column = before.size() - (last_break == std::string_view::npos ? 0 : last_break + 1);
  return fmt::format("line {}, column {}", line, std::max<std::size_t>(column, 1));
}

/// Length of a well-formed UTF-8 sequence at `at`; 0 if ill-formed (RFC 3629: no surrogates, no overlong
/// forms).
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
  };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                             : (lead & 0xF0) == 0xE0        ? 3
                             : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                            : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
  const bool beyond = (lead == 0xED && byte(1) > 0x9F) || (lead == 0xF4 && byte(1) > 0x8F);
  return overlong || beyond ? 0 : length;
}

/// Phrases of the JSON library and the words that replace them.
constexpr std::pair<std::string_view, std::string_view> plain_words[] = {
    {"; expected '}'", "; expected ',' or '}'"},
    {"; expected ']'", "; expected ',' or ']'"},
    {"; expected string literal", "; expected a key in double quotes"},
    {"key - unexpected number literal", "key - unexpected number literal (1.5 is written with a point)"},
    {"invalid literal \"#\"", "invalid literal \"#\": a comment begins with //"},
    {"control character U+000A (LF) must be escaped to \\u000A or \\n",
     "wanted a closing quote in this line"},
    {"control character U+000D (CR) must be escaped to \\u000D or \\r",
     "wanted a closing quote in this line"},
    {"forbidden character after backslash", "wanted \\\\ for a backslash, or / between folders"},
    {"'\\u' must be", "wanted \\\\ for a backslash, or / between folders; '\\u' must be"}};

/// The word or sign that ends at `end`.
std::string_view word_at(std::string_view text, std::size_t end) {
  const auto in_word = [&](std::size_t i) { return std::isalnum(static_cast<unsigned char>(text[i])) != 0; };
  end = std::clamp<std::size_t>(end, 1, text.size());
  std::size_t begin = end - 1;
  if (!in_word(begin)) return text.substr(begin, utf8_length(text, begin));
  while (begin > 0 && in_word(begin - 1)) --begin;
  while (end < text.size() && in_word(end)) ++end;
  return text.substr(begin, std::min<std::size_t>(end - begin, 20));
}

/// The position of the unterminated comment.
std::size_t open_comment(std::string_view text) {
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '\\') ++at;
    } else if (text.substr(at, 2) == "//") {
      at = text.find('\n', at);
    } else if (text.substr(at, 2) == "/*") {
      const std::size_t end = text.find("*/", at + 2);
      if (end == text.npos) return at;
      at = end + 1;
    }
    if (at == text.npos) break;
  }
  return 0;
}

/// Reduces the library's message, "[json.exception...] parse error at line 1, column 2: what; last read:
/// '...'", to `what`: the last read may be the whole file and may end within a character.
std::string plain_message(std::string message, std::string_view found) {
  if (message.starts_with('[')) message.erase(0, message.find("] ") + 2);
  if (message.starts_with("parse error")) message.erase(0, message.find(": ") + 2);
  if (const auto read = message.find("; last read: '"); read != std::string::npos) {
    const auto rest = message.rfind("'; expected ");
    message.erase(read, rest == std::string::npos ? rest : rest + 1 - read);
    if (message.ends_with("value - invalid literal"))
      message += "; expected '{', '[', a number such as 0.5, true, false or a text in double quotes";
    if (const std::string_view literal = "invalid literal"; message.find(literal) != std::string::npos)
      message.insert(message.find(literal) + literal.size(),
                     " " + json(found).dump(-1, ' ', true, json::error_handler_t::replace));
  }
  for (const auto& [phrase, plain] : plain_words)
    if (const auto at = message.find(phrase); at != std::string::npos)
      message.replace(at, phrase.size(), plain);
  return message;
}

void check_bytes(std::string_view text, const fs::path& file) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  if (std::all_of(text.begin(), text.end(), is_space))
    throw SceneError(file.string(), "", "wanted a JSON object, found an empty file");
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw SceneError(file.string(), "", "wanted UTF-8 text, found UTF-16: save it as UTF-8");
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0 || text[at] == '\0')
      throw SceneError(file.string(), line_and_column(text, at + 1),
                       fmt::format("wanted UTF-8 text, found the byte 0x{:02X}: save it as UTF-8",
                                   static_cast<unsigned char>(text[at])));
    at += length;
  }
}

class DocumentBuilder : public nlohmann::json_sax<json> {
 public:
  DocumentBuilder(std::string_view text, const fs::path& file) : text_(text), file_(file) {}

  json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    key_ = name;
    const auto [member, is_new] = open_.back()->emplace(name, nullptr);
    if (!is_new)
      throw SceneError(file_.string(), pointer(), "duplicate key: wanted each key once in an object");
    member_ = &*member;
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::detail::exception& error) override {
    if (dynamic_cast<const json::out_of_range*>(&error))
      throw SceneError(file_.string(), pointer(), fmt::format("wanted a finite number, found {}", token));
    std::string message = plain_message(error.what(), word_at(text_, position));
    if (after_comma(position)) message += ": take the last comma away";
    throw SceneError(file_.string(), line_and_column(text_, begin_of(message, position)), message);
  }

 private:
  /// The pointer of the next value.
  std::string pointer() const {
    std::string result;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) result = join_pointer(result, tokens_[i + 1]);
    if (open_.empty()) return result;
    return join_pointer(result, open_.back()->is_array() ? std::to_string(open_.back()->size()) : key_);
  }

  /// Whether a container ends just before `position`, right after a comma.
  bool after_comma(std::size_t position) const {
    if (position == 0 || position > text_.size() ||
        (text_[position - 1] != '}' && text_[position - 1] != ']'))
      return false;
    const std::size_t before = text_.find_last_not_of(" \t\r\n", position - 2);
    return position > 1 && before != std::string_view::npos && text_[before] == ',';
  }

  /// The position of an error found at `end`: an unterminated comment is reported at its beginning, and the
  /// end of a line belongs to that line.
  std::size_t begin_of(std::string_view message, std::size_t end) const {
    if (message.find("missing closing '*/'") != message.npos) {
      return open_comment(text_) + 1;
    }
    return end > 0 && end <= text_.size() && text_[end - 1] == '\n' ? end - 1 : end;
  }

  json* place(json&& value) {
    if (open_.empty()) return &(root_ = std::move(value));
    if (open_.back()->is_array()) return &open_.back()->emplace_back(std::move(value));
    return &(*member_ = std::move(value));
  }

  bool add(json&& value) {
    place(std::move(value));
    return true;
  }

  bool open(json&& container) {
    if (open_.size() >= max_json_depth)
      throw SceneError(file_.string(), pointer(),
                       fmt::format("wanted at most {} nested arrays and objects", max_json_depth));
    tokens_.push_back(open_.empty()              ? ""
                      : open_.back()->is_array() ? std::to_string(open_.back()->size())
                                                 : key_);
    open_.push_back(place(std::move(container)));
    return true;
  }

  bool close() {
    open_.pop_back();
    tokens_.pop_back();
    return true;
  }

  std::string_view text_;
  const fs::path& file_;
  json root_;
  std::vector<json*> open_;          // open containers, outermost first
  std::vector<std::string> tokens_;  // tokens_[i] leads from open_[i - 1] to open_[i]
  std::string key_;                  // the latest key of the innermost object
  json* member_ = nullptr;           // the value of key_
};

/// Whether the text contains the name as a separate word: "made.ply", not "remade.ply".
bool names_file(const std::string& text, const std::string& name) {
  const auto is_of_word = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_');
  };
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
    if (!is_of_word(at - 1) && !is_of_word(at + name.size())) return true;  // 0 - 1 is beyond the end
  return false;
}

/// A script beside a missing file that mentions it, and so may write it; empty: none.
fs::path maker_of(const fs::path& file) {
  constexpr std::uintmax_t most = 1 << 20;
  std::error_code failed;
  fs::path found;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const fs::path& script = at->path();
    if (script.extension() != ".py" && script.extension() != ".sh") continue;
    try {
      if (names_file(read_regular_file(script, most), file.filename().string()) &&
          (found.empty() || script < found))
        found = script;
    } catch (const IoError&) {  // another script may mention it
    }
  }
  return found;
}

}  // namespace

json parse_json(std::string_view text, const fs::path& file) {
  check_bytes(text, file);
  check_json_memory(text, file);
  DocumentBuilder builder(text, file);
  json::sax_parse(text.begin(), text.end(), &builder, json::input_format_t::json, /*strict=*/true,
                  /*ignore_comments=*/true);
  return builder.take();
}

json read_json_file(const fs::path& file, const std::shared_ptr<Faults>& faults) {
  require_readable(file, file, "");
  return parse_json(read_input(file, most_input_bytes, faults), file);
}

void require_readable(const fs::path& file, const fs::path& named_in, std::string_view place) {
  const std::string name = file == named_in ? "" : fmt::format("\"{}\" ", file.string());
  const auto fail = [&](std::string_view what) {
    throw SceneError(named_in.string(), std::string(place), fmt::format("{}{}", name, what));
  };
  if (named_in.empty()) throw UsageError("a file's name is empty: wanted a scene or a model");
  std::error_code status;
  const fs::file_status found = fs::status(file, status);
  if (!fs::exists(found)) {
    if (status && status != std::errc::no_such_file_or_directory) fail(status.message());
    const fs::path maker = file == named_in ? fs::path() : maker_of(file);
    fail(maker.empty() ? "does not exist"
                       : fmt::format("does not exist: run {}, which names it", maker.string()));
  }
  if (fs::is_directory(found)) fail("is a folder, wanted a file");
  if (::access(file.c_str(), R_OK) != 0) fail(fmt::format("cannot be read: {}", std::strerror(errno)));
  note_file(file);
}

}  // namespace sundog
