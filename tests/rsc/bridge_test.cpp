// rsc bridge: robots that run in this process, the built rsc, and Debian's mosquitto as their broker.
#include <array>
#include <csignal>
#include <map>
#include <memory>
#include <optional>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/prctl.h>
#include <sys/wait.h>

#include "rsc/bridge/mqtt.hpp"
#include "rsc/bridge/topics.hpp"
#include "rsc/failure.hpp"
#include "rsc/loaded_library.hpp"
#include "tests/rsc/device.hpp"

using namespace robosync;
using Catch::Contains;
using nlohmann::json;
using test::Device;
using test::Outcome;
using namespace std::chrono_literals;

namespace {

int free_port() {
  const int file = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  REQUIRE(bind(file, reinterpret_cast<sockaddr*>(&address), size) == 0);
  REQUIRE(getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  close(file);
  return ntohs(address.sin_port);
}

// mosquitto, which forgets everything when it is started again.
class Broker : public test::Folder {
public:
  Broker() { start(); }
  ~Broker() { end(); }
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  void start() {
    write("broker.conf",
          "listener " + std::to_string(port) + " 127.0.0.1\nallow_anonymous true\nlog_dest none\n");
    const std::string file = path("broker.conf");
    process_ = fork();
    if (process_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGTERM);  // a test that aborts leaves no broker behind
      execl("/usr/sbin/mosquitto", "mosquitto", "-c", file.c_str(), nullptr);
      _exit(127);
    }
  }
  void end() {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }

  const int port = free_port();
  std::string place = "localhost:" + std::to_string(port);

private:
  pid_t process_ = 0;
};

// Whoever listens to the broker: all that came, by topic.
class Subscriber {
public:
  explicit Subscriber(const Broker& broker) {
    for (int i = 0; i < 100 && !mqtt_; ++i)
      try {
        mqtt_ = std::make_unique<tool::Mqtt>(tool::parse_broker(broker.place), "robosync/#",
                                             tool::MqttMessage{"test/gone", "1", true});
      } catch (const tool::Failure&) {
        std::this_thread::sleep_for(50ms);  // it is starting
      }
    REQUIRE(mqtt_);
  }

  // A message of the topic with `part` in it, behind the one that was last waited for.
  std::optional<std::string> wait_for(const std::string& topic, const std::string& part) {
    const auto give_up = std::chrono::steady_clock::now() + 15s;
    const std::vector<std::string>& payloads = came_[topic];
    for (std::size_t& next = next_[topic]; std::chrono::steady_clock::now() < give_up;) {
      while (next < payloads.size())
        if (const std::string& payload = payloads[next++]; payload.find(part) != std::string::npos)
          return payload;
      if (const auto message = mqtt_->next())
        came_[message->topic].push_back(message->payload);
      else
        std::this_thread::sleep_for(5ms);
    }
    for (const auto& [other, all] : came_)
      for (const std::string& payload : all)
        UNSCOPED_INFO(other + " " + payload);
    return std::nullopt;
  }
  [[nodiscard]] std::size_t count(const std::string& topic) const {
    return came_.contains(topic) ? came_.at(topic).size() : 0;
  }
  [[nodiscard]] bool has(const std::string& topic) const { return count(topic) != 0; }
  void publish(const std::string& topic, const std::string& payload, bool retain = false) {
    mqtt_->publish(topic, payload, retain);
  }

private:
  std::unique_ptr<tool::Mqtt> mqtt_;
  std::map<std::string, std::vector<std::string>> came_;
  std::map<std::string, std::size_t> next_;  // not yet looked at
};

// rsc bridge, until the robot's line is closed for good or its time is over.
class RunningBridge {
public:
  RunningBridge(const Device& device, const Broker& broker, const std::string& name,
                const std::string& duration)
      : thread_([this, &device, &broker, name, duration] {
          std::vector<std::string> asked{"bridge", "--mqtt", broker.place, "--duration", duration};
          if (!name.empty()) asked.insert(asked.end(), {"--name", name});
          outcome = device.run(asked);
        }) {}
  ~RunningBridge() {
    if (thread_.joinable()) thread_.join();
  }
  void join() { thread_.join(); }

  Outcome outcome;

private:
  std::thread thread_;
};

}  // namespace

TEST_CASE("what is published to be retained before the broker has answered comes once") {
  const Broker broker;
  Subscriber subscriber(broker);
  subscriber.publish("robosync/there", "yes", true);
  REQUIRE(subscriber.wait_for("robosync/there", "yes"));
  tool::Mqtt other(tool::parse_broker(broker.place), "none", {"test/gone", "1", true});
  other.publish("robosync/value", "1", true);
  for (int i = 0; i < 2000 && !other.news(); ++i)
    std::this_thread::sleep_for(5ms);
  CHECK_FALSE(other.next());  // what was retained is sent now
  other.publish("robosync/last", "1", true);
  REQUIRE(subscriber.wait_for("robosync/last", "1"));
  CHECK(subscriber.count("robosync/value") == 1);
}

TEST_CASE("a robot on a broker: what it does is published, and it is fed, stopped, resumed") {
  Broker broker;
  Subscriber subscriber(broker);
  Device device;
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  subscriber.publish("robosync/pet/do/stop", "now", true);  // lay there before: nobody obeys it
  REQUIRE(subscriber.wait_for("robosync/pet/do/stop", "now"));
  RunningBridge bridge(device, broker, "pet", "9s");
  CHECK(subscriber.wait_for("robosync/pet/online", "true"));
  CHECK(subscriber.wait_for("robosync/pet/board", "mps2-an386"));
  CHECK(subscriber.wait_for("robosync/pet/refused", "it was retained"));

  subscriber.publish("robosync/pet/do/feed/touch/LEVEL", "2");
  CHECK(subscriber.wait_for("robosync/pet/sensors/touch/LEVEL", R"("value":2)"));
  const auto command =
      subscriber.wait_for("robosync/pet/actuators/left_arm", R"("event":"command")");
  REQUIRE(command);
  CHECK(json::parse(*command).at("verb") == "MOVE");
  subscriber.publish("robosync/pet/do/feed/proximity/DISTANCE", R"({"value":"30cm"})");
  CHECK(subscriber.wait_for("robosync/pet/sensors/proximity/DISTANCE", R"("value":300)"));
  subscriber.publish("robosync/pet/do/stop", "");
  CHECK(subscriber.wait_for("robosync/pet/actuators/left_arm", "halt"));
  CHECK(subscriber.wait_for("robosync/pet/stopped", "true"));
  subscriber.publish("robosync/pet/do/resume", "");
  CHECK(subscriber.wait_for("robosync/pet/stopped", "false"));

  for (const auto& [topic, payload] : {std::pair{"feed/touch/LEVL", "2"},
                                       {"feed/touch/LEVEL", "x"},
                                       {"feed/touch/LEVEL", "{}"},
                                       {"feed/", ""},
                                       {"jump", "now"}}) {
    subscriber.publish(std::string("robosync/pet/do/") + topic, payload);
    CAPTURE(topic, payload);
    CHECK(subscriber.wait_for("robosync/pet/refused", topic));
  }

  const std::string large(2000, '1'), binary("x\0y", 3);
  subscriber.publish("robosync/pet/do/feed/touch/LEVEL", large);
  CHECK(subscriber.wait_for("robosync/pet/refused", "2000 bytes are too many for a reading"));
  subscriber.publish("robosync/pet/do/feed/touch/LEVEL", binary);
  CHECK(subscriber.wait_for("robosync/pet/refused", "x\xEF\xBF\xBDy"));

  // The broker is away and has forgotten everything; the bridge has not.
  broker.end();
  std::this_thread::sleep_for(200ms);
  broker.start();
  Subscriber late(broker);
  CHECK(late.wait_for("robosync/pet/sensors/touch/LEVEL", R"("value":2)"));
  CHECK(late.wait_for("robosync/pet/online", "true"));
  // The robot is away for a moment.
  device.bridge.hang_up();
  CHECK(late.wait_for("robosync/pet/online", "false"));
  CHECK(late.wait_for("robosync/pet/online", "true"));
  bridge.join();
  CAPTURE(bridge.outcome.err);
  CHECK(bridge.outcome.exit == 0);
  CHECK_THAT(bridge.outcome.err,
             Contains("the broker is away") && Contains("looking for it again"));
  CHECK(late.wait_for("robosync/pet/online", "false"));
}

TEST_CASE("a bridge begins with what is known, tripped, halted and stopped") {
  const Broker broker;
  Subscriber subscriber(broker);
  const Device device;
  const std::string guarded = device.write(
      "guarded.rsl",
      "REMEMBER count = 4\nSAFETY far\n  WHEN touch LEVEL > 8\n  DO STOP left_arm\nEND\n"
      "WHEN touch LEVEL < 3 DO\n  MOVE left_arm SLOWLY TO 90deg\n  SET count TO 5\nEND\n");
  REQUIRE(device.run({"feed", "touch.LEVEL=9", "--upload", guarded, "--watch", "200ms"}).exit == 0);
  REQUIRE(device.run({"stop"}).exit == 0);
  RunningBridge bridge(device, broker, "pet", "500ms");
  const auto reading = subscriber.wait_for("robosync/pet/sensors/touch/LEVEL", R"("value":9)");
  REQUIRE(reading);
  CHECK(json::parse(*reading).at("t_us") > 200'000);  // of the moment at which it was asked for
  CHECK(subscriber.wait_for("robosync/pet/variables/count", R"("value":4)"));
  CHECK(subscriber.wait_for("robosync/pet/safety/line 2", "trip"));
  CHECK(subscriber.wait_for("robosync/pet/actuators/left_arm", "halt"));
  CHECK(subscriber.wait_for("robosync/pet/stopped", "true"));
  bridge.join();
  CHECK(bridge.outcome.exit == 0);
}

TEST_CASE("without --name, the topics begin with the robot's own name, if it has one") {
  const Broker broker;
  Subscriber subscriber(broker);
  const Device device;
  RunningBridge(device, broker, "", "500ms").join();
  CHECK(subscriber.wait_for("robosync/robot/board", "\"robot\":null"));
  json robot = json::parse(test::kRobot);
  robot["name"] = "ada";
  const std::string config = device.write("ada.json", robot.dump());
  REQUIRE(device.run({"upload", device.program, "--config", config}).exit == 0);
  RunningBridge(device, broker, "", "500ms").join();
  CHECK(subscriber.wait_for("robosync/ada/board", "\"robot\":\"ada\""));
}

TEST_CASE("a broker knows which program runs, and has nothing of one that ran before") {
  Broker broker;
  Subscriber subscriber(broker);
  const Device device;
  const auto hash = [&] {
    return json::parse(device.run({"info", "--format", "json"}).out)
        .at("board")
        .at("program")
        .at("hash")
        .get<std::string>();
  };
  REQUIRE(device.run({"upload", device.program}).exit == 0);
  // A bridge was here before, with another program.
  for (const char* const topic :
       {"safety/line 12", "behaviors/beta", "sensors/gone/LEVEL", "program", "mine"})
    subscriber.publish(std::string("robosync/pet/") + topic, "old", true);
  REQUIRE(subscriber.wait_for("robosync/pet/mine", "old"));
  const std::string first = hash();
  {
    const RunningBridge bridge(device, broker, "pet", "2s");
    CHECK(subscriber.wait_for("robosync/pet/program", first));
    subscriber.publish("robosync/pet/do/stop", "");
    CHECK(subscriber.wait_for("robosync/pet/stopped", "true"));
  }
  REQUIRE(device.run({"resume"}).exit == 0);  // while no bridge is there to see it
  const std::string other =
      device.write("other.rsl", "WHEN touch LEVEL > 8 DO\n  MOVE left_arm TO 1deg\nEND\n");
  REQUIRE(device.run({"upload", other, "--config", device.path("robot.json")}).exit == 0);
  const std::string second = hash();
  CHECK(first != second);
  RunningBridge bridge(device, broker, "pet", "3s");
  CHECK(subscriber.wait_for("robosync/pet/program", second));
  Subscriber late(broker);
  CHECK(late.wait_for("robosync/pet/program", second));
  CHECK(late.wait_for("robosync/pet/mine", "old"));
  CHECK(late.wait_for("robosync/pet/stopped", "false"));
  for (const char* const topic : {"safety/line 12", "behaviors/beta", "sensors/gone/LEVEL"})
    CHECK_FALSE(late.has(std::string("robosync/pet/") + topic));
  bridge.join();
  CHECK(bridge.outcome.exit == 0);
}

TEST_CASE("a fleet of twenty robots on one broker, and three who listen to all of them") {
  Broker broker;
  Subscriber first(broker), second(broker), third(broker);
  const std::array everybody{&first, &second, &third};
  constexpr int kRobots = 20;
  std::vector<std::unique_ptr<Device>> robots;
  std::vector<std::unique_ptr<RunningBridge>> bridges;
  for (int i = 0; i < kRobots; ++i) {
    robots.push_back(std::make_unique<Device>());
    REQUIRE(robots.back()->run({"upload", robots.back()->program}).exit == 0);
  }
  for (int i = 0; i < kRobots; ++i)
    bridges.push_back(std::make_unique<RunningBridge>(*robots[static_cast<std::size_t>(i)], broker,
                                                      "r" + std::to_string(i), "15s"));
  for (int i = 0; i < kRobots; ++i) {
    CAPTURE(i);
    const std::string root = "robosync/r" + std::to_string(i) + "/";
    const std::string level = std::to_string(i % 10);
    CHECK(first.wait_for(root + "online", "true"));
    // Whoever listens may also speak.
    everybody[static_cast<std::size_t>(i) % everybody.size()]->publish(root + "do/feed/touch/LEVEL",
                                                                       level);
    for (Subscriber* const subscriber : everybody)
      CHECK(subscriber->wait_for(root + "sensors/touch/LEVEL", "\"value\":" + level));
  }
  for (Subscriber* const subscriber : everybody) {
    CHECK(subscriber->wait_for("robosync/r12/actuators/left_arm", "command"));  // 2 is below 3
    CHECK_FALSE(subscriber->has("robosync/r13/actuators/left_arm"));
  }
  for (const auto& bridge : bridges) {
    bridge->join();
    CHECK(bridge->outcome.exit == 0);
  }
}

TEST_CASE("rsc bridge says what is wrong with a broker") {
  const Device device;
  Outcome outcome = device.run({"bridge", "--mqtt", "localhost:" + std::to_string(free_port())});
  CHECK(outcome.exit == 3);
  CHECK_THAT(outcome.err, Contains("is a broker running there?"));
  for (const char* wrong : {"", ":1883", "localhost:", "localhost:0", "localhost:70000",
                            "localhost:x", "localhost:18x"}) {
    CAPTURE(wrong);
    CHECK(device.run({"bridge", "--mqtt", wrong}).exit == 2);
  }
  for (const char* wrong : {"#", "a/b"}) {
    CAPTURE(wrong);
    outcome = device.run({"bridge", "--mqtt", "localhost", "--name", wrong});
    CHECK(outcome.exit == 2);
    CHECK_THAT(outcome.err, Contains("give the robot another --name"));
  }
  CHECK(tool::parse_broker("[::1]:1884").host == "::1");
  CHECK(tool::parse_broker("[::1]").host == "::1");
  CHECK(tool::parse_broker("broker").port == 1883);
}

TEST_CASE("every event of a trace has a topic, and no name makes one of another robot") {
  CHECK(tool::topic_part("a/b+c#d\n") == "a_b_c_d_");
  CHECK(tool::topic_part("") == "?");
  CHECK(tool::topic_of({{"event", "input"}, {"sensor", "a/b"}, {"channel", 3}}).name ==
        "sensors/a_b/3");
  CHECK(tool::topic_of({{"event", "win"}, {"rule", 1}, {"line", 7}}).name == "behaviors/line 7");
  CHECK(tool::topic_of({{"event", "trip"}, {"rule", 1}, {"line", 7}}).name == "safety/line 7");
  CHECK_FALSE(tool::topic_of({{"event", "deadline"}, {"thread", "x"}}).retain);
  CHECK(tool::topic_of({{"event", "command"}}).name == "actuators/?");
  CHECK(tool::topic_of({{"event", "blocked"}, {"actuator", "base"}}).name == "actuators/base");
  CHECK(tool::reading_of("feed/a/B", "20cm") == "a.B=20cm");
  CHECK(tool::reading_of("feed/a/B", "2.5") == "a.B=2.5");
  CHECK(tool::reading_of("feed/a/B", "\"hello\"") == "a.B=hello");
  CHECK_FALSE(tool::reading_of("stop", ""));
}

TEST_CASE("a library that is not installed, or is another one") {
  CHECK_THROWS_WITH(tool::LoadedLibrary("libnone.so.7", "libnone7", "rsc none"),
                    "rsc none needs libnone.so.7, which is not installed: on Debian, `sudo apt "
                    "install libnone7`");
  void (*function)() = nullptr;
  CHECK_THROWS_WITH(tool::LoadedLibrary("libmosquitto.so.1", "libmosquitto1", "rsc bridge")
                        .find("none", function),
                    "this libmosquitto.so.1 has no none");
}
