// The numbers come from the line and are not trusted. The board's counters wrap at 32 bits, so only
// differences between lists less than minutes apart are meaningful.
#include "rsc/device/threads.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "rsc/device/session.hpp"
#include "rsc/json.hpp"
#include "runtime-m4/policy/standing.hpp"

namespace robosync::tool {
namespace {

// By the numbers in link::ThreadInfo; kernel::Category has the same order.
constexpr std::array<std::string_view, policy::kCategories> kCategories = {
    "system", "sensor", "algorithm", "processing", "behavior", "control", "safety"};
constexpr std::array<std::string_view, 4> kStates = {"blocked", "ready", "stopped", "absent"};

template <std::size_t N>
std::string_view word(const std::array<std::string_view, N>& words, std::size_t number) {
  return number < N ? words[number] : "?";
}

bool is_like(const link::ThreadInfo& one, const link::ThreadInfo& other) {
  return one.name == other.name && one.category == other.category &&
         one.base_priority == other.base_priority;
}

// Several threads may have one name, such as the rules outside behaviours: the n-th now is the n-th before. The board lists them
// by rank, which may have changed: see share(). Null: it was not there.
const link::ThreadInfo* earlier_of(const link::ThreadInfo& thread, ThreadList now,
                                   ThreadList before) {
  auto nth =
      std::count_if(now.data(), &thread, [&](const auto& one) { return is_like(one, thread); });
  for (const link::ThreadInfo& one : before)
    if (is_like(one, thread) && nth-- == 0) return &one;
  return nullptr;
}

// In percent, of a thread in `now`. A new thread, or one of another program, has no share yet. Nor has one whose numbers do not
// fit together: they are those of different threads.
std::optional<double> share(const link::ThreadInfo& thread, ThreadList now, ThreadList before) {
  const link::ThreadInfo* const earlier = earlier_of(thread, now, before);
  if (earlier == nullptr || earlier->activations > thread.activations) return std::nullopt;
  const std::uint32_t ran = thread.run_time - earlier->run_time;
  const std::uint32_t passed = thread.clock - earlier->clock;
  // The last turn before a list may be counted in the next one.
  if (passed == 0 || ran > passed + passed / 8.0) return std::nullopt;
  return std::min(100.0 * ran / passed, 100.0);
}

// "50", and "50+7" while it is raised by 7.
std::string priority(const link::ThreadInfo& thread) {
  const int raised = thread.priority - thread.base_priority;
  return raised == 0 ? fmt::format("{}", thread.priority)
                     : fmt::format("{}{:+}", thread.base_priority, raised);
}

std::string share_column(const link::ThreadInfo& thread, ThreadList now, ThreadList before) {
  if (before.empty()) return {};
  const auto percent = share(thread, now, before);
  return percent ? fmt::format(" {:>5.1f} %", *percent) : fmt::format(" {:>7}", "-");
}

}  // namespace

std::string threads_table(ThreadList now, ThreadList before) {
  std::string text = fmt::format(
      "rank  thread            category    priority{}  state    stack used/bytes     "
      "woken  missed\n",
      before.empty() ? "" : "     cpu");
  for (const link::ThreadInfo& thread : now) {
    text += fmt::format("{:>4}  {:<16}  {:<10}  {:>8}{}  {:<8} {:>10}/{:<6}  {:>9}  {:>6}\n",
                        thread.rank, text_of(thread.name), word(kCategories, thread.category),
                        priority(thread), share_column(thread, now, before),
                        word(kStates, thread.state), thread.stack_used, thread.stack_bytes,
                        thread.activations, thread.missed);
  }
  return text;
}

std::optional<double> load_of(ThreadList now, ThreadList before) {
  std::optional<double> load;
  for (const link::ThreadInfo& thread : now)
    if (const auto percent = share(thread, now, before)) load = load.value_or(0) + *percent;
  return load;
}

Json threads_json(ThreadList now, ThreadList before) {
  Json list = Json::array();
  for (const link::ThreadInfo& thread : now) {
    list.push_back({{"name", text_of(thread.name)},
                    {"category", word(kCategories, thread.category)},
                    {"rank", thread.rank},
                    {"priority", thread.priority},
                    {"base_priority", thread.base_priority},
                    {"state", word(kStates, thread.state)},
                    {"stack_bytes", thread.stack_bytes},
                    {"stack_used", thread.stack_used},
                    {"activations", thread.activations},
                    {"missed_deadlines", thread.missed}});
    if (const auto percent = share(thread, now, before)) list.back()["cpu_percent"] = *percent;
  }
  return list;
}

}  // namespace robosync::tool
