// A robot's worth of threads on the host's kernel, each running a lambda, and a log of what they
// did.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "runtime-m4/kernel/kernel.hpp"

namespace robosync::kernel::test {

class Rig {
public:
  struct Worker {
    Thread thread;
    std::function<void()> body;
    std::array<std::byte, 64> stack{};
  };

  Worker& add(const char* name, Category category, std::int16_t priority,
              std::function<void()> body) {
    workers_.push_back(std::make_unique<Worker>());
    Worker& worker = *workers_.back();
    worker.body = std::move(body);
    REQUIRE(start(worker, name, category, priority));
    return worker;
  }

  bool start(Worker& worker, const char* name, Category category, std::int16_t priority) {
    ThreadSpec spec;
    spec.name = name;
    spec.category = category;
    spec.priority = priority;
    spec.entry = [](void* body) { (*static_cast<std::function<void()>*>(body))(); };
    spec.argument = &worker.body;
    spec.stack = worker.stack;
    return kernel.add(worker.thread, spec);
  }

  void note(const std::string& what) {
    log += log.empty() ? "" : " ";
    log += what;
  }

  std::string names() const {
    std::string all;
    for (const Thread* thread : kernel.threads())
      all += thread->name();
    return all;
  }

  Kernel kernel;
  std::string log;

private:
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace robosync::kernel::test
