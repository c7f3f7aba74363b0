#include "base/faults.h"

#include <atomic>
#include <cstdlib>
#include <deque>
#include <regex>
#include <string>

#include "base/error.h"

namespace sundog {
namespace {

struct Fault {
  std::string kind, where;
  int value = 0;
  std::size_t above = 0;
  bool any_size = true;
  std::size_t only = 0;  // the Nth occasion; 0: each
  std::atomic<std::size_t> occasions{0};
};

void parse(const std::string& text, std::deque<Fault>& faults) {
  static const std::regex form(R"(([a-z]+)(=(-?\d{1,9}))?(>(\d{1,12}))?@([^#,]+)(#(\d{1,9}))?)");
  std::smatch match;
  if (!std::regex_match(text, match, form))
    throw UsageError("SUNDOG_FAULTS: wanted KIND[=VALUE][>SIZE]@WHERE[#N], found " + text);
  Fault& fault = faults.emplace_back();
  fault.kind = match[1];
  fault.where = match[6];
  if (match[3].matched) fault.value = std::stoi(match[3]);
  fault.any_size = !match[5].matched;
  if (match[5].matched) fault.above = std::stoull(match[5]);
  if (match[8].matched) fault.only = std::stoull(match[8]);
}

std::deque<Fault> read_variable() {
  std::deque<Fault> faults;
  const char* variable = std::getenv("SUNDOG_FAULTS");
  const std::string text = variable ? variable : "";
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    parse(text.substr(at, end - at), faults);
    at = end + 1;
  }
  return faults;
}

}  // namespace

std::optional<int> fault(std::string_view kind, std::string_view where, std::size_t size) {
  static std::deque<Fault> faults = read_variable();
  for (Fault& fault : faults) {
    if (fault.kind != kind || fault.where != where || (!fault.any_size && size <= fault.above)) continue;
    const std::size_t occasion = ++fault.occasions;
    if (fault.only == 0 || fault.only == occasion) return fault.value;
  }
  return std::nullopt;
}

}  // namespace sundog
