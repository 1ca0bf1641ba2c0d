// See worker.hpp.
#include "companion/worker.hpp"

#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string_view>
#include <system_error>

namespace robosync::companion {
namespace {

constexpr std::string_view kDashes = "--";

}  // namespace

Arguments::Arguments(int count, char** texts) {
  for (int i = 1; i < count; ++i) {
    const std::string_view name = texts[i];
    if (name == "--no-pace") {
      no_pace_ = true;
      continue;
    }
    if (!name.starts_with(kDashes) || i + 1 == count)
      throw Failure(Exit::asked_wrongly, "expected --NAME VALUE, and got " + std::string(name));
    texts_[std::string(name.substr(kDashes.size()))].emplace_back(texts[++i]);
  }
}

const std::vector<std::string>& Arguments::texts(const std::string& name) const {
  static const std::vector<std::string> kNone;
  const auto found = texts_.find(name);
  return found == texts_.end() ? kNone : found->second;
}

const std::string& Arguments::text(const std::string& name) const {
  if (!has(name)) throw Failure(Exit::asked_wrongly, "there is no --" + name);
  return texts(name).back();
}

std::string Arguments::text_or(const std::string& name, const std::string& otherwise) const {
  return has(name) ? texts(name).back() : otherwise;
}

double Arguments::number(const std::string& name) const {
  const std::string& value = text(name);
  const char* const end = value.data() + value.size();
  double result = 0;
  const auto read = std::from_chars(value.data(), end, result);
  if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(result))
    throw Failure(Exit::asked_wrongly, "--" + name + " is no number: " + value);
  return result;
}

std::chrono::milliseconds Arguments::period() const {
  constexpr double kLongest = 60'000;
  const double period = number("period");
  if (period < 1 || period > kLongest)
    throw Failure(Exit::asked_wrongly, "--period is from 1 to 60000 ms");
  return std::chrono::milliseconds(std::lround(period));
}

void say(const std::string& output, const std::string& value) {
  std::printf("%s %s\n", output.c_str(), value.c_str());
  if (std::fflush(stdout) != 0) throw Failure(Exit::outside, "nobody listens any more");
}

void say(const std::string& output, double value) {
  std::printf("%s %.3f\n", output.c_str(), value);
  if (std::fflush(stdout) != 0) throw Failure(Exit::outside, "nobody listens any more");
}

int run(void (*work)(const Arguments&), int count, char** texts) {
  std::signal(SIGPIPE, SIG_IGN);
  Exit exit = Exit::over;
  try {
    work(Arguments(count, texts));
  } catch (const Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    exit = failure.exit();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    exit = Exit::outside;
  }
  return static_cast<int>(exit);
}

}  // namespace robosync::companion
