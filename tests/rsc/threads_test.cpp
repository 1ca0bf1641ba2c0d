// The list of threads, for people and as JSON: priorities, shares of the processor.
#include "rsc/device/threads.hpp"

#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "runtime-m4/policy/standing.hpp"

using namespace robosync;

namespace {

link::ThreadInfo thread(const char* name, std::int8_t priority, std::int8_t base,
                        std::uint32_t run_time, std::uint32_t clock) {
  link::ThreadInfo info{};
  std::copy_n(name, std::char_traits<char>::length(name), info.name.begin());
  info.category = static_cast<std::uint8_t>(policy::Category::behavior);
  info.rank = 2;
  info.priority = priority;
  info.base_priority = base;
  info.stack_bytes = 320;
  info.stack_used = 204;
  info.activations = 7;
  info.missed = 1;
  info.run_time = run_time;
  info.clock = clock;
  return info;
}

}  // namespace

TEST_CASE("a thread has its priority, and what it is raised by") {
  const std::vector<link::ThreadInfo> list = {thread("greet", 57, 50, 0, 0),
                                              thread("calm", 40, 40, 0, 0)};
  const std::string table = tool::threads_table(list, {});
  CHECK(table.find("greet             behavior        50+7") != std::string::npos);
  CHECK(table.find("calm              behavior          40") != std::string::npos);
  CHECK(table.find("cpu") == std::string::npos);
  const auto json = tool::threads_json(list, {});
  CHECK(json[0].at("priority") == 57);
  CHECK(json[0].at("base_priority") == 50);
  CHECK(json[0].at("missed_deadlines") == 1);
  CHECK_FALSE(json[0].contains("cpu_percent"));
}

TEST_CASE("two lists tell each thread's share of the time between them") {
  const std::vector<link::ThreadInfo> before = {thread("greet", 50, 50, 100, 1000)};
  const std::vector<link::ThreadInfo> now = {thread("greet", 50, 50, 350, 2000),
                                             thread("new", 40, 40, 350, 2000)};
  const auto json = tool::threads_json(now, before);
  CHECK(json[0].at("cpu_percent") == 25.0);
  CHECK_FALSE(json[1].contains("cpu_percent"));
  const std::string table = tool::threads_table(now, before);
  CHECK(table.find(" 25.0 %") != std::string::npos);
}

TEST_CASE("the board's counters wrap, and a list may come twice at one time") {
  const std::vector<link::ThreadInfo> before = {thread("greet", 50, 50, 0xFFFF'FF00, 0xFFFF'FC00)};
  const std::vector<link::ThreadInfo> now = {thread("greet", 50, 50, 0x100, 0xC00)};
  CHECK(tool::threads_json(now, before)[0].at("cpu_percent") == 25.0 / 2);
  CHECK_FALSE(tool::threads_json(before, before)[0].contains("cpu_percent"));
}

TEST_CASE("several threads may have one name: each is compared with itself") {
  const std::vector<link::ThreadInfo> before = {thread("rule", 50, 50, 900'000, 1000),
                                                thread("rule", 50, 50, 100, 1000)};
  const std::vector<link::ThreadInfo> now = {thread("rule", 50, 50, 900'100, 2000),
                                             thread("rule", 50, 50, 400, 2000)};
  const auto json = tool::threads_json(now, before);
  CHECK(json[0].at("cpu_percent") == 10.0);
  CHECK(json[1].at("cpu_percent") == 30.0);
  CHECK(tool::load_of(now, before) == 40.0);
}

TEST_CASE("a thread that would have run backwards, or for longer than the time, has no share") {
  const std::vector<link::ThreadInfo> before = {thread("rule", 50, 50, 900'000, 1000)};
  const std::vector<link::ThreadInfo> now = {thread("rule", 50, 50, 400, 2000)};
  CHECK_FALSE(tool::threads_json(now, before)[0].contains("cpu_percent"));
  CHECK_FALSE(tool::load_of(now, before));
  CHECK(tool::threads_table(now, before).find(" % ") == std::string::npos);
}
