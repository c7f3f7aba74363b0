// DriverThreads: threads that a driver still holds are counted and waited for.
#include <atomic>
#include <chrono>
#include <thread>

#include "base/driver_threads.h"
#include "catch.h"

using namespace sundog;
using namespace std::chrono_literals;

TEST_CASE("threads that drivers have not let go of are counted and waited for by their owner") {
  std::atomic<bool> released{false}, used{false};
  const auto in_driver = [&] {
    while (!released) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(20ms);
    used = true;
  };
  auto owner = std::make_shared<DriverThreads>();
  leave_thread(owner, start_thread(in_driver));
  leave_thread(owner, start_thread([] {}));
  while (owner->count() > 1) std::this_thread::sleep_for(1ms);
  std::this_thread::sleep_for(10ms);
  CHECK(owner->count() == 1);
  released = true;
  owner.reset();
  CHECK(used);
}

TEST_CASE("a thread that is left while its owner waits is waited for, too") {
  std::atomic<bool> waits{false}, done{false};
  const auto owner = std::make_shared<DriverThreads>();
  leave_thread(owner, start_thread([&] {  // a worker that ends leaves its compiler's thread
                 while (!waits) std::this_thread::sleep_for(1ms);
                 std::this_thread::sleep_for(20ms);
                 leave_thread(owner, start_thread([&] {
                                std::this_thread::sleep_for(20ms);
                                done = true;
                              }));
               }));
  waits = true;
  owner->wait();
  CHECK(done);
  CHECK(owner->count() == 0);
}

TEST_CASE("a thread that nobody takes over is waited for") {
  std::atomic<bool> done{false};
  leave_thread({}, start_thread([&] {
                 std::this_thread::sleep_for(20ms);
                 done = true;
               }));
  CHECK(done);
}

TEST_CASE("the owner of a thread that hangs lets it go") {
  const auto released = std::make_shared<std::atomic<bool>>(false),
             ended = std::make_shared<std::atomic<bool>>(false);
  {
    const auto owner = std::make_shared<DriverThreads>(20ms);
    leave_thread(owner, start_thread([released, ended] {
                   while (!*released) std::this_thread::sleep_for(1ms);
                   *ended = true;
                 }));
  }
  CHECK_FALSE(*ended);
  *released = true;
  while (!*ended) std::this_thread::sleep_for(1ms);
}
