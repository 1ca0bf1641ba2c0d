// Setting variables, which value counts when several rules set one, and what the next step sees.
#include <catch2/catch.hpp>

#include "tests/runtime-m4/robot.hpp"

using robosync::test::Robot;

TEST_CASE("what is set enters the step of the next millisecond") {
  Robot robot(R"(
STATE mood: calm, happy
BEHAVIOR single PRIORITY 10
  WHEN near X > 10
  DO SET mood TO happy
  END
  WHEN mood IS happy
  DO LOG "happy"
  END
END
)");
  robot.feed(100, "X", 20);
  robot.run(1000);
  CHECK(robot.only("input fire set log") ==
        "100 #2 input X 20\n100 #2 fire r0 DO\n101 #3 set mood 1\n101 #3 fire r1 DO\n"
        "101 #3 log \"happy\"\n");
}

TEST_CASE("of two SETs in one step the more important one stays; RAISE adds to it") {
  Robot robot(R"(
REMEMBER n = 5
BEHAVIOR low PRIORITY 10
  WHEN near X > 10
  DO SET n TO 100
  END
END
BEHAVIOR high PRIORITY 30
  WHEN near X > 10
  DO RAISE n BY 2
  END
END
BEHAVIOR middle PRIORITY 20
  WHEN near X > 10
  DO SET n TO 40
  END
END
BEHAVIOR lowest PRIORITY 5
  WHEN near X > 10
  DO RAISE n BY 1000
  END
END
)");
  robot.feed(100, "X", 20);
  robot.run(1000);
  CHECK(robot.only("set") == "101 #3 set n 42\n");
}

TEST_CASE("two RAISEs in one step are both counted") {
  Robot robot(R"(
REMEMBER n = 5
BEHAVIOR low PRIORITY 10
  WHEN near X > 10
  DO RAISE n BY 1
  END
END
BEHAVIOR high PRIORITY 30
  WHEN near X > 10
  DO LOWER n BY 3
  END
END
)");
  robot.feed(100, "X", 20);
  robot.run(1000);
  CHECK(robot.only("set") == "101 #3 set n 3\n");
}

TEST_CASE("a response sees at once what it sets, the others in the next step") {
  Robot robot(R"(
REMEMBER n = 1
BEHAVIOR high PRIORITY 30
  WHEN near X > 10
  DO
    SET n TO n + 1
    LOG "mine ", n
  END
END
BEHAVIOR low PRIORITY 10
  WHEN near X > 10
  DO LOG "theirs ", n
  END
END
)");
  robot.feed(100, "X", 20);
  robot.run(1000);
  std::string values;
  for (const std::string& line : robot.lines())
    if (line.find(" log ") != std::string::npos) values += line.substr(line.rfind(' ') + 1) + " ";
  CHECK(values == "2 1 ");
}

TEST_CASE("a WHEN on what it sets itself takes one step a millisecond, for ever") {
  Robot robot(R"(
REMEMBER n = 0
BEHAVIOR count PRIORITY 10
  WHEN n CHANGES
  DO SET n TO n + 1
  END
  AT START DO SET n TO 1
  END
END
)");
  robot.run(50);
  CHECK(robot.only("set").find("1 #2 set n 1\n2 #3 set n 2\n3 #4 set n 3\n") == 0);
  CHECK(robot.lines().back().find("50 #51 ") == 0);
}

TEST_CASE("a SIGNAL is true for one step, for all") {
  Robot robot(R"(
BEHAVIOR sender PRIORITY 10
  WHEN near X > 10
  DO SIGNAL hello
  END
END
BEHAVIOR hears PRIORITY 20
  WHEN hello
  DO LOG "heard"
  END
END
)");
  robot.feed(100, "X", 20);
  robot.feed(200, "X", 5);
  robot.feed(300, "X", 20);
  robot.run(1000);
  CHECK(robot.only("log") == "101 #3 log \"heard\"\n301 #7 log \"heard\"\n");
}

TEST_CASE("a variable of a CHECK follows its input, leaving a band late by its margin") {
  Robot robot(R"(
CHECK space OF near X
  close BELOW 30
  far   OTHERWISE
  MARGIN 5
END
WHEN space IS close
DO LOG "close"
END
)");
  int at = 0;
  for (const int x : {50, 29, 31, 34, 36, 32, 29})
    robot.feed(static_cast<std::uint64_t>(at += 10), "X", x);
  robot.run(100);
  CHECK(robot.only("set log") ==
        "10 #1 set space 1\n20 #2 set space 0\n20 #2 log \"close\"\n50 #5 set space 1\n"
        "70 #7 set space 0\n70 #7 log \"close\"\n");
}

TEST_CASE("a feeling fades to its rest in steps of 100 ms, 95 % in the time given") {
  Robot robot(R"(
FEELING fear FROM 0% TO 100% START 0%
  FADES TO 0% OVER 1s
BEHAVIOR feel PRIORITY 10
  WHEN near X > 10
  DO RAISE fear BY 80%
  END
END
)");
  robot.feed(50, "X", 20);
  robot.run(5000);
  const std::string all = robot.only("set");
  // 80 % at 51 ms; 5 % of it is left ten ticks later.
  CHECK(all.find("51 #3 set fear 80\n151 #4 set fear 59.2") == 0);
  CHECK((all.find("1051 #13 set fear 4.000\n") != std::string::npos ||
         all.find("1051 #13 set fear 3.999\n") != std::string::npos ||
         all.find("1051 #13 set fear 4\n") != std::string::npos));
  CHECK(all.rfind("set fear 0\n") == all.size() - std::string("set fear 0\n").size());
}
