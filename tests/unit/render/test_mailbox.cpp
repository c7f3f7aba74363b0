// Channels between the processes of a job, over a transport within this process; and which rank gets which
// device.
#include <render/plan/deal_devices.h>
#include <render/remote/mailbox.h>

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <thread>

#include "catch.h"

using namespace sundog;

namespace {

/// Two ranks' mail.
struct Wire {
  std::mutex mutex;
  std::array<std::deque<Parcel>, 2> to;
  std::array<std::atomic<bool>, 2> dumb{};  // of that rank, nothing comes any more
  std::array<std::atomic<bool>, 2> finished{};
};

class WireTransport : public Transport {
 public:
  WireTransport(std::shared_ptr<Wire> wire, int rank) : wire_(std::move(wire)), rank_(rank) {}
  int rank() const override { return rank_; }
  const std::vector<std::string>& hosts() const override { return hosts_; }
  void post(int rank, std::string bytes) override {
    const std::lock_guard lock(wire_->mutex);
    if (!wire_->dumb[index(rank_)]) wire_->to[index(rank)].push_back({rank_, std::move(bytes)});
  }
  std::optional<Parcel> take() override {
    const std::lock_guard lock(wire_->mutex);
    std::deque<Parcel>& mine = wire_->to[index(rank_)];
    if (mine.empty()) return std::nullopt;
    Parcel parcel = std::move(mine.front());
    mine.pop_front();
    return parcel;
  }
  void finish() override { wire_->finished[index(rank_)] = true; }
  [[noreturn]] void abort(int status) override { std::_Exit(status); }

 private:
  static std::size_t index(int rank) { return static_cast<std::size_t>(rank); }

  std::shared_ptr<Wire> wire_;
  int rank_;
  std::vector<std::string> hosts_ = {"a", "b"};
};

struct TwoRanks {
  std::shared_ptr<Wire> wire = std::make_shared<Wire>();
  std::unique_ptr<Mailbox> first = mailbox(0), second = mailbox(1);

  std::unique_ptr<Mailbox> mailbox(int rank) const {
    return std::make_unique<Mailbox>([this, rank] { return std::make_unique<WireTransport>(wire, rank); },
                                     1.5);
  }
};

Message receive(Channel& channel) {
  for (int tries = 0; tries < 100; ++tries)
    if (std::optional<Message> message = channel.receive(0.1)) return *message;
  FAIL("nothing came");
  return {};
}

DeviceInfo device(int rank, const std::string& host, const std::string& type,
                  const std::string& identity = "") {
  DeviceInfo info;
  info.device = 0;
  info.rank = rank;
  info.host = host;
  info.type = type;
  info.identity = identity;
  info.compute_units = 8;
  info.max_sub_devices = type == "cpu" ? 8 : 0;
  info.estimate = 80;
  return info;
}

/// "0: 3 units; 1: 2 units" of what was dealt.
std::string text(const std::vector<DeviceInfo>& dealt) {
  std::string all;
  for (const DeviceInfo& each : dealt)
    all += fmt::format("{}{}: {} units", all.empty() ? "" : "; ", each.rank,
                       each.sub_units > 0 ? each.sub_units : each.compute_units);
  return all;
}

}  // namespace

TEST_CASE("channels of two ranks carry messages of any size, each its own") {
  TwoRanks ranks;
  const auto one = ranks.first->connect(1), two = ranks.first->connect(1);
  const std::string large(std::size_t{9} << 20, 'x');  // several pieces
  two->send({Message::render, {{"job", 2}}, large});
  one->send({Message::open, {{"job", 1}}, {}});
  const auto second_one = ranks.second->accept(), second_two = ranks.second->accept();
  CHECK((receive(*second_two).data == large));  // not printed
  CHECK(receive(*second_one).values["job"] == 1);
  second_one->send({Message::ready, {{"job", 3}}, large});
  const Message answer = receive(*one);
  CHECK(answer.kind == Message::ready);
  CHECK((answer.data == large));
  CHECK_FALSE(two->receive(0.01).has_value());
}

TEST_CASE("a job ends in good order when all ranks leave, and its channels with it") {
  TwoRanks ranks;
  const auto channel = ranks.first->connect(1);
  bool other_left = false;  // CHECK is for one thread alone
  std::thread other([&] {
    while (ranks.second->accept()) {  // the channel may come before the end of the job
    }
    other_left = ranks.second->leave(0);
    ranks.second.reset();
  });
  CHECK(ranks.first->leave(0));
  other.join();
  CHECK(other_left);
  ranks.first.reset();
  CHECK(ranks.wire->finished[0]);
  CHECK(ranks.wire->finished[1]);
  CHECK_THROWS_AS(channel->receive(0.1), ChannelClosed);
}

TEST_CASE("a rank that falls silent is named, and only its channels close") {
  TwoRanks ranks;
  const auto channel = ranks.first->connect(1);
  std::this_thread::sleep_for(std::chrono::milliseconds(1800));
  REQUIRE_FALSE(ranks.first->gone(1));  // it has nothing to say, but lives
  ranks.wire->dumb[1] = true;
  std::string why;
  try {
    for (int tries = 0; tries < 100; ++tries) channel->receive(0.1);
  } catch (const ChannelClosed& error) {
    why = error.what();
  }
  CHECK(why.starts_with("rank 1 on b has not been heard of for "));
  CHECK(ranks.first->gone(1));
  CHECK(ranks.first->silent_for(1) == std::vector<int>{1});
  CHECK_FALSE(ranks.second->gone(0));
}

TEST_CASE("the ranks of a machine divide its processor and take turns with its other devices") {
  const DeviceInfo cpu0 = device(0, "a", "cpu"), cpu1 = device(1, "a", "cpu"), cpu2 = device(2, "a", "cpu");
  CHECK(text(deal_devices({{8, {cpu0}}})) == "0: 8 units");
  CHECK(text(deal_devices({{8, {cpu0}}, {8, {cpu1}}, {8, {cpu2}}})) == "0: 3 units; 1: 3 units; 2: 2 units");
  CHECK(text(deal_devices({{2, {cpu0}}, {8, {cpu1}}})) == "0: 2 units; 1: 4 units");  // bound to two cores
  CHECK(text(deal_devices({{8, {cpu0}}, {8, {device(1, "b", "cpu")}}})) == "0: 8 units; 1: 8 units");
  const std::vector<DeviceInfo> halves = deal_devices({{8, {cpu0}}, {8, {cpu1}}});
  CHECK(halves[0].estimate == 40);
  DeviceInfo asked_for = device(1, "a", "cpu");
  asked_for.sub_units = 5;
  CHECK(text(deal_devices({{8, {cpu0}}, {8, {asked_for}}})) == "0: 8 units; 1: 5 units");

  const auto gpus = [](int rank) {
    DeviceInfo other = device(rank, "a", "gpu");
    other.device = 1;
    return std::vector{device(rank, "a", "gpu"), other};
  };
  CHECK(text(deal_devices({{8, gpus(0)}, {8, gpus(1)}, {8, gpus(2)}})) == "0: 8 units; 1: 8 units");
  CHECK(deal_devices({{8, gpus(0)}}).size() == 2);
  // Each rank has been given a device of its own, which it sees as its first.
  CHECK(text(deal_devices({{8, {device(0, "a", "gpu", "x")}}, {8, {device(1, "a", "gpu", "y")}}})) ==
        "0: 8 units; 1: 8 units");
  CHECK(text(deal_devices({{8, {device(0, "a", "gpu", "x")}}, {8, {device(1, "a", "gpu", "x")}}})) ==
        "0: 8 units");
}

TEST_CASE("more ranks than compute units leave some without a device") {
  std::vector<RankDevices> ranks;
  for (int rank = 0; rank < 10; ++rank) ranks.push_back({8, {device(rank, "a", "cpu")}});
  CHECK(deal_devices(ranks).size() == 8);
}
