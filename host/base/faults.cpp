// Parses KIND[=VALUE][>SIZE]@WHERE[#N[+]], and counts the occasions of each fault.
#include "base/faults.h"

#include <algorithm>
#include <atomic>
#include <regex>
#include <utility>

#include "base/error.h"

namespace sundog {

struct Faults::Fault {
  std::string kind, where;
  int value = 0;
  std::size_t above = 0;
  bool any_size = true;
  std::size_t only = 0;  // the Nth occasion; 0: each
  bool and_later = false;
  std::atomic<std::size_t> occasions{0};
};

namespace {

template <class Fault>
void parse(const std::string& text, std::deque<Fault>& faults) {
  static const auto& form =
      *new const std::regex(R"(([a-z]+)(=(-?\d{1,9}))?(>(\d{1,12}))?@([^#,]+)(#(\d{1,9})(\+)?)?)");
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
  fault.and_later = match[9].matched;
}

}  // namespace

Faults::Faults(const std::string& text, std::function<void(const std::string& kind)> end_process)
    : end_process_(std::move(end_process)) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    parse(text.substr(at, end - at), faults_);
    at = end + 1;
  }
}

Faults::~Faults() = default;

std::optional<int> Faults::strike(std::string_view kind, std::string_view where, std::size_t size) {
  for (Fault& fault : faults_) {
    if (fault.kind != kind || fault.where != where || (!fault.any_size && size <= fault.above)) continue;
    const std::size_t occasion = ++fault.occasions;
    if (fault.only == 0 || fault.only == occasion || (fault.and_later && occasion > fault.only))
      return fault.value;
  }
  return std::nullopt;
}

void Faults::end_process(const char* kind, std::string_view where, std::size_t size) {
  if (strike(kind, where, size) && end_process_) end_process_(kind);
}

std::optional<int> fault(const std::shared_ptr<Faults>& faults, std::string_view kind, std::string_view where,
                         std::size_t size) {
  return faults ? faults->strike(kind, where, size) : std::nullopt;
}

}  // namespace sundog
